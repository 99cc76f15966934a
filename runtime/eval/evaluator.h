// Evaluates what is wanted of a graph, and nothing else.
//
// First digests, then values. A node's key is made of its recipe and of the digests of what is wired to it,
// so a result that is known needs none of its inputs, and a change upstream that ends in the same output
// stops there. Values are made or loaded only for nodes that have to run: a graph whose results are all known
// loads nothing. A value that turns out to be lost (evicted, damaged) is made again.
//
// Data flow: a node starts when all that it needs is there, so no thread ever waits for a result and chains
// of any length need no stack. At most as many nodes run at once as there are threads; each may itself run in
// parallel. Two nodes with the same key compute once. Values are let go of when their last reader has run,
// unless the cache keeps them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/exec.h"
#include "eval/cache.h"
#include "eval/disk_store.h"
#include "graph/graph.h"

namespace sherd {

enum class NodeState {
  Run,  ///< it ran
  Hit,  ///< its result was known, or another node with the same key made it
  Failed,
  Skipped,  ///< something that it needs failed, or the run ended before it could
};
/// "run", "hit", "failed", "skipped".
const char* stateName(NodeState state);

/// What became of one node.
struct NodeReport {
  int node = 0;
  NodeState state = NodeState::Skipped;
  double ms = 0;  ///< from start to end; work of other nodes that its threads took up while waiting included
  int threads = 0;              ///< that it was allowed to use
  std::uint64_t bytes = 0;      ///< of its outputs, in memory
  std::uint64_t kept = 0;       ///< of them, written to disk in this run
  Digest key;                   ///< zero where it never came to be known
  std::vector<Digest> digests;  ///< of the outputs, in their order, where they are known
  std::vector<Message> messages;
  /// Parameters whose names of files came over wires, with these names.
  std::vector<std::pair<std::string, std::string>> wiredFiles;
  std::vector<std::string> written;  ///< files, by absolute path; of a hit those that are still there
  std::optional<Error> error;        ///< of a failed node
};

struct EvalReport {
  std::vector<NodeReport> nodes;   ///< of all needed nodes, in the order in which they ended
  std::map<int, Outputs> outputs;  ///< of the wanted nodes that came to an end
  bool cancelled = false;          ///< by the user
  double ms = 0;

  int count(NodeState state) const;
  bool ok() const { return !cancelled && count(NodeState::Failed) == 0; }
};

/// Told of what happens while it happens. Calls come from many threads, but never two at once.
class EvalListener {
 public:
  virtual ~EvalListener() = default;
  virtual void started(int /*node*/) {}
  virtual void progress(int /*node*/, double /*share*/) {
  }  ///< share of the node's work, in steps of 1 % at least
  virtual void finished(const NodeReport& /*report*/) {}
};

struct EvalOptions {
  bool keepGoing = false;     ///< after a failure, go on with what doesn't depend on it
  bool values = true;         ///< the values of wanted nodes are asked for, not only that they are known
  DiskStore* disk = nullptr;  ///< results are looked up here, too, and kept
};

/// Evaluates `wanted` (indices of nodes). The graph must have been checked without errors. A failure stops
/// the run, unless options say otherwise, by cancelling `token`, so that running nodes end soon: one token
/// serves one run. A node that writes files is a hit only where the files that it wrote are as it left them.
/// Exceptions of nodes are failures. < 1 µs for a node that is known, O(nodes + wires) in all.
EvalReport evaluate(const Graph& graph, const std::vector<int>& wanted, Cache& cache, CancelToken& token,
                    const EvalOptions& options = {}, EvalListener* listener = nullptr);

/// Whether keeping the result on disk is worth it: making it again takes longer than writing and reading it.
bool worthKeeping(double ms, std::uint64_t bytes);

}  // namespace sherd
