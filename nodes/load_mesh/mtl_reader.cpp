// Wavefront MTL, with the statements for metallic-roughness (Pr, Pm, norm) that modelling programs have
// added.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "load_mesh/file_looks.h"
#include "load_mesh/text_scanner.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

constexpr double kPlainRoughness = 0.9;

std::string lower(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool namesPicture(const std::string& key) {
  static const std::set<std::string> kMaps = {"norm", "bump", "disp", "decal", "refl"};
  return key.starts_with("map_") || kMaps.contains(key);
}

/// How many values an option of a map has: at least, at most (more only where they are numbers).
std::pair<int, int> valuesOf(const std::string& option) {
  if (option == "-o" || option == "-s" || option == "-t") return {1, 3};
  if (option == "-mm") return {2, 2};
  static const std::set<std::string> kOne = {"-blendu", "-blendv",  "-bm",     "-boost", "-cc",
                                             "-clamp",  "-imfchan", "-texres", "-type"};
  return kOne.contains(option) ? std::pair(1, 1) : std::pair(0, 0);
}

/// What stands behind a map's keyword.
struct MapArguments {
  std::string options;  ///< as written
  std::string file;     ///< may hold blanks
  bool clamped = false, moved = false;

  explicit MapArguments(std::string_view rest) {
    std::size_t from = 0;
    const auto next = [&] {
      from = std::min(rest.find_first_not_of(" \t", from), rest.size());
      const std::size_t end = std::min(rest.find_first_of(" \t", from), rest.size());
      return rest.substr(from, end - from);
    };
    for (std::string_view word = next(); word.starts_with('-'); word = next()) {
      const std::string option = lower(word);
      const auto [least, most] = valuesOf(option);
      if (most == 0) break;  // a name that begins so
      from += word.size();
      moved = moved || option == "-o" || option == "-s";
      for (int i = 0; i < most; ++i) {
        const std::string_view value = next();
        double number = 0;
        if (value.empty() || (i >= least && !parseNumber(value, number))) break;
        clamped = clamped || (option == "-clamp" && lower(value) == "on");
        from += value.size();
      }
    }
    next();
    options = std::string(rest.substr(0, from));
    while (!options.empty() && (options.back() == ' ' || options.back() == '\t')) options.pop_back();
    file = std::string(rest.substr(from));
  }
};

/// The numbers of one material, as far as they were said.
struct MtlNumbers {
  std::optional<double> dissolve, transparency, shininess, roughness;
  Index opacityImage = -1;
};

class MtlReader {
 public:
  MtlReader(std::string_view content, std::string name, const std::vector<std::string>& wanted,
            LooksBuilder& looks, std::set<std::string>& found)
      : scan_(withoutByteOrderMark(content), TextScanner::Comments | TextScanner::Joins),
        name_(std::move(name)),
        wanted_(wanted),
        looks_(looks),
        found_(found) {}

  void read() {
    for (; !scan_.atEnd() && !looks_.exec().cancelled(); scan_.nextLine()) {
      const std::string_view keyword = scan_.word();
      if (keyword.empty()) continue;
      if (lower(keyword) == "newmtl") {
        finish();
        begin(std::string(scan_.rest()));
      } else if (isWanted_) {
        statement(std::string(keyword), scan_.rest());
      }
    }
    finish();
  }

 private:
  /// Of two materials of one name the first counts.
  void begin(std::string material) {
    material_ = std::move(material);
    isWanted_ = std::find(wanted_.begin(), wanted_.end(), material_) != wanted_.end() &&
                found_.insert(material_).second;
    look_ = {};
    look_.roughness = kPlainRoughness;
    look_.baseColour = {0.8, 0.8, 0.8, 1};
    said_ = {};
  }

  void finish() {
    if (!isWanted_) return;
    isWanted_ = false;
    if (said_.dissolve)
      look_.baseColour[3] = *said_.dissolve;
    else if (said_.transparency)
      look_.baseColour[3] = 1 - *said_.transparency;
    if (said_.roughness)
      look_.roughness = *said_.roughness;
    else if (said_.shininess)
      look_.roughness = 1 - std::sqrt(std::clamp(*said_.shininess, 0.0, 1000.0) / 1000);
    if (look_.colourTexture.image >= 0)
      for (std::size_t c = 0; c < 3; ++c) look_.baseColour[c] = 1;
    const bool glowsBlack = *std::max_element(look_.emissive.begin(), look_.emissive.end()) <= 0;
    if (look_.emissiveTexture.image >= 0 && glowsBlack) look_.emissive = {1, 1, 1};
    const bool cutOut = said_.opacityImage >= 0 && said_.opacityImage == look_.colourTexture.image;
    if (look_.baseColour[3] < 1 || cutOut) look_.alpha = Look::Alpha::Blend;
    for (std::size_t m = 0; m < wanted_.size(); ++m)
      if (wanted_[m] == material_) looks_.set(m, look_);
  }

  void statement(std::string keyword, std::string_view rest) {
    const std::string key = lower(keyword);
    if (namesPicture(key)) return map(key, std::move(keyword), MapArguments(rest));
    look_.mtl.push_back({std::move(keyword) + (rest.empty() ? "" : " " + std::string(rest)), -1});
    if (key == "kd") colour(rest, 1, &look_.baseColour[0]);
    if (key == "ke") colour(rest, std::numeric_limits<double>::max(), &look_.emissive[0]);
    if (key == "d") said_.dissolve = number(rest, 1);
    if (key == "tr") said_.transparency = number(rest, 1);
    if (key == "ns") said_.shininess = number(rest, 1000);
    if (key == "pr") said_.roughness = number(rest, 1);
    if (key == "pm") look_.metallic = number(rest, 1).value_or(0);
  }

  void map(const std::string& key, std::string keyword, const MapArguments& arguments) {
    const Index image = arguments.file.empty() ? -1 : looks_.imageFile(arguments.file, material_);
    if (image < 0) return;
    look_.mtl.push_back(
        {std::move(keyword) + (arguments.options.empty() ? "" : " " + arguments.options), image});
    if (key == "map_d") said_.opacityImage = image;
    Texture* texture = key == "map_kd"   ? &look_.colourTexture
                       : key == "map_ke" ? &look_.emissiveTexture
                       : key == "norm"   ? &look_.normalTexture
                                         : nullptr;
    if (texture == nullptr) return;
    texture->image = image;
    if (arguments.clamped) texture->wrapU = texture->wrapV = Texture::Wrap::Clamp;
    if (arguments.moved)
      looks_.warn("texture '" + arguments.file + "' of material '" + material_ +
                  "' is moved or scaled; GLB files hold it as it is");
  }

  std::optional<double> number(std::string_view rest, double most) {
    double value = 0;
    TextScanner words(rest);
    if (const auto word = words.word(); parseNumber(word, value) && std::isfinite(value))
      return std::clamp(value, 0.0, most);
    complain(rest);
    return std::nullopt;
  }

  /// One number stands for three; a spectral curve or xyz is kept for OBJ files alone.
  void colour(std::string_view rest, double most, double* rgb) {
    TextScanner words(rest);
    double values[3];
    int count = 0;
    for (auto word = words.word(); !word.empty() && count < 3; word = words.word(), ++count) {
      if (count == 0 && (word == "spectral" || word == "xyz")) return;
      if (!parseNumber(word, values[count]) || !std::isfinite(values[count])) return complain(rest);
    }
    if (count == 0) return complain(rest);
    for (int c = 0; c < 3; ++c) rgb[c] = std::clamp(values[std::min(c, count - 1)], 0.0, most);
  }

  void complain(std::string_view rest) {
    looks_.warn(name_ + ", line " + std::to_string(scan_.line()) + ": " + quoted(rest) +
                " are no numbers; passed over");
  }

  TextScanner scan_;
  std::string name_;
  const std::vector<std::string>& wanted_;
  LooksBuilder& looks_;
  std::set<std::string>& found_;
  std::string material_;
  bool isWanted_ = false;
  Look look_;
  MtlNumbers said_;
};

}  // namespace

std::string pictureOf(std::string_view keyword, std::string_view rest) {
  return namesPicture(lower(keyword)) ? MapArguments(rest).file : std::string();
}

std::vector<std::string> libraryNames(const fs::path& folder, const std::string& line) {
  if (line.find_first_of(" \t") == std::string::npos || !findBeside(folder, line).empty()) return {line};
  std::vector<std::string> names;
  TextScanner words(line);
  for (auto word = words.word(); !word.empty(); word = words.word()) names.emplace_back(word);
  return names;
}

void readMaterialLibraries(FileMesh& file, const std::string& path, const Exec& exec) {
  if (file.mesh.materials.empty()) return;
  LooksBuilder looks(path, exec);
  std::set<std::string> found;
  bool complete = true;
  for (const std::string& line : file.materialLibraries)
    for (const std::string& name : libraryNames(looks.folder(), line)) {
      const fs::path place = findBeside(looks.folder(), name);
      std::ifstream in(place, std::ios::binary);
      if (place.empty() || !in) {
        looks.warn("its material library '" + name +
                   "' can't be opened; of those materials only the names are known");
        complete = false;
        continue;
      }
      const std::string content(std::istreambuf_iterator<char>(in), {});
      MtlReader(content, name, file.mesh.materials, looks, found).read();
    }
  if (complete && !file.materialLibraries.empty())
    for (const std::string& material : file.mesh.materials)
      if (!material.empty() && !found.contains(material))
        looks.warn("material '" + material + "' is in none of its material libraries");
  file.mesh.looks = looks.take();
}

}  // namespace sherd
