#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "tetrahedralize/inside_share.h"

namespace sherd {
namespace {

/// Buckets of tetrahedra by the cells of a grid that their boxes touch.
class TetGrid {
 public:
  explicit TetGrid(const TetMesh& cage) : box_(boxOf(cage.nodes)) {
    const Vec3 size = box_.high - box_.low;
    const double side = std::cbrt(size.prod() / static_cast<double>(cage.tets.size()));
    for (Eigen::Index i = 0; i < 3; ++i) {
      cells_[i] = std::clamp(static_cast<int>(std::ceil(size[i] / side)), 1, 256);
      side_[i] = size[i] / cells_[i];
    }
    bucket_.resize(static_cast<std::size_t>(cells_.prod()));
    for (std::size_t t = 0; t < cage.tets.size(); ++t) {
      Box box;
      for (const Index n : cage.tets[t]) box.add(cage.nodes[at(n)]);
      eachBucket(box, [&](std::size_t b) { bucket_[b].push_back(static_cast<Index>(t)); });
    }
  }
  void candidates(const Box& box, std::vector<Index>& out) const {
    out.clear();
    eachBucket(box, [&](std::size_t b) { out.insert(out.end(), bucket_[b].begin(), bucket_[b].end()); });
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
  }

 private:
  template <class F>
  void eachBucket(const Box& box, F&& f) const {
    Eigen::Vector3i low, high;
    for (Eigen::Index i = 0; i < 3; ++i) {
      // One more cell on each side than rounding could lose.
      const double margin = 1e-9 * side_[i];
      low[i] = std::clamp(static_cast<int>(std::floor((box.low[i] - margin - box_.low[i]) / side_[i])), 0,
                          cells_[i] - 1);
      high[i] = std::clamp(static_cast<int>(std::floor((box.high[i] + margin - box_.low[i]) / side_[i])), 0,
                           cells_[i] - 1);
    }
    for (int k = low.z(); k <= high.z(); ++k)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int i = low.x(); i <= high.x(); ++i)
          f(static_cast<std::size_t>((k * cells_.y() + j) * cells_.x() + i));
  }

  Box box_;
  Eigen::Vector3i cells_;
  Vec3 side_;
  std::vector<std::vector<Index>> bucket_;
};

/// Is the axis one that separates the two point sets by more than `slack` (m)?
template <std::size_t N, std::size_t M>
bool separates(const Vec3& axis, const std::array<Vec3, N>& a, const std::array<Vec3, M>& b, double slack) {
  double lowA = axis.dot(a[0]), highA = lowA, lowB = axis.dot(b[0]), highB = lowB;
  for (const Vec3& p : a) lowA = std::min(lowA, axis.dot(p)), highA = std::max(highA, axis.dot(p));
  for (const Vec3& p : b) lowB = std::min(lowB, axis.dot(p)), highB = std::max(highB, axis.dot(p));
  const double largest = std::max({std::abs(lowA), std::abs(highA), std::abs(lowB), std::abs(highB)});
  const double margin = 1e-14 * largest + slack * axis.norm();
  return lowA > highB + margin || lowB > highA + margin;
}

/// Do triangle and tetrahedron (relative to a near origin) touch? True where rounding leaves it open.
bool touches(const std::array<Vec3, 3>& triangle, const std::array<Vec3, 4>& tet, double slack) {
  for (const auto& face : kTetraFace) {
    const Vec3& p = tet[static_cast<std::size_t>(face[0])];
    const Vec3 normal =
        (tet[static_cast<std::size_t>(face[1])] - p).cross(tet[static_cast<std::size_t>(face[2])] - p);
    if (separates(normal, triangle, tet, slack)) return false;
  }
  std::array<Vec3, 3> edges;
  for (std::size_t c = 0; c < 3; ++c) edges[c] = triangle[(c + 1) % 3] - triangle[c];
  if (separates(edges[0].cross(edges[1]), triangle, tet, slack)) return false;
  for (const auto& edge : kTetraEdge) {
    const Vec3 e = tet[static_cast<std::size_t>(edge[1])] - tet[static_cast<std::size_t>(edge[0])];
    for (const Vec3& side : edges)
      if (separates(e.cross(side), triangle, tet, slack)) return false;
  }
  return true;
}

}  // namespace

void holdTriangles(TetMesh& cage, std::span<const Vec3> positions, std::span<const Triangle> triangles,
                   const Exec& exec) {
  const TetGrid grid(cage);
  // Points computed within a tetrahedron are rounded to the digits of their coordinates, which are fewer far
  // from the origin; a triangle that such a point can reach counts as held.
  const Box bounds = boxOf(cage.nodes);
  const double farthest = std::max(bounds.low.cwiseAbs().maxCoeff(), bounds.high.cwiseAbs().maxCoeff());
  const double slack = 1e-13 * bounds.diagonal() + 1e-15 * farthest;
  std::vector<std::vector<Index>> touched(triangles.size());
  parallelFor(exec, triangles.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> candidates;
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3 origin = positions[at(triangles[t][0])];
      std::array<Vec3, 3> triangle;
      Box box;
      for (std::size_t c = 0; c < 3; ++c) {
        box.add(positions[at(triangles[t][c])]);
        triangle[c] = positions[at(triangles[t][c])] - origin;
      }
      grid.candidates(box, candidates);
      for (const Index k : candidates) {
        std::array<Vec3, 4> tet;
        for (std::size_t c = 0; c < 4; ++c) tet[c] = cage.nodes[at(cage.tets[at(k)][c])] - origin;
        if (touches(triangle, tet, slack)) touched[t].push_back(k);
      }
    }
  });
  cage.heldBegin.assign(cage.tets.size() + 1, 0);
  for (const auto& list : touched)
    for (const Index k : list) ++cage.heldBegin[at(k) + 1];
  for (std::size_t k = 0; k < cage.tets.size(); ++k) cage.heldBegin[k + 1] += cage.heldBegin[k];
  cage.held.resize(at(cage.heldBegin.back()));
  std::vector<Index> next(cage.heldBegin.begin(), cage.heldBegin.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const Index k : touched[t]) cage.held[at(next[at(k)]++)] = static_cast<Index>(t);
}

}  // namespace sherd
