// Lets small solids join their neighbours.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "tessellate/cell_parts.h"
#include "tessellate/solids.h"

namespace sherd {

class SolidMerger {
 public:
  SolidMerger(const CellParts& parts, std::span<const Vec3> positions, Solids& solids);

  /// Each solid smaller than `minVolume` (m³), smallest first, joins the one with which it shares the largest
  /// area. Those without a neighbour stay, however small, but for pockets of cut skin that rounding laid
  /// flat. Returns how many joined. Cost O(solids), and O(sheets) where any is too small.
  std::size_t mergeBelow(double minVolume);

  /// The solid that this one is part of now; −1 for one that is nothing.
  Index ownerOf(Index solid) const;

 private:
  static constexpr Index kNone = -1;

  bool isLargeEnough(Index solid, double minVolume) const;
  void sumContacts();
  bool joinLargestNeighbour(Index small);
  bool isFlatSkin(Index solid) const;

  const CellParts& parts_;
  std::span<const Vec3> positions_;
  Solids& solids_;
  std::vector<Index> joined_;                      ///< per solid: the one that it joined, itself, or none
  std::vector<std::map<Index, double>> contacts_;  ///< m², per solid that still stands
};

}  // namespace sherd
