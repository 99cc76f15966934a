// A moderate tetrahedral mesh (the cage) that strictly encloses a closed surface and has its topology, but
// for notches and holes smaller than its edges (5).
//
// Schvartzman and Otaduy 2014, section 3: statics, distances and cells are computed on a tetrahedral mesh of
// a few thousand elements; the fine surface is only cut at the end. The paper takes any mesh that surrounds
// the surface; this one is made as follows.
//
// 1. The surface is centred and scaled to a bounding box of diagonal 1, so that the result depends neither on
// the
//    unit of the file nor on where the object stands.
// 2. Gaps: rays along the outward normals find where the surface faces another part of itself. A gap counts
// when
//    the way round it, along the surface, is longer than an edge of the cage (a slit, a vase's cavity, the
//    space between two legs), or it separates two components. r(x), the offset, is a share of the edge
//    length, bounded by a share of the width of the gaps near x, and grows from them with a bounded slope.
// 3. The cage's boundary approximates {d(x) = r(x)} with d the signed distance (OpenVDB; exact distances
// where the
//    offset is too small for the voxels). CGAL Mesh_3 meshes the inside; facets and their distance from the
//    level set follow r(x). The edge length is adapted until the number of tetrahedra is the one asked for.
// 4. Verification with exact predicates, in the surface's own coordinates: no surface triangle meets the
// cage's
//    boundary, every shell lies inside; the boundary is a 2-manifold with the surface's components, shells
//    and Euler characteristics; the gaps are open. Where the surface comes through, boundary nodes are pushed
//    outward; where that does not do, the place is meshed more finely and all is done again.
//    Where all that gives no cage, everything is done once more with four times as many tetrahedra, unless it
//    was gaps that made edges short: where topology stays off by much, the end comes early.
//    Where Mesh_3 sees nothing to fill, since the body is thinner than its starting points are apart, edges
//    are made shorter until it does.
// 5. Where no cage has the surface's topology, one serves that has other handles or further voids, but
//    encloses the surface, has its components, and keeps open all gaps with a way round of more than an edge:
//    it bridges notches and holes that are smaller than its edges, wholly or in part. A warning says so.
//
// Parts of the surface may touch in a point or along an edge, each with vertices of its own there (as
// SelectPiece makes them, or 1e-6 of the diagonal apart, as Repair does): the cage joins them, so there its
// topology may be that of the joined parts (contacts.h).
#pragma once

#include <memory>

#include "base/exec.h"
#include "base/result.h"
#include "types/tet_mesh.h"
#include "types/tri_mesh.h"

namespace sherd {

struct TetrahedralizeParams {
  int tets = 5000;        ///< number of tetrahedra aimed at; gaps and thin parts may need more
  double edgeLength = 0;  ///< m, mean edge length aimed at instead; 0: from the number of tetrahedra
};

/// The cage of `surface` (shared into the result).
///
/// surface: closed, manifold (every edge in two oppositely oriented triangles), outward oriented, without
/// self-intersections; may have several components and voids. Positions in metres, any size and place.
///
/// All fields of the result are filled. Nodes are ordered along a space-filling curve. The sum of
/// insideFraction · volume equals the surface's volume up to rounding (quality.volumeError).
///
/// Errors: more than 5 million tetrahedra asked for; edges that no tetrahedron of the body has room for; an
/// empty, open, non-manifold or inside-out surface or one with NaN; a gap that cannot be kept open, with its
/// place (in the file's coordinates), its width (m) and the edge length (m) that would keep it open, at once
/// where bodies are too near for any cage; a surface that could not be enclosed, with the place.
/// Deterministic: the same input gives the same bits for any number of threads. Cost: a few Mesh_3 runs of
/// O(tets) each (about a second for 5,000), plus O(triangles log triangles).
Result<TetMesh> tetrahedralize(std::shared_ptr<const TriMesh> surface, const TetrahedralizeParams& params,
                               const Exec& exec);

}  // namespace sherd
