#include "export/glb.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

/// What materials use: textures, samplers and images, each once.
class TextureTable {
 public:
  explicit TextureTable(std::shared_ptr<const SurfaceLooks> looks) : looks_(std::move(looks)) {}

  /// Adds `key` with its texture to a material; nothing where there is none.
  void put(Json& owner, const char* key, const Texture& texture, const char* strength = nullptr) {
    if (texture.image < 0 || !looks_) return;
    Json use;
    use["index"] = number(texture);
    if (texture.uvSet > 0) use["texCoord"] = texture.uvSet;
    if (strength != nullptr && (texture.strength < 1 || texture.strength > 1))
      use[strength] = texture.strength;
    owner[key] = std::move(use);
  }

  /// Images go behind `length` bytes of the buffer. Returns the new length.
  std::size_t describe(Json& json, std::size_t length) const {
    if (images_.empty()) return length;
    for (const Index number : images_) {
      const ImageFile& image = looks_->images[at(number)];
      json["images"].push_back({{"name", image.name},
                                {"mimeType", mimeTypeOf(image)},
                                {"bufferView", json["bufferViews"].size()}});
      json["bufferViews"].push_back(
          {{"buffer", 0}, {"byteOffset", length}, {"byteLength", image.bytes.size()}});
      length += padded(image.bytes.size());
    }
    if (!samplers_.empty()) json["samplers"] = samplers_;
    json["textures"] = textures_;
    return length;
  }
  void append(std::string& file) const {
    for (const Index number : images_) {
      const std::string& bytes = looks_->images[at(number)].bytes;
      file += bytes;
      file.append(padded(bytes.size()) - bytes.size(), '\0');
    }
  }

 private:
  static std::size_t padded(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

  /// Where it is found in `list`, to whose end it is added where it isn't there.
  template <class List, class T>
  static std::size_t placeOf(List& list, const T& item) {
    const auto found = std::find(list.begin(), list.end(), item);
    const auto place = static_cast<std::size_t>(found - list.begin());
    if (found == list.end()) list.push_back(item);
    return place;
  }

  std::size_t number(const Texture& texture) {
    Json json;
    if (texture.wrapU != Texture::Wrap::Repeat || texture.wrapV != Texture::Wrap::Repeat)
      json["sampler"] =
          placeOf(samplers_, Json{{"wrapS", modeOf(texture.wrapU)}, {"wrapT", modeOf(texture.wrapV)}});
    json["source"] = placeOf(images_, texture.image);
    return placeOf(textures_, json);
  }
  static int modeOf(Texture::Wrap wrap) {
    return wrap == Texture::Wrap::Clamp ? 33071 : wrap == Texture::Wrap::Mirror ? 33648 : 10497;
  }

  std::shared_ptr<const SurfaceLooks> looks_;
  std::vector<Index> images_;  ///< into the looks' images
  std::vector<Json> textures_, samplers_;
};

/// Accessors of one type of element, one behind the other.
class View {
 public:
  View(const char* type, int component, std::size_t stride, int target)
      : type_(type), component_(component), stride_(stride), target_(target) {}

  /// Appends elements, which take `stride` bytes each; returns the accessor without its view.
  Json add(const void* data, std::size_t count) {
    Json accessor;
    accessor["byteOffset"] = bytes_.size();
    accessor["componentType"] = component_;
    accessor["count"] = count;
    accessor["type"] = type_;
    bytes_.append(static_cast<const char*>(data), stride_ * count);
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    return accessor;
  }
  bool empty() const { return bytes_.empty(); }
  const std::string& bytes() const { return bytes_; }
  Json describe(std::size_t offset) const {
    Json view;
    view["buffer"] = 0;
    view["byteOffset"] = offset;
    view["byteLength"] = bytes_.size();
    if (target_ == kArrayBuffer) view["byteStride"] = stride_;
    view["target"] = target_;
    return view;
  }

 private:
  const char* type_;
  int component_;
  std::size_t stride_;
  int target_;
  std::string bytes_;
};

class Builder {
 public:
  explicit Builder(const GlbScene& scene) : textures_(scene.looks) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "sherd"}};
    json_["scene"] = 0;
    Json roots = Json::array();
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) roots.push_back(i);
    json_["scenes"] = Json::array({{{"name", scene.name}, {"nodes", std::move(roots)}}});
    for (const GlbMaterial& material : scene.materials) addMaterial(material);
    for (const GlbNode& node : scene.nodes) addNode(node);
  }

  Result<std::string> take() {
    std::size_t length = 0;
    std::vector<std::size_t> number(views_.size());
    for (std::size_t v = 0, used = 0; v < views_.size(); ++v) {
      if (views_[v].empty()) continue;
      number[v] = used++;
      json_["bufferViews"].push_back(views_[v].describe(length));
      length += views_[v].bytes().size();
    }
    for (Json& accessor : json_["accessors"])
      accessor["bufferView"] = number[accessor["bufferView"].get<std::size_t>()];
    length = textures_.describe(json_, length);
    json_["buffers"] = Json::array({{{"byteLength", length}}});
    return join(length);
  }

 private:
  enum Kind { Vectors2, Vectors3, Vectors4, Shorts, Ints };

  void addMaterial(const GlbMaterial& material) {
    if (material.look) return addLook(material.name, *material.look);
    const auto& [r, g, b] = material.colour;
    json_["materials"].push_back({{"name", material.name},
                                  {"pbrMetallicRoughness",
                                   {{"baseColorFactor", Json::array({r, g, b, 1})},
                                    {"metallicFactor", 0},
                                    {"roughnessFactor", 0.9}}}});
  }

  void addLook(const std::string& name, const Look& look) {
    Json json, surface;
    surface["baseColorFactor"] = look.baseColour;
    textures_.put(surface, "baseColorTexture", look.colourTexture);
    surface["metallicFactor"] = look.metallic;
    surface["roughnessFactor"] = look.roughness;
    textures_.put(surface, "metallicRoughnessTexture", look.metallicRoughnessTexture);
    json["name"] = name;
    json["pbrMetallicRoughness"] = std::move(surface);
    textures_.put(json, "normalTexture", look.normalTexture, "scale");
    textures_.put(json, "occlusionTexture", look.occlusionTexture, "strength");
    textures_.put(json, "emissiveTexture", look.emissiveTexture);
    std::array<double, 3> emissive = look.emissive;
    for (double& value : emissive) value = std::min(value, 1.0);
    if (emissive != std::array<double, 3>{}) json["emissiveFactor"] = emissive;
    if (look.alpha != Look::Alpha::Opaque)
      json["alphaMode"] = look.alpha == Look::Alpha::Mask ? "MASK" : "BLEND";
    if (look.alpha == Look::Alpha::Mask) json["alphaCutoff"] = look.alphaCutoff;
    if (look.doubleSided) json["doubleSided"] = true;
    json_["materials"].push_back(std::move(json));
  }

  void addNode(const GlbNode& node) {
    Json primitives = Json::array();
    for (const GlbPrimitive& primitive : node.primitives) primitives.push_back(describe(primitive));
    Json json;
    json["name"] = node.name;
    json["mesh"] = json_["meshes"].size();
    json["translation"] = node.translation;
    if (!node.extras.empty()) json["extras"] = Json::parse(node.extras);
    json_["meshes"].push_back({{"name", node.name}, {"primitives", std::move(primitives)}});
    json_["nodes"].push_back(std::move(json));
  }

  Json describe(const GlbPrimitive& p) {
    Json attributes;
    attributes["POSITION"] = addPositions(p.positions);
    const std::size_t count = p.positions.size();
    if (!p.normals.empty()) attributes["NORMAL"] = add(Vectors3, p.normals.data(), count);
    for (std::size_t i = 0; i < p.uvs.size(); ++i)
      attributes["TEXCOORD_" + std::to_string(i)] = add(Vectors2, p.uvs[i].data(), count);
    for (std::size_t i = 0; i < p.colours.size(); ++i)
      attributes["COLOR_" + std::to_string(i)] = add(Vectors4, p.colours[i].data(), count);
    return {{"attributes", std::move(attributes)},
            {"indices", addIndices(p.indices, count)},
            {"material", p.material},
            {"mode", 4}};
  }

  std::size_t add(Kind kind, const void* data, std::size_t count) {
    Json accessor = views_[kind].add(data, count);
    accessor["bufferView"] = kind;
    json_["accessors"].push_back(std::move(accessor));
    return json_["accessors"].size() - 1;
  }

  std::size_t addPositions(const std::vector<Floats3>& positions) {
    const std::size_t accessor = add(Vectors3, positions.data(), positions.size());
    Floats3 low = positions.front(), high = low;
    for (const Floats3& p : positions)
      for (std::size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
    json_["accessors"][accessor]["min"] = low;
    json_["accessors"][accessor]["max"] = high;
    return accessor;
  }

  std::size_t addIndices(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
    // The largest number of either width is left to those who use it to restart a strip.
    if (vertices > std::numeric_limits<std::uint16_t>::max())
      return add(Ints, indices.data(), indices.size());
    const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
    return add(Shorts, narrow.data(), narrow.size());
  }

  Result<std::string> join(std::size_t length) const {
    // Names come from the artist's files; bytes that are no UTF-8 are replaced.
    std::string json = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + json.size() + 8 + length;
    if (total > std::numeric_limits<std::uint32_t>::max())
      return failure("the pieces are more than the 4 GiB that a GLB file can hold",
                     "export fewer or coarser ones");
    std::string file;
    file.reserve(total);
    const auto word = [&](std::size_t number) {
      const auto narrow = static_cast<std::uint32_t>(number);
      file.append(reinterpret_cast<const char*>(&narrow), sizeof narrow);  // little-endian, as the machine
    };
    file += "glTF";
    word(2), word(total);
    word(json.size());
    file += "JSON" + json;
    word(length);
    file.append("BIN\0", 4);
    for (const View& view : views_) file += view.bytes();
    textures_.append(file);
    return file;
  }

  Json json_;
  TextureTable textures_;
  std::array<View, 5> views_{View("VEC2", kFloat, 8, kArrayBuffer), View("VEC3", kFloat, 12, kArrayBuffer),
                             View("VEC4", kFloat, 16, kArrayBuffer),
                             View("SCALAR", kUnsignedShort, 2, kElementArrayBuffer),
                             View("SCALAR", kUnsignedInt, 4, kElementArrayBuffer)};
};

}  // namespace

Result<std::string> writeGlb(const GlbScene& scene) { return Builder(scene).take(); }

}  // namespace sherd
