// The rules that a node is held to by running it.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "base/parallel.h"
#include "base/partial_file.h"
#include "base/rng.h"
#include "eval/disk_store.h"
#include "eval/evaluator.h"
#include "eval/key.h"
#include "graph/migrate.h"
#include "graph/param.h"
#include "graph/subgraphs.h"
#include "support/contract.h"
#include "support/read_watch.h"

namespace sherd::test {
namespace {

std::string where(const Example& example) { return example.type().name + " (\"" + example.name() + "\")"; }

NodeResult run(const Example& example, const CancelToken& token = {}) {
  NodeResult result;
  inArena([&] {
    result = runNode(*example.graph, example.node, example.params, example.inputs, token, [](double) {});
  });
  return result;
}

std::string textOf(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics.sorted()) text += diagnostic.text() + '\n';
  return text;
}

Error evaluationError(const Graph& graph, const EvalReport& report) {
  for (const NodeReport& node : report.nodes)
    if (node.error) return failure(graph.labelOf(node.node) + ": " + node.error->text());
  return failure("the examples could not be evaluated");
}

}  // namespace

// ---- Examples

Result<std::unique_ptr<Examples>> Examples::read(const std::string& path, const Registry& registry,
                                                 const Environment& environment,
                                                 const std::vector<std::string>& vars) {
  Overrides overrides;
  for (const std::string& var : vars) {
    SHERD_ASSIGN(Assignment assignment, parseAssignment("--var", var, environment));
    overrides.vars.push_back(std::move(assignment));
  }
  Diagnostics diagnostics;
  std::vector<std::string> notes;
  GraphFile file = readGraphFile(path, diagnostics);
  expandSubgraphs(file, diagnostics);
  migrate(file, registry, diagnostics, notes);
  auto examples = std::make_unique<Examples>();
  examples->path_ = path;
  examples->graph_ = checkGraph(file, registry, overrides, environment, diagnostics);
  if (!diagnostics.empty()) return failure(textOf(diagnostics));
  return examples;
}

Result<std::vector<Example>> Examples::of(const NodeType& type) {
  std::vector<Example> examples;
  std::set<int> sources;
  for (std::size_t n = 0; n < graph_.nodes.size(); ++n) {
    const Graph::Node& node = graph_.nodes[n];
    if (node.type->name != type.name) continue;
    examples.push_back({&graph_, static_cast<int>(n), {}, {}});
    forEachWire(node, [&](const Graph::Wire& wire, bool) { sources.insert(wire.node); });
  }
  if (examples.empty()) return failure(type.name + " has no example", "add it to " + path_);
  CancelToken token;
  const EvalReport report = evaluate(graph_, {sources.begin(), sources.end()}, cache_, token);
  if (!report.ok()) return evaluationError(graph_, report);
  const auto valueOf = [&](const Graph::Wire& wire) {
    const Output& output = report.outputs.at(wire.node).at(static_cast<std::size_t>(wire.output));
    return WireValue{output.value, output.digest};
  };
  for (Example& example : examples) {
    const Graph::Node& node = graph_.nodes[static_cast<std::size_t>(example.node)];
    std::vector<WireValue> wired;
    for (const Graph::Wire& wire : node.inputs) example.inputs.push_back(valueOf(wire));
    for (const Graph::Wire& wire : node.wiredParams) wired.push_back(valueOf(wire));
    SHERD_ASSIGN(example.params, finalParams(node, wired));
  }
  return examples;
}

Faults Examples::missing(const Registry& registry) const {
  std::set<std::string> there;
  for (const Graph::Node& node : graph_.nodes) there.insert(node.type->name);
  Faults faults;
  for (const NodeType* type : registry.all())
    if (!there.contains(type->name)) faults.push_back(type->name + ": has no example; add it to " + path_);
  return faults;
}

// ---- Undeclared reads

namespace {

bool beginsWithOneOf(const std::string& text, const std::set<std::string>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const std::string& beginning) { return text.rfind(beginning, 0) == 0; });
}

/// Whether the node says that it reads or writes this file.
bool isDeclared(const std::string& path, const Example& example) {
  for (const ParamInfo& info : example.type().params) {
    if (!isPath(info.kind)) continue;
    const std::string& declared = std::get<std::string>(example.params.at(info.name));
    if (path == declared) return true;
    // Writing looks beside the file for what a killed run left.
    const bool isBeside =
        partialTarget(path) == declared || path == std::filesystem::path(declared).parent_path();
    if (info.kind == ParamKind::OutputFile && isBeside) return true;
    if (info.kind == ParamKind::OutputDirectory && path.rfind(declared + '/', 0) == 0) return true;
  }
  return false;
}

}  // namespace

Faults undeclaredReads(const Example& example, const ContractExceptions& exceptions) {
  // The thread library reads its settings when it starts, which is none of the node's business.
  inArena([] { parallelFor({}, 64, 1, [](std::size_t, std::size_t) {}); });
  ReadWatch watch;
  const NodeResult result = run(example);
  const WatchedReads reads = watch.stop();
  Faults faults;
  if (result.error) faults.push_back(where(example) + ": " + result.error->text());
  for (const std::string& file : reads.files)
    if (!isDeclared(file, example) && !beginsWithOneOf(file, exceptions.files))
      faults.push_back(where(example) + ": opens the file \"" + file + "\", which no parameter names");
  for (const std::string& variable : reads.variables)
    if (!beginsWithOneOf(variable, exceptions.variables))
      faults.push_back(where(example) + ": reads the environment variable " + variable +
                       ", which is no part of its key");
  return faults;
}

// ---- Determinism

namespace {

/// What a run left, by the names of outputs and files.
using Left = std::map<std::string, Digest>;

Result<Left> runAndDigest(const Example& example) {
  const NodeResult result = run(example);
  if (result.error) return *result.error;
  Left left;
  for (std::size_t o = 0; o < result.outputs.size(); ++o) {
    const Value& value = result.outputs[o].value;
    left[example.type().outputs[o].name] = value.empty() ? Digest{} : value.type().digest(value.address());
  }
  for (const std::string& file : result.written) {
    SHERD_ASSIGN(left['"' + file + '"'], digestOfFile(file));
  }
  return left;
}

class ThreadLimitGuard {
 public:
  ~ThreadLimitGuard() { setThreadLimit(0); }
};

}  // namespace

Faults nondeterminism(const Example& example) {
  const ThreadLimitGuard guard;
  Faults faults;
  std::optional<Left> first;
  for (const int threads : {1, 2, 4, 1}) {
    setThreadLimit(threads);
    const auto left = runAndDigest(example);
    if (!left.ok()) return {where(example) + ": " + left.error().text()};
    if (!first) {
      first = *left;
      continue;
    }
    for (const auto& [name, digest] : *left)
      if (const auto found = first->find(name); found == first->end() || found->second != digest)
        faults.push_back(where(example) + ": " + name + " is another one " +
                         (threads == 1 ? "the second time"
                                       : "with " + std::to_string(threads) + " threads than with one"));
    if (left->size() != first->size()) faults.push_back(where(example) + ": writes other files every time");
  }
  return faults;
}

// ---- Round trip through the disk cache

namespace {

struct Kept {
  std::string port;
  const ValueType* type = nullptr;
  Digest digest;
};

/// Runs the node and saves its outputs; the values are gone when it returns.
Result<std::vector<Kept>> runAndSave(const Example& example, DiskStore& store) {
  const NodeResult result = run(example);
  if (result.error) return *result.error;
  std::vector<Kept> kept;
  for (std::size_t o = 0; o < result.outputs.size(); ++o) {
    const auto& [value, digest] = result.outputs[o];
    if (value.empty()) continue;
    const std::string& port = example.type().outputs[o].name;
    if (value.type().save == nullptr || !store.save(value, digest, 1e4))
      return failure(port + " can't be kept in the disk cache", "give its type saveValue and loadValue");
    kept.push_back({port, &value.type(), digest});
  }
  return kept;
}

}  // namespace

Faults roundTripFaults(const Example& example, const std::string& scratch) {
  const std::string directory = scratch + "/cache_" + example.name();
  auto store = DiskStore::open(directory);
  if (!store.ok()) return {where(example) + ": " + store.error().text()};
  const auto kept = runAndSave(example, **store);
  if (!kept.ok()) return {where(example) + ": " + kept.error().text()};
  store->reset();
  const auto again = DiskStore::open(directory);
  if (!again.ok()) return {where(example) + ": " + again.error().text()};
  Faults faults;
  for (const auto& [port, type, digest] : *kept) {
    const Value value = (*again)->load(*type, digest);
    if (value.empty())
      faults.push_back(where(example) + ": " + port + " doesn't come back from the disk cache");
    else if (type->digest(value.address()) != digest)
      faults.push_back(where(example) + ": " + port + " comes back from the disk cache as something else");
  }
  return faults;
}

// ---- Cancelling

namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Cancels a token after a while, unless it is told before that this is no longer needed.
class Canceller {
 public:
  Canceller(CancelToken& token, double afterMs)
      : thread_([this, &token, afterMs] { wait(token, afterMs); }) {}
  ~Canceller() { stop(); }
  Canceller(const Canceller&) = delete;
  Canceller& operator=(const Canceller&) = delete;

  /// The lesser of time and processor time since the cancellation, in ms; nothing where it didn't come to it.
  std::optional<double> sinceCancelled() const {
    const std::lock_guard lock(mutex_);
    if (!cancelled_) return std::nullopt;
    const double processor = 1e3 * static_cast<double>(std::clock() - processorThen_) / CLOCKS_PER_SEC;
    return std::min(msSince(then_), processor);
  }
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
  }

 private:
  void wait(CancelToken& token, double afterMs) {
    std::unique_lock lock(mutex_);
    if (wake_.wait_for(lock, std::chrono::duration<double, std::milli>(afterMs), [this] { return stopped_; }))
      return;
    then_ = Clock::now();
    processorThen_ = std::clock();
    cancelled_ = true;
    token.cancel();
  }

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stopped_ = false, cancelled_ = false;
  Clock::time_point then_;
  std::clock_t processorThen_ = 0;
  std::thread thread_;  // last, since it uses the others
};

struct CancelledRun {
  std::optional<double> ms;  ///< from the cancellation to the end; nothing: done before
  std::optional<Error> error;
};

CancelledRun cancelAfter(const Example& example, double afterMs) {
  CancelToken token;
  Canceller canceller(token, afterMs);
  const NodeResult result = run(example, token);
  const std::optional<double> ms = canceller.sinceCancelled();
  canceller.stop();
  return {ms, result.error};
}

/// The quickest of several runs that are cancelled after the same time.
CancelledRun quickest(const Example& example, double afterMs, double mostMs, int repetitions) {
  CancelledRun best = cancelAfter(example, afterMs);
  for (int r = 1; r < repetitions && best.ms.value_or(0) > mostMs; ++r) {
    CancelledRun next = cancelAfter(example, afterMs);
    if (next.ms && *next.ms < *best.ms) best = next;
  }
  return best;
}

double boundOf(const NodeType& type, double mostMs) {
  for (const Uninterruptible& call : type.uninterruptibles) mostMs = std::max(mostMs, 3 * call.longestMs);
  return mostMs;
}

std::string rounded(double number) { return std::to_string(std::lround(number)); }

}  // namespace

CancelResult cancelling(const Example& example, const CancelTrial& trial) {
  CancelResult result;
  const Clock::time_point start = Clock::now();
  if (const auto error = run(example).error) {
    result.faults.push_back(where(example) + ": " + error->text());
    return result;
  }
  result.usualMs = msSince(start);
  const double mostMs = boundOf(example.type(), trial.mostMs);
  Rng rng(trial.seed);
  for (int d = 0; d < trial.delays; ++d) {
    const double share = (d + rng.uniform()) / trial.delays;
    const CancelledRun cancelled = quickest(example, share * result.usualMs, mostMs, trial.repetitions);
    if (!cancelled.ms) continue;
    ++result.cancelled;
    const std::string at = " at " + rounded(100 * share) + " % of its " + rounded(result.usualMs) + " ms";
    if (*cancelled.ms >= result.longestMs) result.longestMs = *cancelled.ms, result.longestAt = share;
    if (*cancelled.ms > mostMs)
      result.faults.push_back(where(example) + ": ends " + rounded(*cancelled.ms) +
                              " ms after it is cancelled" + at + "; it would have to in " + rounded(mostMs) +
                              ": check exec.cancelled() more often, or declare the library's call "
                              "with uninterruptible()");
    if (cancelled.error && cancelled.error->kind != Error::Kind::Cancelled)
      result.faults.push_back(where(example) + ": cancelled" + at + ", it fails with \"" +
                              cancelled.error->text() + "\" instead of cancelledError()");
  }
  return result;
}

}  // namespace sherd::test
