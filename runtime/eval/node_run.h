// One node, run once: everything about it that doesn't concern the others.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/exec.h"
#include "eval/cache.h"
#include "graph/graph.h"

namespace sherd {

/// What comes over one wire.
struct WireValue {
  Value value;  ///< empty where the output was left empty
  Digest digest;
};

/// The node's parameters with those that are wired replaced by what came over the wire. `wired` has one entry
/// per entry of Node::wiredParams.
Result<ParamValues> finalParams(const Graph::Node& node, std::span<const WireValue> wired);

struct NodeResult {
  std::optional<Error> error;
  Outputs outputs;
  std::vector<Message> messages;
  std::vector<std::string> written;
};

/// Runs the node of a graph. `inputs` has one entry per entry of Node::inputs. Exceptions and outputs that
/// the type doesn't declare become errors. `onProgress` hears of each per cent once. Values that are passed
/// through keep their digest. `memo`: where parts of its work are kept, or null.
NodeResult runNode(const Graph& graph, int node, const ParamValues& params, std::span<const WireValue> inputs,
                   const CancelToken& token, const std::function<void(double)>& onProgress,
                   Memo* memo = nullptr);

}  // namespace sherd
