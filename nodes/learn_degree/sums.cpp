#include "learn_degree/sums.h"

#include <algorithm>
#include <cmath>

#include "base/clones.h"

namespace sherd {
namespace {

constexpr std::size_t kPack = 4;      // lanes of one vector
constexpr std::size_t kTogether = 8;  // columns at once: y is read and written once for all

typedef double Pack __attribute__((vector_size(kPack * sizeof(double)), aligned(sizeof(double)), may_alias));

[[gnu::always_inline]] inline double sumOf(const Pack& p) { return (p[0] + p[2]) + (p[1] + p[3]); }

}  // namespace

SHERD_CLONES void addProduct(const Columns& m, const double* __restrict__ a, double* __restrict__ y) {
  std::size_t j = 0;
  for (; j + kTogether <= m.columns; j += kTogether) {
    const double* __restrict__ c = m.value + j * m.rows;
    const std::size_t s = m.rows;
    const double a0 = a[j], a1 = a[j + 1], a2 = a[j + 2], a3 = a[j + 3], a4 = a[j + 4], a5 = a[j + 5],
                 a6 = a[j + 6], a7 = a[j + 7];
    for (std::size_t i = 0; i < s; ++i)
      y[i] += ((c[i] * a0 + c[i + s] * a1) + (c[i + 2 * s] * a2 + c[i + 3 * s] * a3)) +
              ((c[i + 4 * s] * a4 + c[i + 5 * s] * a5) + (c[i + 6 * s] * a6 + c[i + 7 * s] * a7));
  }
  for (; j < m.columns; ++j)
    for (std::size_t i = 0; i < m.rows; ++i) y[i] += m.value[j * m.rows + i] * a[j];
}

SHERD_CLONES void squaredDistances(const Columns& points, const double* __restrict__ z,
                                   double* __restrict__ out) {
  for (std::size_t j = 0; j < points.columns; ++j) {
    const double* p = points.value + j * points.rows;
    Pack sum{};
    std::size_t i = 0;
    for (; i + kPack <= points.rows; i += kPack) {
      const Pack difference = *reinterpret_cast<const Pack*>(p + i) - *reinterpret_cast<const Pack*>(z + i);
      sum += difference * difference;
    }
    double rest = 0;
    for (; i < points.rows; ++i) rest += (p[i] - z[i]) * (p[i] - z[i]);
    out[j] = sumOf(sum) + rest;
  }
}

SHERD_CLONES double squaredNormOfProduct(const Columns& upper, const double* __restrict__ a) {
  double norm2 = 0;
  for (std::size_t j = 0; j < upper.columns; ++j) {
    const double* u = upper.value + j * upper.rows;
    Pack even{}, odd{};
    std::size_t i = 0;
    for (; i + 2 * kPack <= j + 1; i += 2 * kPack) {
      even += *reinterpret_cast<const Pack*>(u + i) * *reinterpret_cast<const Pack*>(a + i);
      odd += *reinterpret_cast<const Pack*>(u + i + kPack) * *reinterpret_cast<const Pack*>(a + i + kPack);
    }
    double rest = 0;
    for (; i <= j; ++i) rest += u[i] * a[i];
    const double sum = sumOf(even + odd) + rest;
    norm2 += sum * sum;
  }
  return norm2;
}

SHERD_CLONES RootSums rootSums(std::span<const double> v, std::span<const double> w) {
  double half[kPack] = {}, threeQuarters[kPack] = {};
  const std::size_t whole = v.size() / kPack * kPack;
  for (std::size_t n = 0; n < whole; n += kPack)
    for (std::size_t lane = 0; lane < kPack; ++lane) {
      const double root = std::sqrt(v[n + lane] * w[n + lane]);
      half[lane] += root;
      threeQuarters[lane] += std::sqrt(w[n + lane] * root);
    }
  for (std::size_t n = whole; n < v.size(); ++n) {
    const double root = std::sqrt(v[n] * w[n]);
    half[0] += root;
    threeQuarters[0] += std::sqrt(w[n] * root);
  }
  return {(half[0] + half[2]) + (half[1] + half[3]),
          (threeQuarters[0] + threeQuarters[2]) + (threeQuarters[1] + threeQuarters[3])};
}

SHERD_CLONES void runningSums(const Columns& columns, const double* __restrict__ centre,
                              const double* __restrict__ weight, std::span<const int> order,
                              double* __restrict__ out) {
  const std::size_t d = columns.rows, stride = d + 2;
  std::fill(out, out + stride, 0.0);
  for (const int node : order) {
    const double* x = columns.value + static_cast<std::size_t>(node) * d;
    const double w = weight[node];
    const double* before = out;
    out += stride;
    double square = 0;
    for (std::size_t i = 0; i < d; ++i) {
      const double at = x[i] - centre[i];
      out[i] = before[i] + w * at;
      square += at * at;
    }
    out[d] = before[d] + w;
    out[d + 1] = before[d + 1] + w * square;
  }
}

}  // namespace sherd
