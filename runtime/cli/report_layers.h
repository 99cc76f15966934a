// The layers of one connected part of a drawing: which box stands in which, in what order, and where. Used by
// report_layout.
#pragma once

#include <vector>

#include "cli/report_layout.h"

namespace sherd {

/// Something that takes room in a layer: a box, or a wire on its way past it.
struct LayerCell {
  int box = -1;  ///< −1: a wire
  int layer = 0;
  double width = 0, height = 0;
  double x = 0;  ///< of its left side; the answer
};

/// From a cell to one in the next layer.
struct LayerLink {
  int from = 0, to = 0;
  double fromAt = 0, toAt = 0;  ///< pixels from the cells' left sides
};

/// The layer of each of `count` boxes: below all that it depends on, as close to what depends on it as that
/// allows. Wires that close a loop are taken no notice of. O(boxes + wires).
std::vector<int> layersOf(int count, const std::vector<LayoutWire>& wires);

/// Orders the cells of each layer so that few links cross: median sweeps up and down, the best of them kept.
/// Returns cells by layer. O(sweeps · links · log).
std::vector<std::vector<int>> orderLayers(const std::vector<LayerCell>& cells,
                                          const std::vector<LayerLink>& links);

/// Sets every cell's x, all ≥ 0, so that links are as steep as the order allows; cells of a layer are `gap`
/// apart.
void placeCells(std::vector<LayerCell>& cells, const std::vector<LayerLink>& links,
                const std::vector<std::vector<int>>& layers, double gap);

}  // namespace sherd
