// A perspective camera that is placed so that everything is in the picture.
#pragma once

#include <vector>

#include "preview/scene.h"

namespace sherd {

/// Unit, orthogonal axes; a point at depth z ahead is seen where |x| ≤ z tanX, |y| ≤ z tanY.
struct Camera {
  Vec3f eye = Vec3f::Zero(), right = Vec3f::UnitX(), up = Vec3f::UnitY(), ahead = -Vec3f::UnitZ();
  float tanX = 1, tanY = 1;

  /// Unit direction through the picture's point (x, y) in [−1, 1]², y up.
  Vec3f ray(float x, float y) const { return (ahead + x * tanX * right + y * tanY * up).normalized(); }
};

/// A three-quarter view from above, from the side on which the body is wider, with `points` filling `share`
/// of a picture of this aspect (width / height).
Camera threeQuarterView(const std::vector<Vec3f>& points, float aspect, float share);

}  // namespace sherd
