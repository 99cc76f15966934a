// The two files of a piece, as bytes.
#pragma once

#include <string>
#include <vector>

#include "export/crack_faces.h"
#include "types/fragments.h"

namespace sherd {

/// Crack triangles of a piece, grouped by neighbour and otherwise in their own order.
std::vector<std::size_t> crackOrder(const Piece& piece);

/// Wavefront OBJ. Of the source's attributes it holds normals, the first UV set and the materials' names, or
/// `outside` where there is none; skin is in the group "g A" of its piece. Crack faces are `inside`, one
/// group per neighbour: "g A_crack_with_B". The group's line follows the material's each time: faces that an
/// earlier fracture laid bare are skin now, though their material is `inside`.
std::string surfaceObj(const Fragments& fragments, const Piece& piece);
std::string crackObj(const Fragments& fragments, const Piece& piece, const CrackCorners& cracks);

/// PLY, binary little-endian, doubles. Vertices are doubled where a corner's attributes differ (their
/// coordinates are the same doubles): x y z, nx ny nz, s t, s1 t1 …, red green blue alpha, red1 …. Faces
/// of the skin carry `material_index` into the comments "material 0 NAME"; those of the crack `neighbour`,
/// the other piece's place in pieces.json, from 0, named in the comments "neighbour 3 piece_0004". Crack
/// faces have normals and one UV set.
std::string surfacePly(const Fragments& fragments, const Piece& piece);
std::string crackPly(const Fragments& fragments, const Piece& piece, const CrackCorners& cracks);

}  // namespace sherd
