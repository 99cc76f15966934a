// The part of a cage that is divided for one load, and a ring of tetrahedra around it: their pieces, and how
// much of the body each holds.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/exec.h"
#include "geometry/surface_tree.h"
#include "simulate/elements.h"
#include "simulate/tet_bisection.h"
#include "types/tet_mesh.h"

namespace sherd {

/// The least share of stiffness that a piece has (kLeastShare, of pieces).
inline constexpr double kLeastPieceShare = 1e-6;

/// The pieces of those tetrahedra that `divided` divides and, in one piece, of those that share nodes with
/// them; and their quadratic elements. Without that ring the coarse functions at the border would be
/// corrected apart from the fine ones beside them, in many more steps.
class RefinedRegion {
 public:
  /// Refers to `cage`. Cost O(tets + pieces log pieces).
  RefinedRegion(const Elements& cage, const DividedTets& divided);

  bool empty() const { return parent_.empty(); }
  const Elements& elements() const { return *elements_; }  ///< of the pieces; nodes in metres
  std::size_t size() const { return parent_.size(); }
  Index parent(std::size_t piece) const { return parent_[piece]; }
  /// Tetrahedron t's: pieces begin(t) … begin(t + 1) − 1; none if it is not covered.
  std::size_t begin(std::size_t t) const { return begin_[t]; }
  bool covers(std::size_t t) const { return begin_[t] < begin_[t + 1]; }
  /// Of the cage, that this node of the pieces' mesh is; −1 for the middle of an edge.
  Index cageNode(std::size_t node) const { return cageNode_[node]; }

  /// Per element node: is it on a tetrahedron that isn't covered too? Functions of the pieces are zero there.
  const std::vector<char>& fixed() const { return fixed_; }
  /// Per element node, a tetrahedron of the cage that it lies in, and the values of its shape functions
  /// there.
  struct Place {
    Index tet;
    std::array<double, kMostElementNodes> value;
  };
  const std::vector<Place>& places() const { return places_; }

 private:
  void takePieces(const DividedTets& divided);
  void findFixed();
  void findPlaces();

  const Elements& cage_;
  std::shared_ptr<const Elements> elements_;
  std::vector<Index> parent_, cageNode_;
  std::vector<std::size_t> begin_;  ///< per tetrahedron of the cage, and one more
  std::vector<char> fixed_;
  std::vector<Place> places_;
};

/// Per piece, the rule that integrates its energy over its part inside the surface, the share of its
/// stiffness that counts, and that of its volume which is inside.
struct PieceRules {
  std::vector<ElementRule> rule;
  std::vector<double> share, inside;
};

/// What tetrahedra of the cage have beyond their insideFraction (`share`: stiffnessShares) is spread evenly
/// over their pieces, so that pieces add up to their tetrahedron (but for kLeastPieceShare). `surface`: the
/// cage's. Cost O(pieces × triangles held by their tetrahedron); unfit for use when cancelled.
PieceRules pieceRules(const RefinedRegion& region, const TetMesh& cage, std::span<const double> share,
                      const SurfaceTree& surface, const Exec& exec);

}  // namespace sherd
