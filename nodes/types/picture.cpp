#include "types/picture.h"

#include "base/value_type.h"

namespace sherd {

static_assert(ArchivedValue<Picture>);

void hashValue(Hasher& hasher, const Picture& picture) {
  hasher.add(picture.width).add(picture.height).add(picture.rgb);
}

std::size_t byteSize(const Picture& picture) { return sizeof(Picture) + picture.rgb.size(); }

void saveValue(ArchiveWriter& to, const Picture& picture) {
  to.put(picture.width);
  to.put(picture.height);
  to.array(picture.rgb);
}

std::optional<Picture> loadValue(ArchiveReader& from, std::type_identity<Picture>) {
  Picture picture;
  from.get(picture.width);
  from.get(picture.height);
  from.array(picture.rgb);
  const bool isEmpty = picture.width == 0 && picture.height == 0 && picture.rgb.empty();
  if (!from.ok() || !(picture.complete() || isEmpty)) return std::nullopt;
  return picture;
}

}  // namespace sherd
