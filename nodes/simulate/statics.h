// Quasi-static, linear elasticity of a free body (Müller et al. 2001; Schvartzman and Otaduy
// 2014, section 2.3).
//
// Linear or quadratic tetrahedra (elements.h) of an isotropic material:
//   K u = f,  energy per tetrahedron  ½ uᵀ K_t u = ∫ W(ε) dV,
//   W(ε) = λ/2 tr(ε)² + μ ε:ε,  λ = E ν / ((1 + ν)(1 − 2ν)),  μ = E / (2 (1 + ν)),
// over the part of the tetrahedron inside the surface (element_rules.h): what is outside has no stiffness.
// Mass is the inside's too, spread evenly over the tetrahedron.
//
// Nearly incompressible materials. As ν → ½, λ grows without bound, and elements that cannot keep their
// volume at every point while they bend lock. Beyond ν = 0.4 the surplus of λ (VolumetricSplit) therefore
// acts on averages of the volume strain: quadratic elements take each one's mean (selective reduced
// integration, the B-bar of Hughes 1980), linear ones the mean over each node's tetrahedra (Bonet and Burton
// 1998). Both keep K symmetric and positive, constant strains exact (patch test) and ν ≤ 0.4 as it is
// without; nodal means couple the nodes of two rings, which makes the factor some three times as large.
// Measured to ν = 0.4999.
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
#include "simulate/assembly.h"
#include "simulate/elements.h"
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

/// The same for quadratic elements. Such a layer around the body is a foam glued to it, which resists bending
/// with the third power of its thickness: around an ear 2 % of the stiffness take a third of the energy,
/// 0.01 % nothing that could be measured. Elements that are integrated over their part inside need no more.
inline constexpr double kLeastQuadraticSupport = 1e-4;

/// The least share of stiffness that any tetrahedron has. Nodes may rest on enough and two groups of them
/// still hang together by next to nothing, or by tetrahedra wholly outside: that is held up here, so that no
/// motion of the parts is free. It is what would be left of a neck of a thousandth of a tetrahedron's width.
inline constexpr double kLeastShare = 1e-6;

/// A solution whose residual is larger than this is none: the energy's digits are lost.
inline constexpr double kWorstResidual = 1e-6;

struct StaticsParams {
  double poissonRatio = 0.2;  ///< in (−1, 0.5)
  ElementOrder elements = ElementOrder::Linear;
  /// A node of the mesh that the springs start from, −1 for the one farthest from the part's centre. Used for
  /// the part that it belongs to.
  Index gaugeNode = -1;
  /// λ / μ up to which λ acts at every point; beyond, on averages. Infinity: plain elements, which lock.
  double largestFull = VolumetricSplit::kLargestFull;
};

struct StaticSolution {
  /// m, per element node (the mesh's come first), free of rigid motion in the sense of the mass matrix.
  std::vector<Vec3> displacement;
  std::vector<double> tetEnergy;  ///< J, per tetrahedron, ≥ 0
  double work = 0;                ///< J: ½ u · f, equal to the sum of tetEnergy up to rounding
  /// What is left of the balanced load f_b: the larger of ‖f_b − K u‖ / ‖f_b‖ and its work on u over that of
  /// f_b. 1e-10 and 1e-12 are aimed at; far worse than that is a body for which K is singular to rounding.
  double residual = 0;
  int refinements = 0;  ///< steps taken for it
};

/// One body, factored once, for any number of loads. Only ν enters the factorization: E and the load scale.
/// Loads and displacements are per node of elements(): of the mesh, then mid-edge ones.
class Statics {
 public:
  /// Errors: flat or inverted tetrahedra, tetrahedra that hang together by less than faces, no memory,
  /// cancelled. Cost for a solid body of n element nodes: O(n²) time, O(n^4/3) memory.
  static Result<Statics> factor(std::shared_ptr<const TetMesh> mesh, const StaticsParams& params,
                                const Exec& exec);

  /// force: N, per element node. Cost: a back-substitution, O(tets), and the same again for each step of
  /// refinement that the residual asks for (at most four: slivers and soft nodes cost digits). Whoever uses
  /// the solution has to look at its residual.
  StaticSolution solve(std::span<const Vec3> force, double youngModulus) const;

  /// solve() for each of `forces`, to the bit and whatever their number, in parallel blocks of kSolveWidth
  /// that read the factor once. Errors: cancelled.
  Result<std::vector<StaticSolution>> solveAll(std::span<const std::vector<Vec3>> forces, double youngModulus,
                                               const Exec& exec) const;

  /// The load plus the d'Alembert forces: no net force or moment on any connected part. N, per element node.
  std::vector<Vec3> balanced(std::span<const Vec3> force) const;
  /// K u, N per element node, for u in metres.
  std::vector<Vec3> internalForce(std::span<const Vec3> displacement, double youngModulus) const;
  /// J per tetrahedron, for u in metres.
  std::vector<double> tetEnergies(std::span<const Vec3> displacement, double youngModulus) const;

  const std::shared_ptr<const Elements>& elements() const { return elements_; }
  std::size_t partCount() const { return parts_.size(); }
  double factorSize() const { return cholesky_.factorSize(); }
  /// Bytes: the most that factoring held at once.
  std::size_t peakBytes() const { return cholesky_.peakBytes(); }

 private:
  friend class LocalRefinement;  // corrects solutions in a part of the body, by the same matrices
  /// A connected part's rigid modes: three translations, and three rotations about `centre`.
  struct Part {
    Vec3 centre = Vec3::Zero();               ///< of mass, in units of size_
    Eigen::Matrix<double, 6, 6> inverseGram;  ///< (RᵀMR)⁻¹
  };
  using Wrench = Eigen::Matrix<double, 6, 1>;  ///< force and moment, or velocity and spin
  /// What a displacement gives, for E = 1 and size_ = 1.
  struct Response {
    std::vector<Vec3> force;     ///< K u
    std::vector<double> energy;  ///< per tetrahedron
  };
  /// One load on its way to a solution, in units of size_ and E.
  struct Progress {
    std::vector<Vec3> load, step, displacement;
    Response response;
    double residual = 0;
    int steps = 0;
  };

  Statics(std::shared_ptr<const Elements> elements, ElementRules rules, SparseCholesky cholesky)
      : elements_(std::move(elements)), rules_(std::move(rules)), cholesky_(std::move(cholesky)) {}
  void setMass(Index partCount);
  std::vector<Wrench> wrenches(std::span<const Vec3> force) const;
  std::vector<Vec3> inertialForce(const std::vector<Wrench>& acceleration) const;
  void removeRigidMotion(std::vector<Vec3>& displacement) const;
  std::vector<Response> respond(std::span<const std::vector<Vec3>* const> displacements) const;
  Response respondToOne(std::span<const Vec3> displacement) const;
  void respond(std::size_t width, const double* displacement, double* force, double* energy) const;
  void takeStep(Progress& progress) const;
  bool isSolved(Progress& progress) const;
  void solveBlock(std::span<const std::vector<Vec3>> forces, double youngModulus,
                  std::span<StaticSolution> solutions) const;
  StaticSolution finished(Progress progress, std::span<const Vec3> force, double youngModulus) const;

  std::shared_ptr<const Elements> elements_;
  ElementRules rules_;
  std::vector<double> share_;  ///< per tetrahedron, of its stiffness that counts (stiffnessShares)
  SparseCholesky cholesky_;
  double size_ = 1;
  Lame lame_{0, 0};  ///< for E = 1
  VolumetricSplit split_;
  std::vector<Vec3> nodes_;                           ///< in units of size_, about the bounding box's centre
  std::vector<double> stiffnessVolume_, massVolume_;  ///< per tetrahedron, size_³: shares times volume
  std::vector<NodalAverages> averages_;               ///< one where the averaged part of λ needs it
  std::vector<Index> partOf_;                         ///< per element node
  std::vector<Part> parts_;
  std::vector<double> nodeMass_;  ///< Σ_j M_ij
  std::vector<Vec3> nodeMoment_;  ///< Σ_j M_ij (X_j − centre): with nodeMass_, all of M that rigid modes need
};

}  // namespace sherd
