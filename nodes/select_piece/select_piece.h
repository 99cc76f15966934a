// A piece of a fracture as a body of its own, to be broken again.
//
// The closed surface of one piece: its outer skin with the attributes that it came with, cut corners
// interpolated (cornerAttribute), and its crack faces in the material `inside`, with smooth
// normals and texture coordinates in metres (geometry/crack_attributes.h). It is a surface like one that
// LoadMesh gives: whatever takes that takes this, and so on down: a piece of a piece of a piece.
//
// Names grow with depth: the pieces of piece_0003 are piece_0003_0001, piece_0003_0002 and so on, unique over
// all that one body ever breaks into.
#pragma once

#include <string>

#include "base/exec.h"
#include "base/result.h"
#include "types/fragments.h"
#include "types/tri_mesh.h"

namespace sherd {

struct SelectPieceParams {
  std::string piece = {};  ///< its name; empty: by `number`
  int number = 1;          ///< ≥ 1: 1 is the piece of largest volume, 2 the next
};

struct SelectedPiece {
  /// Only the vertices that the piece uses, in their order in Fragments::positions; skin before crack. Frame
  /// and source are the body's, `piece` is the piece's name. Materials are the body's, then `inside` unless
  /// it is among them; a body without materials gets `outside` for its skin. Looks are shared. Normals, UV
  /// and colour sets are those of the body: where it has none, nor has the piece; crack faces are white.
  TriMesh mesh;
  std::size_t touching = 0;  ///< vertices doubled where parts of the piece touch in a point or along an edge
};

/// `fragments` as Tessellate makes them. Positions are the very doubles of the pieces, so the volume of the
/// result is the piece's. Errors: no piece of that name, or not as many pieces as `number`, with what there
/// is. Cost O(n log n) in the triangles of the piece.
Result<SelectedPiece> selectPiece(const Fragments& fragments, const SelectPieceParams& params,
                                  const Exec& exec);

}  // namespace sherd
