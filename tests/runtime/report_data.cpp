#include "report_data.h"

#include <algorithm>
#include <random>

namespace sherd::test {
namespace {

struct Row {
  const char *name, *type, *state, *why;
  double ms;
  std::vector<const char*> inputs, outputs;
};

ReportNode nodeOf(const Row& row) {
  ReportNode node;
  node.graph = "first_fracture.json";
  node.name = row.name;
  node.type = row.type;
  node.help = std::string("What ") + row.type + " does, in a sentence or two that say what comes out.";
  node.state = row.state;
  node.why = row.why;
  node.ms = row.ms;
  node.threads = row.ms > 0 ? 2 : 0;
  node.memoryBytes = static_cast<std::uint64_t>(2e6 + 31e3 * row.ms);
  node.cacheBytes = row.ms > 100 ? node.memoryBytes / 2 : 0;
  for (const char* input : row.inputs) node.inputs.push_back({input, "Value", "what is worked on"});
  for (const char* output : row.outputs) node.outputs.push_back({output, "Value", "what comes out"});
  node.params = {{"seed", "7", "0", "", "what random numbers begin with", false, false},
                 {"radius", "0.02", "0.02", "m", "of the patch that is hit", true, false}};
  return node;
}

int indexOf(const ReportData& data, const std::string& name) {
  const auto found = std::find_if(data.nodes.begin(), data.nodes.end(),
                                  [&](const ReportNode& node) { return node.name == name; });
  return static_cast<int>(found - data.nodes.begin());
}

std::vector<Row> vaseRows(bool failed) {
  return {
      {"mesh", "LoadMesh", "hit", "", 0, {}, {"mesh"}},
      {"tets", "Tetrahedralize", "hit", "", 0, {"mesh"}, {"tets"}},
      {"embed", "Embed", "hit", "", 0, {"tets"}, {"embedding"}},
      {"hit", "Simulate", "run", "young 2e6 → 3e6", 1840, {"body", "floor"}, {"energy", "impact"}},
      {"weights", "Weights", "run", "input energy changed", 3.2, {"energy", "beta"}, {"weights"}},
      {"paint", "ReadVdb", "not needed", "", 0, {}, {"beta"}},
      {"degree",
       "PredictDegree",
       "run",
       "input weights changed",
       912,
       {"weights", "embedding", "model"},
       {"degree", "sites"}},
      {"cells", "CVD", "run", "input weights changed", 211, {"weights", "embedding", "sites"}, {"cells"}},
      {"pieces", "Tessellate", failed ? "failed" : "run", "input cells changed", 655, {"cells"}, {"pieces"}},
      {"crack",
       "ExportCrackSurface",
       failed ? "skipped" : "run",
       "input pieces changed",
       failed ? 0. : 87.,
       {"pieces"},
       {"directory"}},
      {"picture",
       "Preview",
       failed ? "skipped" : "run",
       "input pieces changed",
       failed ? 0. : 1210.,
       {"pieces", "energy"},
       {"file", "picture"}},
      {"sheet",
       "ContactSheet",
       failed ? "skipped" : "run",
       "input pictures changed",
       failed ? 0. : 154.,
       {"pictures"},
       {"file", "picture"}},
  };
}

void addNodes(ReportData& data, const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    const bool hasFrames = std::string(row.name) == "picture" || std::string(row.name) == "crack";
    for (int frame = 1001; frame <= (hasFrames ? 1004 : 1001); ++frame) {
      data.nodes.push_back(nodeOf(row));
      if (!hasFrames) continue;
      data.nodes.back().context = "frame " + std::to_string(frame);
      data.nodes.back().ms *= 0.25;
      data.nodes.back().params.push_back(
          {"file", "out/" + std::to_string(frame) + ".png", "", "", "the file to write", false, false});
    }
  }
}

void addWires(ReportData& data) {
  const auto wire = [&](const char* from, const char* output, const char* to, const char* input) {
    for (std::size_t n = 0; n < data.nodes.size(); ++n)
      for (std::size_t m = 0; m < data.nodes.size(); ++m)
        if (data.nodes[n].name == from && data.nodes[m].name == to &&
            (data.nodes[n].context.empty() || data.nodes[m].context.empty() ||
             data.nodes[n].context == data.nodes[m].context))
          data.wires.push_back({static_cast<int>(n), static_cast<int>(m), output, input});
  };
  wire("mesh", "mesh", "tets", "mesh");
  wire("tets", "tets", "embed", "tets");
  wire("tets", "tets", "hit", "body");
  wire("hit", "energy", "weights", "energy");
  wire("paint", "beta", "weights", "beta");
  wire("weights", "weights", "degree", "weights");
  wire("embed", "embedding", "degree", "embedding");
  wire("weights", "weights", "cells", "weights");
  wire("embed", "embedding", "cells", "embedding");
  wire("degree", "sites", "cells", "sites");
  wire("cells", "cells", "pieces", "cells");
  wire("pieces", "pieces", "crack", "pieces");
  wire("pieces", "pieces", "picture", "pieces");
  wire("hit", "energy", "picture", "energy");
  wire("picture", "picture", "sheet", "pictures");
}

}  // namespace

ReportData vaseReport(bool failed) {
  ReportData data;
  data.title = "first_fracture.json";
  data.command = "sherd run graphs/first_fracture.json --set hit.young=3e6 --report out.html";
  data.ok = !failed;
  data.ms = 5123;
  addNodes(data, vaseRows(failed));
  ReportNode& cells = data.nodes[static_cast<std::size_t>(indexOf(data, "cells"))];
  cells.messages = {"12 sites, E_D = 1.9e-3 J·m²", "warning: 2 cells hold one node only"};
  if (failed)
    data.nodes[static_cast<std::size_t>(indexOf(data, "pieces"))].error =
        "graphs/first_fracture.json:26:5: pieces.cells: the cells have no tetrahedra; wire CVD's `cells`";
  else
    data.nodes[static_cast<std::size_t>(indexOf(data, "sheet"))].written = {"/shots/vase/out/sheet.png"};
  addWires(data);
  return data;
}

ReportData randomReport(int count, unsigned seed) {
  std::mt19937 random(seed);
  const char* const states[] = {"run", "hit", "failed", "skipped", "not needed"};
  ReportData data;
  data.title = "random.json";
  for (int n = 0; n < count; ++n) {
    data.nodes.push_back(nodeOf({"node",
                                 "Made",
                                 states[random() % 5],
                                 "",
                                 static_cast<double>(random() % 1000),
                                 {"a", "b", "c"},
                                 {"x", "y"}}));
    data.nodes.back().name += std::to_string(n);
    for (const char* input : {"a", "b", "c"})
      if (n > 0 && random() % 3 > 0)
        data.wires.push_back({n - 1 - static_cast<int>(random() % static_cast<unsigned>(std::min(n, 20))), n,
                              random() % 2 == 0 ? "x" : "y", input});
  }
  return data;
}

}  // namespace sherd::test
