// Surface triangles split by the sheets, and sheets clipped to the inside of the surface.
#pragma once

#include <array>
#include <vector>

#include "base/exec.h"
#include "tessellate/arrangement.h"
#include "tessellate/parted_triangles.h"
#include "types/fragments.h"

namespace sherd {

/// Part of a cut surface triangle, in one cell.
struct SkinTriangle {
  Triangle corners;  ///< into Arrangement::positions
  Index source;      ///< the surface triangle
  Index cell;
};

/// Part of a sheet inside of the surface.
struct SheetTriangle {
  Triangle corners;
  Index front, back;  ///< cells
};

struct ClippedMeshes {
  PartedTriangles<SkinTriangle> skin;    ///< of the cut triangles only, by source
  PartedTriangles<SheetTriangle> sheet;  ///< by polygon
  std::size_t forced = 0;                ///< triangles that rounding left flat or overlapping
  std::size_t flat = 0;                  ///< triangles that are isFlat()
};

/// Is it no higher than two spots over its longest side?
bool isFlat(const Vec3& a, const Vec3& b, const Vec3& c, double spot);

/// Traces the regions that the segments cut a triangle or polygon into and triangulates them. A region is
/// followed from half-edge to half-edge by its cell alone, so the result closes whatever the rounded
/// coordinates are. Vertices on one spot are taken for one. A triangle that one segment cuts from side to
/// side (nearly all) is split at once. Cost O(Σ n²) for n segments in a cut triangle or polygon.
ClippedMeshes clip(const Arrangement& arrangement, const Sheets& sheets, const Exec& exec);

/// Barycentric coordinates of the point of side pq, of corners number p and q, that is closest to `point`.
CornerWeights onSide(const Vec3& from, const Vec3& to, Eigen::Index p, Eigen::Index q, const Vec3& point);

/// Barycentric coordinates, in [0, 1], of a point of the triangle with corners a, b, c: from areas seen along
/// its normal, or on a side where that comes closer to the point.
CornerWeights barycentric(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

}  // namespace sherd
