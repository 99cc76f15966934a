// Reads a picture that something is painted by: the texture of a mesh, say (beta/paint_beta.h).
#pragma once

#include <string>

#include "base/exec.h"
#include "base/result.h"
#include "types/picture.h"

namespace sherd {

struct LoadPictureParams {
  std::string file;
};

/// A PNG of any kind, its values as they are (pictures/png_file.h): eight bits of red, green and blue, rows
/// from the top. Errors (port "file"), with the file's name: no such file, a folder, unreadable, no PNG,
/// damaged, too large. Cost O(file size + pixels).
Result<Picture> loadPicture(const LoadPictureParams& params, const Exec& exec);

}  // namespace sherd
