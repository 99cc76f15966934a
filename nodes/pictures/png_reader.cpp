#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <vector>

#include "pictures/png_file.h"

namespace sherd {
namespace {

constexpr std::size_t kSignature = 8;  // bytes
constexpr png_uint_32 kRowsAtOnce = 64;

/// libpng leaves by longjmp when something is wrong: nothing that has to be destroyed may live in the
/// functions that call it, so it all lives here.
class PngReader {
 public:
  explicit PngReader(std::string_view content)
      : content_(content), png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &onError, &onWarning)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  /// False where something is wrong: problem().
  bool readHeader() {
    if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, this, &onRead);
    png_read_info(png_, info_);
    png_set_expand(png_);
    png_set_scale_16(png_);
    png_set_strip_alpha(png_);
    png_set_gray_to_rgb(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  /// The same; `rows` as many as the picture is high, each as wide. Ends early when cancelled.
  bool readRows(png_bytepp rows, const Exec& exec) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    for (int pass = 0; pass < passes_; ++pass)
      for (png_uint_32 row = 0; row < height() && !exec.cancelled(); row += kRowsAtOnce)
        png_read_rows(png_, rows + row, nullptr, std::min(kRowsAtOnce, height() - row));
    return true;
  }
  png_uint_32 width() const { return png_get_image_width(png_, info_); }
  png_uint_32 height() const { return png_get_image_height(png_, info_); }
  std::size_t rowBytes() const { return png_get_rowbytes(png_, info_); }
  const char* problem() const { return info_ == nullptr ? "there is no memory for it" : problem_; }

 private:
  [[noreturn]] static void onError(png_structp png, png_const_charp what) {
    auto* reader = static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(reader->problem_, what, sizeof reader->problem_ - 1);
    png_longjmp(png, 1);
  }
  static void onWarning(png_structp, png_const_charp) {}
  static void onRead(png_structp png, png_bytep to, std::size_t size) {
    auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > reader->content_.size() - reader->next_) png_error(png, "it is cut off");
    std::memcpy(to, reader->content_.data() + reader->next_, size);
    reader->next_ += size;
  }

  std::string_view content_;
  std::size_t next_ = 0;
  char problem_[120] = {};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;
};

Error damaged(const PngReader& reader) {
  return failure(std::string("the PNG can't be read: ") + reader.problem(),
                 "it may be damaged; save the picture again");
}

}  // namespace

Result<Picture> readPng(std::string_view content, const Exec& exec) {
  if (content.size() < kSignature ||
      png_sig_cmp(reinterpret_cast<png_const_bytep>(content.data()), 0, kSignature) != 0)
    return failure("this is no PNG", "save the picture as a PNG");
  PngReader reader(content);
  if (!reader.readHeader()) return damaged(reader);
  if (static_cast<double>(reader.width()) * reader.height() > kMostPixels)
    return failure(
        fmt::format("the picture has {} × {} pixels, which are too many", reader.width(), reader.height()),
        "save it smaller: 16384 × 16384 is the most");
  Picture picture;
  picture.width = static_cast<int>(reader.width());
  picture.height = static_cast<int>(reader.height());
  picture.rgb.resize(picture.offset(0, picture.height));
  if (reader.rowBytes() != picture.offset(picture.width, 0)) return damaged(reader);
  std::vector<png_bytep> rows;
  for (int y = 0; y < picture.height; ++y) rows.push_back(picture.rgb.data() + picture.offset(0, y));
  if (!reader.readRows(rows.data(), exec)) return damaged(reader);
  if (exec.cancelled()) return cancelledError();
  return picture;
}

}  // namespace sherd
