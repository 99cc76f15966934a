// Triangles to be looked at, and rays through them (Embree).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "preview/colour.h"

namespace sherd {

using Vec3f = Eigen::Vector3f;

/// Loose triangles in picture space (the body's size is about 1). Corner c of triangle t is entry 3 t + c.
struct Soup {
  std::vector<Vec3f> corners;
  std::vector<Vec3f> normals;  ///< unit, per corner
  std::vector<float> values;   ///< empty, or in [0, 1] per corner: shown by energyColour
  std::vector<Index> paint;    ///< per triangle, index into palette; not used with values
  std::vector<Colour> palette;
};

struct Hit {
  float distance = 0;
  Vec3f geometricNormal, normal;  ///< unit, towards the viewer
  Colour colour;
};

class Scene {
 public:
  /// Builds the search tree on one thread, so that ties between triangles fall the same way each time. Ends
  /// when cancelled.
  static Result<Scene> make(Soup soup, const Exec& exec);
  ~Scene();
  Scene(Scene&&) noexcept;

  /// Rays have unit directions. Safe from several threads at once.
  bool firstHit(const Vec3f& origin, const Vec3f& direction, Hit& hit) const;
  bool occluded(const Vec3f& origin, const Vec3f& direction, float reach) const;
  const Soup& soup() const;

 private:
  struct Impl;
  explicit Scene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
