// Materials beside OBJ files: pieces.mtl and the pictures that it names.
#pragma once

#include <string>
#include <vector>

#include "base/exec.h"
#include "types/tri_mesh.h"

namespace sherd {

inline constexpr const char* kMaterialLibrary = "pieces.mtl";

struct MaterialFile {
  std::string name;                     ///< in the directory of the pieces
  std::string own;                      ///< its bytes, where they are not
  const std::string* shared = nullptr;  ///< those of a picture of the mesh's

  const std::string& bytes() const { return shared != nullptr ? *shared : own; }
};

/// pieces.mtl first, then the pictures, "pieces_texture_01_brick.png" and so on; nothing where the mesh's
/// materials are no more than names. Every material of the mesh stands in it, and `outside` and `inside`.
/// What a .mtl file said is said again, word for word; what other formats said in MTL's words, as far as it
/// has some: a warning tells of textures that it has none for. The mesh has to outlive the result.
std::vector<MaterialFile> materialFiles(const TriMesh& source, const Exec& exec);

/// A name as OBJ and MTL can hold it: on one line, and not empty.
std::string objName(const std::string& name);

}  // namespace sherd
