// From the polygons of a file to triangles, the same for all formats.
#pragma once

#include <span>
#include <vector>

#include "types/tri_mesh.h"

namespace sherd {

/// Polygon p has the corners start[p] … start[p + 1] − 1 of `vertices`.
struct Polygons {
  std::vector<Index> vertices;
  std::vector<Index> start{0};

  std::size_t size() const { return start.size() - 1; }
  /// Ends the polygon whose corners were put to the end of `vertices`.
  void close() { start.push_back(static_cast<Index>(vertices.size())); }
};

struct PolygonTriangles {
  std::vector<Triangle> triangles;  ///< of vertices, turning as their polygon does
  std::vector<Index> cornerOf;      ///< per triangle corner: the entry of Polygons::vertices that it is
  std::vector<Index> polygonOf;     ///< per triangle
};

/// Splits polygons of at least three corners with valid indices into n − 2 triangles each.
PolygonTriangles triangulate(const Polygons& polygons, const std::vector<Vec3>& positions);

/// Splits one polygon into n − 2 triangles of corner numbers, appended to `triangles`. A polygon that is
/// strictly convex as seen along its Newell normal becomes the fan around its first corner, any other is cut
/// by ear clipping as seen along that normal (Meisters 1975). What can't be cut that way (no area, or its
/// sides cross) becomes a fan, whatever shape that has: the surface stays connected as in the file. O(n²) at
/// worst, O(n) for convex ones.
void splitPolygon(std::span<const Vec3> corners, std::vector<Triangle>& triangles);

/// A value per vertex, handed to every corner.
template <class T>
std::vector<T> perCorner(const std::vector<Triangle>& triangles, const std::vector<T>& perVertex) {
  std::vector<T> values;
  values.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (Index v : t) values.push_back(perVertex[at(v)]);
  }
  return values;
}

/// Makes the normals unit vectors. A corner that has none, told by a zero vector, gets its triangle's normal,
/// and where that has no area the vector (0, 0, 1).
void finishNormals(TriMesh& mesh);

}  // namespace sherd
