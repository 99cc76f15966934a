// From the program's bodies to triangles to be looked at.
#pragma once

#include <vector>

#include "preview/scene.h"
#include "types/fields.h"
#include "types/fragments.h"

namespace sherd {

/// Picture space: (x − centre) / size.
struct PictureSpace {
  Vec3 centre = Vec3::Zero();
  double size = 1;  ///< m

  static PictureSpace of(const TriMesh& mesh);
  Vec3f place(const Vec3& x) const { return ((x - centre) / size).cast<float>(); }
};

/// Unit normals per corner: the artist's, or averages over the triangles around a vertex that meet at less
/// than 40°.
std::vector<Vec3> shadingNormals(const TriMesh& mesh);

/// The whole surface in one colour.
Soup wholeSoup(const TriMesh& mesh, const std::vector<Vec3>& normals, const PictureSpace& space,
               const Colour& colour);

/// The pieces, each moved by `explode` times the way from the body's centre of mass to its own. `normals` are
/// those of the whole surface, `crackNormals` those of each piece's crack corners.
Soup piecesSoup(const Fragments& fragments, const std::vector<Vec3>& normals,
                const std::vector<std::vector<Vec3>>& crackNormals, const PictureSpace& space,
                double explode);

/// Energy density at the vertices of the surface that the field's tetrahedra hold, J/m³.
std::vector<double> surfaceEnergyDensity(const EnergyField& energy);

/// What the energy colours stand for, J/m³: `low` is the darkest, `high` the lightest; both 0 where there is
/// none.
struct EnergyScale {
  double low = 0, high = 0;
  float place(double density) const;
};
EnergyScale energyScale(std::vector<double> densities);

}  // namespace sherd
