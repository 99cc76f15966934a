// Loads and bodies for tests of elasticity whose answers are known.
#pragma once

#include <functional>
#include <vector>

#include "simulate/elements.h"
#include "support/tet_families.h"

namespace sherd::families {

/// Nodal forces of the stress field acting on the boundary: ∫ N_i σ n dA, by a rule of degree 4 on each face.
inline std::vector<Vec3> tractionOn(const Elements& elements,
                                    const std::function<Mat3(const Vec3&)>& stress) {
  constexpr double a = 0.445948490915965, b = 0.091576213509771, wa = 0.223381589678011,
                   wb = 0.109951743655322;  // Strang and Fix: two orbits of three points
  const TetMesh& mesh = elements.mesh();
  std::vector<Vec3> force(elements.nodeCount(), Vec3::Zero());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t face = 0; face < 4; ++face) {
      if (mesh.neighbours[t][face] >= 0) continue;
      std::array<Vec3, 3> x;
      for (std::size_t c = 0; c < 3; ++c)
        x[c] = mesh.nodes[at(mesh.tets[t][static_cast<std::size_t>(kTetraFace[face][c])])];
      const Vec3 area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
      for (int point = 0; point < 6; ++point) {
        const double inner = point < 3 ? a : b, weight = point < 3 ? wa : wb;
        Vec3 on = Vec3::Constant(inner);
        on[point % 3] = 1 - 2 * inner;
        Vec4 barycentric = Vec4::Zero();
        for (int c = 0; c < 3; ++c) barycentric[kTetraFace[face][c]] = on[c];
        const Vec3 pull = weight * stress(on[0] * x[0] + on[1] * x[1] + on[2] * x[2]) * area;
        const auto value = elements.shapeValues(barycentric);
        const std::span<const Index> nodes = elements.nodesOf(t);
        for (std::size_t i = 0; i < nodes.size(); ++i) force[at(nodes[i])] += value[i] * pull;
      }
    }
  return force;
}

/// Nodes moved off the grid inside, so that no two elements are alike.
inline TetMesh jittered(int n, const Vec3& size, std::uint64_t seed = 5) {
  const TetMesh regular = box(n, n, n, size);
  std::uint64_t state = seed * 2 + 1;
  const auto uniform = [&state] {  // a multiplicative generator is random enough to break symmetry
    state *= 6364136223846793005ULL;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  return mapped(regular, [&](const Vec3& p) {
    Vec3 q = p;
    for (int a = 0; a < 3; ++a)
      if (p[a] > 1e-9 * size[a] && p[a] < size[a] * (1 - 1e-9)) q[a] += 0.3 * size[a] / n * (uniform() - 0.5);
    return q;
  });
}

/// A ball about the origin of n³ mapped cubes.
inline TetMesh ball(int n, double radius) {
  return mapped(box(n, n, n, Vec3(2, 2, 2)), [radius](const Vec3& p) {
    const Vec3 c = p - Vec3::Ones(), s = c.cwiseProduct(c);
    Vec3 q;
    for (int a = 0; a < 3; ++a) {
      const double b = s[(a + 1) % 3], d = s[(a + 2) % 3];
      q[a] = radius * c[a] * std::sqrt(1 - b / 2 - d / 2 + b * d / 3);
    }
    return q;
  });
}

/// A bar along x, bent about z by moments at both ends: σ_xx = E κ (y − h/2). Its energy is exact for any ν:
/// U = E κ² I L / 2 with I = b h³ / 12 (Saint-Venant).
struct PureBending {
  double length = 2, height = 0.5, width = 0.25, curvature = 1e-4;  // m, 1/m

  TetMesh mesh(int k) const { return box(8 * k, 2 * k, k, Vec3(length, height, width)); }
  std::vector<Vec3> load(const Elements& elements, double young) const {
    return tractionOn(elements, [&](const Vec3& x) {
      Mat3 stress = Mat3::Zero();
      stress(0, 0) = young * curvature * (x.y() - height / 2);
      return stress;
    });
  }
  double energy(double young) const {
    return young * curvature * curvature * width * std::pow(height, 3) / 12 * length / 2;
  }
};

/// A cantilever with a shear force P at x = L, held at x = 0 by the tractions that hold it in Timoshenko and
/// Goodier's solution ("Theory of Elasticity", section 21), which is exact in space for ν = 0:
///   σ_xx = P (L − x) y / I,  σ_xy = −P (c² − y²) / (2 I),  U = P² L³ / (6 E I) + 6/5 P² L / (2 G A).
struct Cantilever {
  double length = 2, height = 0.5, width = 0.25, shear = 1e4;  // m, N

  TetMesh mesh(int k) const { return box(8 * k, 2 * k, k, Vec3(length, height, width)); }
  double inertia() const { return width * std::pow(height, 3) / 12; }
  std::vector<Vec3> load(const Elements& elements) const {
    return tractionOn(elements, [&](const Vec3& x) {
      const double y = x.y() - height / 2, c = height / 2;
      Mat3 stress = Mat3::Zero();
      stress(0, 0) = shear * (length - x.x()) * y / inertia();
      stress(0, 1) = stress(1, 0) = -shear * (c * c - y * y) / (2 * inertia());
      return stress;
    });
  }
  double energy(double young) const {
    return shear * shear * std::pow(length, 3) / (6 * young * inertia()) +
           1.2 * shear * shear * length / (young * height * width);  // G = E/2
  }
};

}  // namespace sherd::families
