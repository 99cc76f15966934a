#include "pictures/png_file.h"

#include <png.h>

#include <filesystem>

#include "base/atomic_file.h"
#include "base/partial_file.h"

namespace sherd {

Result<void> writePng(const Picture& picture, const std::string& file) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.format = PNG_FORMAT_RGB;
  header.width = static_cast<png_uint_32>(picture.width);
  header.height = static_cast<png_uint_32>(picture.height);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) == 0)
    return failure(std::string("the picture cannot be encoded as PNG: ") + header.message);
  bytes.resize(size);
  const std::filesystem::path directory = std::filesystem::path(file).parent_path();
  if (!directory.empty()) SHERD_CHECK(makeDirectory(directory.string()));
  const auto written = writeFileAtomically(file, bytes);
  if (written.ok()) SHERD_CHECK(removeAbandoned(file));
  return written.ok() ? Result<void>{} : written.error();
}

}  // namespace sherd
