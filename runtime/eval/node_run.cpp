#include "eval/node_run.h"

#include <algorithm>
#include <exception>
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

Result<void> callNode(const NodeType& type, const ParamValues& params, NodeIo& io) {
  try {
    return type.run(params, io);
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

Digest digestOf(const Value& value, const Outputs& inputs) {
  for (const auto& [port, input] : inputs)
    if (!input.value.empty() && input.value.address() == value.address() &&
        input.value.type().name == value.type().name)
      return input.digest;
  return value.digest();
}

/// Takes the outputs over with their digests, if they are what the type declares.
std::optional<Error> collect(const NodeType& type, const NodeIo& io, const Outputs& inputs,
                             Outputs& outputs) {
  for (const auto& [port, value, label] : io.outputs()) {
    const PortInfo* declared = type.output(port);
    if (declared == nullptr)
      return failure("the node set an output \"" + port + "\" that it doesn't declare",
                     "this is a mistake in " + type.name + ", please report it");
    if (value.empty()) continue;
    if (declared->type != value.type().name)
      return failure("the node set a " + value.type().name + " where it declares a " + declared->type,
                     "this is a mistake in " + type.name + ", please report it", port);
    outputs[port] = {value, digestOf(value, inputs)};
  }
  return std::nullopt;
}

}  // namespace

Result<ParamValues> finalParams(const Graph::Node& node, const Outputs& wired) {
  ParamValues params = node.params;
  for (const Graph::Wire& wire : node.wiredParams) {
    const auto found = wired.find(wire.to);
    const Value value = found == wired.end() ? Value() : found->second.value;
    const auto directory =
        node.origin.source == nullptr ? std::filesystem::path() : node.origin.source->directory;
    auto read = readParam(*node.type->param(wire.to), value, directory);
    if (!read.ok()) {
      Error error = read.error();
      error.kind = Error::Kind::Failed;
      error.port = wire.to;
      return error;
    }
    params[wire.to] = std::move(read).value();
  }
  return params;
}

NodeResult runNode(const Graph::Node& node, const ParamValues& params, const Outputs& inputs,
                   const CancelToken& token, const std::function<void(double)>& onProgress) {
  NodeResult result;
  for (const PortInfo& port : node.type->inputs) {
    if (!port.required || inputs.contains(port.name)) continue;
    result.error = failure("nothing came over the wire: the output that it comes from was left empty",
                           "see the messages of that node", port.name);
    return result;
  }
  std::mutex messagesMutex;
  ProgressFilter progress(onProgress);
  Exec exec;
  exec.cancel = &token;
  exec.onProgress = [&](double share) { progress(share); };
  exec.onMessage = [&](LogLevel level, const std::string& text) {
    const std::lock_guard lock(messagesMutex);
    result.messages.push_back({level, text});
  };
  NodeIo io(exec);
  for (const auto& [port, input] : inputs) io.setInput(port, input.value);
  const Result<void> done = callNode(*node.type, params, io);
  result.written = io.written();
  if (done.ok())
    result.error = collect(*node.type, io, inputs, result.outputs);
  else
    result.error = done.error();
  return result;
}

}  // namespace sherd
