// What the readers hand to LoadMesh: a mesh as the file has it, before welding, units and axes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/tri_mesh.h"

namespace sherd {

struct FileMesh {
  /// Positions in the file's coordinates, one per vertex of the file; triangles by those; attributes per
  /// corner. Polygons come triangulated. `frame` and `source` are not set yet.
  TriMesh mesh;
  std::vector<std::string> materialLibraries;  ///< what follows `mtllib` in each of an OBJ file's lines
  std::optional<double> metresPerUnit;         ///< where the format says so
  std::optional<FileFrame::Up> up;             ///< where the format says so
};

// One reader per format that is read in full double precision. `content` is the whole file. Errors name the
// line (text formats) or the byte (binary ones), what is wrong, and what would be right. No input crashes
// them, and none makes them allocate more than a small multiple of the file's size. They end when cancelled.
Result<FileMesh> readObj(std::string_view content, const Exec& exec = {});
Result<FileMesh> readPly(std::string_view content, const Exec& exec = {});
Result<FileMesh> readStl(std::string_view content, const Exec& exec = {});
Result<FileMesh> readOff(std::string_view content, const Exec& exec = {});

/// glTF, GLB, FBX and whatever else assimp knows, through assimp (single precision), with node transforms
/// applied, and with the looks of its materials (load_mesh/file_looks.h).
Result<FileMesh> readWithAssimp(const std::string& path, const Exec& exec = {});

}  // namespace sherd
