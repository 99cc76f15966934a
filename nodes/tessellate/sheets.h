// The sheets between the cells, tetrahedron by tetrahedron, before anything is clipped.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "types/vec.h"

namespace sherd {

/// A convex part of a sheet, in one tetrahedron.
struct SheetPolygon {
  Index first, count;  ///< its corners in Sheets::corners: counter-clockwise seen from the front
  Index front, back;   ///< the cells on its two sides; they differ
  Index tet;           ///< the tetrahedron that holds it
};

/// All sheets. Polygons meet only in shared vertices and edges, where the vertices are shared by number.
/// Around an edge the cells are all different, so that each cell appears there in one wedge.
struct Sheets {
  std::vector<Vec3> vertices;               ///< m, rounded
  std::vector<SheetPolygon> polygons;       ///< by tetrahedron
  std::vector<Index> corners;               ///< into vertices
  std::vector<Index> edgeOf;                ///< per corner: the edge from it to the polygon's next corner
  std::vector<std::array<Index, 2>> edges;  ///< ends, ends[0] < ends[1], ascending
  std::vector<Index> byEdgeBegin, byEdge;   ///< per edge: the corners where a polygon begins to run along it
  std::vector<unsigned char> onCage;  ///< per vertex: lies on the cage's boundary, outside of the surface
  std::vector<Tetra>
      simplexOf;            ///< per vertex: the nodes, ascending and padded with −1, between which it lies
  std::size_t cutTets = 0;  ///< tetrahedra with a polygon

  std::span<const Index> cornersOf(const SheetPolygon& p) const {
    return std::span(corners).subspan(at(p.first), at(p.count));
  }
  std::span<const Index> edgesOf(const SheetPolygon& p) const {
    return std::span(edgeOf).subspan(at(p.first), at(p.count));
  }
  std::span<const Index> cornersAlong(Index edge) const {
    return std::span(byEdge).subspan(at(byEdgeBegin[at(edge)]),
                                     at(byEdgeBegin[at(edge) + 1] - byEdgeBegin[at(edge)]));
  }
  /// Does the polygon run along its edge number `slot` from the lower end to the higher?
  bool forward(const SheetPolygon& p, Index slot) const {
    return corners[at(p.first + slot)] < corners[at(p.first + (slot + 1 == p.count ? 0 : slot + 1))];
  }
  /// Fills edgeOf, edges, byEdgeBegin and byEdge from the corners. Cost O(corners) for bounded vertex degree.
  void connect();
};

}  // namespace sherd
