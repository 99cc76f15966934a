// Contact forces as nodal loads: a pressure over a patch of the surface, handed to the
// tetrahedra that hold it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "simulate/elements.h"
#include "types/tet_mesh.h"

namespace sherd {

/// The longest edge of a quadrature piece, in radii of the patch: an eighth of its width.
inline constexpr double kPatchPiece = 0.25;

/// A force (N, rest space) at a point of tetrahedron `tet`.
struct PointLoad {
  Index tet;
  Vec4 barycentric;
  Vec3 force;
};

/// Finds patches on one body and loads them. Building costs O(tets + held triangles).
class PatchLoader {
 public:
  explicit PatchLoader(std::shared_ptr<const Elements> elements, double piece = kPatchPiece);

  /// What `force` (N, rest space) acting at `point` (m, on or near the surface) presses on the tetrahedra
  /// with.
  ///
  /// The patch is what lies within `radius` (m, > 0) of the point, is connected within it to the surface at
  /// the point (so that the far side of a thin wall isn't loaded), and faces the force (n·F < 0; all of it
  /// where nothing does). Pressure falls off like Hertz's, √(1 − r²/a²), by quadrature on pieces of
  /// `piece` or less. A patch that is lopsided about the point would act off it: the traction gets
  /// the smallest rigid rotation of forces that makes net force and moment those of `force` at `point`.
  /// Errors: the tetrahedra don't hold the surface there. Cost O(triangles) to find the patch, then O(pieces
  /// of the patch × tetrahedra per triangle).
  Result<std::vector<PointLoad>> pointLoads(const Vec3& point, const Vec3& force, double radius) const;
  /// Adds their nodal forces (N, per element node): a tetrahedron's nodes get the values of their shape
  /// functions, which are exact for force and moment.
  void hand(std::span<const PointLoad> loads, std::vector<Vec3>& nodeForce) const;
  /// Both.
  Result<void> add(const Vec3& point, const Vec3& force, double radius, std::vector<Vec3>& nodeForce) const;
  /// How many points that takes.
  std::size_t pointCount(const Vec3& point, const Vec3& force, double radius) const;

 private:
  struct Sample {
    Vec3 position;
    double weight;
    Index triangle;
  };
  struct Patch {
    Index seed = -1;  ///< the triangle at the point; of several, one that faces the force
    std::vector<Index> triangles;
  };
  Patch patch(const Vec3& point, const Vec3& force, double radius) const;
  std::vector<Index> connectedTo(Index seed, const std::vector<Index>& triangles) const;
  void samplePiece(const Vec3& point, double radius, Index triangle, const std::array<Vec3, 3>& piece,
                   std::vector<Sample>& samples) const;
  std::vector<Sample> quadrature(const Vec3& point, double radius, const std::vector<Index>& triangles) const;
  Result<PointLoad> located(const Sample& sample, const Vec3& force) const;
  std::array<Vec3, 3> corners(Index triangle) const;
  double distanceTo(Index triangle, const Vec3& point) const;

  std::shared_ptr<const Elements> elements_;
  const TetMesh* mesh_;  ///< of elements_
  double piece_;
  std::vector<Index> tetBegin_,
      tetHolding_;  ///< per surface triangle, the tetrahedra that hold (a part of) it
};

}  // namespace sherd
