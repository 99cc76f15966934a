// What a body breaks into: closed pieces over one pool of vertices, so that twins are equal by index.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/material.h"
#include "types/tet_mesh.h"
#include "types/tri_mesh.h"

namespace sherd {

/// A corner's barycentric coordinates in its source triangle.
using CornerWeights = Eigen::Vector3d;

/// One closed, connected solid. Its surface and crack triangles together have no open edge.
struct Piece {
  std::string name;                  ///< "piece_0001", unique, by descending volume then cell
  Index cell = -1;                   ///< the site that it came from
  std::vector<Triangle> surface;     ///< outer skin, vertices in Fragments::positions
  std::vector<Index> surfaceSource;  ///< per outer triangle: the source triangle that it is (part of)
  std::vector<Index> surfaceCut;  ///< per outer triangle: entry of Fragments::cutCorners, −1 for an uncut one
  std::vector<Triangle> crack;    ///< crack faces, counter-clockwise from outside this piece
  std::vector<Index> crackNeighbour;  ///< per crack triangle: the piece that holds its twin
  std::vector<Index> crackSheet;      ///< per crack triangle: its sheet, where two cells met as they were
                                      ///< cut, numbered from 0 over all pieces; the same for both twins
  double volume = 0;                  ///< m³
  Vec3 centreOfMass = Vec3::Zero();   ///< m
  Mat3 inertia = Mat3::Zero();        ///< kg·m², about the centre of mass, program axes
};

struct FractureCounts {
  std::size_t cutTets = 0;              ///< tetrahedra with more than one label
  std::size_t crackTriangles = 0;       ///< triangles of all sheets before clipping
  std::size_t cutSurfaceTriangles = 0;  ///< surface triangles that a sheet crosses
  std::size_t detachedParts = 0;        ///< parts of cells that became pieces of their own
  std::size_t mergedParts = 0;          ///< parts below the minimum volume that joined a neighbour
  std::size_t emptyCells = 0;           ///< sites that hold no volume inside the surface
  std::size_t forcedTriangles = 0;      ///< triangles that rounding left flat or overlapping
};

struct Fragments {
  static constexpr const char* typeName = "Pieces";
  static constexpr int archiveVersion = 2;
  std::shared_ptr<const TetMesh> tets;  ///< tets->surface is the source surface
  Material material;
  std::vector<Vec3> positions;                           ///< m; the first ones are the source's, in its order
  std::vector<std::array<CornerWeights, 3>> cutCorners;  ///< of the triangles made by cutting
  std::vector<Piece> pieces;                             ///< at least one
  std::size_t sites = 1;                                 ///< N
  double energy = 0,
         gamma = 0;  ///< J·m²: E_D and the threshold, which decided nothing where the degree was given
  bool degreeGiven = false;  ///< N was asked for, not found by γ
  FractureCounts counts;
};

/// A corner attribute of the source at one corner of piece triangle `t`: exact copy where uncut, else the
/// barycentric combination of the source triangle's three.
template <class V>
V cornerAttribute(const Fragments& f, const Piece& piece, std::size_t t, std::size_t corner,
                  const std::vector<V>& perCorner) {
  const std::size_t first = 3 * at(piece.surfaceSource[t]);
  const Index cut = piece.surfaceCut[t];
  if (cut < 0) return perCorner[first + corner];
  const CornerWeights& w = f.cutCorners[at(cut)][corner];
  return w[0] * perCorner[first] + w[1] * perCorner[first + 1] + w[2] * perCorner[first + 2];
}

void hashValue(Hasher& hasher, const Fragments& fragments);
std::size_t byteSize(const Fragments& fragments);
void saveValue(ArchiveWriter& to, const Fragments& fragments);
std::optional<Fragments> loadValue(ArchiveReader& from, std::type_identity<Fragments>);

}  // namespace sherd
