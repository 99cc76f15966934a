#include <gtest/gtest.h>

#include "base/value_type.h"
#include "pictures/label.h"
#include "pictures/light.h"
#include "types/picture.h"

namespace sherd {
namespace {

using Lines = std::vector<std::string>;

Picture numbered(int width, int height) {
  Picture picture{width, height, {}};
  for (int i = 0; i < 3 * width * height; ++i) picture.rgb.push_back(static_cast<std::uint8_t>(31 * i));
  return picture;
}

std::shared_ptr<const Picture> reloaded(const std::string& bytes) {
  ArchiveReader reader(bytes, {});
  return std::static_pointer_cast<const Picture>(valueType<Picture>().load(reader));
}

std::string saved(const Picture& picture) {
  ArchiveWriter writer;
  valueType<Picture>().save(writer, &picture);
  return writer.bytes();
}

TEST(PictureValue, RoundTrips) {
  for (const Picture& picture : {Picture{}, numbered(1, 1), numbered(37, 5)}) {
    const auto loaded = reloaded(saved(picture));
    ASSERT_TRUE(loaded);
    EXPECT_EQ(*loaded, picture);
    EXPECT_EQ(valueType<Picture>().digest(loaded.get()), valueType<Picture>().digest(&picture));
  }
}

TEST(PictureValue, DamagedBytesAreNoPicture) {
  const std::string bytes = saved(numbered(6, 4));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(reloaded(bytes.substr(0, size))) << size;
  EXPECT_FALSE(reloaded(bytes + "x"));
  std::string otherSides = bytes;
  otherSides[0] = 4;
  EXPECT_FALSE(reloaded(otherSides));
  otherSides[0] = -6;
  EXPECT_FALSE(reloaded(otherSides));
}

TEST(PictureValue, DigestTellsSidesAndBytesApart) {
  const auto digestOf = [](const Picture& picture) { return valueType<Picture>().digest(&picture); };
  const Picture picture = numbered(6, 4);
  Picture turned = picture, changed = picture;
  std::swap(turned.width, turned.height);
  changed.rgb.back() ^= 1;
  EXPECT_NE(digestOf(turned), digestOf(picture));
  EXPECT_NE(digestOf(changed), digestOf(picture));
  EXPECT_GE(valueType<Picture>().bytes(&picture), 72u);
}

TEST(Light, EveryByteComesBack) {
  for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(toSrgb(linearOfSrgb()[i]), i);
  EXPECT_EQ(toSrgb(-1), 0);
  EXPECT_EQ(toSrgb(2), 255);
}

TEST(WrapText, BreaksAtSpacesWhereItCan) {
  EXPECT_EQ(wrapText("", 10, 3), Lines{});
  EXPECT_EQ(wrapText("frame 1001", 10, 3), Lines{"frame 1001"});
  EXPECT_EQ(wrapText("frame 1001, seed 7", 12, 3), (Lines{"frame 1001,", "seed 7"}));
  EXPECT_EQ(wrapText("abcdefghij", 4, 3), (Lines{"abcd", "efgh", "ij"}));
}

TEST(WrapText, KeepsBeginningAndEndOfWhatIsTooLong) {
  EXPECT_EQ(wrapText("abcdefghijklmnopqrstuvwxyz", 5, 2), (Lines{"abcde", "...yz"}));
  EXPECT_EQ(wrapText("abcdefghijklmnopqrstuvwxyz", 8, 1), Lines{"...vwxyz"});
}

TEST(WrapText, CountsCharactersAndNotBytes) {
  EXPECT_EQ(wrapText("ééééé", 5, 1), Lines{"ééééé"});
  EXPECT_EQ(textWidth("éé", 1), 11);
  EXPECT_EQ(textWidth("", 3), 0);
}

TEST(DrawText, EveryCharacterLooksDifferentAndIsClipped) {
  std::set<std::vector<std::uint8_t>> seen;
  for (char c = ' '; c <= '~'; ++c) {
    Picture picture{6, 8, std::vector<std::uint8_t>(3 * 6 * 8, 255)};
    drawText(picture, 0, 0, std::string(1, c), 1, {0, 0, 0});
    EXPECT_TRUE(seen.insert(picture.rgb).second) << c;
  }
  Picture picture{6, 8, std::vector<std::uint8_t>(3 * 6 * 8, 255)};
  drawText(picture, 0, 0, "é", 1, {0, 0, 0});
  EXPECT_TRUE(seen.insert(picture.rgb).second) << "what the font doesn't have is a box";
  drawText(picture, -3, -3, "clipped", 2, {0, 0, 0});
  drawText(picture, 4, 5, "clipped", 2, {0, 0, 0});
  EXPECT_EQ(picture.rgb.size(), 3u * 6 * 8);
}

}  // namespace
}  // namespace sherd
