// Does the cage enclose the surface? Exact predicates on the given doubles.
#pragma once

#include <span>
#include <vector>

#include "base/exec.h"
#include "tetrahedralize/shells.h"
#include "types/tet_mesh.h"

namespace sherd {

/// A boundary facet of the cage that the surface comes through.
struct Breach {
  Index facet;   ///< into TetMesh::boundary
  double depth;  ///< how far the surface lies beyond it, as far as seen; ≥ 0
  Vec3 place;    ///< a point of the surface there
};

/// Facets that a surface triangle meets (even in a point), and facets nearest to surface vertices outside, in
/// ascending order. Empty if and only if the whole surface lies strictly inside the cage. `cage` needs nodes,
/// tets and boundary. Cost O((triangles + facets) log facets). When cancelled, what is returned has no
/// meaning.
std::vector<Breach> findBreaches(const TetMesh& cage, std::span<const Vec3> positions,
                                 std::span<const Triangle> triangles, const std::vector<Shell>& shells,
                                 const Exec& exec);

/// Moves boundary nodes outward until the surface is enclosed or nothing more can be done. No tetrahedron
/// gets smaller than a share of what it was, and the boundary does not come to meet itself. Returns the
/// breaches left.
std::vector<Breach> pushOutward(TetMesh& cage, std::vector<Breach> breaches, std::span<const Vec3> positions,
                                std::span<const Triangle> triangles, const std::vector<Shell>& shells,
                                const Exec& exec);

}  // namespace sherd
