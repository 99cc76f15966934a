// The functions whose lower envelope the exact cells are (design section 4, point 11).
//
//   g_j(n) = ‖p̄_j‖² − 2 x̄_n·p̄_j,   p̄ and x̄ about the mean of the x̄_n
//
// is the squared distance of node n to site j without the term that all sites share. Within a tetrahedron x̄
// is linear, so g_j is affine, and cell j is where g_j is least. The doubles g_j(n) are computed once;
// everything that follows is exact in them. Nodes of one place in the embedding have the same
// doubles.
//
// Ties. Sites are numbered by rank, their lexicographic order of coordinates (by index where these are
// equal), so that a permutation of the sites changes no rank but those of coincident ones. Each g_j is
// thought of as lowered by an infinitely small constant ε_j, with ε_0 ≫ ε_1 ≫ … by rank: sites that are
// equally far somewhere, even all over a face, even everywhere, are then in general position (Simulation of
// Simplicity, Edelsbrunner and Mücke 1990).
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "base/exec.h"
#include "types/partition.h"

namespace sherd {

class SiteValues {
 public:
  /// Cost O(d · nodes · sites) time and O(nodes · sites) memory, in parallel over nodes.
  SiteValues(const Partition& partition, const Exec& exec);

  std::size_t siteCount() const { return siteOf_.size(); }
  /// g at a node, by rank.
  const double* at(Index node) const { return values_.col(node).data(); }
  /// The rank that is least at a node.
  Index least(Index node) const { return least_[static_cast<std::size_t>(node)]; }
  /// The partition's number of a rank.
  Index site(Index rank) const { return siteOf_[static_cast<std::size_t>(rank)]; }

  /// The ranks that may be least somewhere in the tetrahedron, ascending: all but those that one site, least
  /// at a node, undercuts at all four nodes. Cost O(sites).
  void candidates(const Tetra& nodes, std::vector<Index>& out) const;

 private:
  void findNear(std::size_t node, double squaredNorm, double way);
  std::span<const Index> nearestList(const Tetra& nodes) const;

  std::vector<Index> siteOf_, least_;
  /// Per node: the ranks that can be least in a tetrahedron around it, ascending.
  std::vector<std::vector<Index>> near_;
  Eigen::MatrixXd values_;  ///< sites by rank × nodes
};

}  // namespace sherd
