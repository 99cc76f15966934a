// Where the boxes of a graph's drawing stand: layers from top to bottom, so that every wire leads down, after
// Sugiyama, Tagawa and Toda (1981). Wires that pass a layer go around its boxes.
#pragma once

#include <vector>

namespace sherd {

/// Pixels; y points down.
struct LayoutPoint {
  double x = 0, y = 0;
  friend bool operator==(const LayoutPoint&, const LayoutPoint&) = default;
};

struct LayoutBox {
  double width = 0, height = 0;  ///< pixels, above 0
};

struct LayoutWire {
  int from = 0, to = 0;         ///< boxes
  double fromAt = 0, toAt = 0;  ///< pixels from the box's left side: where the wire leaves and arrives
  int output = 0;               ///< wires of one output share their way as far as they can
};

struct Layout {
  std::vector<LayoutPoint> corners;               ///< of each box: upper left
  std::vector<std::vector<LayoutPoint>> courses;  ///< of each wire: from its first point to its last
  double width = 0, height = 0;                   ///< of the whole, from (0, 0)
};

/// Boxes that nothing connects are laid out for themselves and packed side by side in rows of at least
/// `rowWidth` pixels. Loops, which checked graphs don't have, are drawn with wires that lead up. The same for
/// the same input. O((boxes + wires + layers passed) log), with a bound on the layers passed: beyond it wires
/// go straight.
Layout layeredLayout(const std::vector<LayoutBox>& boxes, const std::vector<LayoutWire>& wires,
                     double rowWidth = 1000);

/// Where rectangles stand that are put into rows from left to right, `gap` apart, in their order.
struct Shelves {
  std::vector<LayoutPoint> corners;
  double width = 0, height = 0;
};
Shelves shelve(const std::vector<LayoutBox>& rectangles, double rowWidth, double gap);

}  // namespace sherd
