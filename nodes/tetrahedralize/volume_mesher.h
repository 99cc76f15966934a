// Delaunay refinement of an implicit volume (CGAL Mesh_3, hidden here).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/vec.h"

namespace sherd {

/// What to mesh: {x : field(x) < 0}, and how finely. All functions are called from one thread, many times.
struct VolumeToMesh {
  std::function<double(const Vec3&)> field;
  std::function<double(const Vec3&)> edgeLength;     ///< aimed at near x
  std::function<double(const Vec3&)> facetDistance;  ///< between facets and the zero set near x
  Box box;                                           ///< holds the volume
  double precision;                                  ///< to which points of the zero set are found
  std::vector<Vec3> seeds;                           ///< points near the zero set, some on every part of it
};

struct Tetrahedra {
  std::vector<Vec3> nodes;
  std::vector<Tetra> tets;  ///< positively oriented
};

/// A run of Mesh_3 that can still be improved. After a failure, or when cancelled, it can only be destroyed.
class VolumeMesh {
 public:
  VolumeMesh();
  ~VolumeMesh();
  VolumeMesh(VolumeMesh&&) noexcept;
  VolumeMesh& operator=(VolumeMesh&&) noexcept;

  /// Refines until all criteria are met, with a manifold boundary. Fails when CGAL does.
  static Result<VolumeMesh> refine(const VolumeToMesh& volume, const Exec& exec);
  std::size_t tetCount() const;
  /// Moves and weights nodes against slivers: perturbation, then exudation, up to the given dihedral angles
  /// (degrees), without limits of time, since those would make the result depend on the clock. Perturbation
  /// may pinch the boundary: where `good` says no to what it made of a good mesh, it is taken back. A bound
  /// of 0 leaves it out.
  Result<void> removeSlivers(double perturbBound, double exudeBound,
                             const std::function<bool(const Tetrahedra&)>& good, const Exec& exec);
  Tetrahedra extract() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sherd
