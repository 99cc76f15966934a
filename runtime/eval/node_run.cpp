#include "eval/node_run.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <mutex>
#include <new>

#include "graph/param.h"

namespace sherd {
namespace {

/// Passes progress on when another per cent is done; called from many threads.
class ProgressFilter {
 public:
  explicit ProgressFilter(const std::function<void(double)>& next) : next_(next) {}

  void operator()(double share) {
    if (!(share >= 0)) return;  // NaN too
    const int percent = static_cast<int>(std::min(share, 1.0) * 100);
    int last = last_.load(std::memory_order_relaxed);
    while (percent > last)
      if (last_.compare_exchange_weak(last, percent)) return next_(percent / 100.0);
  }

 private:
  const std::function<void(double)>& next_;
  std::atomic<int> last_{0};
};

Digest digestOf(const Value& value, std::span<const WireValue> inputs) {
  for (const WireValue& input : inputs)
    if (!input.value.empty() && input.value.address() == value.address() &&
        input.value.type().name == value.type().name)
      return input.digest;
  return value.digest();
}

/// Takes the outputs over with their digests, if they are what the type declares.
std::optional<Error> collect(const NodeType& type, const NodeIo& io, std::span<const WireValue> inputs,
                             Outputs& outputs) {
  outputs.resize(type.outputs.size());
  for (const auto& [port, value, label] : io.outputs()) {
    const PortInfo* declared = type.output(port);
    if (declared == nullptr)
      return failure("the node set an output \"" + port + "\" that it doesn't declare",
                     "this is a mistake in " + type.name + ", please report it");
    if (value.empty()) continue;
    if (declared->type != value.type().name)
      return failure("the node set a " + value.type().name + " where it declares a " + declared->type,
                     "this is a mistake in " + type.name + ", please report it", port);
    outputs[static_cast<std::size_t>(declared - type.outputs.data())] = {value, digestOf(value, inputs)};
  }
  return std::nullopt;
}

/// Runs the node and takes its outputs over. Hashing them is the node's affair, too: its value types do it.
std::optional<Error> callNode(const NodeType& type, const ParamValues& params, NodeIo& io,
                              std::span<const WireValue> inputs, Outputs& outputs) {
  try {
    if (const Result<void> done = type.run(params, io); !done.ok()) return done.error();
    return collect(type, io, inputs, outputs);
  } catch (const std::bad_alloc&) {
    return failure("out of memory", "use a smaller model or a coarser resolution");
  } catch (const std::exception& e) {
    return failure("an exception that the node didn't catch: " + std::string(e.what()),
                   "this is a mistake in " + type.name + ", please report it");
  } catch (...) {
    return failure("an unknown exception that the node didn't catch",
                   "this is a mistake in " + type.name + ", please report it");
  }
}

/// Hands the inputs over. An Error where a required one is missing.
std::optional<Error> setInputs(const Graph& graph, const Graph::Node& node, std::span<const WireValue> inputs,
                               NodeIo& io) {
  std::vector<bool> there(node.type->inputs.size(), false);
  for (std::size_t w = 0; w < inputs.size(); ++w) {
    const Graph::Wire& wire = node.inputs[w];
    const auto place = static_cast<std::size_t>(wire.to);
    const PortInfo& port = node.type->inputs[place];
    if (inputs[w].value.empty()) continue;
    there[place] = true;
    const auto context = graph.nodes[static_cast<std::size_t>(wire.node)].context;
    io.setInput(port.name, inputs[w].value,
                port.gathers ? graph.contexts[static_cast<std::size_t>(context)].label : std::string());
  }
  for (std::size_t p = 0; p < there.size(); ++p)
    if (node.type->inputs[p].required && !there[p])
      return failure("nothing came over the wire: the output that it comes from was left empty",
                     "see the messages of that node", node.type->inputs[p].name);
  return std::nullopt;
}

}  // namespace

Result<ParamValues> finalParams(const Graph::Node& node, std::span<const WireValue> wired) {
  ParamValues params = node.params;
  const auto directory =
      node.origin.source == nullptr ? std::filesystem::path() : node.origin.source->directory;
  for (std::size_t w = 0; w < wired.size(); ++w) {
    const ParamInfo& info = node.type->params[static_cast<std::size_t>(node.wiredParams[w].to)];
    auto read = readParam(info, wired[w].value, directory);
    if (!read.ok()) {
      Error error = read.error();
      error.kind = Error::Kind::Failed;
      error.port = info.name;
      return error;
    }
    params[info.name] = std::move(read).value();
  }
  return params;
}

NodeResult runNode(const Graph& graph, int i, const ParamValues& params, std::span<const WireValue> inputs,
                   const CancelToken& token, const std::function<void(double)>& onProgress, Memo* memo) {
  const Graph::Node& node = graph.nodes[static_cast<std::size_t>(i)];
  NodeResult result;
  std::mutex messagesMutex;
  ProgressFilter progress(onProgress);
  Exec exec;
  exec.cancel = &token;
  exec.onProgress = [&](double share) { progress(share); };
  exec.onMessage = [&](LogLevel level, const std::string& text) {
    const std::lock_guard lock(messagesMutex);
    result.messages.push_back({level, text});
  };
  NodeIo io(exec, memo);
  result.error = setInputs(graph, node, inputs, io);
  if (result.error) return result;
  result.error = callNode(*node.type, params, io, inputs, result.outputs);
  result.written = io.written();
  return result;
}

}  // namespace sherd
