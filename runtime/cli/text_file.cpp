#include "cli/text_file.h"

#include <filesystem>
#include <system_error>

#include "base/atomic_file.h"
#include "base/line_diff.h"
#include "base/partial_file.h"
#include "graph/graph_file.h"

namespace sherd {

namespace fs = std::filesystem;

bool readTextFile(const std::string& path, TextFile& file, Diagnostics& diagnostics) {
  std::error_code problem;
  const fs::path absolute = fs::weakly_canonical(fs::absolute(path, problem), problem);
  file.source = std::make_shared<const Source>(Source{path, absolute.parent_path()});
  file.path = absolute.string();
  auto text = readGraphText(absolute);
  if (text.ok())
    file.text = std::move(text).value();
  else
    diagnostics.add({file.source, 0, 0}, "", text.error());
  return text.ok();
}

void changeTextFile(const TextFile& file, const std::string& text, bool write, Console& console,
                    Diagnostics& diagnostics) {
  if (text == file.text) return;
  console.out << unifiedDiff(file.text, text, file.source->name);
  if (!write) return;
  console.out.flush();
  const auto written = writeFileAtomically(file.path, text);
  const Result<void> cleaned = written.ok() ? removeAbandoned(file.path) : Result<void>(written.error());
  if (cleaned.ok())
    console.out << "wrote " << file.source->name << '\n';
  else
    diagnostics.add({file.source, 0, 0}, "", cleaned.error());
}

}  // namespace sherd
