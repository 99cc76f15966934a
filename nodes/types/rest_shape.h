// The shape that distances are taken from, where that isn't the body as it is.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/tet_mesh.h"

namespace sherd {

/// Another place for every node of a body. It bends the metric in which cells are made, never the geometry.
struct RestShape {
  static constexpr const char* typeName = "RestShape";
  static constexpr int archiveVersion = 1;
  std::shared_ptr<const TetMesh> tets;  ///< the body as it is
  std::vector<Vec3> positions;          ///< m, per node; tetrahedra may be inside out
};

void hashValue(Hasher& hasher, const RestShape& rest);
std::size_t byteSize(const RestShape& rest);
void saveValue(ArchiveWriter& to, const RestShape& rest);
std::optional<RestShape> loadValue(ArchiveReader& from, std::type_identity<RestShape>);

/// Is it of this body: the same nodes and tetrahedra?
bool isOf(const RestShape& rest, const TetMesh& tets);

}  // namespace sherd
