#include "export/material_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "export/crack_faces.h"
#include "export/text_buffer.h"
#include "types/surface_looks.h"

namespace sherd {
namespace {

class LibraryWriter {
 public:
  LibraryWriter(const TriMesh& source, const Exec& exec) : source_(source), exec_(exec) {}

  std::vector<MaterialFile> run() {
    out_ << "# sherd: materials of the pieces\n";
    for (std::size_t m = 0; m < source_.materials.size(); ++m)
      add(source_.materials[m], lookOf(source_.looks.get(), static_cast<Index>(m)),
          isOldInside(source_, m) ? kInsideColour : kOutsideColour);
    add(kOutside, nullptr, kOutsideColour);
    add(kInside, nullptr, kInsideColour);
    std::vector<MaterialFile> files{{kMaterialLibrary, out_.take(), nullptr}};
    std::move(pictures_.begin(), pictures_.end(), std::back_inserter(files));
    return files;
  }

 private:
  void add(const std::string& material, const Look* look, const std::array<float, 3>& colour) {
    const std::string name = objName(material);
    if (!written_.insert(name).second) return;
    out_ << "\nnewmtl " << name << '\n';
    if (look == nullptr)
      plain(colour);
    else if (!look->mtl.empty())
      again(*look);
    else
      describe(*look, material);
  }

  void plain(const std::array<float, 3>& colour) {
    numbers("Kd", {short_(colour[0]), short_(colour[1]), short_(colour[2])});
    numbers("Pr", {kPlainRoughness});
    numbers("Pm", {0});
  }
  /// The decimal number that a float was written as.
  static double short_(float value) { return std::stod(fmt::format("{}", value)); }

  void again(const Look& look) {
    for (const MtlStatement& line : look.mtl) {
      out_ << line.text;
      if (line.image >= 0) out_ << ' ' << fileOf(line.image);
      out_ << '\n';
    }
  }

  void describe(const Look& look, const std::string& material) {
    numbers("Kd", {look.baseColour[0], look.baseColour[1], look.baseColour[2]});
    numbers("d", {look.baseColour[3]});
    numbers("Pr", {look.roughness});
    numbers("Pm", {look.metallic});
    if (look.emissive != std::array<double, 3>{})
      numbers("Ke", {look.emissive[0], look.emissive[1], look.emissive[2]});
    map("map_Kd", look.colourTexture);
    if (look.alpha != Look::Alpha::Opaque) map("map_d", look.colourTexture);
    map("map_Ke", look.emissiveTexture);
    map("norm", look.normalTexture);
    if (look.metallicRoughnessTexture.image >= 0 || look.occlusionTexture.image >= 0)
      exec_.warn(
          "material '" + material +
          "': OBJ's materials have no word for textures of metal, roughness and occlusion; they are left "
          "out (ExportPieces keeps them)");
    for (const Texture* t : {&look.colourTexture, &look.emissiveTexture, &look.normalTexture})
      if (t->image >= 0 && t->uvSet > 0)
        exec_.warn("material '" + material + "': OBJ holds the first UV set only, and its texture '" +
                   source_.looks->images[at(t->image)].name + "' is laid by another");
  }

  void map(const char* key, const Texture& texture) {
    if (texture.image < 0) return;
    out_ << key;
    if (texture.wrapU == Texture::Wrap::Clamp && texture.wrapV == Texture::Wrap::Clamp) out_ << " -clamp on";
    out_ << ' ' << fileOf(texture.image) << '\n';
  }

  void numbers(const char* key, std::initializer_list<double> values) {
    out_ << key;
    for (const double value : values) out_ << ' ' << value;
    out_ << '\n';
  }

  const std::string& fileOf(Index image) {
    std::string& name = names_[image];
    if (!name.empty()) return name;
    const ImageFile& picture = source_.looks->images[at(image)];
    // Names in a glTF file may be longer than a directory's.
    const std::size_t cut = picture.name.size() - std::min<std::size_t>(picture.name.size(), 100);
    name = fmt::format("pieces_texture_{:02}_{}", names_.size(), picture.name.substr(cut));
    for (char& c : name)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
    pictures_.push_back({name, {}, &picture.bytes});
    return name;
  }

  const TriMesh& source_;
  const Exec& exec_;
  TextBuffer out_;
  std::set<std::string> written_;
  std::map<Index, std::string> names_;
  std::vector<MaterialFile> pictures_;
};

}  // namespace

std::string objName(const std::string& name) {
  std::string clean = name;
  for (char& c : clean)
    if (static_cast<unsigned char>(c) < ' ') c = '_';
  return clean.empty() ? "unnamed" : clean;
}

std::vector<MaterialFile> materialFiles(const TriMesh& source, const Exec& exec) {
  if (!source.looks) return {};
  return LibraryWriter(source, exec).run();
}

}  // namespace sherd
