// Surface triangles split by the sheets, and sheets clipped to the inside of the surface.
#pragma once

#include <array>
#include <vector>

#include "base/exec.h"
#include "tessellate/arrangement.h"
#include "types/fragments.h"

namespace sherd {

/// Part of a surface triangle, in one cell.
struct SkinTriangle {
  Triangle corners;  ///< into Arrangement::positions
  Index source;      ///< the surface triangle
  Index cell;
  bool cut;  ///< not the whole source triangle
};

/// Part of a sheet inside of the surface.
struct SheetTriangle {
  Triangle corners;
  Index front, back;  ///< cells
};

struct ClippedMeshes {
  std::vector<SkinTriangle> skin;    ///< by source
  std::vector<SheetTriangle> sheet;  ///< by crack triangle
  std::size_t cutSurfaceTriangles = 0;
  std::size_t forced = 0;  ///< triangles that rounding left flat or overlapping
};

/// Traces the regions that the segments cut a triangle into and triangulates them. A region is followed from
/// half-edge to half-edge by its cell alone, so the result closes whatever the rounded coordinates are.
/// Untouched triangles are passed through. Cost O(surface + Σ n²) for n segments in a cut triangle.
ClippedMeshes clip(const Arrangement& arrangement, const CrackComplex& complex, const Exec& exec);

/// Barycentric coordinates of `point` in the triangle with corners a, b, c, from areas seen along its normal.
CornerWeights barycentric(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

}  // namespace sherd
