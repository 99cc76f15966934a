#include "geometry/level_set.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sherd {
namespace {

/// Crossings of the surface with the lines (i, j, ·) through voxel centres, in voxel units.
class Columns {
 public:
  Columns(const std::vector<openvdb::Vec3s>& points, std::span<const Triangle> triangles, const Exec& exec) {
    Box box;
    for (const openvdb::Vec3s& p : points) box.add(Vec3(p.x(), p.y(), p.z()));
    low_[0] = static_cast<int>(std::floor(box.low.x())) - 1;
    low_[1] = static_cast<int>(std::floor(box.low.y())) - 1;
    size_[0] = static_cast<int>(std::ceil(box.high.x())) + 2 - low_[0];
    size_[1] = static_cast<int>(std::ceil(box.high.y())) + 2 - low_[1];
    crossings_.resize(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]));
    for (const Triangle& t : triangles) {
      if (exec.cancelled()) return;
      add(points[at(t[0])], points[at(t[1])], points[at(t[2])]);
    }
    for (auto& column : crossings_) {
      if (exec.cancelled()) return;
      std::sort(column.begin(), column.end());
    }
  }

  bool inside(int i, int j, double z) const {
    if (i < low_[0] || j < low_[1] || i >= low_[0] + size_[0] || j >= low_[1] + size_[1]) return false;
    int winding = 0;
    for (const auto& [height, sign] : crossings_[index(i, j)])
      if (height > z) winding += sign;
    return winding > 0;
  }

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j - low_[1]) * static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(i - low_[0]);
  }

  /// Twice the area of (a, b, column) seen from above. Computed from the lexicographically smaller end, so
  /// that the two triangles at an edge see exactly opposite numbers and no column slips between them.
  static double side(const openvdb::Vec3s& a, const openvdb::Vec3s& b, double x, double y) {
    const bool swap = b.x() < a.x() || (b.x() == a.x() && b.y() < a.y());
    const openvdb::Vec3s &p = swap ? b : a, &q = swap ? a : b;
    const double area = (static_cast<double>(q.x()) - p.x()) * (y - p.y()) -
                        (static_cast<double>(q.y()) - p.y()) * (x - p.x());
    return swap ? -area : area;
  }

  void add(const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& c) {
    const auto [xLow, xHigh] = std::minmax({a.x(), b.x(), c.x()});
    const auto [yLow, yHigh] = std::minmax({a.y(), b.y(), c.y()});
    for (int j = static_cast<int>(std::floor(yLow)); j <= static_cast<int>(std::ceil(yHigh)); ++j)
      for (int i = static_cast<int>(std::floor(xLow)); i <= static_cast<int>(std::ceil(xHigh)); ++i)
        addCrossing(a, b, c, i, j);
  }

  void addCrossing(const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& c, int i, int j) {
    // Off the voxel's centre by less than it matters, so that vertices on whole coordinates are no special
    // case.
    const double x = i + 1.234567e-4, y = j + 2.345678e-4;
    const double wa = side(b, c, x, y), wb = side(c, a, x, y), wc = side(a, b, x, y);
    const bool up = wa > 0 && wb > 0 && wc > 0, down = wa < 0 && wb < 0 && wc < 0;
    if (!up && !down) return;
    const double z = (wa * a.z() + wb * b.z() + wc * c.z()) / (wa + wb + wc);
    crossings_[index(i, j)].emplace_back(z, up ? 1 : -1);
  }

  int low_[2], size_[2];
  std::vector<std::vector<std::pair<double, int>>> crossings_;
};

/// Lets OpenVDB ask whether to go on.
struct Interrupter : openvdb::util::NullInterrupter {
  explicit Interrupter(const Exec& run) : exec(run) {}
  bool wasInterrupted(int) override { return exec.cancelled(); }
  const Exec& exec;
};

}  // namespace

struct LevelSet::Impl {
  openvdb::FloatGrid::Ptr grid;
};

LevelSet::LevelSet(std::span<const Vec3> positions, std::span<const Triangle> triangles, double voxel,
                   double band, const Exec& exec)
    : impl_(std::make_unique<Impl>()), voxel_(voxel), band_(band) {
  openvdb::initialize();
  std::vector<openvdb::Vec3s> points;
  points.reserve(positions.size());
  for (const Vec3& p : positions)
    points.emplace_back(static_cast<float>(p.x() / voxel), static_cast<float>(p.y() / voxel),
                        static_cast<float>(p.z() / voxel));
  std::vector<openvdb::Vec3I> faces;
  faces.reserve(triangles.size());
  for (const Triangle& t : triangles)
    faces.emplace_back(static_cast<unsigned>(t[0]), static_cast<unsigned>(t[1]), static_cast<unsigned>(t[2]));

  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> mesh(points, faces);
  const auto unit = openvdb::math::Transform::createLinearTransform(1.0);
  Interrupter interrupter(exec);
  // By its base: for that type OpenVDB's library has the template ready.
  openvdb::util::NullInterrupter& interrupterBase = interrupter;
  const float width = static_cast<float>(band / voxel);
  impl_->grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(interrupterBase, mesh, *unit, width, width,
                                                                 openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  if (exec.cancelled()) return;
  const Columns columns(points, triangles, exec);
  for (auto it = impl_->grid->beginValueOn(); it; ++it) {
    if (exec.cancelled()) return;
    const openvdb::Coord c = it.getCoord();
    if (columns.inside(c.x(), c.y(), c.z())) it.setValue(-*it);
  }
  impl_->grid->setGridClass(openvdb::GRID_LEVEL_SET);
  openvdb::tools::signedFloodFill(impl_->grid->tree(), /*threaded=*/false);
}

LevelSet::~LevelSet() = default;
LevelSet::LevelSet(LevelSet&&) noexcept = default;

void LevelSet::visitBand(const std::function<void(int, int, int)>& visit) const {
  for (auto it = impl_->grid->cbeginValueOn(); it; ++it) {
    const openvdb::Coord c = it.getCoord();
    visit(c.x(), c.y(), c.z());
  }
}

std::function<double(int, int, int)> LevelSet::values() const {
  return [accessor = impl_->grid->getConstAccessor(), voxel = voxel_](int i, int j, int k) {
    return voxel * static_cast<double>(accessor.getValue(openvdb::Coord(i, j, k)));
  };
}

std::function<double(const Vec3&)> LevelSet::sampler() const {
  return [accessor = impl_->grid->getConstAccessor(), voxel = voxel_](const Vec3& x) {
    const openvdb::Vec3R at(x.x() / voxel, x.y() / voxel, x.z() / voxel);
    return voxel * static_cast<double>(openvdb::tools::BoxSampler::sample(accessor, at));
  };
}

}  // namespace sherd
