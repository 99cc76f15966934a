// Bodies of cubes over a plan, and the exact lengths of shortest ways inside them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/tet_families.h"

namespace sherd::families {

/// Rows of a plan, the top one (largest y) first: '#' is solid. As many cubes deep as asked, of edge 1.
struct Plan {
  std::vector<std::string> rows;
  int depth = 1;

  int width() const { return static_cast<int>(rows[0].size()); }
  int height() const { return static_cast<int>(rows.size()); }
  bool solid(int i, int j) const {
    return i >= 0 && j >= 0 && i < width() && j < height() &&
           rows[static_cast<std::size_t>(height() - 1 - j)][static_cast<std::size_t>(i)] == '#';
  }
  TetMesh mesh() const {
    return fromCubes(cubesOf(width(), height(), depth, [this](int i, int j, int) { return solid(i, j); }),
                     Vec3::Ones());
  }
};

/// Shortest ways inside a plan's body. In a prism over a plan the way unrolls: its length is the hypotenuse
/// of the shortest way in the plan, which bends at concave corners only, and the difference in depth.
class PlanGeodesics {
 public:
  explicit PlanGeodesics(const Plan& plan) : plan_(plan) {
    for (int i = 1; i < plan.width(); ++i)
      for (int j = 1; j < plan.height(); ++j) {
        const int around =
            plan.solid(i, j) + plan.solid(i - 1, j) + plan.solid(i, j - 1) + plan.solid(i - 1, j - 1);
        if (around == 3) corners_.emplace_back(i, j);
      }
    const std::size_t n = corners_.size();
    between_.assign(n, std::vector<double>(n, kFar));
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b)
        if (sees(corners_[a], corners_[b])) between_[a][b] = (corners_[a] - corners_[b]).norm();
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          between_[a][b] = std::min(between_[a][b], between_[a][k] + between_[k][b]);
  }

  /// Distances to the corners that a place sees; infinite for the others.
  std::vector<double> reach(const Vec3& p) const {
    std::vector<double> out;
    for (const Vec2& c : corners_) out.push_back(sees(p.head<2>(), c) ? (p.head<2>() - c).norm() : kFar);
    return out;
  }

  /// reachA, reachB: reach() of a and b.
  double length(const Vec3& a, const std::vector<double>& reachA, const Vec3& b,
                const std::vector<double>& reachB) const {
    double flat = sees(a.head<2>(), b.head<2>()) ? (a - b).head<2>().norm() : kFar;
    for (std::size_t i = 0; i < corners_.size(); ++i)
      if (reachA[i] < flat)
        for (std::size_t j = 0; j < corners_.size(); ++j)
          flat = std::min(flat, reachA[i] + between_[i][j] + reachB[j]);
    return std::hypot(flat, a.z() - b.z());
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  /// Is the segment inside, or along the border? One along a grid line is where it is on either side of it.
  bool sees(const Vec2& p, const Vec2& q) const {
    const Vec2 across = kAside * Vec2(p.y() - q.y(), q.x() - p.x()).normalized();
    if (!across.allFinite()) return true;
    return isFree(p + across, q + across) || isFree(p - across, q - across);
  }

  /// Does the segment meet the inside of no empty square?
  bool isFree(const Vec2& p, const Vec2& q) const {
    const int i0 = static_cast<int>(std::floor(std::min(p.x(), q.x()))),
              i1 = static_cast<int>(std::ceil(std::max(p.x(), q.x())));
    const int j0 = static_cast<int>(std::floor(std::min(p.y(), q.y()))),
              j1 = static_cast<int>(std::ceil(std::max(p.y(), q.y())));
    for (int i = i0; i < i1; ++i)
      for (int j = j0; j < j1; ++j)
        if (!plan_.solid(i, j) && meetsInside(p, q, Vec2(i, j))) return false;
    return true;
  }

  static constexpr double kAside = 1e-6;

  /// The segment against the unit square, by clipping. What moving it aside adds at its ends does not count.
  static bool meetsInside(const Vec2& p, const Vec2& q, const Vec2& low) {
    double from = 0, to = 1;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const double direction = q[axis] - p[axis], a = low[axis] - p[axis], b = a + 1;
      if (std::abs(direction) < 1e-12) {
        if (a >= 0 || b <= 0) return false;
        continue;
      }
      from = std::max(from, std::min(a / direction, b / direction));
      to = std::min(to, std::max(a / direction, b / direction));
    }
    return (to - from) * (q - p).norm() > 10 * kAside;
  }

  Plan plan_;
  std::vector<Vec2> corners_;
  std::vector<std::vector<double>> between_;
};

/// Each square of the plan becomes factor × factor squares.
inline Plan refined(const Plan& plan, int factor) {
  Plan out;
  out.depth = plan.depth * factor;
  for (const std::string& row : plan.rows) {
    std::string wide;
    for (const char c : row) wide.append(static_cast<std::size_t>(factor), c);
    out.rows.insert(out.rows.end(), static_cast<std::size_t>(factor), wide);
  }
  return out;
}

}  // namespace sherd::families
