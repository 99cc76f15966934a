// What crack faces are drawn with: normals and texture coordinates, made from their shape alone.
#pragma once

#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/fragments.h"

namespace sherd {

/// Of one piece. Corner c of crack triangle t is entry 3 t + c.
struct CrackCorners {
  std::vector<Vec3> normals;  ///< unit, outward
  std::vector<Vec2> uvs;      ///< 1 is 1 m; v points up on steep faces, to −z on flat ones
  std::vector<Index> island;  ///< per triangle: the island of the texture plane that it lies on
};

struct CrackAttributes {
  std::vector<CrackCorners> pieces;  ///< as Fragments::pieces
  std::size_t islands = 0;
  Vec2 extent = Vec2::Zero();  ///< all UVs lie in [0, extent]
};

/// Normals. The sheets of two cells are smooth: at a vertex, the triangles around it of the same sheet and
/// between the same two pieces are averaged, weighted by their angles there. Between sheets, and towards the
/// skin, there is a crease. A corner whose mean would be tilted by more than 80° against its triangle keeps
/// the triangle's own normal. Twins have opposite normals, to the bit.
///
/// UVs. Each sheet is one island, or as many as it takes for none of its triangles to be tilted by more than
/// 25° against its island's plane (surface_charts.h), on which it is projected. So the length of anything
/// drawn on a triangle is right within a tenth (the singular values of the map lie in [0.906, 1]), a flat
/// sheet is laid out without any stretch, and vertices within an island share their UVs. Islands don't
/// overlap, so that textures can be baked, unless a sheet winds over itself. Twins have equal UVs, to the
/// bit; on one of them the texture is therefore mirrored.
///
/// Triangles so thin (10⁻¹⁰ of the largest coordinate) that their plane is mere rounding count for neither.
///
/// Deterministic for any number of threads. Fails where a crack triangle has no twin. Cost O(n log n).
Result<CrackAttributes> crackAttributes(const Fragments& fragments, const Exec& exec);

/// The normals alone, per piece.
Result<std::vector<std::vector<Vec3>>> crackNormals(const Fragments& fragments, const Exec& exec);

}  // namespace sherd
