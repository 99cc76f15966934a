// The page that `--report out.html` writes: one self-contained file with the graph drawn, what became of each
// node and why, and the pictures that were made.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"

namespace sherd {

struct ReportPort {
  std::string name, type, help;
};

struct ReportParam {
  std::string name, value, fallback, unit, help;
  bool isDefault = true, isWired = false;
};

/// One node at one frame and wedge. Nodes of one name are drawn as one box.
struct ReportNode {
  std::string graph;    ///< the shot that it belongs to; the same for all where there is only one
  std::string name;     ///< with the subgraphs that it is in: "break/cells"
  std::string context;  ///< "frame 1001, seed 7"; empty where the node doesn't depend on any
  std::string type, help;
  std::string state;  ///< "run", "hit", "failed" or "skipped"; all else is shown as "not needed"
  std::string why;    ///< why it ran: "young 2e6 → 3e6"
  double ms = 0;
  int threads = 0;
  std::uint64_t memoryBytes = 0, cacheBytes = 0;  ///< of its outputs, in memory and on disk
  std::vector<ReportPort> inputs, outputs;
  std::vector<ReportParam> params;
  std::vector<std::string> messages;  ///< warnings begin with "warning: "
  std::string error;                  ///< empty unless it failed
  std::vector<std::string> written;   ///< files, by absolute path
};

/// Those of different frames and wedges are drawn as one.
struct ReportWire {
  int from = 0, to = 0;  ///< entries of ReportData::nodes, of the same graph
  std::string output;
  std::string input;  ///< a port or a parameter
};

struct ReportData {
  std::string title;    ///< "first_fracture.json"
  std::string command;  ///< as it was typed
  bool ok = true, cancelled = false;
  double ms = 0;
  std::vector<ReportNode> nodes;
  std::vector<ReportWire> wires;
  /// PNG files to show, by absolute path. Those that are gone are left out; so are, and the page says how
  /// many, those beyond 20 MB in all.
  std::vector<std::string> pictures;
};

/// The whole page, the same for the same data. Loads nothing from anywhere: style, script and pictures are in
/// it. Texts from graphs and files are escaped. Of very large runs what matters most is shown, and the page
/// says how much is not: it has at most 10 MB beside the pictures. O((nodes + wires) log + bytes of the
/// pictures).
std::string reportPage(const ReportData& data);
/// Writes it, whole or not at all, and creates its directory where that is missing. The error says what is in
/// the way.
Result<void> writeReport(const ReportData& data, const std::string& file);

}  // namespace sherd
