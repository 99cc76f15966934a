// A contact sheet: many pictures, each scaled to one tile's width with its label below, in rows on one sheet.
//
// A picture is scaled by averaging over the area that each pixel of the tile covers, in linear light, so that
// fine lines neither vanish nor darken. It is never enlarged: one that is smaller than its tile stands in the
// middle at its own size.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/picture.h"

namespace sherd {

struct ContactSheetParams {
  std::string file;  ///< the PNG; its directory is created where it is missing
  int columns = 0;   ///< pictures in a row, in [0, 1000]; 0: as many as make the sheet nearly square
  int width = 320;   ///< pixels, of a tile, in [32, 4096]
  int margin = 12;   ///< pixels, around and between the tiles, in [0, 256]
};

struct SheetPicture {
  std::shared_ptr<const Picture> picture;  ///< not null
  std::string label;                       ///< "frame 1001, seed 7"; may be empty
};

/// The sheet, pictures in their order, row by row. A row is as high as its highest picture, which is at most
/// 1.5 times as high as a tile is wide, and its longest label. Labels are broken into up to four lines; a
/// longer one loses its middle. Errors: parameters out of range, no pictures, a picture without pixels, a
/// sheet of more than 2^28 pixels. The same bytes for any number of threads. O(pixels of the pictures and of
/// the sheet).
Result<Picture> contactSheet(const std::vector<SheetPicture>& pictures, const ContactSheetParams& params,
                             const Exec& exec);

}  // namespace sherd
