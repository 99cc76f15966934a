#include "tetrahedralize/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/disjoint_sets.h"

namespace sherd {
namespace {

using Cell = std::array<std::int64_t, 3>;

/// Cells that points within `distance` of p may be in: few have more than one.
template <class Visit>
void visitCells(const Vec3& p, double distance, double side, Visit&& visit) {
  Cell low, high;
  for (Eigen::Index k = 0; k < 3; ++k) {
    low[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor((p[k] - distance) / side));
    high[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor((p[k] + distance) / side));
  }
  for (std::int64_t x = low[0]; x <= high[0]; ++x)
    for (std::int64_t y = low[1]; y <= high[1]; ++y)
      for (std::int64_t z = low[2]; z <= high[2]; ++z) visit(Cell{x, y, z});
}

}  // namespace

std::vector<std::pair<Index, Index>> nearPairs(std::span<const Vec3> points, double distance) {
  // Each point goes into all cells that it is near to, so that a pair has one in common.
  std::vector<std::pair<Cell, Index>> placed;
  placed.reserve(points.size() + points.size() / 4);
  for (std::size_t v = 0; v < points.size(); ++v)
    visitCells(points[v], distance, 16 * distance,
               [&](const Cell& cell) { placed.emplace_back(cell, static_cast<Index>(v)); });
  std::sort(placed.begin(), placed.end());
  std::vector<std::pair<Index, Index>> pairs;
  for (std::size_t begin = 0, end = 0; begin < placed.size(); begin = end) {
    while (end < placed.size() && placed[end].first == placed[begin].first) ++end;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = i + 1; j < end; ++j)
        if (const Index a = placed[i].second, b = placed[j].second;
            (points[at(a)] - points[at(b)]).squaredNorm() <= distance * distance)
          pairs.emplace_back(a, b);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::size_t countContacts(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                          double distance) {
  const auto pairs = nearPairs(positions, distance);
  if (pairs.empty()) return 0;
  DisjointSets sets(positions.size());
  for (const Triangle& t : triangles)
    for (std::size_t c = 0; c < 3; ++c)
      if (const Index a = t[c], b = t[(c + 1) % 3];
          (positions[at(a)] - positions[at(b)]).squaredNorm() <= distance * distance)
        sets.join(at(a), at(b));
  std::size_t contacts = 0;
  for (const auto& [a, b] : pairs) {
    if (sets.find(at(a)) == sets.find(at(b))) continue;
    sets.join(at(a), at(b));
    ++contacts;
  }
  return contacts;
}

}  // namespace sherd
