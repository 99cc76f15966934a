#include "tessellate/solids.h"

#include <algorithm>
#include <map>
#include <optional>

#include "geometry/surface_tree.h"

namespace sherd {
namespace {

class SolidFinder {
 public:
  SolidFinder(CellParts& parts, std::span<const Vec3> positions) : parts_(parts), positions_(positions) {}

  Solids run() {
    collectShells();
    placeVoids();
    return std::move(out_);
  }

 private:
  /// Numbers the shells in the order of their first parts and adds up what they enclose.
  void collectShells() {
    out_.ofPart.assign(parts_.size(), -1);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      Index& shell = out_.ofPart[parts_.connected().find(p)];  // a root is the least of its set: comes first
      if (shell < 0) {
        shell = static_cast<Index>(out_.list.size());
        out_.list.push_back({parts_.cell(p), {}});
      }
      out_.ofPart[p] = shell;
      out_.list[at(shell)].sums += parts_.sums(p);
    }
  }

  double volume(Index solid) const { return out_.list[at(solid)].sums.volume; }

  std::vector<Triangle> trianglesOf(Index shell) const {
    std::vector<Triangle> triangles;
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (out_.ofPart[p] == shell) parts_.forTriangles(p, [&](const Triangle& t) { triangles.push_back(t); });
    return triangles;
  }

  void placeVoids() {
    std::map<Index, std::vector<Index>> solidsOf;
    std::vector<Index> voids;
    for (Index s = 0; at(s) < out_.list.size(); ++s)
      if (volume(s) > 0)
        solidsOf[out_.list[at(s)].cell].push_back(s);
      else
        voids.push_back(s);
    for (const auto& [cell, list] : solidsOf) out_.detached += list.size() - 1;
    if (voids.empty()) return;
    std::vector<Index> owner(out_.list.size());
    for (std::size_t s = 0; s < owner.size(); ++s) owner[s] = static_cast<Index>(s);
    for (const Index v : voids) owner[at(v)] = holderOf(v, solidsOf[out_.list[at(v)].cell]);
    for (const Index v : voids)
      if (owner[at(v)] != v) out_.list[at(owner[at(v)])].sums += out_.list[at(v)].sums;
    compact(owner);
  }

  /// Centres of the largest triangles: where a void touches what holds it, only corners and edges do.
  std::vector<Vec3> probesOf(Index hole) const {
    constexpr std::size_t most = 9;
    struct Probe {
      double area;
      Vec3 centre;
    };
    std::vector<Probe> probes;
    for (const Triangle& t : trianglesOf(hole)) {
      const Vec3 &a = positions_[at(t[0])], &b = positions_[at(t[1])], &c = positions_[at(t[2])];
      probes.push_back({(b - a).cross(c - a).norm(), a + ((b - a) + (c - a)) / 3});
    }
    std::stable_sort(probes.begin(), probes.end(),
                     [](const Probe& x, const Probe& y) { return x.area > y.area; });
    std::vector<Vec3> centres;
    for (std::size_t i = 0; i < std::min(most, probes.size()); ++i) centres.push_back(probes[i].centre);
    return centres;
  }

  Index holderOf(Index hole, const std::vector<Index>& candidates) const {
    const std::vector<Vec3> probes = probesOf(hole);
    std::optional<Index> best;
    for (const Index s : candidates) {
      if (best && volume(s) >= volume(*best)) continue;
      const SurfaceTree tree(positions_, trianglesOf(s));
      const auto inside =
          std::count_if(probes.begin(), probes.end(), [&](const Vec3& p) { return tree.contains(p); });
      if (2 * static_cast<std::size_t>(inside) > probes.size()) best = s;
    }
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
    for (Index& s : out_.ofPart) s = number[at(owner[at(s)])];
  }

  CellParts& parts_;
  std::span<const Vec3> positions_;
  Solids out_;
};

}  // namespace

Solids findSolids(CellParts& parts, std::span<const Vec3> positions) {
  return SolidFinder(parts, positions).run();
}

}  // namespace sherd
