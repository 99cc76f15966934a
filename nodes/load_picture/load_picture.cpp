#include "load_picture/load_picture.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>

#include "pictures/png_file.h"

namespace sherd {
namespace {

namespace fs = std::filesystem;

Result<std::string> contentOf(const std::string& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) return failure(file + " is a folder", "name the picture in it", "file");
  if (!fs::exists(file, error)) return failure(file + ": no such file", "check the path", "file");
  std::ifstream in(file, std::ios::binary);
  std::string content(std::istreambuf_iterator<char>(in), {});
  if (!in) return failure(file + " can't be read", "check the disk and the file's permissions", "file");
  return content;
}

}  // namespace

Result<Picture> loadPicture(const LoadPictureParams& params, const Exec& exec) {
  try {
    SHERD_ASSIGN(const std::string content, contentOf(params.file));
    Result<Picture> picture = readPng(content, exec);
    if (picture.ok() || picture.error().kind == Error::Kind::Cancelled) return picture;
    return failure(params.file + ": " + picture.error().what, picture.error().remedy, "file");
  } catch (const std::bad_alloc&) {
    return failure(params.file + ": not enough memory for this picture", "use one of fewer pixels", "file");
  }
}

}  // namespace sherd
