#include "tessellate/solids.h"

#include <algorithm>
#include <map>
#include <optional>

#include "base/parallel.h"
#include "geometry/disjoint_sets.h"
#include "geometry/solid.h"
#include "geometry/surface_tree.h"

namespace sherd {
namespace {

/// A cell's side of an edge, bucketed by the edge's lower end.
struct Side {
  Index high, cell, face;
};

class SolidFinder {
 public:
  SolidFinder(const CellFaces& faces, std::span<const Vec3> positions, std::span<const Triangle> neighbours,
              const Exec& exec)
      : faces_(faces), positions_(positions), neighbours_(neighbours), exec_(exec), sets_(faces.size()) {}

  Solids run() {
    joinUncut();
    if (!exec_.cancelled()) joinAlongCuts();
    if (!exec_.cancelled()) collectShells();
    if (!exec_.cancelled()) placeVoids();
    return std::move(out_);
  }

 private:
  /// Uncut triangles that are neighbours lie in one cell. Those at a cut one meet its parts over the edge.
  void joinUncut() {
    for (std::size_t t = 0; t < faces_.firstSkin(); ++t) {
      if (!faces_.exists(t)) continue;
      for (std::size_t side = 0; side < 3; ++side) {
        const std::size_t next = at(neighbours_[t][side]);
        if (!faces_.exists(next))
          addSide(t, side);
        else if (next > t)
          sets_.join(t, next);
      }
    }
    for (std::size_t f = faces_.firstSkin(); f < faces_.size(); ++f)
      for (std::size_t side = 0; side < 3; ++side) addSide(f, side);
  }

  void addSide(std::size_t face, std::size_t side) {
    const Triangle t = faces_.corners(face);
    const auto [low, high] = std::minmax(t[side], t[(side + 1) % 3]);
    lows_.push_back(low);
    sides_.push_back({high, faces_.cell(face), static_cast<Index>(face)});
  }

  void joinAlongCuts() {
    std::vector<Index> begin(positions_.size() + 1, 0);
    for (const Index v : lows_) ++begin[at(v) + 1];
    for (std::size_t v = 0; v < positions_.size(); ++v) begin[v + 1] += begin[v];
    std::vector<Side> sorted(sides_.size());
    std::vector<Index> fill(begin.begin(), begin.end() - 1);
    for (std::size_t i = 0; i < sides_.size(); ++i) sorted[at(fill[at(lows_[i])]++)] = sides_[i];
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      const auto first = sorted.begin() + begin[v], last = sorted.begin() + begin[v + 1];
      std::sort(first, last, [](const Side& a, const Side& b) {
        return std::tie(a.high, a.cell, a.face) < std::tie(b.high, b.cell, b.face);
      });
      for (auto s = first; s != last && s + 1 != last; ++s)
        if (s->high == (s + 1)->high && s->cell == (s + 1)->cell) sets_.join(at(s->face), at((s + 1)->face));
    }
  }

  /// Numbers the shells in the order of their first faces and sums up their volumes about one point.
  void collectShells() {
    out_.ofFace.assign(faces_.size(), -1);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!faces_.exists(f)) continue;
      Index& shell = out_.ofFace[sets_.find(f)];  // a root is the least of its set, so it comes first
      if (shell < 0) {
        shell = static_cast<Index>(out_.list.size());
        out_.list.push_back({faces_.cell(f), 0});
      }
      out_.ofFace[f] = shell;
    }
    sumVolumes();
  }

  void sumVolumes() {
    Vec3 origin = Vec3::Zero();
    if (!positions_.empty()) origin = positions_[0];
    constexpr std::size_t block = 1 << 15;
    std::vector<std::vector<double>> parts((faces_.size() + block - 1) / block);
    parallelFor(exec_, faces_.size(), block, [&](std::size_t begin, std::size_t end) {
      std::vector<double>& volumes = parts[begin / block];
      volumes.assign(out_.list.size(), 0);
      for (std::size_t f = begin; f < end; ++f) {
        if (out_.ofFace[f] < 0) continue;
        const Triangle t = faces_.corners(f);
        const Vec3 a = positions_[at(t[0])] - origin, b = positions_[at(t[1])] - origin,
                   c = positions_[at(t[2])] - origin;
        volumes[at(out_.ofFace[f])] += a.cross(b).dot(c) / 6;
      }
    });
    for (const std::vector<double>& part : parts)
      for (std::size_t s = 0; s < part.size(); ++s) out_.list[s].volume += part[s];
  }

  std::vector<Triangle> trianglesOf(Index shell) const {
    std::vector<Triangle> triangles;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (out_.ofFace[f] == shell) triangles.push_back(faces_.corners(f));
    return triangles;
  }

  void placeVoids() {
    std::map<Index, std::vector<Index>> solidsOf;
    std::vector<Index> voids;
    for (std::size_t s = 0; s < out_.list.size(); ++s)
      if (out_.list[s].volume > 0)
        solidsOf[out_.list[s].cell].push_back(static_cast<Index>(s));
      else
        voids.push_back(static_cast<Index>(s));
    for (const auto& [cell, list] : solidsOf) out_.detached += list.size() - 1;
    if (voids.empty()) return;
    std::vector<Index> owner(out_.list.size());
    for (std::size_t s = 0; s < owner.size(); ++s) owner[s] = static_cast<Index>(s);
    for (const Index v : voids) owner[at(v)] = holderOf(v, solidsOf[out_.list[at(v)].cell]);
    for (const Index v : voids)
      if (owner[at(v)] != v) out_.list[at(owner[at(v)])].volume += out_.list[at(v)].volume;
    compact(owner);
  }

  Index holderOf(Index hole, const std::vector<Index>& candidates) const {
    const std::vector<Triangle> own = trianglesOf(hole);
    const Vec3& probe = positions_[at(own.front()[0])];
    std::optional<Index> best;
    for (const Index s : candidates)
      if (SurfaceTree(positions_, trianglesOf(s)).contains(probe) &&
          (!best || out_.list[at(s)].volume < out_.list[at(*best)].volume))
        best = s;
    return best.value_or(hole);
  }

  void compact(const std::vector<Index>& owner) {
    std::vector<Index> number(owner.size(), -1);
    std::vector<Solid> kept;
    for (std::size_t s = 0; s < owner.size(); ++s)
      if (owner[s] == static_cast<Index>(s)) {
        number[s] = static_cast<Index>(kept.size());
        kept.push_back(out_.list[s]);
      }
    out_.list = std::move(kept);
    for (Index& s : out_.ofFace)
      if (s >= 0) s = number[at(owner[at(s)])];
  }

  const CellFaces& faces_;
  std::span<const Vec3> positions_;
  std::span<const Triangle> neighbours_;
  const Exec& exec_;
  DisjointSets sets_;
  std::vector<Index> lows_;
  std::vector<Side> sides_;
  Solids out_;
};

}  // namespace

Solids findSolids(const CellFaces& faces, std::span<const Vec3> positions,
                  std::span<const Triangle> neighbours, const Exec& exec) {
  return SolidFinder(faces, positions, neighbours, exec).run();
}

}  // namespace sherd
