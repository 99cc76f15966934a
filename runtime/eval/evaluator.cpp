#include "eval/evaluator.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <unordered_map>

#include "base/parallel.h"
#include "eval/key.h"
#include "eval/node_run.h"

namespace sherd {
namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

class Evaluation {
 public:
  Evaluation(const Graph& graph, const std::vector<int>& wanted, Cache& cache, CancelToken& token,
             const EvalOptions& options, EvalListener* listener)
      : graph_(graph),
        cache_(cache),
        token_(token),
        options_(options),
        listener_(listener),
        slots_(graph.nodes.size()) {
    for (const int i : wanted) slot(i).wanted = true;
    const std::vector<int> needed = neededNodes(graph, wanted);
    for (const int i : needed)
      forEachWire(i, [&](const Graph::Wire& wire) {
        ++slot(i).missing;
        ++slot(wire.node).readers;
        slot(wire.node).consumers.push_back(i);
      });
    for (auto it = needed.rbegin(); it != needed.rend(); ++it)  // the last is taken first
      if (slot(*it).missing == 0) ready_.push_back(*it);
  }

  EvalReport evaluate() {
    const auto start = Clock::now();
    inArena([&] {
      TaskGroup group;
      group_ = &group;
      dispatch();
      group.wait();
    });
    // A failure sets the token as well; only what came from outside counts as cancelled.
    report_.cancelled = token_.cancelled() && !stopped_;
    report_.ms = msSince(start);
    return std::move(report_);
  }

 private:
  /// What is known of one node. Guarded by mutex_; but `outputs`, once there, are read without it by the
  /// nodes that wait for them, until the last of these has ended.
  struct Slot {
    bool wanted = false;
    bool blocked = false;        ///< something that it needs failed or was skipped
    std::size_t missing = 0;     ///< wires whose other end hasn't ended yet
    std::size_t readers = 0;     ///< wires that have yet to be read
    std::vector<int> consumers;  ///< one entry per wire
    Outputs outputs;
  };

  /// A node on its way through process().
  struct Work {
    NodeReport report;
    ParamValues params;
    Outputs inputs;
    Clock::time_point start = Clock::now();
  };

  Slot& slot(int i) { return slots_[static_cast<std::size_t>(i)]; }
  const Graph::Node& node(int i) const { return graph_.nodes[static_cast<std::size_t>(i)]; }

  template <class F>
  void forEachWire(int i, F&& f) const {
    for (const Graph::Wire& wire : node(i).inputs) f(wire);
    for (const Graph::Wire& wire : node(i).wiredParams) f(wire);
  }

  template <class F>
  void tell(F&& f) {
    if (listener_ == nullptr) return;
    const std::lock_guard lock(listenerMutex_);
    f(*listener_);
  }

  /// Starts tasks for ready nodes, at most one per thread: more would only be taken up by threads that wait
  /// inside of a node, and nest there.
  void dispatch() {
    std::vector<int> starting;
    {
      const std::lock_guard lock(mutex_);
      const auto limit = static_cast<std::size_t>(threadLimit());
      for (; !ready_.empty() && active_ < limit; ++active_) {
        starting.push_back(ready_.back());
        ready_.pop_back();
      }
    }
    for (const int i : starting) group_->run([this, i] { task(i); });
  }

  void task(int i) {
    process(i);
    {
      const std::lock_guard lock(mutex_);
      --active_;
    }
    dispatch();
  }

  bool mayRun(int i) {
    const std::lock_guard lock(mutex_);
    return !slot(i).blocked && !token_.cancelled();
  }

  void process(int i) {
    Work work;
    work.report.node = i;
    if (!mayRun(i)) return finish(std::move(work.report), {});
    work.report.threads = threadLimit();
    work.inputs = gather(node(i).inputs);
    auto params = finalParams(node(i), gather(node(i).wiredParams));
    if (!params.ok()) return fail(std::move(work.report), params.error());
    work.params = std::move(params).value();
    if (node(i).type->writesFiles) {
      Outputs outputs = run(work);
      return finish(std::move(work.report), outputs);
    }
    const auto key = resultKey(*node(i).type, work.params, work.inputs, files_);
    if (key.ok())
      lookUpOrRun(std::move(work), *key);
    else
      fail(std::move(work.report), key.error());
  }

  void lookUpOrRun(Work work, const Digest& key) {
    {
      const std::lock_guard lock(mutex_);
      const auto [waiting, isFirst] = inFlight_.try_emplace(key);
      if (!isFirst) {  // another node is making this very result, and will end this one too
        waiting->second.push_back(work.report.node);
        return;
      }
    }
    Outputs outputs;
    if (auto cached = cache_.find(key)) {
      work.report.state = NodeState::Hit;
      work.report.messages = std::move(cached->messages);
      work.report.ms = msSince(work.start);
      outputs = std::move(cached->outputs);
    } else {
      outputs = run(work);
      if (work.report.state == NodeState::Run) cache_.insert(key, {outputs, work.report.messages});
    }
    std::vector<int> waiting;
    {
      const std::lock_guard lock(mutex_);
      waiting = std::move(inFlight_.at(key));
      inFlight_.erase(key);
    }
    for (const int other : waiting) {
      NodeReport report = work.report;
      report.node = other;
      report.ms = 0;
      if (report.state == NodeState::Run) report.state = NodeState::Hit;
      finish(std::move(report), outputs);
    }
    finish(std::move(work.report), outputs);
  }

  /// What came over the wires; those that were left empty are not in it.
  Outputs gather(const std::vector<Graph::Wire>& wires) {
    Outputs values;
    for (const Graph::Wire& wire : wires) {
      const Outputs& from = slot(wire.node).outputs;
      const auto found = from.find(wire.output);
      if (found != from.end()) values.emplace(wire.to, found->second);
    }
    return values;
  }

  /// Runs the node and writes down how it went. Its outputs are empty unless it ran to its end.
  Outputs run(Work& work) {
    NodeReport& report = work.report;
    const int i = report.node;
    tell([i](EvalListener& listener) { listener.started(i); });
    NodeResult result = runNode(node(i), work.params, work.inputs, token_, [&](double share) {
      tell([&](EvalListener& listener) { listener.progress(i, share); });
    });
    report.ms = msSince(work.start);
    report.messages = std::move(result.messages);
    report.written = std::move(result.written);
    if (!result.error && (node(i).type->writesFiles || !token_.cancelled())) {
      report.state = NodeState::Run;
      return std::move(result.outputs);
    }
    // Under cancellation parallel loops leave blocks out, so neither result nor error of the node means
    // anything.
    if (token_.cancelled()) return {};
    report.state = NodeState::Failed;
    report.error = std::move(result.error);
    return {};
  }

  void fail(NodeReport report, const Error& error) {
    report.state = NodeState::Failed;
    report.error = error;
    finish(std::move(report), {});
  }

  /// Hands the outputs on, makes ready what now can run, and lets go of what nobody will read again.
  void finish(NodeReport report, const Outputs& outputs) {
    tell([&](EvalListener& listener) { listener.finished(report); });
    const std::lock_guard lock(mutex_);
    const int i = report.node;
    const bool done = report.state == NodeState::Run || report.state == NodeState::Hit;
    if (report.state == NodeState::Failed && !options_.keepGoing && !stopped_) {
      stopped_ = true;
      token_.cancel();
    }
    Slot& self = slot(i);
    if (self.readers > 0) self.outputs = outputs;
    if (self.wanted && done) report_.outputs[i] = outputs;
    for (const int consumer : self.consumers) {
      Slot& next = slot(consumer);
      next.blocked = next.blocked || !done;
      if (--next.missing == 0) ready_.push_back(consumer);
    }
    forEachWire(i, [&](const Graph::Wire& wire) {
      Slot& source = slot(wire.node);
      if (--source.readers == 0) source.outputs.clear();
    });
    report_.nodes.push_back(std::move(report));
  }

  const Graph& graph_;
  Cache& cache_;
  CancelToken& token_;
  const EvalOptions options_;
  EvalListener* const listener_;
  TaskGroup* group_ = nullptr;
  FileDigests files_;

  std::mutex listenerMutex_;
  std::mutex mutex_;  ///< guards all below
  std::vector<Slot> slots_;
  std::vector<int> ready_;
  std::size_t active_ = 0;  ///< tasks that are started and not over
  bool stopped_ = false;    ///< by a failure
  std::unordered_map<Digest, std::vector<int>>
      inFlight_;  ///< results in the making, and who else waits for them
  EvalReport report_;
};

}  // namespace

const char* stateName(NodeState state) {
  switch (state) {
    case NodeState::Run:
      return "run";
    case NodeState::Hit:
      return "hit";
    case NodeState::Failed:
      return "failed";
    case NodeState::Skipped:
      return "skipped";
  }
  return "";
}

int EvalReport::count(NodeState state) const {
  return static_cast<int>(std::count_if(nodes.begin(), nodes.end(),
                                        [&](const NodeReport& report) { return report.state == state; }));
}

EvalReport evaluate(const Graph& graph, const std::vector<int>& wanted, Cache& cache, CancelToken& token,
                    const EvalOptions& options, EvalListener* listener) {
  return Evaluation(graph, wanted, cache, token, options, listener).evaluate();
}

}  // namespace sherd
