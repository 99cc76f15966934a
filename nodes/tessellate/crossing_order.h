// What both ways of arranging share: putting crossings in order along their edges, and spreading what is
// known.
#pragma once

#include <algorithm>
#include <numeric>

#include "geometry/disjoint_sets.h"
#include "tessellate/arrangement.h"

namespace sherd {

/// What lies on the two sides of a crossing, from the edge's lower end to its upper: cells for a sheet,
/// inside (0) and outside (1) for the surface.
using Across = std::array<Index, 2>;

inline Across cellsAcross(const Sheets& sheets, const Crossing& x) {
  const SheetPolygon& p = sheets.polygons[at(x.through)];
  return x.fromFront ? Across{p.front, p.back} : Across{p.back, p.front};
}
inline Across sidesAcross(const Crossing& x) { return x.fromFront ? Across{1, 0} : Across{0, 1}; }

/// Reorders crossings at the very same point so that each leaves the region where the next begins; false
/// where none of the orders tried does.
template <class Order, class AcrossOf>
bool chain(std::span<Crossing> run, Order isBefore, AcrossOf across) {
  const auto follows = [&](const Crossing& x, const Crossing& y) { return across(x)[1] == across(y)[0]; };
  for (std::size_t i = 0; i + 1 < run.size(); ++i) {
    // Among those tied for place i, the first that continues the chain.
    std::size_t end = i + 1;
    while (end < run.size() && !isBefore(run[i], run[end])) ++end;
    for (std::size_t j = i; j < end; ++j) {
      bool fits = i > 0 ? follows(run[i - 1], run[j]) : true;
      if (i == 0)  // a beginning is where no other tied crossing arrives
        for (std::size_t k = i; k < end; ++k) fits = fits && (k == j || !follows(run[k], run[j]));
      if (!fits) continue;
      std::swap(run[i], run[j]);
      break;
    }
  }
  for (std::size_t i = 0; i + 1 < run.size(); ++i)
    if (!follows(run[i], run[i + 1])) return false;
  return true;
}

/// Fills `begin` of crossings that are grouped by ascending edge.
inline void indexByEdge(EdgeCrossings& crossings, std::size_t edges) {
  crossings.begin.assign(edges + 1, 0);
  for (const Crossing& x : crossings.list) ++crossings.begin[at(x.edge) + 1];
  std::partial_sum(crossings.begin.begin(), crossings.begin.end(), crossings.begin.begin());
}

/// Orders each edge's crossings; isBefore(x, y) for two of one edge.
template <class Order, class AcrossOf>
bool orderAlongEdges(EdgeCrossings& crossings, Order isBefore, AcrossOf across) {
  bool consistent = true;
  for (std::size_t first = 0; first < crossings.list.size();) {
    std::size_t last = first + 1;
    while (last < crossings.list.size() && crossings.list[last].edge == crossings.list[first].edge) ++last;
    const std::span<Crossing> run = std::span(crossings.list).subspan(first, last - first);
    if (run.size() > 1) {
      std::stable_sort(run.begin(), run.end(), isBefore);
      consistent = chain(run, isBefore, across) && consistent;
    }
    first = last;
  }
  return consistent;
}

/// Spreads what is known at the ends of crossed edges over the uncrossed ones; −1 where nothing is known.
/// `ends(e)` gives an edge's vertices. False on a contradiction.
template <class Ends, class AcrossOf>
bool spreadOverEdges(std::size_t edges, Ends ends, const EdgeCrossings& crossings, AcrossOf across,
                     std::vector<Index>& known, DisjointSets& sets) {
  for (std::size_t e = 0; e < edges; ++e)
    if (crossings.begin[e] == crossings.begin[e + 1]) sets.join(at(ends(e)[0]), at(ends(e)[1]));
  std::vector<Index> ofRoot(known.size(), -1);
  bool consistent = true;
  const auto tell = [&](Index vertex, Index what) {
    Index& slot = ofRoot[sets.find(at(vertex))];
    if (slot >= 0 && slot != what) consistent = false;
    slot = what;
  };
  for (std::size_t e = 0; e < edges; ++e) {
    const auto on = crossings.on(static_cast<Index>(e));
    if (on.empty()) continue;
    tell(ends(e)[0], across(on.front())[0]);
    tell(ends(e)[1], across(on.back())[1]);
  }
  for (std::size_t v = 0; v < known.size(); ++v) known[v] = ofRoot[sets.find(v)];
  return consistent;
}

Error inconsistentCut(const char* what);

/// Inside or outside for every vertex of the sheets, from their crossings; parts that the surface does not
/// cross are outside where they reach the cage's boundary, and else tested.
Result<void> classifySheets(const TetMesh& tets, const Sheets& sheets, Arrangement& arrangement);

/// Fills byPolygon from segments.
void groupByPolygon(std::size_t polygons, Arrangement& arrangement);

/// Fills segmentBegin from segments and cutTriangles.
void groupBySurface(Arrangement& arrangement);

}  // namespace sherd
