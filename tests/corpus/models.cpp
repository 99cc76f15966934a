#include "corpus/models.h"

#include <algorithm>
#include <cstdlib>
#include <set>

namespace sherd::test {
namespace {

namespace fs = std::filesystem;

/// Files of known formats below a directory, by name.
void addFrom(const fs::path& directory, CorpusModels& models) {
  const std::set<std::string> formats{".obj", ".off", ".ply", ".stl"};
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(directory))
    if (formats.count(entry.path().extension().string())) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  models.files.insert(models.files.end(), found.begin(), found.end());
}

}  // namespace

CorpusModels assetModels() {
  CorpusModels models;
  addFrom(SHERD_SOURCE_DIR "/assets", models);
  return models;
}

CorpusModels allModels(const fs::path& scratch) {
  CorpusModels models;
  const fs::path real = SHERD_SOURCE_DIR "/../shared/meshes";
  if (fs::is_directory(real))
    addFrom(real, models);
  else
    models.absent.push_back("real models: " + real.string() + " is absent");
  const fs::path data = "/usr/share/doc/libcgal-demo/data.tar.gz";
  if (!fs::exists(data)) {
    models.absent.push_back("CGAL's models: " + data.string() + " is absent; install libcgal-demo");
    return models;
  }
  fs::create_directories(scratch);
  const std::string unpack = "tar -xzf '" + data.string() + "' -C '" + scratch.string() + "' data/meshes";
  if (std::system(unpack.c_str()) == 0)
    addFrom(scratch / "data/meshes", models);
  else
    models.absent.push_back("CGAL's models: '" + unpack + "' failed");
  return models;
}

}  // namespace sherd::test
