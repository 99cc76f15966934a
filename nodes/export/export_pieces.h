// Writes all pieces of a fracture as one GLB file, as modelling programs and game engines read them.
//
// What is written into the directory
//   pieces.glb                   the pieces
//   sherd_pieces_manifest.json   that it is ours (owned_files.h); not the manifest of ExportCrackSurface,
//   which may
//                                write into the same directory
//
// Metres, y up, whatever the source file had. One node and mesh per piece, both named as the piece
// ("piece_0001"), without parents; the node stands at the piece's centre of mass (rounded to a float), and
// vertices are relative to it. `extras` of the node: cell, mass, volume, centre_of_mass, inertia, neighbours
// (name, contact_area, centroid, normal towards it), parent; SI units.
//
// A mesh has one primitive for each material: the artist's own, `outside` for faces that have none, `inside`
// for crack faces, those of earlier fractures included. Two pieces hold the same material, not two of the
// same name.
//   outside   NORMAL, TEXCOORD_0…, COLOR_0… as far as the source has them, cut triangles with the
//   interpolation
//             of their corners. Colours are kept within [0, 1], as the format demands (with a warning).
//   inside    NORMAL, and the generated UVs (geometry/crack_attributes.h) in as many sets as the source has,
//   at
//             least one: whichever set a material reads, crack faces have UVs there. No colours: where a
//             primitive lacks them readers take white, which changes nothing.
// So primitives of one mesh differ in their attributes where the source has colours, or lacks normals or UVs.
// Readers that join them fill in white, zeros, or flat normals.
//
// Coordinates are floats. A vertex is off by at most 2⁻²⁴ of its distance from its piece's centre (along each
// axis), and since the node's place is a float already, readers add nothing to that: twins agree to 10⁻⁷ of
// the size.
#pragma once

#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "export/crack_faces.h"
#include "types/fragments.h"

namespace sherd {

struct ExportPiecesParams {
  std::string directory;  ///< created where it is missing
  CrackNormals crackNormals = CrackNormals::Smooth;
  double textureDensity = 1;  ///< UV units per metre on crack faces, above 0
};

struct ExportPiecesReport {
  std::string file;                ///< path of pieces.glb
  std::vector<std::string> files;  ///< that, and the manifest
  bool written = false;            ///< false where it held the same bytes already and was not touched
};

/// Fragments must be whole: tets->surface set, at least one piece, indices in range. A foreign pieces.glb in
/// the directory is an error before anything is written; otherwise nothing else in it is touched. Errors:
/// there is no piece, a crack triangle has no twin, or a number is too large for a float (`pieces`); the
/// texture density
/// (`texture_density`); the directory cannot be made or written, the disk is full, the manifest is damaged
/// (`directory`). After an error or a cancel the file is as it was. Cost O(n log n) in the number of
/// triangles.
Result<ExportPiecesReport> exportPieces(const Fragments& fragments, const ExportPiecesParams& params,
                                        const Exec& exec);

}  // namespace sherd
