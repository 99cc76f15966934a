// One linear tetrahedron of an isotropic material with E = 1; its gradients are also those that quadratic
// shape functions are made of (elements.h).
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "types/vec.h"

namespace sherd {

struct Lame {
  double lambda, mu;
  Lame(double lambda_, double mu_) : lambda(lambda_), mu(mu_) {}
  /// For E = 1.
  explicit Lame(double poisson)
      : lambda(poisson / ((1 + poisson) * (1 - 2 * poisson))), mu(1 / (2 * (1 + poisson))) {}
};

/// λ in two parts, λ = full + averaged. The first acts on the volume strain of every point, the other on
/// averages of it: where λ ≫ μ, a volume strain of zero at every point is more than the elements can satisfy
/// without stiffening against everything else (locking). `full` is λ itself up to ν = 0.4, which therefore is
/// computed as if there were no such split, and stays at that level beyond.
struct VolumetricSplit {
  static constexpr double kLargestFull = 4;  ///< λ / μ = 2 ν / (1 − 2 ν) at ν = 0.4
  double full = 0, averaged = 0;
  VolumetricSplit() = default;
  explicit VolumetricSplit(const Lame& lame, double largestFull = kLargestFull)
      : full(std::min(lame.lambda, largestFull * lame.mu)), averaged(std::max(lame.lambda - full, 0.0)) {}
};

struct Element {
  double volume = 0;
  std::array<Vec3, 4> gradient;  ///< of the shape functions

  Element(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 ab = b - a, ac = c - a, ad = d - a;
    const double det = ab.dot(ac.cross(ad));
    volume = det / 6;
    gradient = {Vec3::Zero(), ac.cross(ad) / det, ad.cross(ab) / det, ab.cross(ac) / det};
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
  }
  Element(std::span<const Vec3> nodes, const Tetra& t)
      : Element(nodes[at(t[0])], nodes[at(t[1])], nodes[at(t[2])], nodes[at(t[3])]) {}

  Mat3 strain(std::span<const Vec3> u, const Tetra& t) const {
    // Differences to one node: a large common translation costs no digits.
    Mat3 f = Mat3::Zero();
    for (std::size_t i = 1; i < 4; ++i) f += (u[at(t[i])] - u[at(t[0])]) * gradient[i].transpose();
    return 0.5 * (f + f.transpose());
  }
  static Mat3 stress(const Mat3& strain, const Lame& lame) {
    return lame.lambda * strain.trace() * Mat3::Identity() + 2 * lame.mu * strain;
  }
};

}  // namespace sherd
