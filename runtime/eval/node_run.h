// One node, run once: everything about it that doesn't concern the others.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/exec.h"
#include "eval/cache.h"
#include "graph/graph.h"

namespace sherd {

/// The node's parameters with those that are wired replaced by what came over the wire. `wired` is by
/// parameter.
Result<ParamValues> finalParams(const Graph::Node& node, const Outputs& wired);

struct NodeResult {
  std::optional<Error> error;
  Outputs outputs;
  std::vector<Message> messages;
  std::vector<std::string> written;
};

/// Runs the node. Exceptions and outputs that the type doesn't declare become errors. `onProgress` hears of
/// each per cent once. Values that are passed through keep their digest.
NodeResult runNode(const Graph::Node& node, const ParamValues& params, const Outputs& inputs,
                   const CancelToken& token, const std::function<void(double)>& onProgress);

}  // namespace sherd
