// Evaluates what is wanted of a graph, and nothing else.
//
// Data flow: a node starts when all that it is wired to is there, so no thread ever waits for a result and
// chains of any length need no stack. At most as many nodes run at once as there are threads; each may itself
// run in parallel. Two nodes with the same key compute once. Values are let go of when their last reader has
// run, unless the cache keeps them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/exec.h"
#include "eval/cache.h"
#include "graph/graph.h"

namespace sherd {

enum class NodeState {
  Run,  ///< it ran
  Hit,  ///< its result was there, or another node with the same key made it
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
  int threads = 0;  ///< that it was allowed to use
  std::vector<Message> messages;
  std::vector<std::string> written;  ///< files, by absolute path
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
  bool keepGoing = false;  ///< after a failure, go on with what doesn't depend on it
};

/// Evaluates `wanted` (indices of nodes). The graph must have been checked without errors. A failure stops
/// the run, unless options say otherwise, by cancelling `token`, so that running nodes end soon: one token
/// serves one run. Nodes that write files always run; the others are looked up in the cache. Exceptions of
/// nodes are failures.
EvalReport evaluate(const Graph& graph, const std::vector<int>& wanted, Cache& cache, CancelToken& token,
                    const EvalOptions& options = {}, EvalListener* listener = nullptr);

}  // namespace sherd
