// Quasi-static, linear elasticity of a free body (Müller et al. 2001; Schvartzman and Otaduy
// 2014, section 2.3).
//
// Linear tetrahedra of an isotropic material:  K u = f,  energy per tetrahedron  ½ uᵀ K_t u = f_t V_t W(ε),
//   W(ε) = λ/2 tr(ε)² + μ ε:ε,  λ = E ν / ((1 + ν)(1 − 2ν)),  μ = E / (2 (1 + ν)),
// where f_t is the share of the tetrahedron inside the surface: what is outside has neither
// stiffness nor mass.
//
// A body that floats has no supports, and K six null modes R per connected part. Inertia relief balances the
// load by the d'Alembert forces of the rigid acceleration that it causes, f_b = f − M R (RᵀMR)⁻¹ Rᵀ f with
// the consistent mass matrix M, so that Rᵀ f_b = 0. Three nodes of each part are then held by six springs,
// which carry no force under a balanced load: their choice (the gauge) changes u by a rigid motion, which is
// removed (RᵀM u = 0), and no energy.
//
// Symbols: X node position (m), u displacement (m), f nodal force (N), E Young's modulus
// (Pa), ν Poisson's ratio.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "simulate/sparse_cholesky.h"
#include "types/material.h"
#include "types/tet_mesh.h"

namespace sherd {

/// The least share of inside volume that a node rests on. Where a node's tetrahedra hold less, each of them
/// is given at least this share of stiffness: a node that hardly anything of the body belongs to would
/// otherwise make K singular, or turn the little load that reaches it into an energy without bound (the
/// share of a load falls with the first power of how deep the surface reaches into a tetrahedron, its
/// stiffness with the third).
inline constexpr double kLeastSupport = 0.02;

struct StaticSolution {
  std::vector<Vec3> displacement;  ///< m, per node, free of rigid motion in the sense of the mass matrix
  std::vector<double> tetEnergy;   ///< J, per tetrahedron, ≥ 0
  double work = 0;                 ///< J: ½ u · f, equal to the sum of tetEnergy up to rounding
};

/// One body, factored once, for any number of loads. Only ν enters the factorization: E and the load scale.
class Statics {
 public:
  /// `gaugeNode`: node that the springs start from, −1 for the one farthest from the part's centre. Used for
  /// the part that it belongs to. Errors: flat or inverted tetrahedra, tetrahedra that hang together by less
  /// than faces, no memory, cancelled.
  static Result<Statics> factor(std::shared_ptr<const TetMesh> mesh, double poissonRatio, const Exec& exec,
                                Index gaugeNode = -1);

  /// force: N, per node. Cost: two back-substitutions (the second for the residual), O(tets).
  StaticSolution solve(std::span<const Vec3> force, double youngModulus) const;

  /// The load plus the d'Alembert forces: no net force or moment on any connected part. N, per node.
  std::vector<Vec3> balanced(std::span<const Vec3> force) const;
  /// K u, N per node, for u in metres.
  std::vector<Vec3> internalForce(std::span<const Vec3> displacement, double youngModulus) const;
  /// J per tetrahedron, for u in metres.
  std::vector<double> tetEnergies(std::span<const Vec3> displacement, double youngModulus) const;

  std::size_t partCount() const { return parts_.size(); }
  double factorSize() const { return cholesky_.factorSize(); }

 private:
  /// A connected part's rigid modes: three translations, and three rotations about `centre`.
  struct Part {
    Vec3 centre = Vec3::Zero();               ///< of mass, in units of size_
    Eigen::Matrix<double, 6, 6> inverseGram;  ///< (RᵀMR)⁻¹
  };
  using Wrench = Eigen::Matrix<double, 6, 1>;  ///< force and moment, or velocity and spin

  Statics(std::shared_ptr<const TetMesh> mesh, SparseCholesky cholesky)
      : mesh_(std::move(mesh)), cholesky_(std::move(cholesky)) {}
  std::vector<Wrench> wrenches(std::span<const Vec3> force) const;
  std::vector<Vec3> rigidField(const std::vector<Wrench>& motion) const;
  void removeRigidMotion(std::vector<Vec3>& displacement) const;
  void setParts(Index count);

  std::shared_ptr<const TetMesh> mesh_;
  SparseCholesky cholesky_;
  double size_ = 1, poisson_ = 0;
  std::vector<Vec3> nodes_;                           ///< in units of size_, about the bounding box's centre
  std::vector<double> stiffnessVolume_, massVolume_;  ///< per tetrahedron, size_³: shares times volume
  std::vector<Index> partOf_;                         ///< per node
  std::vector<Part> parts_;
};

}  // namespace sherd
