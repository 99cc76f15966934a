#include "repair/leaves.h"

#include <cmath>
#include <map>

namespace sherd {
namespace {

class Slabs {
 public:
  Slabs(Patchwork& surface, std::span<const Index> triangles, double thickness, const Footing* footing)
      : surface_(surface), triangles_(triangles) {
    std::map<Index, Vec3> normals;
    for (const Index t : triangles) {
      const Triangle& v = surface.triangles[at(t)];
      const Vec3& a = surface.positions[at(v[0])];
      const Vec3 normal =
          (surface.positions[at(v[1])] - a).cross(surface.positions[at(v[2])] - a).normalized();
      for (const Index corner : v) {
        auto [it, isNew] = normals.try_emplace(corner, Vec3::Zero());
        it->second += normal;
      }
    }
    for (const auto& [v, sum] : normals) {
      const double length = sum.norm();
      const Vec3 step = length > 1e-9 ? Vec3(0.5 * thickness / length * sum) : Vec3(0, 0.5 * thickness, 0);
      Vec3 p = surface.positions[at(v)];
      if (footing != nullptr) p += footing->reach(p, step.normalized(), thickness);
      front_[v] = static_cast<Index>(surface.positions.size());
      surface.positions.push_back(p + step);
      back_[v] = static_cast<Index>(surface.positions.size());
      surface.positions.push_back(p - step);
    }
  }

  void add() {
    std::map<std::array<Index, 2>, int> balance;
    const auto keyOf = [](Index a, Index b) { return std::array<Index, 2>{std::min(a, b), std::max(a, b)}; };
    for (const Index t : triangles_) {
      const Triangle v = surface_.triangles[at(t)];
      const Facet facet = surface_.facets[at(t)];
      surface_.add({front_[v[0]], front_[v[1]], front_[v[2]]}, facet);
      surface_.add({back_[v[0]], back_[v[1]], back_[v[2]]}, facet);
      turn(surface_, surface_.triangles.size() - 1);
      for (std::size_t c = 0; c < 3; ++c)
        balance[keyOf(v[c], v[(c + 1) % 3])] += v[c] < v[(c + 1) % 3] ? 1 : -1;
    }
    for (const Index t : triangles_)
      for (std::size_t c = 0; c < 3; ++c) {
        const Triangle v = surface_.triangles[at(t)];
        const Index a = v[c], b = v[(c + 1) % 3];
        int& net = balance[keyOf(a, b)];
        if ((a < b ? net : -net) <= 0) continue;
        net -= a < b ? 1 : -1;
        addWall(a, b, surface_.facets[at(t)], c);
      }
  }

 private:
  /// Behind the edge that runs from a to b, corners c and c + 1 of the facet.
  void addWall(Index a, Index b, const Facet& beside, std::size_t c) {
    const CornerOrigin from = originOf(beside, c), to = originOf(beside, (c + 1) % 3);
    Facet wall{.base = {to, from, from}};
    wall.from = beside.from;
    wall.isNew = true;
    surface_.add({front_[b], front_[a], back_[a]}, wall);
    wall.base[2] = to;
    surface_.add({front_[b], back_[a], back_[b]}, wall);
  }

  Patchwork& surface_;
  std::span<const Index> triangles_;
  std::map<Index, Index> front_, back_;
};

}  // namespace

void addSlabs(Patchwork& surface, std::span<const Index> triangles, double thickness,
              const Footing* footing) {
  Slabs(surface, triangles, thickness, footing).add();
}

}  // namespace sherd
