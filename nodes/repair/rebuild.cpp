#include "repair/rebuild.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <unordered_map>

#include "base/parallel.h"
#include "geometry/level_set.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

struct Cell {
  int i, j, k;
  auto operator<=>(const Cell&) const = default;
};

/// The zero surface of values at whole coordinates, linear in each of six tetrahedra of a cell.
class MarchingTetrahedra {
 public:
  explicit MarchingTetrahedra(const LevelSet& levelSet)
      : value_(levelSet.values()), voxel_(levelSet.voxel()) {}

  /// Around the six paths along the axes from a cell's lowest corner to its highest: neighbours' faces match.
  void march(const Cell& cell) {
    static constexpr int kPaths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
    double values[8];
    bool anyIn = false, anyOut = false;
    for (int c = 0; c < 8; ++c) {
      values[c] = value_(cell.i + (c & 1), cell.j + (c >> 1 & 1), cell.k + (c >> 2 & 1));
      (values[c] < 0 ? anyIn : anyOut) = true;
    }
    if (!anyIn || !anyOut) return;
    for (const auto& path : kPaths) tetrahedron(cell, values, {0, path[0], path[1], 7});
  }

  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;

 private:
  void tetrahedron(const Cell& cell, const double* values, const std::array<int, 4>& corners) {
    std::vector<int> in, out;
    for (const int c : corners) (values[c] < 0 ? in : out).push_back(c);
    if (in.empty() || out.empty()) return;
    const auto cut = [&](int a, int b) { return vertex(cell, a, b, values[a], values[b]); };
    std::vector<Index> ring;
    if (in.size() == 1)
      for (const int b : out) ring.push_back(cut(in[0], b));
    else if (out.size() == 1)
      for (const int a : in) ring.push_back(cut(a, out[0]));
    else
      ring = {cut(in[0], out[0]), cut(in[0], out[1]), cut(in[1], out[1]), cut(in[1], out[0])};
    // Facing from the inside to the outside.
    const Vec3 outward = corner(cell, out[0]) - corner(cell, in[0]);
    const Vec3& p = positions[at(ring[0])];
    const Vec3 normal = (positions[at(ring[1])] - p).cross(positions[at(ring[2])] - p);
    if (normal.dot(outward) < 0) std::reverse(ring.begin(), ring.end());
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) triangles.push_back({ring[0], ring[k], ring[k + 1]});
  }
  Vec3 corner(const Cell& cell, int c) const {
    return voxel_ * Vec3(cell.i + (c & 1), cell.j + (c >> 1 & 1), cell.k + (c >> 2 & 1));
  }

  /// On the edge between corners a (inside) and b of the cell, once for all cells.
  Index vertex(const Cell& cell, int a, int b, double valueA, double valueB) {
    const Cell low{cell.i + (std::min(a, b) & 1), cell.j + (std::min(a, b) >> 1 & 1),
                   cell.k + (std::min(a, b) >> 2 & 1)};
    const auto [it, isNew] = number_.try_emplace(keyOf(low, a ^ b), static_cast<Index>(positions.size()));
    if (isNew) {
      // Off the ends, so that no triangle is a needle.
      const double share = std::clamp(valueA / (valueA - valueB), 0.05, 0.95);
      const Vec3 p = corner(cell, a), q = corner(cell, b);
      positions.push_back(p + share * (q - p));
    }
    return it->second;
  }
  /// Coordinates stay within ±2²⁰. `along` has a bit for each axis that the edge runs along.
  static std::uint64_t keyOf(const Cell& low, int along) {
    const auto part = [](int x) { return static_cast<std::uint64_t>(x + (1 << 19)) & 0xfffff; };
    return part(low.i) << 43 | part(low.j) << 23 | part(low.k) << 3 | static_cast<std::uint64_t>(along);
  }

  std::function<double(int, int, int)> value_;
  double voxel_;
  std::unordered_map<std::uint64_t, Index> number_;
};

/// Moved so that the box's centre is the origin, which keeps the voxels' numbers small.
std::vector<Vec3> centred(const Patchwork& surface, const Vec3& centre) {
  std::vector<Vec3> positions = surface.positions;
  for (Vec3& p : positions) p -= centre;
  return positions;
}

/// The cells with a corner in the band, in a fixed order.
std::vector<Cell> cellsOf(const LevelSet& levelSet) {
  std::vector<Cell> cells;
  levelSet.visitBand([&](int i, int j, int k) {
    for (int c = 0; c < 8; ++c) cells.push_back({i - (c & 1), j - (c >> 1 & 1), k - (c >> 2 & 1)});
  });
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// Points of the old surface, for measuring: vertices and middles of triangles.
std::vector<Vec3> samplesOf(const Patchwork& surface) {
  std::vector<Vec3> samples;
  std::vector<bool> used(surface.positions.size(), false);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& v = surface.triangles[t];
    if (surface.facets[t].isNew) continue;
    samples.push_back(
        (surface.positions[at(v[0])] + surface.positions[at(v[1])] + surface.positions[at(v[2])]) / 3);
    for (const Index corner : v) {
      if (!used[at(corner)]) samples.push_back(surface.positions[at(corner)]);
      used[at(corner)] = true;
    }
  }
  return samples;
}

double largest(const Exec& exec, std::size_t n, const std::function<double(std::size_t)>& f) {
  constexpr std::size_t kBlock = 256;
  std::vector<double> most((n + kBlock - 1) / kBlock, 0);
  parallelFor(exec, n, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !exec.cancelled(); ++i)
      most[begin / kBlock] = std::max(most[begin / kBlock], f(i));
  });
  return most.empty() ? 0 : *std::max_element(most.begin(), most.end());
}

/// The attributes of the closest points of the old surface.
void takeAttributes(Patchwork& made, const Patchwork& old, const SurfaceTree& tree,
                    const std::vector<Index>& numbers, const Exec& exec) {
  made.facets.resize(made.triangles.size());
  parallelFor(exec, made.triangles.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end && !exec.cancelled(); ++t) {
      const Triangle& v = made.triangles[t];
      Vec3 middle = Vec3::Zero();
      for (const Index corner : v) middle += made.positions[at(corner)] / 3;
      const SurfacePoint near = tree.closest(middle);
      const Facet& from = old.facets[at(numbers[at(near.triangle)])];
      Facet& facet = made.facets[t];
      facet.from = from.from;
      facet.turned = from.turned;
      facet.isNew = from.isNew;
      for (std::size_t c = 0; c < 3; ++c) {
        const SurfacePoint own = tree.closest(made.positions[at(v[c])]);
        const Facet& source = old.facets[at(numbers[at(own.triangle)])];
        facet.base[c] = originAt(source, own.barycentric);
      }
    }
  });
}

class Rebuilder {
 public:
  Rebuilder(const Patchwork& surface, const Exec& exec)
      : surface_(surface),
        exec_(exec),
        box_(boxOf(surface.positions)),
        positions_(centred(surface, box_.centre())) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      if (!surface.facets[t].isNew) {
        visible_.push_back(surface.triangles[t]);
        numbers_.push_back(static_cast<Index>(t));
      }
  }

  Result<Rebuilt> run(int resolution, int finest) {
    double last = std::numeric_limits<double>::infinity();
    for (;; resolution *= 2) {
      Rebuilt made = with(box_.diagonal() / resolution);
      if (exec_.cancelled()) return cancelledError();
      const bool isFinest = 2 * resolution > finest;
      if (made.surface.triangles.empty()) {
        if (!isFinest) continue;
        return failure("the surface encloses nothing that " + std::to_string(resolution) +
                       " voxels along it could hold");
      }
      const SurfaceTree fresh(made.surface.positions, made.surface.triangles);
      const double there = distanceThere(made, fresh);
      // Finer voxels keep thin parts; what is lost all the same encloses nothing.
      if (there > 2 * made.voxel && there < 0.8 * last && !isFinest) {
        last = there;
        continue;
      }
      made.hausdorff = std::max(there, distanceBack(made));
      takeAttributes(made.surface, surface_, SurfaceTree(surface_.positions, visible_), numbers_, exec_);
      if (exec_.cancelled()) return cancelledError();
      return made;
    }
  }

 private:
  Rebuilt with(double voxel) const {
    Rebuilt made{{}, voxel, 0};
    const LevelSet levelSet(positions_, surface_.triangles, voxel, 3 * voxel, exec_);
    if (exec_.cancelled()) return made;
    MarchingTetrahedra march(levelSet);
    for (const Cell& cell : cellsOf(levelSet)) {
      if (exec_.cancelled()) return made;
      march.march(cell);
    }
    made.surface.positions = std::move(march.positions);
    for (Vec3& p : made.surface.positions) p += box_.centre();
    made.surface.triangles = std::move(march.triangles);
    return made;
  }

  double distanceThere(const Rebuilt& made, const SurfaceTree& fresh) const {
    const std::vector<Vec3> samples = samplesOf(surface_);
    return largest(exec_, samples.size(), [&](std::size_t i) {
      const double distance = fresh.closest(samples[i]).distance;
      // Far within the new solid nothing is seen of the old surface.
      return distance > made.voxel && fresh.contains(samples[i]) ? 0.0 : distance;
    });
  }
  double distanceBack(const Rebuilt& made) const {
    const SurfaceTree all(surface_.positions, surface_.triangles);
    return largest(exec_, made.surface.positions.size(),
                   [&](std::size_t i) { return all.closest(made.surface.positions[i]).distance; });
  }

  const Patchwork& surface_;
  const Exec& exec_;
  Box box_;
  std::vector<Vec3> positions_;
  std::vector<Triangle> visible_;
  std::vector<Index> numbers_;
};

}  // namespace

Result<Rebuilt> rebuild(const Patchwork& surface, int resolution, int finest, const Exec& exec) {
  try {
    return Rebuilder(surface, exec).run(resolution, finest);
  } catch (const std::exception& error) {  // OpenVDB's
    return failure(std::string("the level set failed: ") + error.what());
  }
}

}  // namespace sherd
