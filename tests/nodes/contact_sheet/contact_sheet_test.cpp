#include "contact_sheet/contact_sheet.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>

#include "base/parallel.h"
#include "contact_sheet/scaling.h"
#include "graph/node_type.h"
#include "pictures/light.h"
#include "pictures/png_file.h"
#include "support/program.h"

namespace sherd {

NodeType contactSheetNode();

namespace {

using Rgb = std::array<std::uint8_t, 3>;

Picture plain(int width, int height, const Rgb& colour) {
  Picture picture{width, height, {}};
  for (int i = 0; i < width * height; ++i)
    picture.rgb.insert(picture.rgb.end(), colour.begin(), colour.end());
  return picture;
}

Picture noise(int width, int height, std::uint32_t seed) {
  Picture picture{width, height, {}};
  for (int i = 0; i < 3 * width * height; ++i)
    picture.rgb.push_back(static_cast<std::uint8_t>((seed = seed * 1664525u + 1013904223u) >> 24));
  return picture;
}

SheetPicture entry(Picture picture, std::string label = {}) {
  return {std::make_shared<const Picture>(std::move(picture)), std::move(label)};
}

Rgb pixel(const Picture& picture, int x, int y) {
  const std::uint8_t* p = picture.rgb.data() + picture.offset(x, y);
  return {p[0], p[1], p[2]};
}

/// The smallest rectangle (left, top, right, bottom; both ends inside) around all pixels of one colour.
std::array<int, 4> boundsOf(const Picture& picture, const Rgb& colour) {
  std::array<int, 4> bounds{picture.width, picture.height, -1, -1};
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (pixel(picture, x, y) == colour)
        bounds = {std::min(bounds[0], x), std::min(bounds[1], y), std::max(bounds[2], x),
                  std::max(bounds[3], y)};
  return bounds;
}

/// Rows of [top, bottom) in which something of the ink's colour stands.
int inkedRows(const Picture& picture, int left, int right, int top, int bottom) {
  const Rgb ink{44, 47, 52};
  int rows = 0;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x)
      if (pixel(picture, x, y) == ink) {
        ++rows;
        break;
      }
  return rows;
}

ContactSheetParams tiles(int width, int columns = 0, int margin = 10) {
  ContactSheetParams params;
  params.width = width;
  params.columns = columns;
  params.margin = margin;
  return params;
}

Picture mustSheet(const std::vector<SheetPicture>& pictures, const ContactSheetParams& params) {
  auto sheet = contactSheet(pictures, params, Exec{});
  EXPECT_TRUE(sheet.ok()) << sheet.error().text();
  return sheet.ok() ? *sheet : Picture{};
}

constexpr Rgb kRed{200, 30, 30}, kGreen{20, 160, 40}, kBlue{30, 40, 190}, kPaper{244, 244, 242};

TEST(Scaling, OwnSizeIsUnchanged) {
  const Picture picture = noise(17, 9, 1);
  EXPECT_EQ(scaledDown(picture, {17, 9}), picture);
}

TEST(Scaling, PlainStaysPlain) {
  for (const auto& [width, height] : {std::pair(1, 1), {7, 3}, {99, 63}, {100, 1}}) {
    const Picture scaled = scaledDown(plain(100, 64, {13, 128, 251}), {width, height});
    EXPECT_EQ(scaled, plain(width, height, {13, 128, 251})) << width << " × " << height;
  }
}

TEST(Scaling, AveragesLightAndNotBytes) {
  Picture picture{2, 1, {0, 0, 0, 255, 255, 255}};
  // Half the light of white is sRGB 188 (0.5 → 1.055 · 0.5^(1/2.4) − 0.055 = 0.7354).
  EXPECT_EQ(scaledDown(picture, {1, 1}).rgb, (std::vector<std::uint8_t>{188, 188, 188}));
}

TEST(Scaling, SharesOfBordersAreExact) {
  // Three pixels to two: the middle one goes to both, half each.
  Picture picture{3, 1, {0, 0, 0, 255, 255, 255, 0, 0, 0}};
  const std::uint8_t third = toSrgb(1 / 3.f);
  EXPECT_EQ(scaledDown(picture, {2, 1}).rgb, std::vector<std::uint8_t>(6, third));
}

TEST(Scaling, KeepsTheMeanLight) {
  const Picture picture = noise(130, 70, 3);
  const auto meanLight = [](const Picture& p) {
    double sum = 0;
    for (const std::uint8_t byte : p.rgb) sum += static_cast<double>(linearOfSrgb()[byte]);
    return sum / static_cast<double>(p.rgb.size());
  };
  for (const auto& [width, height] : {std::pair(130, 1), {50, 50}, {129, 69}, {3, 2}})
    EXPECT_NEAR(meanLight(scaledDown(picture, {width, height})), meanLight(picture), 2e-3);
}

TEST(Scaling, FitsAndNeverEnlarges) {
  const auto fitted = [](int width, int height) {
    const PictureSize size = fittedSize(Picture{width, height, {}}, {320, 480});
    return std::pair(size.width, size.height);
  };
  EXPECT_EQ(fitted(1600, 600), std::pair(320, 120));
  EXPECT_EQ(fitted(1, 1), std::pair(1, 1));
  EXPECT_EQ(fitted(100, 50), std::pair(100, 50));
  EXPECT_EQ(fitted(600, 1200), std::pair(240, 480));
  EXPECT_EQ(fitted(1, 10000), std::pair(1, 480));
  EXPECT_EQ(fitted(10000, 1), std::pair(320, 1));
}

TEST(ContactSheet, RefusesWhatItCannotDraw) {
  const std::vector<SheetPicture> one{entry(plain(8, 8, kRed))};
  const auto portOf = [](const std::vector<SheetPicture>& pictures, const ContactSheetParams& params) {
    const auto sheet = contactSheet(pictures, params, Exec{});
    return sheet.ok() ? "none" : sheet.error().port;
  };
  EXPECT_EQ(portOf({}, tiles(64)), "pictures");
  EXPECT_EQ(portOf({entry(Picture{}, "frame 7")}, tiles(64)), "pictures");
  EXPECT_EQ(portOf({entry(Picture{4, 4, {1, 2, 3}})}, tiles(64)), "pictures");
  EXPECT_EQ(portOf(one, tiles(31)), "width");
  EXPECT_EQ(portOf(one, tiles(5000)), "width");
  EXPECT_EQ(portOf(one, tiles(64, -1)), "columns");
  EXPECT_EQ(portOf(one, tiles(64, 1001)), "columns");
  EXPECT_EQ(portOf(one, tiles(64, 1, -1)), "margin");
  EXPECT_EQ(portOf(one, tiles(64, 1, 257)), "margin");
  EXPECT_EQ(portOf(std::vector<SheetPicture>(100, entry(plain(4096, 4096, kRed))), tiles(4096)), "width");
}

TEST(ContactSheet, OnePictureWithoutLabelIsFramedByTheMargin) {
  const Picture sheet = mustSheet({entry(plain(64, 48, kRed))}, tiles(64));
  EXPECT_EQ(sheet.width, 84);
  EXPECT_EQ(sheet.height, 68);
  EXPECT_EQ(boundsOf(sheet, kRed), (std::array<int, 4>{10, 10, 73, 57}));
  EXPECT_EQ(pixel(sheet, 0, 0), kPaper);
}

TEST(ContactSheet, LabelsStandBelowTheirPictures) {
  const Picture sheet =
      mustSheet({entry(plain(320, 120, kRed), "frame 1001"), entry(plain(320, 120, kBlue))}, tiles(320, 2));
  EXPECT_EQ(sheet.width, 3 * 10 + 2 * 320);
  EXPECT_EQ(inkedRows(sheet, 10, 330, 10, 130), 0);
  EXPECT_EQ(inkedRows(sheet, 10, 330, 130, sheet.height), 14);  // seven dots of two pixels
  EXPECT_EQ(inkedRows(sheet, 340, 660, 130, sheet.height), 0);
}

TEST(ContactSheet, PicturesOfDifferentSizesStandInTheMiddleOnOneLine) {
  const Picture sheet =
      mustSheet({entry(plain(200, 100, kRed)), entry(plain(10, 20, kGreen)), entry(plain(50, 1000, kBlue))},
                tiles(100, 3));
  // The tile is as high as the highest, which is limited to 150.
  EXPECT_EQ(sheet.height, 170);
  EXPECT_EQ(boundsOf(sheet, kRed), (std::array<int, 4>{10, 110, 109, 159}));
  EXPECT_EQ(boundsOf(sheet, kGreen), (std::array<int, 4>{165, 140, 174, 159}));
  EXPECT_EQ(boundsOf(sheet, kBlue), (std::array<int, 4>{276, 10, 283, 159}));
}

TEST(ContactSheet, ARowIsAsHighAsWhatStandsInIt) {
  const Picture sheet =
      mustSheet({entry(plain(100, 100, kRed)), entry(plain(100, 30, kBlue), "frame 2")}, tiles(100, 1));
  EXPECT_EQ(boundsOf(sheet, kRed), (std::array<int, 4>{10, 10, 109, 109}));
  EXPECT_EQ(boundsOf(sheet, kBlue), (std::array<int, 4>{10, 120, 109, 149}));
  EXPECT_EQ(sheet.height, 150 + 3 + 10 + 10);
}

TEST(ContactSheet, ColumnsMakeTheSheetNearlySquare) {
  const auto sizeOf = [](int count, int columns) {
    const Picture sheet =
        mustSheet(std::vector<SheetPicture>(static_cast<std::size_t>(count), entry(plain(40, 40, kRed))),
                  tiles(40, columns, 0));
    return std::pair(sheet.width / 40, sheet.height / 40);
  };
  EXPECT_EQ(sizeOf(1, 0), std::pair(1, 1));
  EXPECT_EQ(sizeOf(9, 0), std::pair(3, 3));
  EXPECT_EQ(sizeOf(16, 0), std::pair(4, 4));
  EXPECT_EQ(sizeOf(9, 9), std::pair(9, 1));
  EXPECT_EQ(sizeOf(10, 4), std::pair(4, 3));
  EXPECT_EQ(sizeOf(3, 8), std::pair(3, 1));
}

TEST(ContactSheet, OrderIsRowByRow) {
  const Picture sheet =
      mustSheet({entry(plain(40, 40, kRed)), entry(plain(40, 40, kGreen)), entry(plain(40, 40, kBlue))},
                tiles(40, 2, 0));
  EXPECT_EQ(pixel(sheet, 20, 20), kRed);
  EXPECT_EQ(pixel(sheet, 60, 20), kGreen);
  EXPECT_EQ(pixel(sheet, 20, 60), kBlue);
  EXPECT_EQ(pixel(sheet, 60, 60), kPaper);
}

TEST(ContactSheet, VeryLongLabelsStayInTheirTiles) {
  const std::string word(5000, 'm'), unicode = [] {
    std::string text;
    for (int i = 0; i < 400; ++i) text += "é ";
    return text;
  }();
  for (const std::string& label : {word, unicode, "frame 1001, mesh " + word}) {
    const Picture sheet =
        mustSheet({entry(plain(64, 64, kRed), label), entry(plain(64, 64, kBlue))}, tiles(64, 2));
    EXPECT_EQ(sheet.height, 10 + 64 + 3 + 4 * 10 + 10);
    EXPECT_GT(inkedRows(sheet, 10, 74, 74, sheet.height), 15);
    EXPECT_EQ(inkedRows(sheet, 74, sheet.width, 0, sheet.height), 0) << "beyond the tile";
    EXPECT_EQ(inkedRows(sheet, 0, 10, 0, sheet.height), 0) << "before the tile";
  }
}

TEST(ContactSheet, AThousandTilesForAnyNumberOfThreads) {
  std::vector<SheetPicture> pictures;
  for (int i = 0; i < 1000; ++i)
    pictures.push_back(
        entry(noise(48 + i % 7, 30 + i % 5, static_cast<std::uint32_t>(i)), std::to_string(i)));
  Picture sheets[2];
  for (int i = 0; i < 2; ++i) {
    setThreadLimit(i + 1);
    inArena([&] { sheets[i] = mustSheet(pictures, tiles(40)); });
  }
  setThreadLimit(0);
  EXPECT_TRUE(sheets[0] == sheets[1]);
  EXPECT_LT(std::abs(std::log(static_cast<double>(sheets[0].width) / sheets[0].height)), 0.1);
}

TEST(ContactSheet, CancelledIsAnError) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const auto sheet = contactSheet({entry(plain(40, 40, kRed))}, tiles(40), exec);
  ASSERT_FALSE(sheet.ok());
  EXPECT_EQ(sheet.error().kind, Error::Kind::Cancelled);
}

TEST(ContactSheetNode, WritesTheSheetOfAllItsPictures) {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("new/sheet.png");
  const NodeType type = contactSheetNode();
  ASSERT_TRUE(type.writesFiles);
  ASSERT_TRUE(type.input("pictures") && type.input("pictures")->gathers);
  EXPECT_EQ(type.outputs.front().name, "file");
  ParamValues params;
  for (const ParamInfo& info : type.params) params[info.name] = info.fallback;
  params["file"] = file;
  const Exec exec;
  NodeIo io(exec);
  std::vector<SheetPicture> pictures;
  for (const auto& [colour, label] : {std::pair(kRed, "frame 1"), {kGreen, "frame 2"}}) {
    pictures.push_back(entry(plain(320, 120, colour), label));
    io.setInput("pictures", Value::of<Picture>(pictures.back().picture), label);
  }
  const auto result = type.run(params, io);
  ASSERT_TRUE(result.ok()) << result.error().text();
  EXPECT_EQ(io.written(), std::vector<std::string>{file});
  const auto sheet = io.output("picture").as<Picture>();
  ASSERT_TRUE(sheet);
  EXPECT_EQ(*sheet, mustSheet(pictures, ContactSheetParams{}));

  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&header, file.c_str()), 0);
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> decoded(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, decoded.data(), 0, nullptr), 0);
  EXPECT_EQ(decoded, sheet->rgb);
}

TEST(ContactSheetNode, SaysWhatIsInTheWay) {
  const ScratchDirectory scratch;
  const NodeType type = contactSheetNode();
  ParamValues params;
  for (const ParamInfo& info : type.params) params[info.name] = info.fallback;
  std::ofstream(scratch.file("file")) << "";
  params["file"] = scratch.file("file/sheet.png");
  const Exec exec;
  NodeIo nothing(exec), some(exec);
  EXPECT_EQ(type.run(params, nothing).error().port, "pictures");
  some.setInput("pictures", Value::of<Picture>(entry(plain(8, 8, kRed)).picture), "");
  EXPECT_FALSE(type.run(params, some).ok());
  EXPECT_TRUE(some.written().empty());
}

}  // namespace
}  // namespace sherd
