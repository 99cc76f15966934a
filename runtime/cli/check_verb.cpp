#include "cli/open_graph.h"
#include "cli/verbs.h"

namespace sherd {

int checkVerb(const CheckOptions& options, const Registry& registry, const Environment& environment,
              Console& console) {
  int code = kOk;
  for (const std::string& path : options.graphs) {
    Diagnostics diagnostics;
    GraphFile file;
    const Graph graph = openGraph(path, options.vars, options.sets, registry, environment, diagnostics, file);
    std::vector<int> all;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) all.push_back(static_cast<int>(i));
    checkFiles(graph, all, diagnostics);
    printDiagnostics(diagnostics, console.err);
    if (diagnostics.empty())
      console.out << path << ": " << (file.subgraph != nullptr ? "a subgraph of " : "")
                  << countText(graph.nodes.size(), "node") << ", no errors\n";
    else
      code = kWrongInput;
  }
  return code;
}

}  // namespace sherd
