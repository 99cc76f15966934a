// The moderate tetrahedral mesh (the cage) that encloses a surface and carries statics, distances and cells.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/tri_mesh.h"
#include "types/triangle_patches.h"
#include "types/vec.h"

namespace sherd {

struct TetQuality {
  double minDihedral = 0, maxDihedral = 0;  ///< degrees
  double cageVolume = 0;                    ///< m³, sum over tetrahedra
  double surfaceVolume = 0;                 ///< m³, enclosed by the surface
  double volumeError = 0;                   ///< |Σ insideFraction·volume − surfaceVolume| / surfaceVolume
};

struct TetMesh {
  static constexpr const char* typeName = "TetMesh";
  static constexpr int archiveVersion = 3;

  std::shared_ptr<const TriMesh> surface;  ///< lies strictly inside the union of the tetrahedra
  std::vector<Vec3> nodes;                 ///< m; every node belongs to a tetrahedron
  std::vector<Tetra> tets;                 ///< positively oriented: det[b−a, c−a, d−a] > 0
  std::vector<Tetra> neighbours;   ///< per tetrahedron: across face i (kTetraFace), −1 on the boundary
  std::vector<Triangle> boundary;  ///< faces with no neighbour, counter-clockwise from outside

  /// Surface triangles that touch tetrahedron t: held[heldBegin[t]] … held[heldBegin[t + 1] − 1], ascending.
  /// Never misses one; may hold one that comes within rounding of the tetrahedron.
  std::vector<Index> heldBegin, held;
  /// Per surface vertex the tetrahedron that it lies in, and per surface triangle the next one around the
  /// edge of corners (i, i + 1): geometry/surface_links.h fills both, and the patches.
  std::vector<Index> vertexTet;
  std::vector<Triangle> surfaceNeighbours;
  TrianglePatches patches;
  std::vector<double> insideFraction;  ///< per tetrahedron, share of its volume inside the surface, in [0, 1]
  TetQuality quality;
};

void hashValue(Hasher& hasher, const TetMesh& mesh);
std::size_t byteSize(const TetMesh& mesh);
void saveValue(ArchiveWriter& to, const TetMesh& mesh);
std::optional<TetMesh> loadValue(ArchiveReader& from, std::type_identity<TetMesh>);

/// Volume of tetrahedron t, m³.
double tetVolume(const TetMesh& mesh, std::size_t t);
/// V_n of design section 4: a quarter of the inside volume of each incident tetrahedron, per node, m³.
std::vector<double> lumpedVolumes(const TetMesh& mesh);
/// Fills neighbours and boundary from tets. Cost O(tets).
void connectTets(TetMesh& mesh);

}  // namespace sherd
