// How many cells of a fixed tree a hit needs: a quick stand-in for the search.
//
// The body's nodes are halved again and again, each part across its longest direction in the embedding, once
// for the body. For a hit, the cell with the largest energy is split until the sum over the cells of
//   Σ w ‖x̄ − p̄‖²,  p̄ the cell's weighted centroid,
// is below γ. Cells that a search finds fit better: it needs about a fifth fewer of them, whatever the body,
// the hit and their number. What is left to learn is that ratio.
#pragma once

#include <span>
#include <vector>

#include "base/exec.h"
#include "types/partition.h"

namespace sherd {

/// The tree: nodes in an order in which every part is a range, halved at its middle; any order where `exec`
/// is cancelled. O(nodes · dimensions² · log nodes).
std::vector<Index> splitOrder(const Embedding& embedding, const Exec& exec);

struct TreeEnergy {
  double whole = 0;    ///< Σ w ‖x̄ − centre‖², J·m²
  double centred = 0;  ///< the same about the weighted centroid
  double weight = 0;   ///< J
  /// log ν for each threshold: ν is where the line through log E(N − 1) and log E(N) over log N falls to it;
  /// where one cell is below, as if E fell as N^(-2/3) there.
  std::vector<double> logPieces;
};

/// `thresholds`: J·m², > 0, descending. `centre`: d numbers, m; `weight`: not all zero. Cost O(nodes ·
/// dimensions) and O(log N + dimensions) per cell.
TreeEnergy treeEnergy(const std::vector<Index>& order, const Embedding& embedding,
                      const Eigen::VectorXd& centre, const std::vector<double>& weight,
                      std::span<const double> thresholds);

}  // namespace sherd
