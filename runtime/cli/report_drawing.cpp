#include "cli/report_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cli/console.h"
#include "cli/report_layout.h"
#include "cli/report_text.h"

namespace sherd {
namespace {

constexpr double kNameEm = 16.6, kTextEm = 12.9, kPortEm = 11.2;  // px, bold ones being wider
constexpr double kLeast = 150, kPortGap = 16, kBody = 48, kPortRow = 17, kMargin = 24, kHeading = 34;
constexpr int kLongestName = 30, kLongestType = 24, kLongestPort = 16;
constexpr std::size_t kMostPorts = 40;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct DrawnPort {
  std::string name, tip;
  bool isParameter = false;
  double at = 0;  ///< px from the box's left side
};

struct DrawnBox {
  std::vector<DrawnPort> inputs, outputs;
  double width = 0, height = 0;

  /// Ports that aren't drawn, of which there may be thousands, share the last one.
  static double place(const std::vector<DrawnPort>& ports, const std::string& name, double fallback) {
    for (const DrawnPort& port : ports)
      if (port.name == name) return port.at;
    return ports.empty() ? fallback : ports.back().at;
  }
};

double portWidth(const DrawnPort& port) { return kPortEm * widthInEms(elided(port.name, kLongestPort)); }

double rowWidth(const std::vector<DrawnPort>& ports) {
  double width = kPortGap;
  for (const DrawnPort& port : ports) width += portWidth(port) + kPortGap;
  return width;
}

/// Spreads the ports evenly over the box's side.
void placePorts(std::vector<DrawnPort>& ports, double width) {
  const double spare = (width - rowWidth(ports)) / static_cast<double>(ports.size() + 1);
  double x = kPortGap + spare;
  for (DrawnPort& port : ports) {
    port.at = x + portWidth(port) / 2;
    x += portWidth(port) + kPortGap + spare;
  }
}

std::vector<DrawnPort> portsOf(const std::vector<ReportPort>& ports) {
  std::vector<DrawnPort> drawn;
  for (const ReportPort& port : ports)
    if (drawn.size() < kMostPorts)
      drawn.push_back({port.name, port.name + " (" + port.type + "): " + port.help, false, 0});
  return drawn;
}

std::string typeLine(const ReportNode& node) { return elided(node.type, kLongestType); }

std::string resultLine(const ReportGroup& group) {
  const std::string word = kShownStates[group.state].name;
  return group.ms > 0 ? word + " · " + durationText(group.ms) : word;
}

std::string countMark(const ReportGroup& group) {
  return group.all > 1 ? fmt::format("×{}", group.all) : std::string();
}

DrawnBox measure(const ReportNode& node, const ReportGroup& group,
                 const std::vector<std::string>& wiredParams) {
  DrawnBox box;
  box.inputs = portsOf(node.inputs);
  box.outputs = portsOf(node.outputs);
  for (const std::string& name : wiredParams)
    if (box.inputs.size() < kMostPorts) box.inputs.push_back({name, name + ": a parameter", true, 0});
  const double name = 48 + kNameEm * widthInEms(elided(node.name, kLongestName)) +
                      (group.all > 1 ? 16 + kTextEm * widthInEms(countMark(group)) : 0);
  const double text = 40 + kTextEm * (widthInEms(typeLine(node)) + 1.1 * widthInEms(resultLine(group)));
  box.width = std::max({kLeast, name, text, rowWidth(box.inputs), rowWidth(box.outputs)});
  box.height = kBody + (box.inputs.empty() ? 4 : kPortRow) + (box.outputs.empty() ? 4 : kPortRow);
  placePorts(box.inputs, box.width);
  placePorts(box.outputs, box.width);
  return box;
}

void drawPorts(std::string& svg, const std::vector<DrawnPort>& ports, double edge, double label) {
  for (const DrawnPort& port : ports) {
    const char* shape = port.isParameter ? "port param" : "port";
    fmt::format_to(std::back_inserter(svg),
                   "<g class=\"{}\"><title>{}</title><circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>"
                   "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text></g>",
                   shape, htmlEscaped(port.tip), port.at, edge, port.at, label,
                   htmlEscaped(elided(port.name, kLongestPort)));
  }
}

/// What share of the slowest node's time this one took.
void drawTimeBar(std::string& svg, const DrawnBox& box, double y, double share) {
  const double room = box.width - 24;
  fmt::format_to(std::back_inserter(svg),
                 "<rect class=\"track\" x=\"12\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"3\" rx=\"1.5\"/>", y,
                 room);
  if (share > 0)
    fmt::format_to(std::back_inserter(svg),
                   "<rect class=\"time\" x=\"12\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"3\" rx=\"1.5\"/>", y,
                   std::max(3.0, share * room));
}

void drawBox(std::string& svg, const DrawnBox& box, const LayoutPoint& corner, std::size_t number,
             const ReportNode& node, const ReportGroup& group, double slowest) {
  const ShownState& state = kShownStates[group.state];
  const double top = box.inputs.empty() ? 4 : kPortRow;
  const auto to = std::back_inserter(svg);
  fmt::format_to(
      to,
      "<g class=\"box s-{}\" data-group=\"{}\" transform=\"translate({:.1f} {:.1f})\" tabindex=\"0\" "
      "role=\"button\" aria-label=\"{}: {}, {}\"><title>{} ({}): {}</title>"
      "<rect class=\"card\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"8\"/>",
      state.style, number, corner.x, corner.y, htmlEscaped(node.name), htmlEscaped(node.type),
      htmlEscaped(resultLine(group)), htmlEscaped(node.name), htmlEscaped(node.type), group.stateText(),
      box.width, box.height);
  fmt::format_to(to,
                 "<use href=\"#m-{}\" class=\"mark\" x=\"11\" y=\"{:.1f}\" width=\"18\" height=\"18\"/>"
                 "<text class=\"name\" x=\"36\" y=\"{:.1f}\">{}</text>",
                 state.style, top + 3, top + 17, htmlEscaped(elided(node.name, kLongestName)));
  if (group.all > 1)
    fmt::format_to(to, "<text class=\"count\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", box.width - 12, top + 17,
                   countMark(group));
  fmt::format_to(to,
                 "<text class=\"type\" x=\"12\" y=\"{:.1f}\">{}</text>"
                 "<text class=\"result\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                 top + 35, htmlEscaped(typeLine(node)), box.width - 12, top + 35,
                 htmlEscaped(resultLine(group)));
  drawTimeBar(svg, box, top + 41, slowest > 0 ? group.ms / slowest : 0);
  drawPorts(svg, box.inputs, 0, 13);
  drawPorts(svg, box.outputs, box.height, box.height - 7);
  svg += "</g>\n";
}

void drawWire(std::string& svg, const std::vector<LayoutPoint>& course, const LayoutPoint& corner,
              const GroupWire& wire, const std::string& tip) {
  const auto to = std::back_inserter(svg);
  fmt::format_to(to, "<path class=\"wire\" data-from=\"{}\" data-to=\"{}\" d=\"M{:.1f} {:.1f}", wire.from,
                 wire.to, corner.x + course.front().x, corner.y + course.front().y);
  for (std::size_t i = 1; i < course.size(); ++i) {
    const LayoutPoint &a = course[i - 1], &b = course[i];
    const double x0 = corner.x + a.x, y0 = corner.y + a.y, x1 = corner.x + b.x, y1 = corner.y + b.y;
    const double bend = std::max(16.0, 0.5 * (b.y - a.y));
    if (a.x == b.x && b.y >= a.y)
      fmt::format_to(to, "L{:.1f} {:.1f}", x1, y1);
    else
      fmt::format_to(to, "C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}", x0, y0 + bend, x1, y1 - bend, x1, y1);
  }
  fmt::format_to(to, "\"><title>{}</title></path>\n", htmlEscaped(tip));
}

/// The drawing of one shot's graph.
struct DrawnGraph {
  std::string name;
  std::vector<int> groups, wires;
  Layout layout;
};

class Drawing {
 public:
  Drawing(const ReportData& data, const ReportGroups& grouped) : data_(data), grouped_(grouped) {
    std::vector<std::vector<std::string>> wiredParams(grouped.groups.size());
    for (const GroupWire& wire : grouped.wires) {
      const auto& inputs = first(wire.to).inputs;
      auto& params = wiredParams[at(wire.to)];
      const auto isIt = [&](const ReportPort& port) { return port.name == wire.input; };
      if (std::none_of(inputs.begin(), inputs.end(), isIt) &&
          std::find(params.begin(), params.end(), wire.input) == params.end())
        params.push_back(wire.input);
    }
    for (std::size_t g = 0; g < grouped.groups.size(); ++g) {
      boxes_.push_back(measure(first(static_cast<int>(g)), grouped.groups[g], wiredParams[g]));
      slowest_ = std::max(slowest_, grouped.groups[g].ms);
    }
    splitByGraph();
  }

  std::string svg() {
    std::vector<LayoutBox> sizes;
    const double heading = graphs_.size() > 1 ? kHeading : 0;
    double widest = 1000;
    for (DrawnGraph& graph : graphs_) {
      graph.layout = layoutOf(graph);
      sizes.push_back({graph.layout.width, graph.layout.height + heading});
      widest = std::max(widest, graph.layout.width);
    }
    const Shelves shelves = shelve(sizes, widest, 2 * kMargin);
    const double width = shelves.width + 2 * kMargin, height = shelves.height + 2 * kMargin;
    std::string svg = fmt::format(
        "<svg id=\"drawing\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.1f} {1:.1f}\" "
        "width=\"{0:.1f}\" height=\"{1:.1f}\" role=\"group\" aria-label=\"the graph\">\n",
        width, height);
    for (std::size_t i = 0; i < graphs_.size(); ++i) {
      const LayoutPoint corner{kMargin + shelves.corners[i].x, kMargin + shelves.corners[i].y + heading};
      if (heading > 0)
        svg += fmt::format("<text class=\"heading\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", corner.x,
                           corner.y - 14, htmlEscaped(graphs_[i].name));
      draw(svg, graphs_[i], corner);
    }
    return svg + "</svg>\n";
  }

 private:
  const ReportNode& first(int group) const {
    return data_.nodes[at(grouped_.groups[at(group)].runs.front())];
  }

  void splitByGraph() {
    std::map<std::string, std::size_t> known;
    std::vector<std::size_t> graphOf;
    for (std::size_t g = 0; g < grouped_.groups.size(); ++g) {
      const std::string& name = first(static_cast<int>(g)).graph;
      const auto [entry, isNew] = known.try_emplace(name, graphs_.size());
      if (isNew) graphs_.push_back({name, {}, {}, {}});
      graphs_[entry->second].groups.push_back(static_cast<int>(g));
      graphOf.push_back(entry->second);
    }
    for (std::size_t w = 0; w < grouped_.wires.size(); ++w) {
      const GroupWire& wire = grouped_.wires[w];
      if (graphOf[at(wire.from)] == graphOf[at(wire.to)])
        graphs_[graphOf[at(wire.from)]].wires.push_back(static_cast<int>(w));
    }
  }

  Layout layoutOf(const DrawnGraph& graph) const {
    std::vector<LayoutBox> boxes;
    std::vector<LayoutWire> wires;
    std::map<int, int> local;
    for (const int g : graph.groups) {
      local[g] = static_cast<int>(boxes.size());
      boxes.push_back({boxes_[at(g)].width, boxes_[at(g)].height});
    }
    std::map<std::pair<int, std::string>, int> outputs;
    for (const int w : graph.wires) {
      const GroupWire& wire = grouped_.wires[at(w)];
      const DrawnBox &from = boxes_[at(wire.from)], &to = boxes_[at(wire.to)];
      const int output =
          outputs.try_emplace({wire.from, wire.output}, static_cast<int>(outputs.size())).first->second;
      wires.push_back({local[wire.from], local[wire.to],
                       DrawnBox::place(from.outputs, wire.output, from.width / 2),
                       DrawnBox::place(to.inputs, wire.input, to.width / 2), output});
    }
    return layeredLayout(boxes, wires);
  }

  void draw(std::string& svg, const DrawnGraph& graph, const LayoutPoint& corner) const {
    for (std::size_t i = 0; i < graph.wires.size(); ++i) {
      const GroupWire& wire = grouped_.wires[at(graph.wires[i])];
      drawWire(svg, graph.layout.courses[i], corner, wire,
               first(wire.from).name + "." + wire.output + " → " + first(wire.to).name + "." + wire.input);
    }
    for (std::size_t i = 0; i < graph.groups.size(); ++i) {
      const int g = graph.groups[i];
      const LayoutPoint& place = graph.layout.corners[i];
      drawBox(svg, boxes_[at(g)], {corner.x + place.x, corner.y + place.y}, at(g), first(g),
              grouped_.groups[at(g)], slowest_);
    }
  }

  const ReportData& data_;
  const ReportGroups& grouped_;
  std::vector<DrawnBox> boxes_;
  std::vector<DrawnGraph> graphs_;
  double slowest_ = 0;
};

}  // namespace

std::string drawGraphs(const ReportData& data, const ReportGroups& grouped) {
  return Drawing(data, grouped).svg();
}

}  // namespace sherd
