// What the nodes of a graph were made of when it was last run, so that a plan can say what has changed since.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "eval/evaluator.h"
#include "eval/key.h"
#include "graph/graph.h"

namespace sherd {

/// One node at one frame and wedge.
struct PastNode {
  struct Input {
    std::string port, source;  ///< the node at the other end, with its frame and wedge where they are others
    Digest digest;
  };
  struct File {
    std::string param, path;
    Digest content;
  };
  std::string type;  ///< "Type@1", the implementation and the kind of processor
  std::vector<std::pair<std::string, std::string>> params;  ///< those that are not at their defaults, as text
  std::vector<File> files;
  std::vector<Input> inputs;
  Digest key;
};

using History = std::map<std::string, PastNode, std::less<>>;  ///< by Graph::labelOf

/// The name of a node as another one sees it: frame and wedge are only told where they aren't its own.
std::string sourceName(const Graph& graph, int reader, int source);

/// What a node is made of now. `digests` are the outputs of all nodes, empty where they aren't known; files
/// that can't be read have a digest of zero. `wiredFiles` are those of this node, as far as they are known.
PastNode describe(const Graph& graph, int node, const std::vector<std::vector<Digest>>& digests,
                  const WiredFiles& wiredFiles, FileDigests& files);

/// Brings the history of one shot up to date with what ran and what was a hit; nodes that weren't needed keep
/// their entries as long as the graph has nodes of their names.
void update(History& history, const Graph& graph, int shot, const EvalReport& report, FileDigests& files);

std::string pack(const History& history);
/// Empty where the bytes are none that pack() made.
History unpack(std::string_view bytes);

/// What differs, in words: "young_modulus 2e6 → 3e6", "beta.vdb has changed", "`tets` is another"; empty
/// where nothing does. At most a few things, the most telling first.
std::string difference(const PastNode& before, const PastNode& now, const NodeType& type);

}  // namespace sherd
