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
  explicit Builder(const GlbScene& scene) {
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
    json_["buffers"] = Json::array({{{"byteLength", length}}});
    return join(length);
  }

 private:
  enum Kind { Vectors2, Vectors3, Vectors4, Shorts, Ints };

  void addMaterial(const GlbMaterial& material) {
    const auto& [r, g, b] = material.colour;
    json_["materials"].push_back({{"name", material.name},
                                  {"pbrMetallicRoughness",
                                   {{"baseColorFactor", Json::array({r, g, b, 1})},
                                    {"metallicFactor", 0},
                                    {"roughnessFactor", 0.9}}}});
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
    return file;
  }

  Json json_;
  std::array<View, 5> views_{View("VEC2", kFloat, 8, kArrayBuffer), View("VEC3", kFloat, 12, kArrayBuffer),
                             View("VEC4", kFloat, 16, kArrayBuffer),
                             View("SCALAR", kUnsignedShort, 2, kElementArrayBuffer),
                             View("SCALAR", kUnsignedInt, 4, kElementArrayBuffer)};
};

}  // namespace

Result<std::string> writeGlb(const GlbScene& scene) { return Builder(scene).take(); }

}  // namespace sherd
