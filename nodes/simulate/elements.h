// The elements that displacements are interpolated by: linear tetrahedra, or quadratic ones with a node in
// the middle of every edge (Zienkiewicz and Taylor, "The Finite Element Method", 2000, volume 1,
// section 8.8).
//
// With barycentric coordinates ξ and their gradients g:
//   linear     N_i = ξ_i
//   quadratic  N_i = ξ_i (2 ξ_i − 1) at corners,  N_ij = 4 ξ_i ξ_j on edges; all edges are straight
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "simulate/element.h"
#include "types/tet_mesh.h"

namespace sherd {

enum class ElementOrder { Linear, Quadratic };

inline constexpr std::size_t kMostElementNodes = 10;  ///< of one tetrahedron

/// The nodes of all elements: those of the tetrahedral mesh under their numbers, then one per edge in the
/// order of tetEdges.
class Elements {
 public:
  /// Cost O(tets log tets) for quadratic ones.
  Elements(std::shared_ptr<const TetMesh> mesh, ElementOrder order);

  ElementOrder order() const { return order_; }
  const TetMesh& mesh() const { return *mesh_; }
  const std::shared_ptr<const TetMesh>& sharedMesh() const { return mesh_; }
  std::size_t nodeCount() const { return nodeCount_; }
  std::size_t perTet() const { return order_ == ElementOrder::Linear ? 4 : kMostElementNodes; }
  /// Of tetrahedron t: its corners, then its edges in the order of kTetraEdge.
  std::span<const Index> nodesOf(std::size_t t) const { return {&nodes_[t * perTet()], perTet()}; }
  /// Of all nodes, given those of the mesh (in any unit).
  std::vector<Vec3> positions(std::span<const Vec3> meshNodes) const;
  /// N_i at barycentric coordinates; the last six are zero for linear ones.
  std::array<double, kMostElementNodes> shapeValues(const Vec4& barycentric) const;

 private:
  std::shared_ptr<const TetMesh> mesh_;
  ElementOrder order_;
  std::size_t nodeCount_;
  std::vector<Index> nodes_;
  std::vector<std::array<Index, 2>> edges_;
};

/// Barycentric coordinates of p in tetrahedron t.
Vec4 barycentricIn(const TetMesh& mesh, Index t, const Vec3& p);

/// ∫ N_i N_j / V of one element, in the order of nodesOf.
Eigen::MatrixXd elementMass(ElementOrder order);

/// Four points of one weight that integrate the products of two linear functions over (a part of) a
/// tetrahedron: in barycentric coordinates, which need not add up to 1 (a function's value is then Σ ξ_i f_i,
/// f_i its corners').
using ElementRule = std::array<Vec4, 4>;

/// Over the whole of it.
ElementRule wholeRule();
/// From ∫ ξ_i ξ_j / V, up to a factor: the products are then means.
ElementRule ruleOf(const Eigen::Matrix4d& products);

/// One element: the gradients of its shape functions at the points that integrate its energy exactly (one,
/// or the four of a rule with the weight 1/4 each).
class ElementGradients {
 public:
  ElementGradients(const Element& linear, ElementOrder order);
  /// A quadratic one.
  ElementGradients(const Element& linear, const ElementRule& rule);

  std::size_t points() const { return points_; }
  std::size_t nodes() const { return nodes_; }
  double weight() const { return 1.0 / static_cast<double>(points_); }  ///< share of the volume
  const Vec3& at(std::size_t point, std::size_t node) const { return gradient_[point][node]; }
  /// Mean over the element, of the shape functions' gradients.
  const Vec3& mean(std::size_t node) const { return mean_[node]; }

 private:
  std::size_t points_, nodes_;
  std::array<std::array<Vec3, kMostElementNodes>, 4> gradient_;
  std::array<Vec3, kMostElementNodes> mean_;
};

}  // namespace sherd
