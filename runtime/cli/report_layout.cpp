#include "cli/report_layout.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "cli/report_layers.h"

namespace sherd {
namespace {

constexpr double kBoxGap = 28, kLayerGap = 40, kPartGap = 44, kPassingWidth = 2;
/// More cells than this for passing wires cost more than they help.
constexpr int kMostPassing = 60000;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// One connected part: boxes and wires by their numbers in the whole, and its own drawing.
struct Part {
  std::vector<int> boxes, wires;
  Layout drawing;
};

int rootOf(std::vector<int>& parents, int box) {
  while (parents[at(box)] != box) box = parents[at(box)] = parents[at(parents[at(box)])];
  return box;
}

std::vector<Part> partsOf(int count, const std::vector<LayoutWire>& wires) {
  std::vector<int> parents(at(count)), partOf(at(count), -1);
  std::iota(parents.begin(), parents.end(), 0);
  for (const LayoutWire& wire : wires) {
    const int a = rootOf(parents, wire.from), b = rootOf(parents, wire.to);
    parents[at(std::max(a, b))] = std::min(a, b);
  }
  std::vector<Part> parts;
  for (int box = 0; box < count; ++box) {
    int& part = partOf[at(rootOf(parents, box))];
    if (part < 0) {
      part = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    parts[at(part)].boxes.push_back(box);
  }
  for (std::size_t w = 0; w < wires.size(); ++w)
    parts[at(partOf[at(rootOf(parents, wires[w].from))])].wires.push_back(static_cast<int>(w));
  return parts;
}

/// The cells and links that a part's boxes and wires become.
class Layered {
 public:
  Layered(const std::vector<LayoutBox>& boxes, const std::vector<LayoutWire>& wires) : wires_(wires) {
    const std::vector<int> layers = layersOf(static_cast<int>(boxes.size()), wires);
    for (std::size_t b = 0; b < boxes.size(); ++b)
      cells_.push_back({static_cast<int>(b), layers[b], boxes[b].width, boxes[b].height, 0});
    for (const LayoutWire& wire : wires) courses_.push_back(route(wire));
  }

  Layout draw() {
    const auto layers = orderLayers(cells_, links_);
    placeCells(cells_, links_, layers, kBoxGap);
    Layout drawing;
    std::vector<double> tops, heights;
    for (const auto& layer : layers) {
      double height = 0;
      for (const int cell : layer) height = std::max(height, cells_[at(cell)].height);
      tops.push_back(tops.empty() ? 0 : tops.back() + heights.back() + kLayerGap);
      heights.push_back(height);
    }
    for (const LayerCell& cell : cells_) {
      drawing.width = std::max(drawing.width, cell.x + cell.width);
      if (cell.box >= 0) drawing.corners.push_back({cell.x, tops[at(cell.layer)]});
    }
    drawing.height = tops.back() + heights.back();
    for (std::size_t w = 0; w < wires_.size(); ++w) {
      const LayoutWire& wire = wires_[w];
      const LayerCell &from = cells_[at(wire.from)], &to = cells_[at(wire.to)];
      std::vector<LayoutPoint> course{{from.x + wire.fromAt, tops[at(from.layer)] + from.height}};
      for (const int cell : courses_[w]) {
        const LayerCell& passing = cells_[at(cell)];
        const double x = passing.x + passing.width / 2, top = tops[at(passing.layer)];
        course.push_back({x, top});
        course.push_back({x, top + heights[at(passing.layer)]});
      }
      course.push_back({to.x + wire.toAt, tops[at(to.layer)]});
      drawing.courses.push_back(std::move(course));
    }
    return drawing;
  }

 private:
  /// The cells that a wire passes. Those that an earlier wire of the same output passed are taken again.
  std::vector<int> route(const LayoutWire& wire) {
    const int first = cells_[at(wire.from)].layer, last = cells_[at(wire.to)].layer;
    std::vector<int> passed;
    if (last <= first) return passed;
    auto& known = passing_[{wire.from, wire.output}];
    if (passingCount_ + last - first - 1 - static_cast<int>(known.size()) > kMostPassing) return passed;
    int cell = wire.from;
    double cellAt = wire.fromAt;
    for (int layer = first + 1; layer < last; ++layer) {
      const std::size_t step = at(layer - first - 1);
      if (step == known.size()) {
        known.push_back(static_cast<int>(cells_.size()));
        cells_.push_back({-1, layer, kPassingWidth, 0, 0});
        links_.push_back({cell, known.back(), cellAt, kPassingWidth / 2});
        ++passingCount_;
      }
      cell = known[step];
      cellAt = kPassingWidth / 2;
      passed.push_back(cell);
    }
    links_.push_back({cell, wire.to, cellAt, wire.toAt});
    return passed;
  }

  const std::vector<LayoutWire>& wires_;
  std::vector<LayerCell> cells_;
  std::vector<LayerLink> links_;
  std::vector<std::vector<int>> courses_;
  std::map<std::pair<int, int>, std::vector<int>> passing_;  ///< by box and output
  int passingCount_ = 0;
};

Layout drawPart(const Part& part, const std::vector<LayoutBox>& boxes, const std::vector<LayoutWire>& wires,
                std::vector<int>& local) {
  std::vector<LayoutBox> own;
  std::vector<LayoutWire> ownWires;
  for (const int box : part.boxes) {
    local[at(box)] = static_cast<int>(own.size());
    own.push_back(boxes[at(box)]);
  }
  for (const int w : part.wires) {
    LayoutWire wire = wires[at(w)];
    wire.from = local[at(wire.from)];
    wire.to = local[at(wire.to)];
    ownWires.push_back(wire);
  }
  return Layered(own, ownWires).draw();
}

}  // namespace

Shelves shelve(const std::vector<LayoutBox>& rectangles, double rowWidth, double gap) {
  Shelves shelves;
  double x = 0, y = 0, height = 0;
  for (const LayoutBox& rectangle : rectangles) {
    if (x > 0 && x + rectangle.width > rowWidth) {
      y += height + gap;
      x = height = 0;
    }
    shelves.corners.push_back({x, y});
    shelves.width = std::max(shelves.width, x + rectangle.width);
    height = std::max(height, rectangle.height);
    shelves.height = y + height;
    x += rectangle.width + gap;
  }
  return shelves;
}

Layout layeredLayout(const std::vector<LayoutBox>& boxes, const std::vector<LayoutWire>& wires,
                     double rowWidth) {
  std::vector<Part> parts = partsOf(static_cast<int>(boxes.size()), wires);
  std::vector<int> local(boxes.size());
  std::vector<LayoutBox> sizes;
  for (Part& part : parts) {
    part.drawing = drawPart(part, boxes, wires, local);
    sizes.push_back({part.drawing.width, part.drawing.height});
    rowWidth = std::max(rowWidth, part.drawing.width);
  }
  const Shelves shelves = shelve(sizes, rowWidth, kPartGap);
  Layout layout;
  layout.corners.resize(boxes.size());
  layout.courses.resize(wires.size());
  layout.width = shelves.width;
  layout.height = shelves.height;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const LayoutPoint corner = shelves.corners[p];
    const auto moved = [&](const LayoutPoint& point) {
      return LayoutPoint{corner.x + point.x, corner.y + point.y};
    };
    for (std::size_t b = 0; b < parts[p].boxes.size(); ++b)
      layout.corners[at(parts[p].boxes[b])] = moved(parts[p].drawing.corners[b]);
    for (std::size_t w = 0; w < parts[p].wires.size(); ++w)
      for (const LayoutPoint& point : parts[p].drawing.courses[w])
        layout.courses[at(parts[p].wires[w])].push_back(moved(point));
  }
  return layout;
}

}  // namespace sherd
