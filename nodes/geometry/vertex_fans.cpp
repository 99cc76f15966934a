#include "geometry/vertex_fans.h"

#include <algorithm>

#include "geometry/disjoint_sets.h"

namespace sherd {

std::vector<int> countFans(std::span<const Triangle> triangles, std::size_t vertexCount,
                           const EdgeTable& edges) {
  DisjointSets fans(3 * triangles.size());
  const auto cornerAt = [&](Index t, Index v) {
    const Triangle& corners = triangles[at(t)];
    return 3 * at(t) +
           static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
  };
  for (std::size_t e = 0; e < edges.ends.size(); ++e) {
    const auto users = edges.trianglesOf(static_cast<Index>(e));
    for (const Index v : edges.ends[e])
      for (std::size_t k = 1; k < users.size(); ++k) fans.join(cornerAt(users[0], v), cornerAt(users[k], v));
  }
  std::vector<int> count(vertexCount, 0);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      if (fans.find(3 * t + c) == 3 * t + c) ++count[at(triangles[t][c])];
  return count;
}

}  // namespace sherd
