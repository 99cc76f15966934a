// Made-up nodes, and short ways to read, check and evaluate graphs of them.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "eval/evaluator.h"
#include "graph/graph.h"
#include "graph/node_type.h"
#include "graph/registry.h"

namespace sherd::test {

namespace fs = std::filesystem;

/// A directory that is removed with its content at the end of the test.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  const fs::path& path() const { return path_; }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& content) const;

 private:
  fs::path path_;
};

/// A value of some size.
struct Blob {
  static constexpr const char* typeName = "Blob";
  static constexpr int archiveVersion = 1;
  std::vector<double> numbers;
};
void hashValue(Hasher& hasher, const Blob& blob);
std::size_t byteSize(const Blob& blob);
void saveValue(ArchiveWriter& to, const Blob& blob);
std::optional<Blob> loadValue(ArchiveReader& from, std::type_identity<Blob>);

/// How often each of the made-up nodes ran.
struct Counters {
  std::atomic<int> constants{0}, adds{0}, blobs{0}, reads{0}, sinks{0};
};

/// Constant: `value` → "value" Number, "whole" Integer.
/// Add: inputs a, b (optional) Number, parameter `offset` → "sum".
/// MakeBlob: `size`, `seed` → "blob" Blob, computed in parallel. PassBlob: passes a Blob through.
/// SumBlob: Blob → "sum" Number.
/// ReadText: input file → "text" String. Word: `text` → "text" String.
/// Sink: input Number, output directory; writes "value.txt". Writes files.
/// Kinds: one parameter of every kind.
Registry madeUpNodes(const std::shared_ptr<Counters>& counters = std::make_shared<Counters>());

/// An environment in which only what is given is set.
Environment environment(const fs::path& current = "/current", const fs::path& assets = "/assets");

struct Checked {
  Graph graph;
  std::vector<std::string> errors, notes;
};
/// Reads and checks `text` as the file "test.json" in `directory`.
Checked check(const std::string& text, const Registry& registry, const std::vector<std::string>& sets = {},
              const std::vector<std::string>& vars = {}, const fs::path& directory = "/graphs");
/// A graph of the given "nodes" content and other keys (`"frames": "1-5", `), checked to be without errors.
Graph graphOf(const std::string& nodes, const Registry& registry, const fs::path& directory = "/graphs",
              const std::string& more = "");

/// The wanted nodes by name.
std::vector<int> nodesOf(const Graph& graph, const std::vector<std::string>& names);
/// The value at "node.port" of a report; empty where there is none.
Value valueAt(const Graph& graph, const EvalReport& report, const std::string& node, const std::string& port);
/// The number there.
double numberAt(const Graph& graph, const EvalReport& report, const std::string& node,
                const std::string& port);
/// The state of a node in a report, as a word; "absent" where it isn't in it.
std::string stateOf(const Graph& graph, const EvalReport& report, const std::string& node);

}  // namespace sherd::test
