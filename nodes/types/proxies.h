// Convex stand-ins for the pieces, for rigid-body engines.
#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/tri_mesh.h"
#include "types/vec.h"

namespace sherd {

/// A closed convex surface: the hull of its positions.
struct ConvexHull {
  std::vector<Vec3> positions;      ///< m; all of them corners of the hull
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside; several may lie in one plane
  double volume = 0;                ///< m³; 0 where all positions lie in one plane
};

/// What stands for one piece.
struct PieceProxy {
  std::string name;  ///< the piece's
  std::vector<ConvexHull> hulls;
  double pieceVolume = 0;            ///< m³
  double volume = 0;                 ///< m³, of all hulls; they do not overlap each other
  double error = 0;                  ///< (volume − pieceVolume) / pieceVolume; 0 for a piece without volume
  double overlap = 0;                ///< m³ that lie in other pieces' hulls too
  double mass = 0;                   ///< kg, of the piece
  Vec3 centreOfMass = Vec3::Zero();  ///< m, of the piece
  Mat3 inertia = Mat3::Zero();       ///< kg·m², of the piece about its centre of mass, program axes
};

struct Proxies {
  static constexpr const char* typeName = "Proxies";
  static constexpr int archiveVersion = 1;
  std::vector<PieceProxy> pieces;  ///< in the order of the pieces
  FileFrame frame;                 ///< of the file that the body came from
};

void hashValue(Hasher& hasher, const Proxies& proxies);
std::size_t byteSize(const Proxies& proxies);
void saveValue(ArchiveWriter& to, const Proxies& proxies);
std::optional<Proxies> loadValue(ArchiveReader& from, std::type_identity<Proxies>);

}  // namespace sherd
