#include "graph/graph_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "graph/graph_reader.h"

namespace sherd {
namespace {

constexpr std::size_t kLargestFile = std::size_t{64} << 20;

Error unreadable(std::string what, std::string remedy) {
  return Error{std::move(what), std::move(remedy), {}, Error::Kind::Input};
}

}  // namespace

Result<std::string> readGraphText(const std::filesystem::path& path) {
  std::error_code problem;
  if (std::filesystem::is_directory(path, problem))
    return unreadable("this is a directory", "name a graph file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return unreadable("the graph can't be opened: " + std::string(std::strerror(errno)), "name a graph file");
  std::string text;
  for (char block[1 << 16]; file && text.size() <= kLargestFile;) {
    file.read(block, sizeof block);
    text.append(block, static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad())
    return unreadable("the graph can't be read to its end", "check the disk and copy the file again");
  if (text.size() > kLargestFile) return unreadable("the file is larger than 64 MB", "this is no graph file");
  return text;
}

GraphFile readGraph(std::string_view text, const SourcePtr& source, Diagnostics& diagnostics) {
  GraphFile graph;
  graph.source = source;
  if (const auto root = parseJson(text, source, diagnostics)) GraphReader(diagnostics).readFile(*root, graph);
  return graph;
}

GraphFile readGraphFile(const std::string& path, Diagnostics& diagnostics) {
  std::error_code problem;
  const auto absolute = std::filesystem::absolute(path, problem).lexically_normal();
  const auto source = std::make_shared<const Source>(Source{path, absolute.parent_path()});
  const auto text = readGraphText(absolute);
  if (text.ok()) return readGraph(*text, source, diagnostics);
  diagnostics.add({source, 0, 0}, "", text.error());
  GraphFile nothing;
  nothing.source = source;
  return nothing;
}

}  // namespace sherd
