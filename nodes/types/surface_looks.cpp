#include "types/surface_looks.h"

#include <algorithm>
#include <string_view>

#include "base/value_type.h"
#include "types/value_bytes.h"

namespace sherd {

static_assert(ArchivedValue<SurfaceLooks>);

namespace {

using namespace std::string_view_literals;

/// How files of a format begin, at most with a gap of bytes that say something else.
struct Mark {
  std::string_view mimeType, extension, start;
  std::string_view later = {};  ///< behind the four bytes that follow `start`
};
constexpr Mark kMarks[] = {
    {"image/png", ".png", "\x89PNG\r\n\x1a\n"sv},
    {"image/jpeg", ".jpg", "\xff\xd8\xff"sv},
    {"image/webp", ".webp", "RIFF"sv, "WEBP"sv},
    {"image/gif", ".gif", "GIF8"sv},
    {"image/bmp", ".bmp", "BM"sv},
    {"image/tiff", ".tif", "II*\0"sv},
    {"image/tiff", ".tif", "MM\0*"sv},
    {"image/vnd-ms.dds", ".dds", "DDS "sv},
    {"image/ktx2", ".ktx2", "\xabKTX 20\xbb"sv},
    {"image/x-exr", ".exr", "v/1\x01"sv},
    {"image/vnd.radiance", ".hdr", "#?R"sv},
    {"image/vnd.adobe.photoshop", ".psd", "8BPS"sv},
};
constexpr std::string_view kTarga = "image/x-tga";

bool carries(const Mark& mark, std::string_view bytes) {
  return bytes.starts_with(mark.start) &&
         (mark.later.empty() ||
          bytes.substr(std::min(bytes.size(), mark.start.size() + 4)).starts_with(mark.later));
}

}  // namespace

std::string mimeTypeOf(const ImageFile& image) {
  for (const Mark& mark : kMarks)
    if (carries(mark, image.bytes)) return std::string(mark.mimeType);
  std::string ending = image.name.substr(image.name.size() - std::min<std::size_t>(4, image.name.size()));
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const bool isTarga = ending == ".tga" && image.bytes.size() > 18;  // its header
  return isTarga ? std::string(kTarga) : std::string();
}

std::string extensionOfMimeType(const std::string& mimeType) {
  for (const Mark& mark : kMarks)
    if (mark.mimeType == mimeType) return std::string(mark.extension);
  return mimeType == kTarga ? ".tga" : "";
}

namespace {

/// Calls f with every number and enumeration of a look, in one order for all purposes. A number comes as
/// itself.
template <class L, class F>
void forEachNumber(L& look, F&& f) {
  for (auto& value : look.baseColour) f(value);
  f(look.metallic), f(look.roughness);
  for (auto& value : look.emissive) f(value);
  f(look.alpha), f(look.alphaCutoff), f(look.doubleSided);
  forEachTexture(look, [&](auto& texture) {
    f(texture.image), f(texture.uvSet), f(texture.strength), f(texture.wrapU), f(texture.wrapV);
  });
}

void hashNumber(Hasher& hasher, double value) { hashBits(hasher, value); }
void hashNumber(Hasher& hasher, Index value) { hasher.add(value); }
void hashNumber(Hasher& hasher, bool value) { hasher.add(value); }
template <class E>
requires(std::is_enum_v<E>) void hashNumber(Hasher& hasher, E value) { hasher.add(static_cast<int>(value)); }

bool isSound(const Look& look, std::size_t images) {
  bool sound = look.alpha >= Look::Alpha::Opaque && look.alpha <= Look::Alpha::Blend;
  forEachTexture(look, [&](const Texture& t) {
    sound = sound && inRange(t.image, -1, images) && t.uvSet >= 0;
    for (const auto wrap : {t.wrapU, t.wrapV})
      sound = sound && wrap >= Texture::Wrap::Repeat && wrap <= Texture::Wrap::Clamp;
  });
  return sound && std::all_of(look.mtl.begin(), look.mtl.end(),
                              [&](const MtlStatement& line) { return inRange(line.image, -1, images); });
}

}  // namespace

void hashValue(Hasher& hasher, const SurfaceLooks& value) {
  hasher.add(value.images.size()).add(value.looks.size());
  for (const ImageFile& image : value.images) hasher.add(image.name).add(image.bytes);
  for (const auto& look : value.looks) {
    hasher.add(look.has_value());
    if (!look) continue;
    forEachNumber(*look, [&](const auto& number) { hashNumber(hasher, number); });
    hasher.add(look->mtl.size());
    for (const MtlStatement& line : look->mtl) hasher.add(line.text).add(line.image);
  }
}

std::size_t byteSize(const SurfaceLooks& value) {
  std::size_t bytes = sizeof value + value.looks.size() * sizeof(std::optional<Look>);
  for (const ImageFile& image : value.images) bytes += sizeof image + image.name.size() + image.bytes.size();
  return bytes;
}

void saveValue(ArchiveWriter& to, const SurfaceLooks& value) {
  putList(to, value.images, [&](const ImageFile& image) {
    to.text(image.name);
    to.text(image.bytes);
  });
  putList(to, value.looks, [&](const std::optional<Look>& look) {
    to.put(look.has_value());
    if (!look) return;
    forEachNumber(*look, [&](const auto& number) { to.put(number); });
    putList(to, look->mtl, [&](const MtlStatement& line) {
      to.text(line.text);
      to.put(line.image);
    });
  });
}

std::optional<SurfaceLooks> loadValue(ArchiveReader& from, std::type_identity<SurfaceLooks>) {
  std::optional<SurfaceLooks> loaded(std::in_place);
  getList(from, loaded->images, [&](ImageFile& image) {
    image.name = from.text();
    image.bytes = from.text();
  });
  bool sound = true;
  getList(from, loaded->looks, [&](std::optional<Look>& look) {
    if (!from.get<bool>()) return;
    look.emplace();
    forEachNumber(*look, [&](auto& number) { from.get(number); });
    getList(from, look->mtl, [&](MtlStatement& line) {
      line.text = from.text();
      from.get(line.image);
    });
    sound = sound && isSound(*look, loaded->images.size());
  });
  if (!from.ok() || !sound) loaded.reset();
  return loaded;
}

}  // namespace sherd
