#include "load_mesh/load_mesh.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <utility>

#include "geometry/inspect_surface.h"
#include "geometry/weld.h"
#include "load_mesh/file_looks.h"
#include "load_mesh/file_mesh.h"
#include "repair/repair.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

std::string counted(std::size_t n, const std::string& one, const std::string& several) {
  return std::to_string(n) + " " + (n == 1 ? one : several);
}

std::string extensionOf(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// That there is a file with something in it, so that what readers say is about its content.
Result<void> checkFile(const std::string& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    return failure(file + ": no such file", "check the path", "file");
  if (error) return failure(file + ": " + error.message(), "check the path and its permissions", "file");
  if (fs::is_directory(status)) return failure(file + " is a folder", "name the mesh file in it", "file");
  if (!fs::is_regular_file(status)) return failure(file + " is no regular file", "name a mesh file", "file");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    return failure(file + " can't be opened: " + std::strerror(errno), "check its permissions", "file");
  if (stream.peek() == std::ifstream::traits_type::eof())
    return failure(file + " is empty", "export the mesh again", "file");
  return {};
}

Result<std::string> readContent(const std::string& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  std::string content;
  if (!error) content.resize(size);
  if (error || !stream.read(content.data(), static_cast<std::streamsize>(content.size())))
    return failure(file + " can't be read", "check the disk and the file's permissions", "file");
  return content;
}

Result<FileMesh> readAny(const std::string& file, const Exec& exec) {
  const std::string extension = extensionOf(file);
  const auto reader = extension == ".obj"   ? readObj
                      : extension == ".ply" ? readPly
                      : extension == ".stl" ? readStl
                      : extension == ".off" ? readOff
                                            : nullptr;
  if (reader == nullptr) return readWithAssimp(file, exec);
  SHERD_ASSIGN(const std::string content, readContent(file));
  SHERD_ASSIGN(FileMesh mesh, reader(content, exec));
  if (!mesh.materialLibraries.empty()) readMaterialLibraries(mesh, file, exec);
  return mesh;
}

/// Reads, and puts the file's name before what the reader complains of.
Result<FileMesh> readFile(const std::string& file, const Exec& exec) {
  SHERD_CHECK(checkFile(file));
  Result<FileMesh> mesh = readAny(file, exec);
  if (mesh.ok() || mesh.error().kind == Error::Kind::Cancelled) return mesh;
  Error error = mesh.error();
  if (error.what.find(file) == std::string::npos) error.what = file + ": " + error.what;
  if (error.port.empty()) error.port = "file";
  return error;
}

/// The frame that file, parameters and defaults make together; says what had to be assumed.
Result<FileFrame> frameOf(const FileMesh& file, const LoadMeshParams& params, const std::string& name,
                          const Exec& exec) {
  FileFrame frame;
  if (params.up != UpAxis::Auto) {
    frame.up = params.up == UpAxis::Y ? FileFrame::Up::Y : FileFrame::Up::Z;
  } else if (file.up) {
    frame.up = *file.up;
  } else {
    exec.info(name + ": its format doesn't say which axis points up; taking y (parameter `up`)");
  }
  if (params.length > 0) {
    const Box box = boxOf(file.mesh.positions);
    frame.metresPerUnit = params.length / (box.high - box.low).maxCoeff();
    if (!std::isfinite(frame.metresPerUnit) || frame.metresPerUnit <= 0)
      return failure(name + " can't be scaled to a length: the longest side of its bounding box is " +
                         std::to_string((box.high - box.low).maxCoeff()),
                     "leave `length` out and look at the file", "length");
    if (params.unit > 0) exec.warn(name + ": both `unit` and `length` are set; `length` decides");
  } else if (params.unit > 0) {
    frame.metresPerUnit = params.unit;
  } else if (file.metresPerUnit) {
    frame.metresPerUnit = *file.metresPerUnit;
  } else {
    exec.info(name +
              ": its format doesn't say how long a unit is; taking 1 m (parameter `unit` or `length`)");
  }
  return frame;
}

Result<void> checkAttributes(const TriMesh& mesh, const std::string& name) {
  const auto refuse = [&](const std::string& kind, const std::string& set, std::size_t corner) {
    return failure(
        name + ": " + kind + (set.empty() ? "" : " \"" + set + "\"") +
            " hold a value that is not finite, near " +
            placeInFile(mesh.frame.toFile(mesh.positions[at(mesh.triangles[corner / 3][corner % 3])])),
        "repair or remove that set", "file");
  };
  for (std::size_t k = 0; k < mesh.normals.size(); ++k)
    if (!mesh.normals[k].allFinite()) return refuse("normals", "", k);
  for (const auto& set : mesh.uvSets)
    for (std::size_t k = 0; k < set.uv.size(); ++k)
      if (!set.uv[k].allFinite()) return refuse("texture coordinates", set.name, k);
  for (const auto& set : mesh.colorSets)
    for (std::size_t k = 0; k < set.rgba.size(); ++k)
      if (!set.rgba[k].allFinite()) return refuse("colours", set.name, k);
  return {};
}

void sayWelded(const WeldCounts& counts, const std::string& name, const Exec& exec) {
  if (counts.joined > 0)
    exec.info(name + ": joined " + counted(counts.joined, "vertex", "vertices") +
              " of the same position as another");
  if (counts.collapsedTriangles > 0)
    exec.warn(name + ": left out " + counted(counts.collapsedTriangles, "triangle", "triangles") +
              " with two corners in one place");
  if (counts.unusedVertices > 0)
    exec.info(name + ": left out " + counted(counts.unusedVertices, "vertex", "vertices") +
              " that no face uses");
}

/// From file coordinates to the program's.
void toMetres(TriMesh& mesh) {
  for (Vec3& p : mesh.positions) p = mesh.frame.toMetres(p);
  for (Vec3& n : mesh.normals) n = mesh.frame.directionToMetres(n);
}

Result<TriMesh> load(const LoadMeshParams& params, const Exec& exec) {
  SHERD_ASSIGN(FileMesh file, readFile(params.file, exec));
  const std::string name = fs::path(params.file).filename().string();
  TriMesh& mesh = file.mesh;
  mesh.source = params.file;
  if (exec.cancelled()) return cancelledError();
  exec.progress(0.4);
  SurfaceReport report;
  report.empty = mesh.triangles.empty();
  report.nonFinite = nonFiniteVertices(mesh);
  if (auto error = refusal(report, params.file)) return *error;

  SHERD_ASSIGN(mesh.frame, frameOf(file, params, name, exec));
  toMetres(mesh);
  if (nonFiniteVertices(mesh))
    return failure(params.file + " is too large in metres: coordinates overflow",
                   "set a smaller `unit` or `length`", params.length > 0 ? "length" : "unit");
  sayWelded(weld(mesh), name, exec);
  SHERD_CHECK(checkAttributes(mesh, params.file));
  if (exec.cancelled()) return cancelledError();
  exec.progress(0.5);
  const bool isStrict = params.repair == RepairMode::Strict;
  const RepairParams how{.mode = isStrict ? RepairParams::Mode::Strict : RepairParams::Mode::Auto};
  Exec rest = exec;
  rest.onProgress = [&](double share) { exec.progress(0.5 + 0.5 * share); };
  SHERD_ASSIGN(Repaired repaired, repair(std::move(mesh), how, rest));
  exec.progress(1);
  return std::move(repaired.mesh);
}

}  // namespace

Result<TriMesh> loadMesh(const LoadMeshParams& params, const Exec& exec) {
  for (const auto& [value, parameter] : {std::pair(params.unit, "unit"), std::pair(params.length, "length")})
    if (!std::isfinite(value) || value < 0)
      return failure(std::string(parameter) + " is " + std::to_string(value),
                     "a length in metres, or 0 for none", parameter);
  try {
    return load(params, exec);
  } catch (const std::bad_alloc&) {
    return failure(params.file + ": not enough memory for this mesh", "use one of fewer triangles", "file");
  } catch (const std::exception& error) {  // CGAL, on a failed check of its own
    return failure(params.file + ": " + error.what(), "report this file to the developers", "file");
  }
}

}  // namespace sherd
