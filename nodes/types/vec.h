// The small vectors and index tuples that all types share. Lengths are metres unless a comment says
// otherwise.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace sherd {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat3 = Eigen::Matrix3d;

using Index = std::int32_t;  ///< index of a vertex, triangle, tetrahedron, site; -1 for none
using Triangle = std::array<Index, 3>;
using Tetra = std::array<Index, 4>;

constexpr std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Axis-aligned box; empty until something is added.
struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  bool overlaps(const Box& o) const {
    return (low.array() <= o.high.array()).all() && (o.low.array() <= high.array()).all();
  }
  double diagonal() const { return (high - low).norm(); }
  Vec3 centre() const { return 0.5 * (low + high); }
};

template <class Points>
Box boxOf(const Points& points) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  return box;
}

/// The corners of face i of a tetrahedron, the one opposite corner i, in outward order for a positively
/// oriented tetrahedron (det[b−a, c−a, d−a] > 0).
inline constexpr int kTetraFace[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
/// The corners of the six edges of a tetrahedron.
inline constexpr int kTetraEdge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

}  // namespace sherd
