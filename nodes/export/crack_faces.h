// How crack faces are to be drawn, as exporters need it.
#pragma once

#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "geometry/crack_attributes.h"
#include "types/fragments.h"

namespace sherd {

enum class CrackNormals {
  Smooth,  ///< averaged within each sheet, with creases between sheets (geometry/crack_attributes.h)
  Flat,    ///< one per triangle: what was cut is what is seen
};

struct CrackStyle {
  CrackNormals normals = CrackNormals::Smooth;
  double textureDensity = 1;  ///< UV units per metre, above 0
};

inline constexpr const char* kCrackNormalsHelp =
    "normals of the crack faces: smooth within each sheet between two cells, with creases between sheets, or "
    "flat";
inline constexpr const char* kTextureDensityHelp =
    "how often a tiling texture repeats per metre of crack face (UV units): at 4, every 25 cm";

/// Attributes of all crack faces in the program's axes, with the precision of a float (made numbers need no
/// more digits; files are smaller for it). Errors as those of crackAttributes(), and `texture_density` out of
/// range.
Result<CrackAttributes> styledCracks(const Fragments& fragments, const CrackStyle& style, const Exec& exec);

/// Unit normals, three per outer triangle of `piece`, program axes; empty where the source has none. Those of
/// a cut triangle are interpolated and made unit again.
std::vector<Vec3> surfaceNormals(const Fragments& fragments, const Piece& piece);

/// Material of an outer triangle: index into the source's materials, −1 for `outside`.
inline Index outerMaterial(const TriMesh& source, const Piece& piece, std::size_t t) {
  return source.materialOf.empty() ? -1 : source.materialOf[at(piece.surfaceSource[t])];
}

/// What faces are made of where the artist named nothing, and what crack faces are made of.
inline constexpr const char* kOutside = "outside";
inline constexpr const char* kInside = "inside";

/// Warns where a material of the artist's has a name that would be taken for ours. A piece that is broken
/// again has ours already: its old crack faces and its new ones are of the same material.
void warnOfNames(const TriMesh& source, const Exec& exec);

}  // namespace sherd
