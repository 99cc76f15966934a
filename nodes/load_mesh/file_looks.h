// Looks of materials as files give them: pictures found and read, once each, whatever the format.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/exec.h"
#include "load_mesh/file_mesh.h"
#include "types/surface_looks.h"

struct aiScene;

namespace sherd {

/// Where a file that lies in `folder` may mean by a name: as it is written, with Windows' separators, with
/// what URIs encode, and last the bare name beside it. Each once.
std::vector<std::filesystem::path> placesOf(const std::filesystem::path& folder, const std::string& written);

/// The first of placesOf() that is a regular file; empty where none is.
std::filesystem::path findBeside(const std::filesystem::path& folder, const std::string& written);

/// Collects the looks of one mesh's materials. What can't be had is warned of by name and left out.
class LooksBuilder {
 public:
  /// `file`: the mesh file. Lives no longer than `exec`.
  LooksBuilder(std::filesystem::path file, const Exec& exec);

  /// The number of a picture that `material` names, −1 where it can't be had. Asked again it gives the same
  /// and says nothing more.
  Index imageFile(const std::string& written, const std::string& material);
  /// The number of a picture that stands in the mesh file itself, as `key`; of `name` folders are left out.
  Index embedded(const std::string& key, std::string name, std::string bytes, const std::string& material);

  void warn(const std::string& what) const;
  const std::filesystem::path& folder() const { return folder_; }
  const Exec& exec() const { return exec_; }
  void set(std::size_t material, Look look);
  /// Null where no material has a look.
  std::shared_ptr<const SurfaceLooks> take();

 private:
  Index keep(const std::string& key, ImageFile image, const std::string& material);

  std::filesystem::path file_, folder_;
  const Exec& exec_;
  std::map<std::string, Index> known_;
  SurfaceLooks looks_;
};

/// Reads the libraries that an OBJ file named (`mesh.materialLibraries`) and gives its materials their looks:
/// - base colour Kd (1 where map_Kd gives it, which is how modelling programs show it), opacity d or 1 − Tr;
/// - roughness Pr, or 1 − √(Ns / 1000), or 0.9; metallic Pm; emission Ke;
/// - textures map_Kd, map_Ke and norm. All other statements are kept for OBJ files alone.
void readMaterialLibraries(FileMesh& mesh, const std::string& file, const Exec& exec);

/// The names behind `mtllib` in one of its lines: one with blanks, or several.
std::vector<std::string> libraryNames(const std::filesystem::path& folder, const std::string& line);

/// The picture that a statement of a .mtl file names, as it is written; empty where it names none.
std::string pictureOf(std::string_view keyword, std::string_view rest);

/// The look of one of assimp's materials; nothing where it is no more than a name.
std::optional<Look> lookOf(const aiScene& scene, unsigned material, LooksBuilder& looks);

}  // namespace sherd
