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
constexpr int kMostLines = 4;
constexpr double kTallest = 1.5;  // of a tile's picture, in widths

/// What all tiles have in common.
struct Sheet {
  int columns = 1, rows = 1;
  PictureSize box;    ///< that each picture is made to fit into
  PictureSize tile;   ///< the room for it: the box, as high as the highest picture
  int dots = 1;       ///< pixels to a dot of the font
  int textLines = 0;  ///< below each picture
  int margin = 0;

  int textHeight() const { return textLines == 0 ? 0 : (3 + kLineDots * textLines) * dots; }
  std::int64_t step(bool across) const { return margin + (across ? tile.width : tile.height + textHeight()); }
  std::int64_t width(std::int64_t across) const { return margin + across * step(true); }
  std::int64_t height(std::int64_t down) const { return margin + down * step(false); }
};

Result<void> checkInput(const std::vector<SheetPicture>& pictures, const ContactSheetParams& params) {
  const auto check = [](int value, int low, int high, const char* name) -> Result<void> {
    if (value >= low && value <= high) return {};
    return failure(fmt::format("{} is {}", name, value), fmt::format("{} to {}", low, high), name);
  };
  SHERD_CHECK(check(params.columns, 0, 1000, "columns"));
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

/// Columns with which the sheet's sides differ least; of equally good ones those that leave fewer gaps.
int columnsOf(const Sheet& sheet, int count) {
  int best = 1, bestGaps = 0;
  double bestStretch = 0;
  for (int columns = 1; columns <= count; ++columns) {
    const int rows = (count + columns - 1) / columns, gaps = rows * columns - count;
    const double stretch = std::abs(
        std::log(static_cast<double>(sheet.width(columns)) / static_cast<double>(sheet.height(rows))));
    if (columns == 1 || stretch < bestStretch || (stretch == bestStretch && gaps < bestGaps)) {
      best = columns;
      bestGaps = gaps;
      bestStretch = stretch;
    }
  }
  return best;
}

std::vector<std::string> linesOf(const std::string& label, const Sheet& sheet) {
  return wrapText(label, (sheet.tile.width / sheet.dots + 1) / kCharacterDots, kMostLines);
}

Sheet arrange(const std::vector<SheetPicture>& pictures, const ContactSheetParams& params) {
  Sheet sheet;
  sheet.margin = params.margin;
  sheet.tile.width = params.width;
  sheet.dots = std::max(1, params.width / 160);
  sheet.box = {params.width, static_cast<int>(kTallest * params.width)};
  for (const SheetPicture& entry : pictures) {
    sheet.tile.height = std::max(sheet.tile.height, fittedSize(*entry.picture, sheet.box).height);
    sheet.textLines = std::max(sheet.textLines, static_cast<int>(linesOf(entry.label, sheet).size()));
  }
  const int count = static_cast<int>(pictures.size());
  sheet.columns = params.columns > 0 ? std::min(params.columns, count) : columnsOf(sheet, count);
  sheet.rows = (count + sheet.columns - 1) / sheet.columns;
  return sheet;
}

void place(const Picture& picture, int left, int top, Picture& sheet) {
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(picture.rgb.data() + picture.offset(0, y), 3 * static_cast<std::size_t>(picture.width),
                sheet.rgb.data() + sheet.offset(left, top + y));
}

/// Draws entry i of the sheet; writes to its own tile only.
void drawTile(const SheetPicture& entry, int i, const Sheet& sheet, Picture& page) {
  const int left = static_cast<int>(sheet.width(i % sheet.columns));
  const int top = static_cast<int>(sheet.height(i / sheet.columns));
  const PictureSize size = fittedSize(*entry.picture, sheet.box);
  // Standing on its label, so that pictures of different heights share a base line.
  place(scaledDown(*entry.picture, size), left + (sheet.tile.width - size.width) / 2,
        top + sheet.tile.height - size.height, page);
  int y = top + sheet.tile.height + 3 * sheet.dots;
  for (const std::string& line : linesOf(entry.label, sheet)) {
    drawText(page, left + (sheet.tile.width - textWidth(line, sheet.dots)) / 2, y, line, sheet.dots, kInk);
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
  const std::int64_t width = sheet.width(sheet.columns), height = sheet.height(sheet.rows);
  if (width * height > kMostPixels)
    return failure(
        fmt::format("a sheet of {} pictures would have {} × {} pixels", pictures.size(), width, height),
        "narrower tiles, or fewer pictures", "width");
  Picture page = blankPage(static_cast<int>(width), static_cast<int>(height));
  parallelFor(exec, pictures.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) drawTile(pictures[i], static_cast<int>(i), sheet, page);
  });
  if (exec.cancelled()) return cancelledError();
  return page;
}

}  // namespace sherd
