// Reads the mesh that is to be broken, in metres and y up, and makes sure that it bounds a solid.
//
// OBJ, PLY, STL and OFF are read in double precision by readers of our own; everything else (glTF, FBX, …) by
// assimp, in the single precision that it has. Positions are frame.toMetres(position in the file): with y up
// and 1 m per unit the very doubles of the file. Normals turn along; no other attribute is touched.
// Materials come with what they look like: from the file or, for OBJ, from the .mtl files that it names;
// textures beside the file or in it (load_mesh/file_looks.h). What of that can't be had is a warning by name.
// Vertices of identical position are joined, collapsed triangles and unused vertices left out (weld.h). What
// then doesn't bound a solid is repaired or refused (repair.h).
#pragma once

#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/tri_mesh.h"

namespace sherd {

enum class UpAxis { Auto, Y, Z };
enum class RepairMode {
  Auto,   ///< mends what is wrong with the surface, as step repair does by default
  Strict  ///< refuses whatever is wrong, parts that are inside out included
};

struct LoadMeshParams {
  std::string file;
  UpAxis up = UpAxis::Auto;  ///< Auto: from the file where its format says so, else y
  double unit = 0;  ///< m per unit of the file, ≥ 0; 0: from the file where its format says so, else 1 m
  double length =
      0;  ///< m, ≥ 0; above 0 the mesh is scaled so that the longest side of its bounding box has this
          ///< length, whatever the unit. Enters frame.metresPerUnit, so that frame.toFile undoes it
  RepairMode repair = RepairMode::Auto;
};

/// A closed, coherent, outward-facing 2-manifold without self-intersections, of any number of parts and
/// voids. A message tells of everything that was assumed, left out or repaired; warnings of what changed the
/// visible surface. Errors (port "file" or the parameter): no such file; a folder or device; unreadable;
/// empty; not a mesh of the format that its name says (with line or byte); no triangles; coordinates that are
/// not finite, in the file or after scaling; `length` of a mesh without extent; normals, texture coordinates
/// or colours that are not finite; where it is to be strict one error for all defects of the surface, each
/// with its count, first place in file coordinates and what to do (geometry/inspect_surface.h); else what
/// could not be repaired. Cost O(file size + triangles · log triangles) for a sound surface, and that of
/// repair.h for others.
Result<TriMesh> loadMesh(const LoadMeshParams& params, const Exec& exec);

/// The paths of all files beside a mesh file that loadMesh() may read with it, whether they are there or not:
/// material libraries, textures and buffers of OBJ, glTF and GLB files. Never fails; reads the file.
std::vector<std::string> filesReadWith(const std::string& meshFile);

}  // namespace sherd
