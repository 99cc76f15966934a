// What becomes of the parts of a surface that bound nothing: sheets.
#pragma once

#include <cstddef>
#include <vector>

#include "base/exec.h"
#include "repair/patchwork.h"

namespace sherd {

struct SheetRules {
  double thin;       ///< of area · diagonal: an open part with less volume is a sheet
  double thickness;  ///< m, that sheets get
  double touching;   ///< m, this near a sheet counts as on the solid
  double small;      ///< m²: a sheet on the solid with less area is left out
};

/// Counted sheets of one fate.
struct SheetCount {
  std::size_t count = 0;
  double area = 0;            ///< m², of all
  Vec3 place = Vec3::Zero();  ///< m, on the first
};

/// Sheets on their way through repair. Those that hang on a solid by an edge are taken out before holes
/// are filled, since their borders are none; the others are found after that, by what they bound.
class LooseSheets {
 public:
  explicit LooseSheets(const SheetRules& rules) : rules_(rules) {}

  /// Takes dangling sheets out of the surface, whose neighbours agree in which way they face.
  void takeHanging(Patchwork& surface, const Exec& exec);
  /// Finds the other sheets in the surface, whose holes are filled. Those in or on a solid are left out where
  /// they are wholly in it or small; the rest are made slabs. A slab on the solid overlaps it. Returns how
  /// many were found. Cost O(n log n).
  std::size_t thicken(Patchwork& surface, const Exec& exec);

  const SheetCount& freed() const { return free_; }     ///< made slabs, off the solid or through it
  const SheetCount& united() const { return united_; }  ///< made slabs that were made to overlap the solid
  const SheetCount& within() const { return within_; }  ///< left out, being in the solid
  const SheetCount& strays() const { return strays_; }  ///< left out, being small and on the solid

 private:
  void addHanging(Patchwork& surface, std::vector<std::vector<Index>>& sheets) const;

  SheetRules rules_;
  Patchwork hanging_;                     ///< with the positions of the surface that they were taken from
  std::vector<std::size_t> hangingEnds_;  ///< of each sheet's triangles in hanging_
  SheetCount free_, united_, within_, strays_;
};

}  // namespace sherd
