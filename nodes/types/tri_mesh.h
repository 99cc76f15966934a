// A triangle surface with the artist's attributes, kept per corner so that seams need no doubled vertices.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/vec.h"

namespace sherd {

struct SurfaceLooks;  // types/surface_looks.h

/// How a file's coordinates relate to the program's (metres, y up, right-handed):
/// metres = metresPerUnit · turn(file), where turn is the identity for y up and (x, y, z) → (x, z, −y) for z
/// up.
struct FileFrame {
  enum class Up { Y, Z };
  double metresPerUnit = 1;
  Up up = Up::Y;

  Vec3 toMetres(const Vec3& file) const {
    return metresPerUnit * (up == Up::Y ? file : Vec3(file.x(), file.z(), -file.y()));
  }
  Vec3 toFile(const Vec3& metres) const { return directionToFile(metres) / metresPerUnit; }
  Vec3 directionToMetres(const Vec3& d) const { return up == Up::Y ? d : Vec3(d.x(), d.z(), -d.y()); }
  Vec3 directionToFile(const Vec3& d) const { return up == Up::Y ? d : Vec3(d.x(), -d.z(), d.y()); }
};

/// Corner c of triangle t is entry 3 t + c of every per-corner array.
struct TriMesh {
  static constexpr const char* typeName = "Mesh";
  static constexpr int archiveVersion = 3;

  struct UvSet {
    std::string name;
    std::vector<Vec2> uv;  ///< per corner
  };
  struct ColorSet {
    std::string name;
    std::vector<Vec4> rgba;  ///< per corner, linear as in the file
  };

  std::vector<Vec3> positions;      ///< m; identical positions are one vertex
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside
  std::vector<Vec3> normals;        ///< empty, or unit vectors per corner
  std::vector<UvSet> uvSets;
  std::vector<ColorSet> colorSets;
  std::vector<std::string> materials;  ///< names as in the file; may be empty
  std::vector<Index> materialOf;       ///< per triangle, index into materials; empty if there are none
  FileFrame frame;                     ///< of the file that it came from
  std::string source;                  ///< that file's name, for messages
  std::string piece;  ///< "piece_0003": the piece of an earlier fracture that this is; empty for a whole body
  /// What `materials` look like, along these; null where the file says no more than names.
  std::shared_ptr<const SurfaceLooks> looks;

  std::size_t cornerCount() const { return 3 * triangles.size(); }
};

void hashValue(Hasher& hasher, const TriMesh& mesh);
std::size_t byteSize(const TriMesh& mesh);
/// Loading refuses indices out of range and arrays whose lengths don't belong together, here and in all
/// types.
void saveValue(ArchiveWriter& to, const TriMesh& mesh);
std::optional<TriMesh> loadValue(ArchiveReader& from, std::type_identity<TriMesh>);

}  // namespace sherd
