#include "tetrahedralize/cage_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "tetrahedralize/surface_patches.h"

namespace sherd {
namespace {

constexpr double kGrading = 0.5;                              ///< growth of edge lengths with distance
constexpr double kFacetDistance = 0.4;                        ///< in offsets of the edge length
constexpr double kVoxelsPerOffset = 3.5, kLeastVoxels = 2.8;  ///< voxels in an offset

std::vector<GradedMinimum::Spot> gapSpots(const CageSizes& sizes) {
  std::vector<GradedMinimum::Spot> spots;
  for (const Gap& gap : sizes.open)
    for (const Vec3& place : {gap.from, gap.middle(), gap.to})
      spots.push_back({place, kEdgeOfGap * gap.width});
  return spots;
}

/// Points no closer to each other than asked for, where they look the same way: the two sides of a thin wall
/// need points of their own.
class SpreadPoints {
 public:
  explicit SpreadPoints(double cell) : cell_(cell) {}
  bool add(const Vec3& p, const Vec3& normal, double apart) {
    const Eigen::Vector3i c = (p / cell_).array().floor().matrix().cast<int>();
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k)
          if (const auto found = points_.find(key(c + Eigen::Vector3i(i, j, k))); found != points_.end())
            for (const auto& [q, other] : found->second)
              if ((p - q).squaredNorm() < apart * apart && normal.dot(other) > 0) return false;
    points_[key(c)].emplace_back(p, normal);
    return true;
  }

 private:
  static std::uint64_t key(const Eigen::Vector3i& c) {
    const auto part = [](int i) { return static_cast<std::uint64_t>(i + (1 << 20)) & 0x1fffff; };
    return part(c.x()) | part(c.y()) << 21 | part(c.z()) << 42;
  }
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<std::pair<Vec3, Vec3>>> points_;
};

/// Voxels and band for offsets around `offset`: the search for the edge length shall not need a new one each
/// time.
std::shared_ptr<const LevelSet> fittingLevelSet(const UnitSurface& surface, double offset,
                                                std::shared_ptr<const LevelSet>& last, const Exec& exec) {
  const auto bandFor = [](double largest, double voxel) { return largest + 2 * voxel; };
  if (last && last->voxel() <= offset / kLeastVoxels && last->band() >= bandFor(offset, last->voxel()))
    return last;
  const double voxel = offset / kVoxelsPerOffset;
  last = std::make_shared<const LevelSet>(surface.positions, surface.triangles, voxel,
                                          bandFor(1.2 * offset, voxel), exec);
  return last;
}

}  // namespace

CageField::CageField(const UnitSurface& surface, const SurfaceTree& tree, CageSizes sizes,
                     std::shared_ptr<const LevelSet>& levelSet, const Exec& exec)
    : surface_(surface),
      tree_(tree),
      exec_(exec),
      sizes_(std::move(sizes)),
      offsetShare_(kOffsetShare * sizes_.closeness),
      gapEdge_(sizes_.edgeLength, kGrading, gapSpots(sizes_)),
      finer_(sizes_.edgeLength, kGrading, sizes_.finer),
      levelSet_(fittingLevelSet(surface, offsetShare_ * sizes_.edgeLength, levelSet, exec)),
      distance_(levelSet_->sampler()) {}

double CageField::operator()(const Vec3& x) const {
  const double sampled = distance_(x), voxel = levelSet_->voxel(), error = 1.8 * voxel;
  const double largest = offsetShare_ * gapEdge_.top();
  if (sampled > largest + error) return sampled - largest;
  if (sampled < -error) return sampled - largest;
  const double r = offset(x);
  // The sampled distance errs by a fraction of a voxel: too much where the offset is not several of them.
  if (r >= 0.6 * largest || std::abs(sampled - r) > error) return sampled - r;
  const double distance = tree_.closest(x).distance;
  return (sampled < error && tree_.contains(x) ? -distance : distance) - r;
}

double CageField::expectedTets() const {
  // Facets of the edge length h near the surface have an area of √3/4 h²; a layer of tetrahedra has about
  // four per facet. Inside, a tetrahedron takes about h³/8.
  const RefinedSurface fine = refineLongEdges(surface_.positions, surface_.triangles, sizes_.edgeLength);
  double layer = 0;
  for (const Triangle& t : fine.triangles) {
    if (exec_.cancelled()) break;
    const Vec3 &a = fine.positions[at(t[0])], &b = fine.positions[at(t[1])], &c = fine.positions[at(t[2])];
    const double h = edgeLength((a + b + c) / 3);
    layer += 0.5 * (b - a).cross(c - a).norm() * 4 / (0.433 * h * h);
  }
  return layer + 8 * surface_.volume / std::pow(sizes_.edgeLength, 3);
}

std::vector<Vec3> CageField::seeds() const {
  SpreadPoints spread(2 * sizes_.edgeLength);
  std::vector<Vec3> points;
  for (const Shell& shell : surface_.shells) {
    std::vector<Triangle> part;
    Box box;
    for (const Index t : shell.triangles) {
      part.push_back(surface_.triangles[at(t)]);
      for (const Index v : part.back()) box.add(surface_.positions[at(v)]);
    }
    const double apart = std::min(1.5 * sizes_.edgeLength, 0.3 * box.diagonal());
    const RefinedSurface fine = refineLongEdges(surface_.positions, part, apart);
    for (const Triangle& t : fine.triangles) {
      if (exec_.cancelled()) return points;
      const Vec3 &a = fine.positions[at(t[0])], &b = fine.positions[at(t[1])], &c = fine.positions[at(t[2])];
      const Vec3 p = (a + b + c) / 3, normal = (b - a).cross(c - a).normalized();
      if (!(normal.squaredNorm() > 0.5) || !spread.add(p, normal, std::min(apart, 1.5 * edgeLength(p))))
        continue;
      if (const auto seed = onLevelSet(p, normal)) points.push_back(*seed);
    }
  }
  return points;
}

std::optional<Vec3> CageField::onLevelSet(const Vec3& p, const Vec3& normal) const {
  double low = 0, high = 2 * offset(p);
  if ((*this)(p) >= 0 || (*this)(p + high * normal) <= 0) return std::nullopt;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    ((*this)(p + middle * normal) < 0 ? low : high) = middle;
  }
  return p + low * normal;
}

VolumeToMesh CageField::volume() const {
  VolumeToMesh volume;
  volume.field = [this](const Vec3& x) { return (*this)(x); };
  volume.edgeLength = [this](const Vec3& x) { return edgeLength(x); };
  volume.facetDistance = [this](const Vec3& x) { return kFacetDistance * offsetShare_ * edgeLength(x); };
  volume.box = boxOf(surface_.positions);
  const double margin = 2 * offsetShare_ * sizes_.edgeLength;
  volume.box.low -= Vec3::Constant(margin);
  volume.box.high += Vec3::Constant(margin);
  volume.precision = 1e-3 * offsetShare_ * std::min(gapEdge_.lowest(), finer_.lowest());
  volume.seeds = seeds();
  return volume;
}

}  // namespace sherd
