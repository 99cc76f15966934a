// Where the tetrahedra of a cage are too large for an impact, and its energies with smaller ones there.
//
// Two things make a strain energy too low in a cage of some thousand tetrahedra: a contact patch smaller than
// their edges, whose dent they can't follow, and a lot of the energy in a few of them, as where a leg of one
// tetrahedron's width bends. So edges are at most kPatchEdges radii long in a patch, and longer by a metre
// per metre away from it; and no tetrahedron keeps more than kLargestShare of the energy found without (more
// where there are fewer than kShareTets of them), but is divided into about as many pieces as there are such
// shares in it. What that costs is about what the cage itself costs, at any size of it.
#pragma once

#include <memory>
#include <span>

#include "base/exec.h"
#include "base/result.h"
#include "simulate/patch_load.h"
#include "simulate/statics.h"
#include "types/fields.h"

namespace sherd {

inline constexpr double kPatchEdges = 0.5;       ///< radii
inline constexpr double kLargestShare = 0.0025;  ///< of the energy, in meshes of kShareTets or more
inline constexpr double kShareTets = 5000;
/// Edges are halved for energy's sake at most to this share of the tetrahedron's longest.
inline constexpr double kShortestShare = 0.25;

struct RefinementParams {
  double patchEdges = kPatchEdges, largestShare = kLargestShare;
};

/// One body's, for any number of impacts. Cost of making O(triangles log triangles).
class ImpactRefinement {
 public:
  /// `statics`, of quadratic elements, is referred to.
  explicit ImpactRefinement(const Statics& statics, const RefinementParams& params = {});
  ~ImpactRefinement();

  /// Replaces the solution of an impact (`loads` of all its contacts, `force` the same as nodal forces) by
  /// that with smaller elements; leaves it as it is where tetrahedra are small enough, and, warning of it,
  /// where rounding is too much for smaller ones (bodies as flat as paper). Returns the number of pieces. The
  /// same for any number of threads. Errors: cancelled.
  Result<std::size_t> refine(const Impact& impact, std::span<const Vec3> force,
                             std::span<const PointLoad> loads, double youngModulus, StaticSolution& solution,
                             const Exec& exec) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace sherd
