// Labels by flooding the cells from the sites' nearest nodes (Schvartzman and Otaduy 2014, Algorithm 2, lines
// 1–15).
#pragma once

#include <vector>

#include "base/exec.h"
#include "geometry/tet_edges.h"

namespace sherd {

/// Coordinates of nodes and sites, one after another, `dimensions` each.
struct FloodPoints {
  const double* nodes;
  const double* sites;
  std::size_t nodeCount, siteCount, dimensions;
};

/// Per node its label, or −1 where no flood arrived. First in, first out, sites in order, neighbours
/// ascending; a node takes another label only for a smaller distance, or an equal one and a lower site. Ends
/// early, with some labels missing, when cancelled.
std::vector<Index> floodLabels(const FloodPoints& points, const NodeGraph& graph, const Exec& exec);

}  // namespace sherd
