#include "cli/open_graph.h"
#include "cli/shots.h"
#include "cli/verbs.h"

namespace sherd {

int checkVerb(const ShotOptions& options, const Registry& registry, const Environment& environment,
              Console& console) {
  Diagnostics arguments;
  const std::vector<std::string> files = graphFiles(options.graphs, arguments);
  printDiagnostics(arguments, console.err);
  int code = arguments.empty() ? kOk : kWrongInput;
  for (const std::string& path : files) {
    ShotOptions one = options;
    one.graphs = {path};
    Diagnostics diagnostics;
    const Shots shots = openShots(one, Opening::ToCheck, registry, environment, diagnostics);
    for (const std::string& note : shots.notes) console.err << note << '\n';
    printDiagnostics(diagnostics, console.err);
    if (!diagnostics.empty()) {
      code = kWrongInput;
      continue;
    }
    console.out << path << ": " << (shots.isSubgraph.front() ? "a subgraph of " : "")
                << countText(shots.graph.nodes.size(), "node") << ", no errors\n";
  }
  return code;
}

}  // namespace sherd
