#include "simulate/element_response.h"

#include <algorithm>
#include <array>

#include "base/clones.h"

namespace sherd {
namespace {

template <std::size_t Width>
using Lanes = std::array<double, Width>;

/// Moduli of one element, times its volume.
struct Moduli {
  double lambda, averaged, mu;
};

/// Σ_i (u_i − u_0) ⊗ g_i: differences to one node, so that a large common translation costs no digits.
template <std::size_t Width>
[[gnu::always_inline]] inline void gradientOf(const ElementGradients& g, std::size_t q,
                                              std::span<const Index> own, const double* u,
                                              std::array<Lanes<Width>, 9>& f) {
  for (auto& lanes : f) lanes.fill(0);
  const double* first = u + 3 * Width * at(own[0]);
  for (std::size_t i = 1; i < own.size(); ++i) {
    const double* ui = u + 3 * Width * at(own[i]);
    const Vec3& gradient = g.at(q, i);
    for (std::size_t a = 0; a < 3; ++a) {
      Lanes<Width> d;
      for (std::size_t w = 0; w < Width; ++w) d[w] = ui[a * Width + w] - first[a * Width + w];
      for (std::size_t b = 0; b < 3; ++b) {
        const double component = gradient[static_cast<Eigen::Index>(b)];
        for (std::size_t w = 0; w < Width; ++w) f[3 * a + b][w] += d[w] * component;
      }
    }
  }
}

/// f, a displacement's gradient, becomes the stress: xx, yy, zz, xy, yz, zx first. Adds the energy as a sum
/// of squares, bulk and deviatoric.
template <std::size_t Width>
[[gnu::always_inline]] inline void toStress(std::array<Lanes<Width>, 9>& f, const Moduli& m, double* energy) {
  for (std::size_t w = 0; w < Width; ++w) {
    const double xx = f[0][w], yy = f[4][w], zz = f[8][w], xy = 0.5 * (f[1][w] + f[3][w]),
                 yz = 0.5 * (f[5][w] + f[7][w]), zx = 0.5 * (f[2][w] + f[6][w]);
    const double trace = xx + yy + zz, mean = trace / 3, dx = xx - mean, dy = yy - mean, dz = zz - mean;
    energy[w] += 0.5 * (m.lambda + 2 * m.mu / 3) * trace * trace +
                 m.mu * (dx * dx + dy * dy + dz * dz + 2 * (xy * xy + yz * yz + zx * zx));
    const double bulk = m.lambda * trace;
    f[0][w] = bulk + 2 * m.mu * xx;
    f[1][w] = bulk + 2 * m.mu * yy;
    f[2][w] = bulk + 2 * m.mu * zz;
    f[3][w] = 2 * m.mu * xy;
    f[4][w] = 2 * m.mu * yz;
    f[5][w] = 2 * m.mu * zx;
  }
}

/// What a stress pulls at one node with.
template <std::size_t Width>
[[gnu::always_inline]] inline void pull(const std::array<Lanes<Width>, 9>& stress, const Vec3& g,
                                        double* __restrict__ force) {
  for (std::size_t w = 0; w < Width; ++w) {
    force[w] += stress[0][w] * g.x() + stress[3][w] * g.y() + stress[5][w] * g.z();
    force[Width + w] += stress[3][w] * g.x() + stress[1][w] * g.y() + stress[4][w] * g.z();
    force[2 * Width + w] += stress[5][w] * g.x() + stress[4][w] * g.y() + stress[2][w] * g.z();
  }
}

/// The averaged part of λ: on the nodes' dilatations where there are any, else on the element's mean.
template <std::size_t Width>
[[gnu::always_inline]] inline void addAveraged(const ElementGradients& g, std::span<const Index> own,
                                               const ElementResponse::Block& block, double averaged,
                                               double* energy) {
  Lanes<Width> pressure{};
  if (block.dilatation != nullptr) {
    for (const Index n : own)
      for (std::size_t w = 0; w < Width; ++w) {
        const double theta = block.dilatation[Width * at(n) + w];
        pressure[w] += averaged * theta / 4;
        energy[w] += averaged / 2 * theta * theta / 4;
      }
  } else {
    const double* first = block.displacement + 3 * Width * at(own[0]);
    for (std::size_t i = 1; i < own.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a) {
        const double* ui = block.displacement + (3 * at(own[i]) + a) * Width;
        const double mean = averaged * g.mean(i)[static_cast<Eigen::Index>(a)];
        for (std::size_t w = 0; w < Width; ++w) pressure[w] += mean * (ui[w] - first[a * Width + w]);
      }
    for (std::size_t w = 0; w < Width; ++w) energy[w] += pressure[w] * pressure[w] / (2 * averaged);
  }
  for (std::size_t i = 0; i < own.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      double* force = block.force + (3 * at(own[i]) + a) * Width;
      for (std::size_t w = 0; w < Width; ++w)
        force[w] += pressure[w] * g.mean(i)[static_cast<Eigen::Index>(a)];
    }
}

template <std::size_t Width>
[[gnu::always_inline]] inline void addElement(const ElementGradients& g, std::span<const Index> own,
                                              const Moduli& moduli, const ElementResponse::Block& block,
                                              double* energy) {
  std::fill_n(energy, Width, 0.0);
  const Moduli atPoint{g.weight() * moduli.lambda, 0, g.weight() * moduli.mu};
  std::array<Lanes<Width>, 9> f;
  for (std::size_t q = 0; q < g.points(); ++q) {
    gradientOf<Width>(g, q, own, block.displacement, f);
    toStress<Width>(f, atPoint, energy);
    for (std::size_t i = 0; i < own.size(); ++i)
      pull<Width>(f, g.at(q, i), block.force + 3 * Width * at(own[i]));
  }
  if (moduli.averaged > 0) addAveraged<Width>(g, own, block, moduli.averaged, energy);
}

void addOne(const ElementGradients& g, std::span<const Index> own, const Moduli& moduli,
            const ElementResponse::Block& block, double* energy) {
  addElement<1>(g, own, moduli, block, energy);
}
SHERD_CLONES void addWide(const ElementGradients& g, std::span<const Index> own, const Moduli& moduli,
                          const ElementResponse::Block& block, double* energy) {
  addElement<kSolveWidth>(g, own, moduli, block, energy);
}

}  // namespace

void ElementResponse::add(const Block& block) const {
  const auto one = block.width == 1 ? addOne : addWide;
  for (std::size_t t = 0; t < volume_.size(); ++t) {
    const double v = volume_[t];
    one(rules_.gradients(nodes_, t), elements_.nodesOf(t), {v * lambda_.full, v * lambda_.averaged, v * mu_},
        block, block.energy + block.width * t);
  }
}

void ElementResponse::addDilatation(std::size_t width, const double* displacement, double* sum) const {
  std::vector<double> trace(width);
  for (std::size_t t = 0; t < volume_.size(); ++t) {
    const Tetra& tet = elements_.mesh().tets[t];
    const Element element(nodes_, tet);
    std::fill(trace.begin(), trace.end(), 0.0);
    for (std::size_t i = 1; i < 4; ++i)
      for (std::size_t a = 0; a < 3; ++a) {
        const double gradient = element.gradient[i][static_cast<Eigen::Index>(a)];
        const double *own = displacement + (3 * at(tet[i]) + a) * width,
                     *first = displacement + (3 * at(tet[0]) + a) * width;
        for (std::size_t w = 0; w < width; ++w) trace[w] += (own[w] - first[w]) * gradient;
      }
    for (const Index n : tet)
      for (std::size_t w = 0; w < width; ++w) sum[at(n) * width + w] += volume_[t] / 4 * trace[w];
  }
}

}  // namespace sherd
