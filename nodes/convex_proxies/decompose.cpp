#include "convex_proxies/decompose.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/rng.h"
#include "convex_proxies/clipped.h"
#include "convex_proxies/cut_planes.h"
#include "geometry/convex_hull.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

constexpr std::size_t kRankingPoints = 160;  ///< of a part, that candidate planes are compared by
constexpr double kClose = 1e-3;      ///< in shares of the hull: candidates no further apart are equally good
constexpr double kLeastPart = 1e-6;  ///< of the solid's volume, that a cut leaves on either side

struct Part {
  ClippedSolid solid;
  HullMesh hull;
  double volume;
  bool whole = false;  ///< no plane makes it better
  double excess() const { return whole ? 0 : hull.volume - volume; }
};

/// Every k-th of the points, so that about `most` are left.
std::vector<Vec3> thinned(std::span<const Vec3> points, std::size_t most) {
  const std::size_t step = (points.size() + most - 1) / std::max<std::size_t>(most, 1);
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(step, 1)) out.push_back(points[i]);
  return out;
}

class Decomposer {
 public:
  Decomposer(std::span<const Vec3> positions, std::span<const Triangle> triangles, double volume,
             const ConvexProxiesParams& params, const Exec& exec)
      : positions_(positions), triangles_(triangles), volume_(volume), params_(params), exec_(exec) {}

  Result<std::vector<ConvexHull>> run() {
    SHERD_ASSIGN(Part first, makePart(ClippedSolid(positions_, triangles_)));
    first.volume = volume_;
    size_ = boxOf(first.hull.positions).diagonal();
    std::vector<Part> parts;
    parts.push_back(std::move(first));
    if (volume_ > 0 && params_.maxHulls > 1) SHERD_CHECK(cutDown(parts));
    std::vector<ConvexHull> hulls;
    for (Part& part : parts)
      hulls.push_back({std::move(part.hull.positions), std::move(part.hull.triangles), part.hull.volume});
    return hulls;
  }

 private:
  Result<void> cutDown(std::vector<Part>& parts) {
    while (parts.size() < static_cast<std::size_t>(params_.maxHulls) && !exec_.cancelled()) {
      double hulls = 0;
      for (const Part& part : parts) hulls += part.hull.volume;
      if (hulls - volume_ <= params_.tolerance * volume_ || hulls - volume_ <= 1e-12 * volume_) break;
      if (edges_.empty() && parts.size() == 1) edges_ = concaveEdges(positions_, triangles_);
      const auto worst = std::max_element(
          parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.excess() < b.excess(); });
      if (!(worst->excess() > 1e-12 * volume_)) break;
      SHERD_ASSIGN(auto halves, bestCut(*worst));
      if (!halves) {
        worst->whole = true;
        continue;
      }
      *worst = std::move(halves->first);
      parts.push_back(std::move(halves->second));
    }
    return {};
  }

  Result<Part> makePart(ClippedSolid solid) const {
    std::vector<Vec3> points = solid.skin().corners;
    addCornersWithin(solid.planes(), points);
    SHERD_ASSIGN(HullMesh hull, convexHull(points));
    const double volume = solid.volume();
    return Part{std::move(solid), std::move(hull), volume};
  }

  /// Where three cutting planes meet within the solid: the one kind of corner that is not of the skin.
  void addCornersWithin(const std::vector<CutPlane>& planes, std::vector<Vec3>& points) const {
    for (std::size_t i = 0; i < planes.size(); ++i)
      for (std::size_t j = i + 1; j < planes.size(); ++j)
        for (std::size_t k = j + 1; k < planes.size(); ++k) {
          Mat3 normals;
          normals << planes[i].normal.transpose(), planes[j].normal.transpose(), planes[k].normal.transpose();
          if (std::abs(normals.determinant()) < 1e-9) continue;
          const Vec3 x = normals.inverse() * Vec3(planes[i].normal.dot(planes[i].origin),
                                                  planes[j].normal.dot(planes[j].origin),
                                                  planes[k].normal.dot(planes[k].origin));
          const bool isInside = std::all_of(planes.begin(), planes.end(), [&](const CutPlane& plane) {
            return plane.height(x) <= 1e-12 * size_;
          });
          if (!isInside) continue;
          if (!tree_) tree_.emplace(positions_, triangles_);
          if (tree_->contains(x)) points.push_back(x);
        }
  }

  /// What a plane would leave.
  struct Candidate {
    CutPlane plane;
    double hulls;      ///< m³, of both sides; infinite where it cuts nothing
    double imbalance;  ///< difference of the two
  };

  Result<std::optional<std::pair<Part, Part>>> bestCut(const Part& part) const {
    using Halves = std::optional<std::pair<Part, Part>>;
    std::vector<Candidate> ranking;
    for (const CutPlane& plane : candidatePlanes(edges_, part.hull, part.solid.planes(), exec_)) {
      if (exec_.cancelled()) return Halves();
      SHERD_ASSIGN(Candidate candidate, tryCut(part, plane));
      ranking.push_back(std::move(candidate));
    }
    sortByMerit(part, ranking);
    for (const Candidate& c : ranking) {
      if (exec_.cancelled() || !std::isfinite(c.hulls)) break;
      SHERD_ASSIGN(Part below, makePart(part.solid.clipped(c.plane)));
      if (exec_.cancelled()) break;
      SHERD_ASSIGN(Part above, makePart(part.solid.clipped(c.plane.turned())));
      const double least = kLeastPart * volume_;
      if (below.volume < least || above.volume < least) continue;
      if (below.hull.volume + above.hull.volume > part.hull.volume * (1 + 1e-12)) continue;
      return Halves(std::pair(std::move(below), std::move(above)));
    }
    return Halves();
  }

  /// The smallest hulls first. Of equally good cuts the first guess, along a concave edge, comes first; but
  /// where none gains anything, as with a ring, halves do: they can be cut better.
  static void sortByMerit(const Part& part, std::vector<Candidate>& ranking) {
    double best = std::numeric_limits<double>::infinity();
    for (const Candidate& c : ranking) best = std::min(best, c.hulls);
    const double close = kClose * part.hull.volume;
    const bool gains = best < part.hull.volume - close;
    std::stable_sort(ranking.begin(), ranking.end(), [&](const Candidate& a, const Candidate& b) {
      const bool aBest = a.hulls <= best + close, bBest = b.hulls <= best + close;
      if (aBest != bBest) return aBest;
      if (aBest) return !gains && a.imbalance < b.imbalance;
      return a.hulls < b.hulls;
    });
  }

  /// From some of the points, moved a little: general position is many times faster for exact predicates.
  Result<Candidate> tryCut(const Part& part, const CutPlane& plane) const {
    std::vector<Vec3> sides[2], section;
    const PolygonList& skin = part.solid.skin();
    for (std::size_t i = 0; i < skin.size(); ++i) {
      const auto polygon = skin.polygon(i);
      bool below = false, above = false;  // corners in the plane belong to the side that their polygon is on
      for (const Vec3& p : polygon) {
        const double h = plane.height(p);
        below = below || h < 0;
        above = above || h > 0;
      }
      for (std::size_t c = 0; c < polygon.size(); ++c) {
        const Vec3 &p = polygon[c], &q = polygon[(c + 1) % polygon.size()];
        const double hp = plane.height(p), hq = plane.height(q);
        if (below && hp <= 0) sides[0].push_back(p);
        if (above && hp >= 0) sides[1].push_back(p);
        if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) section.push_back(p + hp / (hp - hq) * (q - p));
      }
    }
    section = thinned(section, kRankingPoints / 2);
    double volumes[2] = {0, 0};
    for (const std::size_t side : {0, 1}) {
      std::vector<Vec3> points = thinned(sides[side], kRankingPoints);
      points.insert(points.end(), section.begin(), section.end());
      moveALittle(points);
      SHERD_ASSIGN(const HullMesh hull, convexHull(points));
      volumes[side] = hull.volume;
      if (!(hull.volume > 1e-6 * part.hull.volume))
        return Candidate{plane, std::numeric_limits<double>::infinity(), 0};
    }
    return Candidate{plane, volumes[0] + volumes[1], std::abs(volumes[0] - volumes[1])};
  }

  void moveALittle(std::vector<Vec3>& points) const {
    const Rng rng(1);
    for (std::size_t i = 0; i < points.size(); ++i)
      for (const std::size_t axis : {0, 1, 2})
        points[i][static_cast<Eigen::Index>(axis)] += 1e-6 * size_ * (rng.uniformAt(3 * i + axis) - 0.5);
  }

  std::span<const Vec3> positions_;
  std::span<const Triangle> triangles_;
  double volume_;
  const ConvexProxiesParams& params_;
  const Exec& exec_;
  double size_ = 0;
  std::vector<ConcaveEdge> edges_;
  mutable std::optional<SurfaceTree> tree_;  ///< made where a part has a corner within
};

}  // namespace

Result<std::vector<ConvexHull>> decompose(std::span<const Vec3> positions,
                                          std::span<const Triangle> triangles, double volume,
                                          const ConvexProxiesParams& params, const Exec& exec) {
  return Decomposer(positions, triangles, volume, params, exec).run();
}

}  // namespace sherd
