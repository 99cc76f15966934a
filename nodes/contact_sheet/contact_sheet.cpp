#include "contact_sheet/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "contact_sheet/scaling.h"
#include "pictures/label.h"

namespace sherd {
namespace {

constexpr Rgb kPaper{244, 244, 242}, kInk{44, 47, 52};
constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;
constexpr int kMostLines = 4, kMostColumns = 1000;
constexpr double kTallest = 1.5;  // of a tile's picture, in widths

/// One picture's place in its tile.
struct Tile {
  PictureSize size;
  std::vector<std::string> lines;  ///< of its label
};

struct Row {
  std::int64_t top = 0;   ///< of its tiles
  int pictureHeight = 0;  ///< of the highest picture
};

struct Sheet {
  std::vector<Tile> tiles;
  std::vector<Row> rows;
  int columns = 1, tileWidth = 0, margin = 0;
  int dots = 1;  ///< pixels to a dot of the font
  std::int64_t width = 0, height = 0;

  int textHeight(std::size_t lines) const {
    return lines == 0 ? 0 : (3 + kLineDots * static_cast<int>(lines)) * dots;
  }
  int left(int column) const { return margin + column * (tileWidth + margin); }
};

Result<void> checkInput(const std::vector<SheetPicture>& pictures, const ContactSheetParams& params) {
  const auto check = [](int value, int low, int high, const char* name) -> Result<void> {
    if (value >= low && value <= high) return {};
    return failure(fmt::format("{} is {}", name, value), fmt::format("{} to {}", low, high), name);
  };
  SHERD_CHECK(check(params.columns, 0, kMostColumns, "columns"));
  SHERD_CHECK(check(params.width, 32, 4096, "width"));
  SHERD_CHECK(check(params.margin, 0, 256, "margin"));
  if (pictures.empty())
    return failure("there are no pictures for the sheet", "wire Preview's `picture`", "pictures");
  for (const SheetPicture& entry : pictures)
    if (!entry.picture->complete())
      return failure(
          fmt::format("the picture{} has no pixels", entry.label.empty() ? "" : " of " + entry.label), {},
          "pictures");
  return {};
}

std::vector<Tile> makeTiles(const std::vector<SheetPicture>& pictures, const Sheet& sheet) {
  const PictureSize box{sheet.tileWidth, static_cast<int>(kTallest * sheet.tileWidth)};
  const int columns = (sheet.tileWidth / sheet.dots + 1) / kCharacterDots;
  std::vector<Tile> tiles;
  for (const SheetPicture& entry : pictures)
    tiles.push_back({fittedSize(*entry.picture, box), wrapText(entry.label, columns, kMostLines)});
  return tiles;
}

/// Puts the tiles into rows, each as high as what stands in it.
void makeRows(Sheet& sheet, int columns) {
  sheet.columns = columns;
  sheet.rows.clear();
  sheet.height = sheet.margin;
  for (std::size_t begin = 0; begin < sheet.tiles.size(); begin += static_cast<std::size_t>(columns)) {
    const std::size_t end = std::min(begin + static_cast<std::size_t>(columns), sheet.tiles.size());
    Row row{sheet.height, 0};
    std::size_t lines = 0;
    for (std::size_t t = begin; t < end; ++t) {
      row.pictureHeight = std::max(row.pictureHeight, sheet.tiles[t].size.height);
      lines = std::max(lines, sheet.tiles[t].lines.size());
    }
    sheet.rows.push_back(row);
    sheet.height += row.pictureHeight + sheet.textHeight(lines) + sheet.margin;
  }
  sheet.width = sheet.left(columns);
}

/// Rows with which the sheet's sides differ least; of equally good ones those that leave fewer gaps.
void makeNearlySquare(Sheet& sheet) {
  const int count = static_cast<int>(sheet.tiles.size());
  int best = 1, bestGaps = 0;
  double bestStretch = 0;
  for (int columns = 1; columns <= std::min(count, kMostColumns); ++columns) {
    makeRows(sheet, columns);
    const int gaps = static_cast<int>(sheet.rows.size()) * columns - count;
    const double stretch =
        std::abs(std::log(static_cast<double>(sheet.width) / static_cast<double>(sheet.height)));
    if (columns == 1 || stretch < bestStretch || (stretch == bestStretch && gaps < bestGaps)) {
      best = columns;
      bestGaps = gaps;
      bestStretch = stretch;
    }
    if (sheet.width > 4 * sheet.height) break;  // more columns only make it wider
  }
  makeRows(sheet, best);
}

Sheet arrange(const std::vector<SheetPicture>& pictures, const ContactSheetParams& params) {
  Sheet sheet;
  sheet.margin = params.margin;
  sheet.tileWidth = params.width;
  sheet.dots = std::max(1, params.width / 160);
  sheet.tiles = makeTiles(pictures, sheet);
  if (params.columns == 0)
    makeNearlySquare(sheet);
  else
    makeRows(sheet, std::min(params.columns, static_cast<int>(pictures.size())));
  return sheet;
}

void place(const Picture& picture, int left, int top, Picture& sheet) {
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(picture.rgb.data() + picture.offset(0, y), 3 * static_cast<std::size_t>(picture.width),
                sheet.rgb.data() + sheet.offset(left, top + y));
}

/// Draws picture i; writes to its own tile only.
void drawTile(const Picture& picture, std::size_t i, const Sheet& sheet, Picture& page) {
  const Tile& tile = sheet.tiles[i];
  const auto columns = static_cast<std::size_t>(sheet.columns);
  const Row& row = sheet.rows[i / columns];
  const int left = sheet.left(static_cast<int>(i % columns));
  const int bottom = static_cast<int>(row.top) + row.pictureHeight;
  // Standing on its label, so that pictures of different heights share a base line.
  place(scaledDown(picture, tile.size), left + (sheet.tileWidth - tile.size.width) / 2,
        bottom - tile.size.height, page);
  int y = bottom + 3 * sheet.dots;
  for (const std::string& line : tile.lines) {
    drawText(page, left + (sheet.tileWidth - textWidth(line, sheet.dots)) / 2, y, line, sheet.dots, kInk);
    y += kLineDots * sheet.dots;
  }
}

Picture blankPage(int width, int height) {
  Picture page{width, height, {}};
  page.rgb.resize(page.offset(0, height));
  for (std::size_t i = 0; i < page.rgb.size(); ++i) page.rgb[i] = kPaper[i % 3];
  return page;
}

}  // namespace

Result<Picture> contactSheet(const std::vector<SheetPicture>& pictures, const ContactSheetParams& params,
                             const Exec& exec) {
  SHERD_CHECK(checkInput(pictures, params));
  const Sheet sheet = arrange(pictures, params);
  if (sheet.width * sheet.height > kMostPixels)
    return failure(fmt::format("a sheet of {} pictures would have {} × {} pixels", pictures.size(),
                               sheet.width, sheet.height),
                   "narrower tiles, or fewer pictures", "width");
  Picture page = blankPage(static_cast<int>(sheet.width), static_cast<int>(sheet.height));
  parallelFor(exec, pictures.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) drawTile(*pictures[i].picture, i, sheet, page);
  });
  if (exec.cancelled()) return cancelledError();
  return page;
}

}  // namespace sherd
