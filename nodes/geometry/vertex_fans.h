// How many separate fans of triangles meet in each vertex.
#pragma once

#include <span>
#include <vector>

#include "geometry/edge_table.h"

namespace sherd {

/// Corners at a vertex belong to one fan where their triangles share an edge at it. Per vertex: 1 on a
/// manifold, 0 where no triangle uses it. `edges` is the triangles' table; corners of a triangle differ. Cost
/// O(triangles).
std::vector<int> countFans(std::span<const Triangle> triangles, std::size_t vertexCount,
                           const EdgeTable& edges);

}  // namespace sherd
