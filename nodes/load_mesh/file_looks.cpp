#include "load_mesh/file_looks.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

namespace sherd {
namespace {

namespace fs = std::filesystem;

std::string withoutEscapes(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto digit = [&](std::size_t k) {
      return k < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[k]));
    };
    if (uri[i] == '%' && digit(i + 1) && digit(i + 2)) {
      text += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

bool isFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

}  // namespace

std::vector<fs::path> placesOf(const fs::path& folder, const std::string& written) {
  std::string plain = written;
  std::replace(plain.begin(), plain.end(), '\\', '/');
  std::vector<fs::path> places;
  for (const std::string& name :
       {written, plain, withoutEscapes(plain), fs::path(plain).filename().string()}) {
    if (name.empty() || name.find('\0') != std::string::npos) continue;
    const fs::path place = folder / name;
    if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
  }
  return places;
}

fs::path findBeside(const fs::path& folder, const std::string& written) {
  const auto places = placesOf(folder, written);
  const auto found = std::find_if(places.begin(), places.end(), isFile);
  return found == places.end() ? fs::path() : *found;
}

LooksBuilder::LooksBuilder(fs::path file, const Exec& exec)
    : file_(std::move(file)), folder_(file_.parent_path()), exec_(exec) {}

void LooksBuilder::warn(const std::string& what) const {
  exec_.warn(file_.filename().string() + ": " + what);
}

Index LooksBuilder::imageFile(const std::string& written, const std::string& material) {
  if (const auto known = known_.find(written); known != known_.end()) return known->second;
  const fs::path path = findBeside(folder_, written);
  std::ifstream in(path, std::ios::binary);
  std::string bytes;
  if (!path.empty() && in) bytes.assign(std::istreambuf_iterator<char>(in), {});
  if (path.empty() || !in) {
    warn("texture '" + written + "' of material '" + material +
         "' can't be opened; the pieces are written without it");
    return known_[written] = -1;
  }
  return keep(written, {path.filename().string(), std::move(bytes)}, material);
}

Index LooksBuilder::embedded(const std::string& key, std::string name, std::string bytes,
                             const std::string& material) {
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  std::replace(name.begin(), name.end(), '\\', '/');
  ImageFile image{fs::path(name).filename().string(), std::move(bytes)};
  if (image.name.empty()) image.name = "texture";
  const std::string ending = extensionOfMimeType(mimeTypeOf(image));
  if (fs::path(image.name).extension().empty()) image.name += ending;
  return keep(key, std::move(image), material);
}

Index LooksBuilder::keep(const std::string& key, ImageFile image, const std::string& material) {
  if (mimeTypeOf(image).empty()) {
    warn("texture '" + image.name + "' of material '" + material +
         "' is no picture (PNG, JPEG, …); the pieces are written without it");
    return known_[key] = -1;
  }
  // Two names may stand for one file.
  const auto same = std::find_if(looks_.images.begin(), looks_.images.end(), [&](const ImageFile& other) {
    return other.name == image.name && other.bytes == image.bytes;
  });
  const auto number = static_cast<Index>(same - looks_.images.begin());
  if (same == looks_.images.end()) looks_.images.push_back(std::move(image));
  return known_[key] = number;
}

void LooksBuilder::set(std::size_t material, Look look) {
  if (looks_.looks.size() <= material) looks_.looks.resize(material + 1);
  looks_.looks[material] = std::move(look);
}

std::shared_ptr<const SurfaceLooks> LooksBuilder::take() {
  if (looks_.looks.empty()) return nullptr;
  return std::make_shared<const SurfaceLooks>(std::move(looks_));
}

}  // namespace sherd
