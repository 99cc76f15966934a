// Tells whether a surface bounds a solid, and if not, why and where.
#pragma once

#include <optional>
#include <string>

#include "base/exec.h"
#include "base/result.h"
#include "types/tri_mesh.h"

namespace sherd {

/// How often something is wrong, and where it is first.
struct Defect {
  std::size_t count = 0;
  Vec3 place = Vec3::Zero();  ///< in the file's coordinates; of the first one
  bool more = false;          ///< there are at least `count`
  Index vertex = -1;          ///< of vertices: the first one's number, from 0

  explicit operator bool() const { return count > 0; }
};

struct SurfaceReport {
  bool empty = false;  ///< no triangles
  Defect nonFinite;    ///< vertices with NaN or infinity; where there are any, nothing else is looked for
  Defect openEdges;    ///< edges of one triangle
  Defect nonManifoldEdges;     ///< edges of three triangles and more
  Defect nonManifoldVertices;  ///< vertices in which several fans of triangles meet
  Defect incoherentEdges;      ///< edges whose two triangles face opposite sides
  Defect nonOrientable;        ///< one-sided parts, such as a Möbius strip
  Defect duplicateTriangles;   ///< triangles with the same three corners as an earlier one
  Defect zeroArea;             ///< triangles with their corners on one line
  Defect selfIntersections;    ///< pairs of triangles that meet elsewhere than at a shared corner or edge
  Defect crossingParts;        ///< pairs of edge-connected parts that meet each other
  Defect noVolume;             ///< closed parts that enclose less than rounding can tell from nothing
  Defect inverted;  ///< closed parts that face the wrong side; those that meet others aren't judged

  bool sound() const;
};

/// Vertices with NaN or infinity, placed in the coordinates of mesh.frame.
Defect nonFiniteVertices(const TriMesh& mesh);

/// Looks for everything that keeps a surface from bounding a solid. `mesh` is welded; its frame is that of
/// the file. Topology is exact, and so are zero area and self-intersection on the mesh's doubles; a part has
/// no volume where |volume| ≤ 1e-12 · area · diagonal of it. When exec is cancelled the report means nothing.
/// Cost O(n log n) on usual surfaces.
SurfaceReport inspectSurface(const TriMesh& mesh, const Exec& exec = {});

/// One error that names the file and lists each defect with its count and first place, and what to do about
/// it; none for a sound surface.
std::optional<Error> refusal(const SurfaceReport& report, const std::string& file);

/// "(x, y, z)", with enough digits to find the place.
std::string placeInFile(const Vec3& place);

}  // namespace sherd
