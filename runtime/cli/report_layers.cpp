#include "cli/report_layers.h"

#include <algorithm>
#include <numeric>

namespace sherd {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Large drawings get fewer sweeps: they are looked at piece by piece, but waited for as a whole.
int sweepsFor(std::size_t cells) {
  return static_cast<int>(std::clamp<std::size_t>(60000 / (cells + 1), 4, 32));
}

/// The boxes so that each comes after all that it depends on. Where only loops are left, the first box that
/// is is taken.
std::vector<int> topologicalOrder(int count, const std::vector<LayoutWire>& wires) {
  std::vector<std::vector<int>> next(at(count));
  std::vector<int> missing(at(count), 0), order;
  for (const LayoutWire& wire : wires)
    if (wire.from != wire.to) {
      next[at(wire.from)].push_back(wire.to);
      ++missing[at(wire.to)];
    }
  std::vector<bool> taken(at(count), false);
  const auto take = [&](int box) {
    taken[at(box)] = true;
    order.push_back(box);
  };
  for (int box = 0; box < count; ++box)
    if (missing[at(box)] == 0) take(box);
  std::size_t done = 0;
  for (int first = 0; done < order.size() || first < count;) {
    if (done == order.size()) {
      if (!taken[at(first)]) take(first);
      ++first;
      continue;
    }
    for (const int to : next[at(order[done++])])
      if (--missing[at(to)] == 0 && !taken[at(to)]) take(to);
  }
  return order;
}

/// Cells and the ends of their links, for walking both ways.
struct Neighbours {
  std::vector<std::vector<int>> above, below;  ///< entries of the links

  Neighbours(std::size_t cells, const std::vector<LayerLink>& links) : above(cells), below(cells) {
    for (std::size_t l = 0; l < links.size(); ++l) {
      below[at(links[l].from)].push_back(static_cast<int>(l));
      above[at(links[l].to)].push_back(static_cast<int>(l));
    }
  }
};

/// Pairs of links between two layers that cross; ends are compared by cell and place on it. Counts inversions
/// by a binary indexed tree.
std::size_t crossingsBetween(const std::vector<int>& upper, const std::vector<int>& position,
                             std::size_t lowerSize, const std::vector<LayerLink>& links,
                             const Neighbours& neighbours) {
  std::vector<std::size_t> tree(lowerSize + 1, 0);
  std::size_t crossings = 0, entered = 0;
  for (const int cell : upper) {
    const auto& below = neighbours.below[at(cell)];
    for (const int l : below) {
      std::size_t notRight = 0;
      for (std::size_t i = at(position[at(links[at(l)].to)]) + 1; i > 0; i &= i - 1) notRight += tree[i];
      crossings += entered - notRight;
    }
    for (const int l : below) {
      for (std::size_t i = at(position[at(links[at(l)].to)]) + 1; i <= lowerSize; i += i & (~i + 1))
        ++tree[i];
      ++entered;
    }
  }
  return crossings;
}

class Ordering {
 public:
  Ordering(const std::vector<LayerCell>& cells, const std::vector<LayerLink>& links)
      : cells_(cells), links_(links), neighbours_(cells.size(), links), position_(cells.size(), 0) {
    int deepest = 0;
    for (const LayerCell& cell : cells) deepest = std::max(deepest, cell.layer);
    layers_.resize(at(deepest) + 1);
    for (std::size_t c = 0; c < cells.size(); ++c) layers_[at(cells[c].layer)].push_back(static_cast<int>(c));
    for (auto& layer : layers_) number(layer);
  }

  std::vector<std::vector<int>> best() {
    std::vector<std::vector<int>> best = layers_;
    std::size_t fewest = crossings();
    for (int sweep = 0; sweep < sweepsFor(cells_.size()) && fewest > 0; ++sweep) {
      sweep % 2 == 0 ? down() : up();
      if (const std::size_t found = crossings(); found < fewest) {
        fewest = found;
        best = layers_;
      }
    }
    return best;
  }

 private:
  void number(const std::vector<int>& layer) {
    for (std::size_t i = 0; i < layer.size(); ++i) position_[at(layer[i])] = static_cast<int>(i);
  }
  void down() {
    for (std::size_t l = 1; l < layers_.size(); ++l) sort(layers_[l], neighbours_.above, true);
  }
  void up() {
    for (std::size_t l = layers_.size() - 1; l-- > 0;) sort(layers_[l], neighbours_.below, false);
  }

  /// By the mean place of the neighbours on one side; a cell without any keeps its place.
  void sort(std::vector<int>& layer, const std::vector<std::vector<int>>& sides, bool above) {
    std::vector<std::pair<double, int>> keys;
    for (const int cell : layer) {
      const auto& side = sides[at(cell)];
      double sum = 0;
      for (const int l : side) {
        const LayerLink& link = links_[at(l)];
        const int other = above ? link.from : link.to;
        const double share = (above ? link.fromAt : link.toAt) / std::max(1.0, cells_[at(other)].width);
        sum += position_[at(other)] + 0.9 * std::clamp(share, 0.0, 1.0);
      }
      keys.emplace_back(side.empty() ? position_[at(cell)] + 0.45 : sum / static_cast<double>(side.size()),
                        cell);
    }
    std::stable_sort(keys.begin(), keys.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = keys[i].second;
    number(layer);
  }

  std::size_t crossings() const {
    std::size_t sum = 0;
    for (std::size_t l = 0; l + 1 < layers_.size(); ++l)
      sum += crossingsBetween(layers_[l], position_, layers_[l + 1].size(), links_, neighbours_);
    return sum;
  }

  const std::vector<LayerCell>& cells_;
  const std::vector<LayerLink>& links_;
  Neighbours neighbours_;
  std::vector<int> position_;
  std::vector<std::vector<int>> layers_;
};

/// A wish for a cell's place, and how much it counts.
struct Wish {
  double x = 0, weight = 1;
};

/// Moves a layer's cells to where the squared distance to their wishes is smallest while they keep order and
/// gap: isotonic regression by pooling neighbours that would overlap.
void settle(std::vector<LayerCell>& cells, const std::vector<int>& layer, const std::vector<Wish>& wishes,
            double gap) {
  struct Pool {
    double sum, weight;
    std::size_t count;
    double place() const { return sum / weight; }
  };
  std::vector<Pool> pools;
  double offset = 0;
  std::vector<double> offsets;
  for (std::size_t i = 0; i < layer.size(); ++i) {
    offsets.push_back(offset);
    pools.push_back({wishes[i].weight * (wishes[i].x - offset), wishes[i].weight, 1});
    offset += cells[at(layer[i])].width + gap;
    while (pools.size() > 1 && pools[pools.size() - 2].place() > pools.back().place()) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back().sum += last.sum;
      pools.back().weight += last.weight;
      pools.back().count += last.count;
    }
  }
  std::size_t i = 0;
  for (const Pool& pool : pools)
    for (std::size_t k = 0; k < pool.count; ++k, ++i) cells[at(layer[i])].x = pool.place() + offsets[i];
}

class Placement {
 public:
  Placement(std::vector<LayerCell>& cells, const std::vector<LayerLink>& links, double gap)
      : cells_(cells), links_(links), neighbours_(cells.size(), links), gap_(gap) {}

  void settleLayer(const std::vector<int>& layer, bool above, bool below) {
    std::vector<Wish> wishes;
    for (const int cell : layer) wishes.push_back(wishOf(cell, above, below));
    settle(cells_, layer, wishes, gap_);
  }

 private:
  Wish wishOf(int cell, bool above, bool below) const {
    double sum = 0, weight = 0;
    const auto add = [&](double x, int other) {
      // Long wires bend where they must, and then best near their ends.
      const double w = cells_[at(cell)].box < 0 && cells_[at(other)].box < 0 ? 8 : 1;
      sum += w * x;
      weight += w;
    };
    if (above)
      for (const int l : neighbours_.above[at(cell)]) {
        const LayerLink& link = links_[at(l)];
        add(cells_[at(link.from)].x + link.fromAt - link.toAt, link.from);
      }
    if (below)
      for (const int l : neighbours_.below[at(cell)]) {
        const LayerLink& link = links_[at(l)];
        add(cells_[at(link.to)].x + link.toAt - link.fromAt, link.to);
      }
    if (weight == 0) return {cells_[at(cell)].x, 0.01};
    return {sum / weight, weight};
  }

  std::vector<LayerCell>& cells_;
  const std::vector<LayerLink>& links_;
  Neighbours neighbours_;
  double gap_;
};

}  // namespace

std::vector<int> layersOf(int count, const std::vector<LayoutWire>& wires) {
  const std::vector<int> order = topologicalOrder(count, wires);
  std::vector<int> rank(at(count)), layers(at(count), 0);
  for (std::size_t i = 0; i < order.size(); ++i) rank[at(order[i])] = static_cast<int>(i);
  std::vector<std::vector<int>> after(at(count));
  std::vector<bool> isFed(at(count), false);
  for (const LayoutWire& wire : wires)
    if (rank[at(wire.from)] < rank[at(wire.to)]) {
      after[at(wire.from)].push_back(wire.to);
      isFed[at(wire.to)] = true;
    }
  for (const int box : order)
    for (const int to : after[at(box)]) layers[at(to)] = std::max(layers[at(to)], layers[at(box)] + 1);
  // What nothing leads to may stand just above its first reader.
  for (int box = 0; box < count; ++box) {
    if (isFed[at(box)] || after[at(box)].empty()) continue;
    int first = layers[at(after[at(box)].front())];
    for (const int to : after[at(box)]) first = std::min(first, layers[at(to)]);
    layers[at(box)] = first - 1;
  }
  return layers;
}

std::vector<std::vector<int>> orderLayers(const std::vector<LayerCell>& cells,
                                          const std::vector<LayerLink>& links) {
  return Ordering(cells, links).best();
}

void placeCells(std::vector<LayerCell>& cells, const std::vector<LayerLink>& links,
                const std::vector<std::vector<int>>& layers, double gap) {
  for (const auto& layer : layers) {
    double x = 0;
    for (const int cell : layer) {
      cells[at(cell)].x = x;
      x += cells[at(cell)].width + gap;
    }
  }
  Placement placement(cells, links, gap);
  const int sweeps = sweepsFor(cells.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const bool both = 3 * sweep >= sweeps;
    for (std::size_t l = 1; l < layers.size(); ++l) placement.settleLayer(layers[l], true, both);
    for (std::size_t l = layers.size() - 1; l-- > 0;) placement.settleLayer(layers[l], both, true);
  }
  double left = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) left = c == 0 ? cells[c].x : std::min(left, cells[c].x);
  for (LayerCell& cell : cells) cell.x -= left;
}

}  // namespace sherd
