// pieces.json: what a fracture is made of, for scripts and simulators.
#pragma once

#include <string>
#include <vector>

#include "export/bonds.h"
#include "types/fragments.h"

namespace sherd {

struct PieceFileNames {
  std::string surface;
  std::string crack;  ///< empty where the piece has no crack face
};

/// All quantities are in SI units and the program's axes (y up, right-handed), which the file says;
/// `files_frame` tells how the coordinates in the piece files relate to that. `files` has one entry per
/// piece.
std::string piecesJson(const Fragments& fragments, const std::vector<Bond>& bonds,
                       const std::vector<PieceFileNames>& files);

/// What is to be known of one piece, as a JSON object: cell, mass, volume, centre_of_mass, inertia,
/// neighbours (name, contact_area, centroid, normal towards it) and parent. `own` are the piece's bonds.
std::string pieceProperties(const Fragments& fragments, std::size_t piece, const std::vector<Bond>& own);

}  // namespace sherd
