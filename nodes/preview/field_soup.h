// A painted field on the surface, as it is to be looked at.
#pragma once

#include "preview/soups.h"
#include "types/scalar_grid.h"

namespace sherd {

/// What the colours stand for: evenly from the least to the greatest value that is shown.
struct FieldScale {
  double low = 0, high = 0;
  bool isOne() const { return !(high > low); }
  float place(double value) const {
    return static_cast<float>((value - low) / (high - low));
  }  ///< unless one
};

struct FieldSoup {
  Soup soup;
  FieldScale scale;
};

/// The whole surface with the field's values, or in the neutral colour where these are one. Triangles are
/// divided until the field is sampled about a hundred times along the body, so that paint shows on coarse
/// models, too. Errors: a value that isn't finite.
Result<FieldSoup> fieldSoup(const TriMesh& mesh, const std::vector<Vec3>& normals, const ScalarGrid& field,
                            const PictureSpace& space);

}  // namespace sherd
