// The meshes that the corpus is made of.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sherd::test {

struct CorpusModels {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> absent;  ///< what could not be looked through, and why
};

/// The project's own models.
CorpusModels assetModels();

/// Real models in ../shared/meshes, and all meshes in the data of Debian's libcgal-demo, unpacked into
/// `scratch`.
CorpusModels allModels(const std::filesystem::path& scratch);

}  // namespace sherd::test
