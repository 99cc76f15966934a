// The tetrahedra as they are to be looked at: whole, or cut open by a plane.
#pragma once

#include <optional>

#include "preview/soups.h"
#include "types/fields.h"
#include "types/partition.h"

namespace sherd {

/// What lies at x[axis] > offset (m) is taken away: the camera looks from there, whichever the axis.
struct SlicePlane {
  int axis = 0;
  double offset = 0;
};

/// The outer faces of the tetrahedra and, where they are cut open, the section through them, each cell in its
/// colour. Borders between cells lie where two sites are equally near, as Tessellate cuts (among the sites
/// that are nearest to a corner of the tetrahedron). Faces are flat.
Soup cellsSoup(const Partition& cells, const std::optional<SlicePlane>& cut, const PictureSpace& space);

/// The same with the density of the strain energy, J/m³, by the scale.
Soup energySoup(const EnergyField& energy, const EnergyScale& scale, const std::optional<SlicePlane>& cut,
                const PictureSpace& space);

/// Per node, J/m³: e_n / V_n, 0 where the node has no volume.
std::vector<double> nodeEnergyDensity(const EnergyField& energy);

}  // namespace sherd
