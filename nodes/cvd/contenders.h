// Which sites the nodes of a cell have to be compared with to make their labels exact.
#pragma once

#include <span>
#include <vector>

#include "cvd/lloyd_state.h"

namespace sherd {

/// Few pairs of node and site: all may be; else it is found cell by cell, from bounds of how far the sites
/// are from one another. Cost then: O(N² d / 16) where all sites have moved, O(N d / 16) where one has.
class Contenders {
 public:
  Contenders(LloydState& state, const Exec& exec);

  /// Whether they are told cell by cell.
  bool isByCell() const { return isByCell_; }
  /// Those of a cell, nearest first.
  std::span<const Contender> of(std::size_t cell) const { return s_.contenders[cell]; }
  /// The sites that have moved since labels were exact, ascending.
  std::span<const Index> movers() const { return movers_; }
  /// Blocks that hold nodes of cells with contenders, ascending.
  std::vector<Index> blocks() const;

 private:
  void findByCell(const Exec& exec);
  void measure(std::size_t cell);
  void findOfBlock(std::size_t block);

  LloydState& s_;
  bool isByCell_;
  std::vector<Index> movers_;
};

}  // namespace sherd
