#include "cli/text_file.h"
#include "cli/verbs.h"
#include "graph/document.h"
#include "graph/json.h"

namespace sherd {
namespace {

/// Whether two texts hold the same values: the last guard before a file is written over.
bool sameContent(const std::string& a, const std::string& b) {
  Diagnostics ignored;  // what can't be parsed is not the same
  const auto first = parseJson(a, nullptr, ignored), second = parseJson(b, nullptr, ignored);
  return first && second && jsonText(*first) == jsonText(*second);
}

}  // namespace

int fmtVerb(const FmtOptions& options, Console& console) {
  int code = kOk;
  bool changes = false;
  for (const std::string& path : options.files) {
    Diagnostics diagnostics;
    TextFile file;
    if (readTextFile(path, file, diagnostics)) {
      const Document document(file.text, file.source, diagnostics);
      const std::string text = diagnostics.empty() ? document.formatted() : file.text;
      changes = changes || text != file.text;
      if (sameContent(file.text, text) || !diagnostics.empty())
        changeTextFile(file, text, options.write, console, diagnostics);
      else
        diagnostics.add({file.source, 0, 0}, "", "formatting would change the content",
                        "this is a mistake in this program; please report it");
    }
    printDiagnostics(diagnostics, console.err);
    if (!diagnostics.empty()) code = kWrongInput;
  }
  return code == kOk && changes && options.check ? kNodeFailed : code;
}

}  // namespace sherd
