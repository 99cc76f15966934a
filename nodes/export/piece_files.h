// The two files of a piece, as bytes.
#pragma once

#include <string>
#include <vector>

#include "export/export_crack_surface.h"
#include "types/fragments.h"

namespace sherd {

/// Unit normals, three per outer triangle of `piece`, program axes; empty where the source has none. Those of
/// a cut triangle are interpolated and made unit again.
std::vector<Vec3> surfaceNormals(const Fragments& fragments, const Piece& piece);

/// Unit normals, three per crack triangle, program axes, with the precision of a float.
std::vector<Vec3> crackNormals(const Fragments& fragments, const Piece& piece,
                               ExportCrackSurfaceParams::CrackNormals kind);

/// Crack triangles of a piece, grouped by neighbour and otherwise in their own order.
std::vector<std::size_t> crackOrder(const Piece& piece);

/// Wavefront OBJ. Of the source's attributes it holds normals, the first UV set and the materials' names.
std::string surfaceObj(const Fragments& fragments, const Piece& piece);
std::string crackObj(const Fragments& fragments, const Piece& piece,
                     ExportCrackSurfaceParams::CrackNormals kind);

/// PLY, binary little-endian, doubles. Vertices are doubled where a corner's attributes differ (their
/// coordinates are the same doubles): x y z, nx ny nz, s t, s1 t1 …, red green blue alpha, red1 …; faces
/// carry `material_index` into the comments "material 0 NAME", or `neighbour`, the other piece's place in
/// pieces.json, from 0.
std::string surfacePly(const Fragments& fragments, const Piece& piece);
std::string crackPly(const Fragments& fragments, const Piece& piece,
                     ExportCrackSurfaceParams::CrackNormals kind);

}  // namespace sherd
