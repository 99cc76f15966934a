// What a result depends on, as digests.
#pragma once

#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "base/result.h"
#include "eval/cache.h"
#include "eval/disk_store.h"
#include "graph/graph.h"

namespace sherd {

/// Digests of files by content. Each file is looked at once in the life of the object, and read only where
/// the store doesn't know it by its identity. Thread-safe.
class FileDigests {
 public:
  explicit FileDigests(DiskStore* disk = nullptr) : disk_(disk) {}
  /// O(size of the file) the first time. An Error where it can't be read.
  Result<Digest> of(const std::string& path);

 private:
  DiskStore* disk_;
  std::mutex mutex_;
  std::unordered_map<std::string, Digest> known_;
};

/// The digest of one file's content; O(its size).
Result<Digest> digestOfFile(const std::string& path);

/// The node's recipe with the content and name (readers go by its ending) of the files that `params` name,
/// and of those that are read with them (graph/companion_files.h). The Error's port is the parameter.
Result<Digest> recipeWithFiles(const Graph::Node& node, const ParamValues& params, FileDigests& files);

/// Parameters whose names of files came over wires, with these names.
using WiredFiles = std::vector<std::pair<std::string, std::string>>;
WiredFiles wiredFilesOf(const Graph::Node& node, const ParamValues& params);

/// Something that came over a wire, as far as a key is concerned.
struct KeyInput {
  std::uint64_t place = 0;  ///< of the input, or of the parameter with kKeyParam added
  Digest label;             ///< of a gathered value's label; else zero
  Digest digest;            ///< of the value; zero where the output was left empty
};
static_assert(sizeof(KeyInput) == 40);
inline constexpr std::uint64_t kKeyParam = std::uint64_t{1} << 32;

/// The key: recipe and inputs, in the order of the wires. O(inputs).
Digest resultKey(const Digest& recipe, std::span<const KeyInput> inputs);

/// Calls f(wire, isParam) for the inputs' wires, then for the parameters'.
template <class F>
void forEachWire(const Graph::Node& node, F&& f) {
  for (const Graph::Wire& wire : node.inputs) f(wire, false);
  for (const Graph::Wire& wire : node.wiredParams) f(wire, true);
}

/// Of a gathered value: the source's label. Else zero.
Digest labelDigest(const Graph& graph, const Graph::Node& node, const Graph::Wire& wire, bool isParam);

}  // namespace sherd
