#include "simulate/supernodal_solve.h"

#include <algorithm>
#include <vector>

#include "base/clones.h"

namespace sherd {
namespace {

constexpr std::size_t kPanel = 32;  // columns that are walked at once: as many streams as prefetching follows
constexpr std::size_t kAhead = 32;  // rows that are fetched ahead where a panel is walked across its columns
constexpr std::size_t kTogether = 8;  // columns of a single load at once

/// Loads in one vector. A tile is as many rows or columns, with two such vectors for each: half of all
/// registers or more. (A template's argument would lose the vector's attributes.)
struct Four {
  static constexpr std::size_t count = 4;
  typedef double Pack __attribute__((vector_size(32), aligned(sizeof(double)), may_alias));
};
struct Eight {
  static constexpr std::size_t count = 8;
  typedef double Pack __attribute__((vector_size(64), aligned(sizeof(double)), may_alias));
};

/// Dense columns below a panel's triangle.
struct Columns {
  const double* value;  ///< of the first row
  std::size_t stride, columns, rows;
};

// y_i −= Σ_j L_ij x_j, j ascending.

SHERD_CLONES void subtractDown(const Columns& l, const double* __restrict__ x, double* __restrict__ y) {
  std::size_t j = 0;
  for (; j + kTogether <= l.columns; j += kTogether) {
    const double* __restrict__ a = l.value + j * l.stride;
    const std::size_t s = l.stride;
    const double x0 = x[j], x1 = x[j + 1], x2 = x[j + 2], x3 = x[j + 3], x4 = x[j + 4], x5 = x[j + 5],
                 x6 = x[j + 6], x7 = x[j + 7];
    for (std::size_t i = 0; i < l.rows; ++i) {
      double sum = y[i] - a[i] * x0;
      sum -= a[i + s] * x1;
      sum -= a[i + 2 * s] * x2;
      sum -= a[i + 3 * s] * x3;
      sum -= a[i + 4 * s] * x4;
      sum -= a[i + 5 * s] * x5;
      sum -= a[i + 6 * s] * x6;
      y[i] = sum - a[i + 7 * s] * x7;
    }
  }
  for (; j < l.columns; ++j)
    for (std::size_t i = 0; i < l.rows; ++i) y[i] -= l.value[i + j * l.stride] * x[j];
}

/// Some rows of it, for all loads; x and y as solveSupernodal has them.
template <class Loads, std::size_t Rows>
[[gnu::always_inline]] inline void subtractRows(const Columns& l, std::size_t row, const double* x,
                                                double* y) {
  using Pack = typename Loads::Pack;
  for (std::size_t lane = 0; lane < kSolveWidth; lane += 2 * Loads::count) {
    Pack sum[Rows][2];
#pragma GCC unroll 8
    for (std::size_t r = 0; r < Rows; ++r) {
      const Pack* from = reinterpret_cast<const Pack*>(y + (row + r) * kSolveWidth + lane);
      sum[r][0] = from[0];
      sum[r][1] = from[1];
    }
    for (std::size_t j = 0; j < l.columns; ++j) {
      const double* a = l.value + j * l.stride + row;
      if (lane == 0) __builtin_prefetch(a + kAhead);
      const Pack* right = reinterpret_cast<const Pack*>(x + j * kSolveWidth + lane);
      const Pack x0 = right[0], x1 = right[1];
#pragma GCC unroll 8
      for (std::size_t r = 0; r < Rows; ++r) {
        sum[r][0] -= a[r] * x0;
        sum[r][1] -= a[r] * x1;
      }
    }
#pragma GCC unroll 8
    for (std::size_t r = 0; r < Rows; ++r) {
      Pack* to = reinterpret_cast<Pack*>(y + (row + r) * kSolveWidth + lane);
      to[0] = sum[r][0];
      to[1] = sum[r][1];
    }
  }
}

template <class Loads>
[[gnu::always_inline]] inline void subtractAllRows(const Columns& l, const double* x, double* y) {
  std::size_t row = 0;
  for (; row + Loads::count <= l.rows; row += Loads::count) subtractRows<Loads, Loads::count>(l, row, x, y);
  for (; row < l.rows; ++row) subtractRows<Loads, 1>(l, row, x, y);
}

SHERD_BASELINE void subtractDownWide(const Columns& l, const double* x, double* y) {
  subtractAllRows<Four>(l, x, y);
}
#ifdef SHERD_VERSIONS
SHERD_AVX2 void subtractDownWide(const Columns& l, const double* x, double* y) {
  subtractAllRows<Four>(l, x, y);
}
SHERD_AVX512 void subtractDownWide(const Columns& l, const double* x, double* y) {
  subtractAllRows<Eight>(l, x, y);
}
#endif

// x_j −= Σ_i L_ij y_i, i ascending.

SHERD_CLONES void subtractUp(const Columns& l, const double* __restrict__ y, double* __restrict__ x) {
  std::size_t j = 0;
  for (; j + kTogether <= l.columns; j += kTogether) {
    const double* __restrict__ a = l.value + j * l.stride;
    double sum[kTogether];
    for (std::size_t c = 0; c < kTogether; ++c) sum[c] = x[j + c];
    for (std::size_t i = 0; i < l.rows; ++i) {
#pragma GCC unroll 8
      for (std::size_t c = 0; c < kTogether; ++c) sum[c] -= a[i + c * l.stride] * y[i];
    }
    for (std::size_t c = 0; c < kTogether; ++c) x[j + c] = sum[c];
  }
  for (; j < l.columns; ++j)
    for (std::size_t i = 0; i < l.rows; ++i) x[j] -= l.value[i + j * l.stride] * y[i];
}

/// Some columns of it, for all loads.
template <class Loads, std::size_t Count>
[[gnu::always_inline]] inline void subtractColumns(const Columns& l, std::size_t column, const double* y,
                                                   double* x) {
  using Pack = typename Loads::Pack;
  for (std::size_t lane = 0; lane < kSolveWidth; lane += 2 * Loads::count) {
    Pack sum[Count][2];
#pragma GCC unroll 8
    for (std::size_t c = 0; c < Count; ++c) {
      const Pack* from = reinterpret_cast<const Pack*>(x + (column + c) * kSolveWidth + lane);
      sum[c][0] = from[0];
      sum[c][1] = from[1];
    }
    const double* a = l.value + column * l.stride;
    for (std::size_t i = 0; i < l.rows; ++i) {
      const Pack* right = reinterpret_cast<const Pack*>(y + i * kSolveWidth + lane);
      const Pack y0 = right[0], y1 = right[1];
#pragma GCC unroll 8
      for (std::size_t c = 0; c < Count; ++c) {
        sum[c][0] -= a[i + c * l.stride] * y0;
        sum[c][1] -= a[i + c * l.stride] * y1;
      }
    }
#pragma GCC unroll 8
    for (std::size_t c = 0; c < Count; ++c) {
      Pack* to = reinterpret_cast<Pack*>(x + (column + c) * kSolveWidth + lane);
      to[0] = sum[c][0];
      to[1] = sum[c][1];
    }
  }
}

template <class Loads>
[[gnu::always_inline]] inline void subtractAllColumns(const Columns& l, const double* y, double* x) {
  std::size_t column = 0;
  for (; column + Loads::count <= l.columns; column += Loads::count)
    subtractColumns<Loads, Loads::count>(l, column, y, x);
  for (; column < l.columns; ++column) subtractColumns<Loads, 1>(l, column, y, x);
}

SHERD_BASELINE void subtractUpWide(const Columns& l, const double* y, double* x) {
  subtractAllColumns<Four>(l, y, x);
}
#ifdef SHERD_VERSIONS
SHERD_AVX2 void subtractUpWide(const Columns& l, const double* y, double* x) {
  subtractAllColumns<Four>(l, y, x);
}
SHERD_AVX512 void subtractUpWide(const Columns& l, const double* y, double* x) {
  subtractAllColumns<Eight>(l, y, x);
}
#endif

/// The two operations above and the triangle of one panel, by width.
template <std::size_t Width>
struct Panel {
  static void down(const Columns& l, const double* x, double* y) {
    if constexpr (Width == 1)
      subtractDown(l, x, y);
    else
      subtractDownWide(l, x, y);
  }
  static void up(const Columns& l, const double* y, double* x) {
    if constexpr (Width == 1)
      subtractUp(l, y, x);
    else
      subtractUpWide(l, y, x);
  }
  /// `l`: of the panel's first diagonal entry.
  static void triangleDown(const double* l, std::size_t stride, std::size_t columns, double* x) {
    for (std::size_t j = 0; j < columns; ++j) {
      for (std::size_t w = 0; w < Width; ++w) x[j * Width + w] /= l[j * stride + j];
      for (std::size_t i = j + 1; i < columns; ++i)
        for (std::size_t w = 0; w < Width; ++w) x[i * Width + w] -= l[j * stride + i] * x[j * Width + w];
    }
  }
  static void triangleUp(const double* l, std::size_t stride, std::size_t columns, double* x) {
    for (std::size_t j = columns; j-- > 0;) {
      for (std::size_t i = j + 1; i < columns; ++i)
        for (std::size_t w = 0; w < Width; ++w) x[j * Width + w] -= l[j * stride + i] * x[i * Width + w];
      for (std::size_t w = 0; w < Width; ++w) x[j * Width + w] /= l[j * stride + j];
    }
  }
};

template <std::size_t Width>
class Substitution {
 public:
  Substitution(const SupernodalFactor& factor, double* x) : f_(factor), x_(x) {
    std::size_t most = 0;
    for (std::size_t s = 0; s < f_.supernodes; ++s) most = std::max(most, rows(s));
    y_.resize(most * Width);
  }

  void run() {
    for (std::size_t s = 0; s < f_.supernodes; ++s) down(s);
    for (std::size_t s = f_.supernodes; s-- > 0;) up(s);
  }

 private:
  std::size_t rows(std::size_t s) const {
    return static_cast<std::size_t>(f_.rowBegin[s + 1] - f_.rowBegin[s]);
  }
  std::size_t columns(std::size_t s) const {
    return static_cast<std::size_t>(f_.column[s + 1] - f_.column[s]);
  }

  double* place(std::size_t s, std::size_t r) {
    return x_ + Width * static_cast<std::size_t>(f_.row[static_cast<std::size_t>(f_.rowBegin[s]) + r]);
  }
  void gather(std::size_t s) {
    for (std::size_t r = 0; r < rows(s); ++r) std::copy_n(place(s, r), Width, y_.data() + r * Width);
  }
  void scatter(std::size_t s, std::size_t count) {
    for (std::size_t r = 0; r < count; ++r) std::copy_n(y_.data() + r * Width, Width, place(s, r));
  }

  void down(std::size_t s) {
    gather(s);
    const std::size_t stride = rows(s), all = columns(s);
    const double* l = f_.value + f_.valueBegin[s];
    for (std::size_t p = 0; p < all; p += kPanel) {
      const std::size_t n = std::min(kPanel, all - p), below = p + n;
      Panel<Width>::triangleDown(l + p * stride + p, stride, n, y_.data() + p * Width);
      Panel<Width>::down({l + p * stride + below, stride, n, stride - below}, y_.data() + p * Width,
                         y_.data() + below * Width);
    }
    scatter(s, stride);
  }

  void up(std::size_t s) {
    gather(s);
    const std::size_t stride = rows(s), all = columns(s);
    const double* l = f_.value + f_.valueBegin[s];
    for (std::size_t p = (all - 1) / kPanel * kPanel;; p -= kPanel) {
      const std::size_t n = std::min(kPanel, all - p), below = p + n;
      Panel<Width>::up({l + p * stride + below, stride, n, stride - below}, y_.data() + below * Width,
                       y_.data() + p * Width);
      Panel<Width>::triangleUp(l + p * stride + p, stride, n, y_.data() + p * Width);
      if (p == 0) break;
    }
    scatter(s, all);
  }

  const SupernodalFactor& f_;
  double* x_;
  std::vector<double> y_;  ///< the rows of one supernode
};

}  // namespace

void solveSupernodal(const SupernodalFactor& factor, double* x, std::size_t width) {
  if (width == 1)
    Substitution<1>(factor, x).run();
  else
    Substitution<kSolveWidth>(factor, x).run();
}

}  // namespace sherd
