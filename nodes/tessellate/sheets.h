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
  /// Does the polygon run from ends[0] to ends[1] along its edge number `slot`?
  bool forward(const SheetPolygon& p, Index slot) const {
    const std::size_t c = at(p.first + slot);
    return edges[at(edgeOf[c])][0] == corners[c];
  }
  /// Fills edges and edgeOf from the corners. Cost O(corners) for bounded vertex degree.
  void connect();
};

}  // namespace sherd
