// Which files stand behind a mesh file, found without reading the mesh.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "load_mesh/file_looks.h"
#include "load_mesh/load_mesh.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

using Places = std::vector<std::string>;

std::string contentOf(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void add(Places& places, const fs::path& folder, const std::string& written) {
  for (const fs::path& place : placesOf(folder, written)) places.push_back(place.string());
}

/// Calls f(keyword, rest) for each line of a text.
template <class F>
void forEachLine(const std::string& text, F&& f) {
  constexpr const char* kBlank = " \t\r";
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\n\r", from), text.size());
    const std::string_view line(text.data() + from, end - from);
    from = end + 1;
    const std::size_t start = std::min(line.find_first_not_of(kBlank), line.size());
    // Nearly all lines are vertices and faces.
    if (start == line.size() || line[start] == 'v' || line[start] == 'f') continue;
    const std::size_t stop = std::min(line.find_first_of(kBlank, start), line.size());
    std::string_view rest = line.substr(stop);
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlank), rest.size()));
    while (!rest.empty() && (rest.back() == ' ' || rest.back() == '\t')) rest.remove_suffix(1);
    f(line.substr(start, stop - start), std::string(rest));
  }
}

Places withObj(const fs::path& file) {
  Places places;
  const fs::path folder = file.parent_path();
  forEachLine(contentOf(file), [&](std::string_view keyword, const std::string& rest) {
    if (keyword != "mtllib") return;
    add(places, folder, rest);
    for (const std::string& name : libraryNames(folder, rest)) {
      add(places, folder, name);
      forEachLine(contentOf(findBeside(folder, name)), [&](std::string_view key, const std::string& value) {
        add(places, folder, pictureOf(key, value));
      });
    }
  });
  return places;
}

/// The JSON of a glTF file, or of a GLB file's first chunk.
nlohmann::json sceneOf(const fs::path& file, bool isBinary) {
  std::string text;
  if (isBinary) {
    std::ifstream in(file, std::ios::binary);
    char head[20];
    std::uint32_t length = 0;
    std::error_code error;
    if (!in.read(head, sizeof head)) return {};
    std::memcpy(&length, head + 12, sizeof length);
    if (length > fs::file_size(file, error) || error) return {};
    text.resize(length);
    if (!in.read(text.data(), static_cast<std::streamsize>(length))) return {};
  } else {
    text = contentOf(file);
  }
  return nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
}

Places withGltf(const fs::path& file, bool isBinary) {
  Places places;
  const nlohmann::json scene = sceneOf(file, isBinary);
  if (!scene.is_object()) return places;
  for (const char* list : {"buffers", "images"}) {
    const auto items = scene.find(list);
    if (items == scene.end() || !items->is_array()) continue;
    for (const auto& item : *items) {
      if (!item.is_object() || !item.contains("uri") || !item["uri"].is_string()) continue;
      const auto uri = item["uri"].get<std::string>();
      if (!uri.starts_with("data:")) add(places, file.parent_path(), uri);
    }
  }
  return places;
}

}  // namespace

std::vector<std::string> filesReadWith(const std::string& meshFile) {
  const fs::path file(meshFile);
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  Places places;
  if (extension == ".obj") places = withObj(file);
  if (extension == ".gltf" || extension == ".glb") places = withGltf(file, extension == ".glb");
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace sherd
