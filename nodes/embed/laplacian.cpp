// Assembling the Laplacians of spectrum.h.
#include <algorithm>
#include <cmath>
#include <vector>

#include "embed/spectrum.h"

namespace sherd {
namespace {

constexpr double kFlattest = 1e-10;

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Of an element's corners.
template <std::size_t N>
double meanStretch(const std::array<Index, N>& corners, std::span<const double> stretch) {
  if (stretch.empty()) return 1;
  double sum = 0;
  for (const Index n : corners) sum += stretch[at(n)];
  return sum / static_cast<double>(N);
}

void addEdge(Triplets& entries, Index i, Index j, double weight) {
  entries.emplace_back(i, i, weight);
  entries.emplace_back(j, j, weight);
  entries.emplace_back(i, j, -weight);
  entries.emplace_back(j, i, -weight);
}

Laplacian assembled(std::size_t vertices, const Triplets& entries, Eigen::VectorXd mass) {
  const auto n = static_cast<Eigen::Index>(vertices);
  Laplacian out{Eigen::SparseMatrix<double>(n, n), std::move(mass)};
  out.stiffness.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace

Laplacian surfaceLaplacian(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                           std::span<const double> stretch) {
  Triplets entries;
  entries.reserve(12 * triangles.size());
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(positions.size()));
  for (const Triangle& triangle : triangles) {
    Vec3 side[3];  // opposite corner c
    for (std::size_t c = 0; c < 3; ++c)
      side[c] = positions[at(triangle[(c + 2) % 3])] - positions[at(triangle[(c + 1) % 3])];
    const double longest = std::max({side[0].squaredNorm(), side[1].squaredNorm(), side[2].squaredNorm()});
    const double twiceArea = std::max(side[0].cross(side[1]).norm(), kFlattest * longest);
    const double s = meanStretch(triangle, stretch);
    for (std::size_t c = 0; c < 3; ++c) {
      mass[triangle[c]] += s * s * (twiceArea / 6);
      const double cotangent = -side[(c + 1) % 3].dot(side[(c + 2) % 3]) / twiceArea;
      addEdge(entries, triangle[(c + 1) % 3], triangle[(c + 2) % 3], 0.5 * cotangent);
    }
  }
  return assembled(positions.size(), entries, std::move(mass));
}

Laplacian solidLaplacian(std::span<const Vec3> positions, std::span<const Tetra> tets,
                         std::span<const double> stretch) {
  Triplets entries;
  entries.reserve(24 * tets.size());
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(positions.size()));
  for (const Tetra& tet : tets) {
    Vec3 areaNormal[4];  // of the face opposite each corner, outward, twice the area long
    for (std::size_t f = 0; f < 4; ++f) {
      const Vec3& a = positions[at(tet[at(kTetraFace[f][0])])];
      areaNormal[f] =
          (positions[at(tet[at(kTetraFace[f][1])])] - a).cross(positions[at(tet[at(kTetraFace[f][2])])] - a);
    }
    const Vec3 height = positions[at(tet[0])] - positions[at(tet[1])];
    const double longest =
        std::max({areaNormal[0].norm(), areaNormal[1].norm(), areaNormal[2].norm(), areaNormal[3].norm()});
    const double sixVolumes =
        std::max(std::abs(areaNormal[0].dot(height)), kFlattest * std::pow(longest, 1.5));
    const double s = meanStretch(tet, stretch);
    for (const Index n : tet) mass[n] += s * s * s * (sixVolumes / 24);
    // ∇b_i = −areaNormal_i / (6 V); the stiffness is V ∇b_i·∇b_j.
    for (const auto& [i, j] : kTetraEdge)
      addEdge(entries, tet[at(i)], tet[at(j)], s * (-areaNormal[i].dot(areaNormal[j]) / (6 * sixVolumes)));
  }
  return assembled(positions.size(), entries, std::move(mass));
}

}  // namespace sherd
