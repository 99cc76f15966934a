// What faces look like, as the artist's file says it: the metallic-roughness model of glTF 2.0, which the
// models of other formats are turned into. Pictures stay as they are encoded; nothing here decodes them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/archive.h"
#include "base/hash.h"
#include "types/vec.h"

namespace sherd {

/// A picture file, byte for byte.
struct ImageFile {
  std::string name;   ///< "brick.png", for messages and for files that are written; no folders
  std::string bytes;  ///< encoded
};

/// "image/png" and the like by the first bytes, or by the name's ending where a format has no mark; empty
/// where it is no picture that is known.
std::string mimeTypeOf(const ImageFile& image);
/// The ending that goes with such a type, ".png"; empty for the empty one.
std::string extensionOfMimeType(const std::string& mimeType);

/// A use of a picture.
struct Texture {
  enum class Wrap { Repeat, Mirror, Clamp };
  Index image = -1;     ///< into SurfaceLooks::images; −1: no texture
  Index uvSet = 0;      ///< into TriMesh::uvSets
  double strength = 1;  ///< of normals and occlusion
  Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
};

/// A line of a .mtl file as it came, but for the name of its picture.
struct MtlStatement {
  std::string text;  ///< "map_Bump -bm 0.3"
  Index image = -1;  ///< into SurfaceLooks::images: its name follows; −1: none does
};

/// Factors multiply their textures. Colours are linear.
struct Look {
  enum class Alpha { Opaque, Mask, Blend };
  std::array<double, 4> baseColour{1, 1, 1, 1};  ///< in [0, 1]
  double metallic = 0, roughness = 1;            ///< in [0, 1]
  std::array<double, 3> emissive{};              ///< ≥ 0
  Alpha alpha = Alpha::Opaque;
  double alphaCutoff = 0.5;  ///< of Mask
  bool doubleSided = false;
  Texture colourTexture, metallicRoughnessTexture, normalTexture, occlusionTexture, emissiveTexture;
  std::vector<MtlStatement> mtl;  ///< of a look that a .mtl file gave, all of its lines; else empty
};

/// Shared by all meshes that come from one file: pieces, and pieces of pieces.
struct SurfaceLooks {
  static constexpr const char* typeName = "Looks";
  static constexpr int archiveVersion = 1;
  std::vector<ImageFile> images;           ///< each once
  std::vector<std::optional<Look>> looks;  ///< along TriMesh::materials, whose further entries have none
};

/// The look of material `material`, or null.
inline const Look* lookOf(const SurfaceLooks* looks, Index material) {
  if (looks == nullptr || material < 0 || at(material) >= looks->looks.size()) return nullptr;
  const auto& look = looks->looks[at(material)];
  return look ? &*look : nullptr;
}

/// Calls f(texture) for each of the five, const or not.
template <class L, class F>
void forEachTexture(L& look, F&& f) {
  f(look.colourTexture), f(look.metallicRoughnessTexture), f(look.normalTexture), f(look.occlusionTexture),
      f(look.emissiveTexture);
}

void hashValue(Hasher& hasher, const SurfaceLooks& looks);
std::size_t byteSize(const SurfaceLooks& looks);
void saveValue(ArchiveWriter& to, const SurfaceLooks& looks);
/// Nothing where an image is named that isn't there.
std::optional<SurfaceLooks> loadValue(ArchiveReader& from, std::type_identity<SurfaceLooks>);

}  // namespace sherd
