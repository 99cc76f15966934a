#include "cli/text_file.h"
#include "cli/verbs.h"
#include "graph/upgrade.h"

namespace sherd {

int upgradeVerb(const UpgradeOptions& options, const Registry& registry, Console& console) {
  int code = kOk;
  for (const std::string& path : options.files) {
    Diagnostics diagnostics;
    TextFile file;
    if (readTextFile(path, file, diagnostics)) {
      const Document document(file.text, file.source, diagnostics);
      Diagnostics
          ofForm;  // of the graph: they don't keep the rest from being upgraded, and `check` tells them
      if (diagnostics.empty()) {
        const GraphFile graph = readGraph(file.text, file.source, ofForm);
        const std::string text = withEdits(file.text, upgradeEdits(document, graph, registry, diagnostics));
        if (text == file.text && diagnostics.empty()) console.out << path << ": all nodes are current\n";
        changeTextFile(file, text, options.write, console, diagnostics);
      }
    }
    printDiagnostics(diagnostics, console.err);
    if (!diagnostics.empty()) code = kWrongInput;
  }
  return code;
}

}  // namespace sherd
