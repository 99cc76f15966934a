#include "tetrahedralize/surface_patches.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>

#include "tetrahedralize/contacts.h"

namespace sherd {
namespace {

using EdgeKey = std::uint64_t;
EdgeKey edgeKey(Index a, Index b) {
  return static_cast<EdgeKey>(std::min(a, b)) << 32 | static_cast<EdgeKey>(std::max(a, b));
}

/// Splits one triangle whose edge c → c + 1 has a middle vertex middle[c], or −1.
void splitTriangle(const Triangle& t, const std::array<Index, 3>& middle, std::vector<Triangle>& out) {
  const int marked =
      static_cast<int>(std::count_if(middle.begin(), middle.end(), [](Index m) { return m >= 0; }));
  if (marked == 0) {
    out.push_back(t);
    return;
  }
  // Turn the triangle so that the cases below see one arrangement each.
  std::size_t first = 0;
  if (marked == 1)
    while (middle[first] < 0) ++first;
  if (marked == 2)
    while (middle[(first + 2) % 3] >= 0) ++first;
  const Index a = t[first], b = t[(first + 1) % 3], c = t[(first + 2) % 3];
  const Index ab = middle[first], bc = middle[(first + 1) % 3], ca = middle[(first + 2) % 3];
  if (marked == 1) out.insert(out.end(), {Triangle{a, ab, c}, Triangle{ab, b, c}});
  if (marked == 2) out.insert(out.end(), {Triangle{ab, b, bc}, Triangle{a, ab, bc}, Triangle{a, bc, c}});
  if (marked == 3)
    out.insert(out.end(),
               {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}});
}

/// Where parts of the surface touch, or as good as, each has a vertex of its own: no way at all from one to
/// the other.
void linkTouching(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                  const std::vector<Index>& patchOf, std::vector<std::pair<Index, Index>>& links) {
  std::vector<std::pair<std::array<double, 3>, Index>> places;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const Index v : triangles[t]) {
      const Vec3& p = positions[at(v)];
      places.push_back({{p.x(), p.y(), p.z()}, patchOf[t]});
    }
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
    if (const Index a = places[i].second, b = places[i + 1].second;
        places[i].first == places[i + 1].first && a != b)
      links.insert(links.end(), {{a, b}, {b, a}});
  std::vector<Index> patchAt(positions.size(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const Index v : triangles[t]) patchAt[at(v)] = patchOf[t];
  for (const auto& [v, w] : nearPairs(positions, kTouching))
    if (const Index a = patchAt[at(v)], b = patchAt[at(w)];
        a >= 0 && b >= 0 && a != b && positions[at(v)] != positions[at(w)])
      links.insert(links.end(), {{a, b}, {b, a}});
}

}  // namespace

RefinedSurface refineLongEdges(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                               double longest) {
  RefinedSurface out{{positions.begin(), positions.end()}, {triangles.begin(), triangles.end()}};
  for (bool split = true; split;) {
    split = false;
    std::unordered_map<EdgeKey, Index> middles;
    std::vector<Triangle> next;
    next.reserve(out.triangles.size());
    for (const Triangle& t : out.triangles) {
      std::array<Index, 3> middle{-1, -1, -1};
      for (std::size_t c = 0; c < 3; ++c) {
        const Index a = t[c], b = t[(c + 1) % 3];
        const Vec3 p = out.positions[at(a)], q = out.positions[at(b)];
        if ((p - q).squaredNorm() <= longest * longest) continue;
        const auto [found, isNew] =
            middles.try_emplace(edgeKey(a, b), static_cast<Index>(out.positions.size()));
        if (isNew) out.positions.push_back(0.5 * (p + q));
        middle[c] = found->second;
        split = true;
      }
      splitTriangle(t, middle, next);
    }
    out.triangles = std::move(next);
  }
  return out;
}

SurfacePatches::SurfacePatches(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                               double size, bool touching) {
  using Cell = std::array<int, 3>;
  std::vector<Vec3> centroid(triangles.size());
  std::vector<Cell> cell(triangles.size());
  std::vector<std::pair<EdgeKey, Index>> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& v = triangles[t];
    centroid[t] = (positions[at(v[0])] + positions[at(v[1])] + positions[at(v[2])]) / 3;
    for (std::size_t i = 0; i < 3; ++i)
      cell[t][i] = static_cast<int>(std::floor(centroid[t][static_cast<Eigen::Index>(i)] / size));
    for (std::size_t c = 0; c < 3; ++c)
      sides.emplace_back(edgeKey(v[c], v[(c + 1) % 3]), static_cast<Index>(t));
  }
  std::sort(sides.begin(), sides.end());
  std::vector<std::pair<Index, Index>> neighbours;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i)
    if (sides[i].first == sides[i + 1].first) neighbours.emplace_back(sides[i].second, sides[i + 1].second);

  std::vector<Index> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index t) {
    while (parent[at(t)] != t) t = parent[at(t)] = parent[at(parent[at(t)])];
    return t;
  };
  for (const auto& [s, t] : neighbours)
    if (cell[at(s)] == cell[at(t)]) {
      const Index a = root(s), b = root(t);
      parent[at(std::max(a, b))] = std::min(a, b);
    }

  patchOf_.assign(triangles.size(), -1);
  std::vector<double> count;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Index r = root(static_cast<Index>(t));
    if (at(r) == t) {
      patchOf_[t] = static_cast<Index>(centre_.size());
      centre_.push_back(Vec3::Zero());
      count.push_back(0);
    }
    patchOf_[t] = patchOf_[at(r)];
    centre_[at(patchOf_[t])] += centroid[t];
    count[at(patchOf_[t])] += 1;
  }
  for (std::size_t p = 0; p < centre_.size(); ++p) centre_[p] /= count[p];

  std::vector<std::pair<Index, Index>> links;
  for (const auto& [s, t] : neighbours) {
    const Index a = patchOf_[at(s)], b = patchOf_[at(t)];
    if (a != b) links.insert(links.end(), {{a, b}, {b, a}});
  }
  if (touching) linkTouching(positions, triangles, patchOf_, links);
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  links_.resize(centre_.size());
  for (const auto& [a, b] : links) links_[at(a)].push_back({b, (centre_[at(a)] - centre_[at(b)]).norm()});
}

SurfacePatches::Distances SurfacePatches::distancesFrom(Index patch, double farthest) const {
  Distances distances;
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue;
  queue.emplace(0.0, patch);
  while (!queue.empty()) {
    const auto [distance, p] = queue.top();
    queue.pop();
    if (!distances.try_emplace(p, distance).second) continue;
    for (const Link& link : links_[at(p)])
      if (distance + link.length <= farthest && !distances.contains(link.patch))
        queue.emplace(distance + link.length, link.patch);
  }
  return distances;
}

double SurfacePatches::distance(Index s, Index t, double farthest) {
  const Index a = patchOf_[at(s)], b = patchOf_[at(t)];
  auto found = found_.find(a);
  if (found == found_.end()) found = found_.emplace(a, distancesFrom(a, farthest)).first;
  const auto way = found->second.find(b);
  return way == found->second.end() ? std::numeric_limits<double>::infinity() : way->second;
}

}  // namespace sherd
