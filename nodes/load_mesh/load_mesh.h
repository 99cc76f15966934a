// Reads the mesh that is to be broken, in metres and y up, and makes sure that it bounds a solid.
//
// OBJ, PLY, STL and OFF are read in double precision by readers of our own; everything else (glTF, FBX, …) by
// assimp, in the single precision that it has. Positions are frame.toMetres(position in the file): with y up
// and 1 m per unit the very doubles of the file. Normals turn along; no other attribute is touched. Vertices
// of identical position are joined, collapsed triangles and unused vertices left out (weld.h), and parts that
// are inside out turned (orient.h). Nothing else is repaired: what still doesn't bound a solid is refused.
#pragma once

#include <string>

#include "base/exec.h"
#include "base/result.h"
#include "types/tri_mesh.h"

namespace sherd {

enum class UpAxis { Auto, Y, Z };

struct LoadMeshParams {
  std::string file;
  UpAxis up = UpAxis::Auto;  ///< Auto: from the file where its format says so, else y
  double unit = 0;  ///< m per unit of the file, ≥ 0; 0: from the file where its format says so, else 1 m
  double length =
      0;  ///< m, ≥ 0; above 0 the mesh is scaled so that the longest side of its bounding box has this
          ///< length, whatever the unit. Enters frame.metresPerUnit, so that frame.toFile undoes it
};

/// A closed, coherent, outward-facing 2-manifold without self-intersections, of any number of parts and
/// voids. A message tells of everything that was assumed, left out or turned. Errors (port "file" or the
/// parameter): no such file; a folder or device; unreadable; empty; not a mesh of the format that its name
/// says (with line or byte); no triangles; coordinates that are not finite, in the file or after scaling;
/// `length` of a mesh without extent; normals, texture coordinates or colours that are not finite; and one
/// error for all defects of the surface, each with its count, first place in file coordinates and what to do
/// (inspect_surface.h). Cost O(file size + triangles · log triangles).
Result<TriMesh> loadMesh(const LoadMeshParams& params, const Exec& exec);

}  // namespace sherd
