// A load's solution with smaller elements in a part of the body, without another factorization of the whole.
//
// Displacements are sought in V_H + V_h: the cage's quadratic elements, factored once, and those of the
// pieces that a part of it is divided into, zero where that part ends. Together they are the
// elements of a conforming mesh, smaller in that part. With K the stiffness of all of it, P the interpolation
// of V_H on the pieces and h the nodes of V_h, the latter are eliminated by a small factorization of their
// own,
//   S x = f_H − Pᵀ K_h K_hh⁻¹ f_h,   S = Pᵀ (K − K_h K_hh⁻¹ K_hᵀ) P,
// and conjugate gradients find x, preconditioned by the cage's factor (a Schwarz method with two overlapping
// spaces: Smith, Bjørstad and Gropp 1996, "Domain Decomposition"). Starting from nothing, u · f = 2 energy
// holds at any of its steps, and the energy rises to that of the whole space from below.
//
// Mass is where the body is, too, spread evenly over each piece: what is accelerated has to be held.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "simulate/patch_load.h"
#include "simulate/refined_region.h"
#include "simulate/sparse_cholesky.h"
#include "simulate/statics.h"

namespace sherd {

class LocalRefinement {
 public:
  /// `statics`, of quadratic elements, is referred to; `surface`: its mesh's. `divided`: its mesh's
  /// tetrahedra. Errors: no memory; a body too flat for smaller elements; cancelled. Cost: that of factoring
  /// what is divided, O(tets) beside.
  static Result<LocalRefinement> make(const Statics& statics, const DividedTets& divided,
                                      const SurfaceTree& surface, const Exec& exec);

  std::size_t pieces() const { return region_->size(); }

  /// What Statics::solve finds for `loads` (`force`: the same as nodal forces), but for displacements: of the
  /// mesh's nodes alone. The energies are those of its tetrahedra, pieces added up. `residual`: the work
  /// that what is left of the load does on what it would move, over that of the load; `refinements`:
  /// steps of conjugate gradients. Errors: cancelled.
  Result<StaticSolution> solve(std::span<const Vec3> force, std::span<const PointLoad> loads,
                               double youngModulus, const Exec& exec) const;

 private:
  using Field = std::vector<Vec3>;  ///< per element node, of the cage or of the pieces
  struct Solved {
    Field cage, pieces;  ///< x, and K_hh⁻¹ (f_h − K_hᵀ P x) with zero where fixed
    double residual;
    int steps;
  };
  explicit LocalRefinement(const Statics& statics) : statics_(&statics) {}
  Result<void> factorPieces();
  void holdWholeParts(BlockMatrix& free, std::span<const Vec3> positions) const;
  std::size_t partOfNode(std::size_t node) const;
  std::size_t partOfTet(std::size_t tet) const;
  Field interpolated(const Field& cage) const;
  void addRestricted(const Field& pieces, Field& cage) const;
  Field timesPieces(const Field& pieces) const;
  Field solvedPieces(const Field& force) const;
  Field outsideForce(const Field& cage, std::vector<double>& energy) const;
  Field timesSchur(const Field& cage) const;
  /// What it takes to accelerate nodes: Σ_j M_ij and Σ_j M_ij (X_j − centre), as in Statics.
  struct Inertia {
    std::vector<double> mass;
    Field moment;
    explicit Inertia(std::size_t nodes) : mass(nodes, 0.0), moment(nodes, Vec3::Zero()) {}
    void addElement(std::span<const Index> nodes, const Vec3& centre, std::span<const Vec3> positions,
                    double mass);
  };
  using Wrenches = std::vector<Eigen::Matrix<double, 6, 1>>;
  Field inertialForce(const Wrenches& acceleration, bool ofPieces) const;
  Field pieceForce(const Wrenches& acceleration, std::span<const PointLoad> loads) const;
  void addPointLoad(const PointLoad& load, Field& force) const;
  Result<Solved> conjugateGradients(const Field& load, const Field& pieceLoad, const Exec& exec) const;
  void setMass(const PieceRules& rules);
  void setInertia();
  void removeRigidMotion(const Solved& solved, Field& displacement) const;

  const Statics* statics_;
  std::unique_ptr<const RefinedRegion> region_;
  std::vector<Vec3> nodes_;  ///< of the pieces' mesh, in the unit of statics_
  std::unique_ptr<const ElementRules> rules_;
  std::vector<double> weight_;         ///< per piece: volume that counts
  std::vector<double> outsideVolume_;  ///< per tetrahedron of the cage: 0 where covered
  BlockMatrix stiffness_;              ///< of the pieces
  std::vector<Index> free_;            ///< element nodes of the pieces that aren't fixed
  std::vector<Inertia> inertia_;  ///< of the cage's nodes, pieces counted as what they hold; of the pieces'
  std::vector<Eigen::Matrix<double, 6, 6>> inverseGram_;  ///< (RᵀMR)⁻¹ per connected part
  std::vector<SparseCholesky> cholesky_;                  ///< one, of the free nodes
};

}  // namespace sherd
