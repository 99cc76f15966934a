#include "load_picture/load_picture.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>

#include "pictures/png_file.h"
#include "support/program.h"

namespace sherd {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string bigEndian(std::uint32_t n) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(n >> shift & 0xff);
  return bytes;
}

std::uint32_t crcOf(const std::string& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

std::string chunk(const std::string& type, const std::string& data) {
  return bigEndian(static_cast<std::uint32_t>(data.size())) + type + data + bigEndian(crcOf(type + data));
}

/// One stored block, as zlib allows.
std::string stored(const Bytes& raw) {
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : raw) a = (a + byte) % 65521, b = (b + a) % 65521;
  const auto size = static_cast<std::uint16_t>(raw.size()), other = static_cast<std::uint16_t>(~size);
  std::string out = "\x78\x01\x01";
  for (const std::uint16_t n : {size, other}) out += {static_cast<char>(n & 0xff), static_cast<char>(n >> 8)};
  return out + std::string(raw.begin(), raw.end()) + bigEndian(b << 16 | a);
}

struct PngKind {
  std::uint32_t width, height;
  std::uint8_t depth, colour, interlaced = 0;
  std::string before = {};  ///< chunks ahead of the pixels
};

/// `raw`: rows with a filter byte, 0, before each.
std::string pngOf(const PngKind& kind, const Bytes& raw) {
  const std::string header = bigEndian(kind.width) + bigEndian(kind.height) +
                             std::string{static_cast<char>(kind.depth), static_cast<char>(kind.colour), 0, 0,
                                         static_cast<char>(kind.interlaced)};
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + kind.before + chunk("IDAT", stored(raw)) +
         chunk("IEND", "");
}

Bytes pixelsOf(const std::string& png) {
  const auto picture = readPng(png, Exec{});
  EXPECT_TRUE(picture.ok()) << (picture.ok() ? "" : picture.error().text());
  return picture.ok() ? picture->rgb : Bytes{};
}

std::string errorOf(const std::string& png) {
  const auto picture = readPng(png, Exec{});
  return picture.ok() ? "" : picture.error().text();
}

constexpr std::uint8_t kGrey = 0, kColours = 2, kPalette = 3, kGreyAlpha = 4, kColoursAlpha = 6;

TEST(ReadPng, ValuesAreThoseOfTheFileWhateverItsKind) {
  EXPECT_EQ(pixelsOf(pngOf({2, 1, 8, kColours}, {0, 1, 2, 3, 250, 251, 252})),
            (Bytes{1, 2, 3, 250, 251, 252}));
  EXPECT_EQ(pixelsOf(pngOf({1, 2, 8, kGrey}, {0, 7, 0, 128})), (Bytes{7, 7, 7, 128, 128, 128}));
  EXPECT_EQ(pixelsOf(pngOf({3, 1, 1, kGrey}, {0, 0b10100000})),
            (Bytes{255, 255, 255, 0, 0, 0, 255, 255, 255}));
  EXPECT_EQ(pixelsOf(pngOf({1, 1, 16, kGrey}, {0, 0x80, 0x80})), (Bytes{128, 128, 128})) << "not brightened";
  EXPECT_EQ(pixelsOf(pngOf({1, 1, 8, kGreyAlpha}, {0, 90, 10})), (Bytes{90, 90, 90}))
      << "not darkened by alpha";
  EXPECT_EQ(pixelsOf(pngOf({1, 1, 8, kColoursAlpha}, {0, 90, 91, 92, 0})), (Bytes{90, 91, 92}));
  const std::string palette = chunk("PLTE", std::string{1, 2, 3, 4, 5, 6});
  EXPECT_EQ(pixelsOf(pngOf({2, 1, 8, kPalette, 0, palette}, {0, 1, 0})), (Bytes{4, 5, 6, 1, 2, 3}));
  const std::string gamma = chunk("gAMA", bigEndian(100000));
  EXPECT_EQ(pixelsOf(pngOf({1, 1, 8, kGrey, 0, gamma}, {0, 128})), (Bytes{128, 128, 128}));
  // Two by two in passes: the first pixel, the one right of it, the second row.
  EXPECT_EQ(pixelsOf(pngOf({2, 2, 8, kGrey, 1}, {0, 10, 0, 20, 0, 30, 40})),
            (Bytes{10, 10, 10, 20, 20, 20, 30, 30, 30, 40, 40, 40}));
}

TEST(ReadPng, ReadsWhatWritePngWrites) {
  const ScratchDirectory directory;
  const std::string file = directory.file("picture.png");
  Picture picture{37, 81, {}};
  for (std::size_t i = 0; i < picture.offset(0, 81); ++i)
    picture.rgb.push_back(static_cast<std::uint8_t>(i * i % 251));
  ASSERT_TRUE(writePng(picture, file).ok());
  const auto loaded = loadPicture({file}, Exec{});
  ASSERT_TRUE(loaded.ok()) << loaded.error().text();
  EXPECT_EQ(*loaded, picture);
}

TEST(ReadPng, SaysWhatIsWrong) {
  const std::string good = pngOf({2, 1, 8, kColours}, {0, 1, 2, 3, 4, 5, 6});
  EXPECT_EQ(errorOf(""), "this is no PNG; save the picture as a PNG");
  EXPECT_EQ(errorOf("\xff\xd8\xff\xe0 a JPEG"), "this is no PNG; save the picture as a PNG");
  for (std::size_t size = 8; size < good.size() - 16; ++size)  // the last chunk and a checksum can be missing
    EXPECT_NE(errorOf(good.substr(0, size)).find("the PNG can't be read: "), std::string::npos) << size;
  std::string flipped = good;
  flipped[30] = static_cast<char>(flipped[30] ^ 1);
  EXPECT_NE(errorOf(flipped).find("can't be read"), std::string::npos);
  const std::string huge = errorOf(pngOf({900000, 900000, 8, kColours}, {0}));
  EXPECT_NE(huge.find("900000 × 900000 pixels, which are too many; save it smaller"), std::string::npos)
      << huge;
}

TEST(LoadPicture, NamesTheFile) {
  const ScratchDirectory directory;
  const auto errorFor = [](const std::string& file) {
    const auto picture = loadPicture({file}, Exec{});
    EXPECT_FALSE(picture.ok());
    EXPECT_EQ(picture.error().port, "file");
    return picture.error().text();
  };
  const std::string folder = directory.file(""), file = directory.file("mask.png");
  EXPECT_EQ(errorFor(file), file + ": no such file; check the path");
  EXPECT_EQ(errorFor(folder), folder + " is a folder; name the picture in it");
  std::ofstream(file) << "nothing";
  EXPECT_EQ(errorFor(file), file + ": this is no PNG; save the picture as a PNG");
}

TEST(LoadPicture, EndsWhenCancelled) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const auto picture = readPng(pngOf({1, 1, 8, kGrey}, {0, 1}), exec);
  ASSERT_FALSE(picture.ok());
  EXPECT_EQ(picture.error().kind, Error::Kind::Cancelled);
}

}  // namespace
}  // namespace sherd
