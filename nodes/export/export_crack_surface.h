// Writes the pieces of a fracture: for each its outer skin and its crack faces, and a description of all of
// them.
//
// What is written into the directory
//   piece_0001_surface.obj  the outer skin of piece 1, with the artist's normals, first UV set and materials
//                           (`outside` where there is none); cut triangles carry the interpolation of their
//                           source triangle's corners
//   piece_0001_crack.obj    its crack faces, material `inside`, one group per neighbour, with normals and UVs
//                           (geometry/crack_attributes.h); none where it has no crack
//   pieces.mtl              where the file that the mesh came from says what its materials look like: that,
//   and
//                           `outside` and `inside`
//   pieces_texture_01_….png the pictures that it names, byte for byte (material_files.h)
//   pieces.json             N, E_D, γ; per piece mass, volume, centre of mass, inertia, neighbours; bonds
//                           (pieces_json.h)
//   sherd_manifest.json     which of the directory's files are ours, with digests (owned_files.h)
// or the same with PLY (binary, double), which holds all UV sets and colours, but of
// materials the names only.
//
// The two files of a piece together are closed, and a vertex that several files share is the same three
// doubles in all of them: coordinates are written with as many digits as bring back the very double (at most
// 17), in the unit and axes of the file that the mesh came from. Only where that unit is not the metre do
// they go through one division, equal for all files, so that twins stay twins.
#pragma once

#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "export/crack_faces.h"
#include "types/fragments.h"

namespace sherd {

struct ExportCrackSurfaceParams {
  enum class Format { Obj, Ply };
  std::string directory;  ///< created where it is missing
  Format format = Format::Obj;
  CrackNormals crackNormals = CrackNormals::Smooth;
  double textureDensity = 1;  ///< UV units per metre on crack faces, above 0
};

struct ExportReport {
  std::string description;  ///< path of pieces.json
  std::vector<std::string>
      files;                ///< paths of all files that now hold the result, in order of their names' making
  std::size_t written = 0;  ///< of these, how many were written
  std::size_t kept = 0;     ///< and how many held the same bytes already and were not touched
  std::size_t removed = 0;  ///< files of an earlier run that are no part of this result
};

/// Fragments must be whole: tets->surface set, at least one piece, names piece_0001 and so on, indices in
/// range. Files of an earlier run that the manifest lists are replaced or removed; anything else is left
/// alone, and a foreign file under one of our names is an error before anything is written. Says what was
/// written, and where nothing broke, that, with E_D and γ. Errors: a crack triangle has no twin (`pieces`);
/// the directory cannot be made or written, the disk is full, a foreign file is in the way, the manifest is
/// damaged
/// (`directory`). An old pieces.json is removed before the first file that changes is written, and the new
/// one comes last: after an error or a cancel every file is either whole or absent, a directory without
/// pieces.json is incomplete, and the next run cleans up. Cost O(n log n) in the number of triangles.
Result<ExportReport> exportCrackSurface(const Fragments& fragments, const ExportCrackSurfaceParams& params,
                                        const Exec& exec);

}  // namespace sherd
