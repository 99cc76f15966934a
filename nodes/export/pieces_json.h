// pieces.json: what a fracture is made of, for scripts and simulators.
#pragma once

#include <string>
#include <vector>

#include "types/fragments.h"

namespace sherd {

struct PieceFileNames {
  std::string surface;
  std::string crack;  ///< empty where the piece has no crack face
};

/// All quantities are in SI units and the program's axes (y up, right-handed), which the file says; `length`
/// tells how the coordinates in the piece files relate to that. `files` has one entry per piece.
std::string piecesJson(const Fragments& fragments, const std::vector<PieceFileNames>& files);

}  // namespace sherd
