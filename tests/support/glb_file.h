// Reads a GLB file with nothing but the specification (glTF 2.0, core) and finds what is wrong in it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sherd::test {

/// Elements of one accessor, as doubles.
using GlbArray = std::vector<std::vector<double>>;

class GlbFile {
 public:
  nlohmann::json json;
  std::vector<std::string> faults;

  explicit GlbFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
    if (!readChunks()) return;
    checkBuffers();
    for (const auto& accessor : list("accessors")) checkAccessor(accessor);
    for (const auto& mesh : list("meshes"))
      for (const auto& primitive : mesh["primitives"]) checkPrimitive(primitive);
    checkTextures();
    checkScene();
  }

  GlbArray array(std::size_t number) const {
    const auto& accessor = json["accessors"].at(number);
    const auto& view = json["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
    const int type = accessor["componentType"];
    const std::size_t width = widthOf(accessor), size = sizeOf(type), count = accessor["count"];
    const std::size_t stride = view.value("byteStride", width * size);
    const std::size_t first = view.value("byteOffset", 0u) + accessor.value("byteOffset", 0u);
    GlbArray values(count, std::vector<double>(width));
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < width; ++c)
        values[i][c] = number_(binary_ + first + i * stride + c * size, type);
    return values;
  }
  GlbArray attribute(const nlohmann::json& primitive, const std::string& name) const {
    return array(primitive["attributes"].at(name).get<std::size_t>());
  }
  /// The bytes of image `number`.
  std::string image(std::size_t number) const {
    const auto& view = json["bufferViews"].at(json["images"].at(number)["bufferView"].get<std::size_t>());
    return bytes_.substr(binary_ + view.value("byteOffset", 0u), view["byteLength"].get<std::size_t>());
  }
  std::vector<std::size_t> indices(const nlohmann::json& primitive) const {
    std::vector<std::size_t> result;
    for (const auto& value : array(primitive["indices"]))
      result.push_back(static_cast<std::size_t>(value[0]));
    return result;
  }

 private:
  void fault(const std::string& what) { faults.push_back(what); }
  void expect(bool holds, const std::string& what) {
    if (!holds) fault(what);
  }
  nlohmann::json list(const char* name) const {
    return json.contains(name) ? json[name] : nlohmann::json::array();
  }
  std::uint32_t word(std::size_t offset) const {
    std::uint32_t value = 0;
    if (offset + 4 <= bytes_.size()) std::memcpy(&value, bytes_.data() + offset, 4);
    return value;
  }
  static std::size_t sizeOf(int type) { return type == 5126 || type == 5125 ? 4 : type == 5123 ? 2 : 0; }
  static std::size_t widthOf(const nlohmann::json& accessor) {
    const std::string type = accessor["type"];
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
  }
  double number_(std::size_t offset, int type) const {
    if (type == 5123) {
      std::uint16_t value = 0;
      std::memcpy(&value, bytes_.data() + offset, sizeof value);
      return value;
    }
    if (type == 5125) return word(offset);
    float value = 0;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }

  bool readChunks() {
    const std::size_t before = faults.size();
    expect(bytes_.substr(0, 4) == "glTF", "magic");
    expect(word(4) == 2, "version");
    expect(word(8) == bytes_.size(), "length of the file");
    const std::size_t length = word(12);
    expect(length % 4 == 0, "JSON chunk is not a multiple of 4");
    expect(bytes_.substr(16, 4) == "JSON", "first chunk is not JSON");
    binary_ = 20 + length + 8;
    expect(binary_ <= bytes_.size(), "no second chunk");
    if (faults.size() > before) return false;
    json = nlohmann::json::parse(bytes_.substr(20, length), nullptr, false);
    expect(json.is_object(), "JSON chunk cannot be parsed");
    binaryLength_ = word(binary_ - 8);
    expect(binaryLength_ % 4 == 0, "binary chunk is not a multiple of 4");
    expect(bytes_.substr(binary_ - 4, 4) == std::string("BIN\0", 4), "second chunk is not BIN");
    expect(binary_ + binaryLength_ == bytes_.size(), "bytes behind the second chunk");
    return faults.size() == before;
  }

  void checkBuffers() {
    expect(json["asset"]["version"] == "2.0", "asset version");
    expect(json["buffers"].size() == 1 && !json["buffers"][0].contains("uri"), "one buffer, in the file");
    const std::size_t length = json["buffers"][0]["byteLength"];
    expect(length <= binaryLength_ && binaryLength_ <= length + 3, "buffer's length");
    std::size_t end = 0, number = 0;
    for (const auto& view : list("bufferViews")) {
      expect(view["buffer"] == 0, "view's buffer");
      const std::size_t first = view.value("byteOffset", 0u), size = view["byteLength"];
      expect(first % 4 == 0, "view is not aligned");
      expect(size > 0 && first + size <= length, "view leaves the buffer");
      expect(first >= end, "views overlap");
      end = first + size;
      if (isImage(number++)) {
        expect(!view.contains("target") && !view.contains("byteStride"), "image's view");
        continue;
      }
      const int target = view["target"];
      expect(target == 34962 || target == 34963, "view's target");
      if (!view.contains("byteStride")) continue;
      const std::size_t stride = view["byteStride"];
      expect(target == 34962 && stride % 4 == 0 && stride >= 4 && stride <= 252, "view's stride");
    }
  }

  bool isImage(std::size_t view) const {
    for (const auto& image : list("images"))
      if (image["bufferView"] == view) return true;
    return false;
  }

  /// That what a material names is there.
  void checkTextures() {
    for (const auto& texture : list("textures")) {
      expect(texture["source"].get<std::size_t>() < list("images").size(), "texture's image");
      if (texture.contains("sampler"))
        expect(texture["sampler"].get<std::size_t>() < list("samplers").size(), "texture's sampler");
    }
    for (const auto& image : list("images"))
      expect(image["mimeType"] == "image/png" || image["mimeType"] == "image/jpeg", "image's type");
    for (const auto& material : list("materials"))
      for (const auto* owner : {&material, &material["pbrMetallicRoughness"]})
        for (const auto& [name, use] : owner->items())
          if (name.ends_with("Texture"))
            expect(use["index"].get<std::size_t>() < list("textures").size(), "material's texture");
  }

  void checkAccessor(const nlohmann::json& accessor) {
    const std::size_t number = accessor["bufferView"];
    if (number >= list("bufferViews").size()) return fault("accessor's view");
    const auto& view = json["bufferViews"][number];
    const std::size_t size = sizeOf(accessor["componentType"]), width = widthOf(accessor);
    const std::size_t offset = accessor.value("byteOffset", 0u), count = accessor["count"];
    const std::size_t stride = view.value("byteStride", width * size);
    if (size == 0 || width == 0 || count == 0) return fault("accessor's type or count");
    expect(offset % size == 0 && stride % size == 0, "accessor is not aligned");
    expect(offset + (count - 1) * stride + width * size <= view["byteLength"].get<std::size_t>(),
           "accessor leaves its view");
  }

  void checkPrimitive(const nlohmann::json& primitive) {
    expect(primitive.value("mode", 4) == 4, "no triangles");
    expect(primitive["material"].get<std::size_t>() < list("materials").size(), "primitive's material");
    const auto& attributes = primitive["attributes"];
    if (!attributes.contains("POSITION")) return fault("no positions");
    const GlbArray positions = attribute(primitive, "POSITION");
    checkBounds(json["accessors"][attributes["POSITION"].get<std::size_t>()], positions);
    for (const auto& [name, number] : attributes.items()) checkAttribute(name, number, positions.size());
    const auto& accessor = json["accessors"].at(primitive["indices"].get<std::size_t>());
    const int type = accessor["componentType"];
    expect(accessor["type"] == "SCALAR" && (type == 5123 || type == 5125), "indices' type");
    expect(json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["target"] == 34963,
           "indices' target");
    const auto corners = indices(primitive);
    expect(corners.size() % 3 == 0, "indices are no triangles");
    std::vector<char> used(positions.size(), 0);
    for (const std::size_t i : corners) {
      if (i >= positions.size() || (type == 5123 && i == 65535)) return fault("index out of range");
      used[i] = 1;
    }
    for (const char is : used)
      if (!is) return fault("unused vertex");
  }

  void checkBounds(const nlohmann::json& accessor, const GlbArray& positions) {
    if (!accessor.contains("min") || !accessor.contains("max")) return fault("positions without bounds");
    for (std::size_t c = 0; c < 3; ++c) {
      double low = positions[0][c], high = low;
      for (const auto& p : positions) low = std::min(low, p[c]), high = std::max(high, p[c]);
      expect(accessor["min"][c] == low && accessor["max"][c] == high,
             "bounds are not those of the positions");
    }
  }

  void checkAttribute(const std::string& name, std::size_t number, std::size_t count) {
    const auto& accessor = json["accessors"].at(number);
    const std::map<std::string, std::string> types{
        {"POSITION", "VEC3"}, {"NORMAL", "VEC3"}, {"TEXCOORD", "VEC2"}, {"COLOR", "VEC4"}};
    const auto type = types.find(name.substr(0, name.find('_')));
    if (type == types.end()) return fault("attribute " + name);
    expect(accessor["type"] == type->second && accessor["componentType"] == 5126, name + "'s type");
    expect(accessor["count"] == count, name + "'s count");
    expect(json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["target"] == 34962,
           name + "'s target");
    for (const auto& values : array(number)) {
      double squares = 0;
      for (const double value : values) {
        if (!std::isfinite(value)) return fault(name + " is not finite");
        if (type->first == "COLOR" && (value < 0 || value > 1)) return fault("colour leaves [0, 1]");
        squares += value * value;
      }
      if (type->first == "NORMAL" && std::abs(std::sqrt(squares) - 1) > 1e-5)
        return fault("normal is not unit");
    }
  }

  void checkScene() {
    const std::size_t scene = json.value("scene", 0u);
    if (scene >= list("scenes").size()) return fault("scene");
    std::vector<char> seen(list("nodes").size(), 0);
    for (const auto& root : json["scenes"][scene]["nodes"]) {
      if (root >= seen.size() || seen[root.get<std::size_t>()]++) return fault("scene's nodes");
      expect(json["nodes"][root.get<std::size_t>()]["mesh"].get<std::size_t>() < list("meshes").size(),
             "node's mesh");
    }
  }

  std::string bytes_;
  std::size_t binary_ = 0, binaryLength_ = 0;
};

}  // namespace sherd::test
