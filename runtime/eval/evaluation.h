// One evaluation: what is known of every node, and what follows when something becomes known. The contract is
// in evaluator.h; this is its machinery.
//
// A node goes through these states. Waiting: a digest that its key is made of isn't known yet. NeedsNames:
// the name of a file that it reads comes over a wire, so its key needs that value. Known: its digests are
// known; values may be there or not. NeedsValues: it has to run, and some of its inputs' values aren't there
// yet. Twin: another node with the same key is on its way, and will end this one, too.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/parallel.h"
#include "eval/evaluator.h"
#include "eval/key.h"
#include "eval/lookup.h"
#include "eval/node_run.h"

namespace sherd {

class Evaluation {
 public:
  Evaluation(const Graph& graph, const std::vector<int>& wanted, Cache& cache, CancelToken& token,
             const EvalOptions& options, EvalListener* listener);
  EvalReport evaluate();

 private:
  using Clock = std::chrono::steady_clock;
  enum class State : std::uint8_t {
    NotNeeded,
    Waiting,
    NeedsNames,
    NeedsValues,
    Known,
    Failed,
    Skipped,
    Twin
  };

  struct Slot {
    State state = State::NotNeeded;
    bool wanted = false;
    bool told = false;     ///< consumers know its digests
    bool counted = false;  ///< `values` is up to date
    bool started = false;  ///< its job is running, or has run
    bool reported = false;
    bool released = false;              ///< it won't ask for values any more
    int digests = 0;                    ///< wires whose source isn't known
    int values = 0;                     ///< wires that it waits for the values of
    int readers = 0;                    ///< wires that may still ask for its values
    std::uint64_t asked = 0, lost = 0;  ///< outputs whose values somebody wants; that could not be loaded
    Digest recipe, key;
    Outputs outputs;
    NodeReport report;
  };
  /// A wire, seen from its source.
  struct Reader {
    int node = 0, output = 0;
    bool isParam = false;
  };
  /// To run a node, or to load one output of it.
  struct Job {
    int node = 0;
    int output = kRun;
    static constexpr int kRun = -1;
  };

  Slot& slot(int i) { return slots_[static_cast<std::size_t>(i)]; }
  const Graph::Node& node(int i) const { return graph_.nodes[static_cast<std::size_t>(i)]; }
  bool has(const Slot& s, int output) const;
  bool isDone(const Slot& s) const { return s.state == State::Failed || s.state == State::Skipped; }
  template <class F>
  void forEachReader(int i, F&& f);

  // Set-up and end, by one thread.
  void prepare(const std::vector<int>& wanted);
  void connect();
  void sweep();
  void finalise();

  bool namesFile(int i, int output);

  // What follows from what; under mutex_. Chains are followed by the lists of things to do, never by
  // recursion.
  void drain();
  void resolve(int i);
  void look(int i, const ParamValues& params);
  void mustRun(int i);
  std::optional<std::vector<WireValue>> namesAtHand(int i);
  void lookWith(int i, const std::vector<WireValue>& wired);
  void countNames(int i);
  void countValues(int i);
  void ask(int i, int output);
  void request(int i, int output);
  void signal(int i, int output);
  void becomeKnown(int i, Known known);
  void tellDigests(int i);
  void complete(int i, const Outputs& outputs);
  void endTwins(int i);
  void fail(int i, const Error& error);
  void skipReaders(int i);
  void release(int i);
  void report(int i, NodeState state);

  // Jobs; outside of mutex_.
  void dispatch();
  void work();
  void doJob(Job job);
  void load(Job job);
  std::optional<NodeResult> attempt(int i);
  void run(int i);
  void conclude(int i, const NodeResult& result, double ms, const ResultRecord& record, bool later);
  bool isKept(int i, const ResultRecord& record, std::size_t output);
  std::uint64_t keep(int i, const ResultRecord& record, const Outputs& outputs);
  std::vector<WireValue> gather(const std::vector<Graph::Wire>& wires);
  ResultRecord recordOf(int i, const NodeResult& result, double ms) const;
  void warnOfDifference(int i, NodeResult& result);
  template <class F>
  void tell(F&& f);
  void tellReports(std::vector<const NodeReport*> reports);

  const Graph& graph_;
  Cache& cache_;
  CancelToken& token_;
  const EvalOptions options_;
  EvalListener* const listener_;
  FileDigests files_;
  AbandonedFiles abandoned_;
  TaskGroup* group_ = nullptr;

  std::vector<int> order_;        ///< needed nodes, sources first
  std::vector<int> place_;        ///< of a node in it
  std::vector<int> firstReader_;  ///< of a node in readers_; one entry more than nodes
  std::vector<Reader> readers_;
  std::vector<KeyInput> keyInputs_;  ///< scratch of look()

  bool sweeping_ = false;  ///< nodes are resolved in their order, not as they are told

  std::mutex listenerMutex_;
  std::mutex mutex_;  ///< guards all below
  std::vector<Slot> slots_;
  std::vector<int> toResolve_, toCount_, toSkip_, settled_;
  std::size_t counted_ = 0;  ///< of toCount_: the first in is the first out, as a plan foresees it
  std::vector<Job> ready_;   ///< the last is taken first
  std::size_t active_ = 0;   ///< tasks that are started and not over
  bool stopped_ = false;     ///< by a failure
  struct Flight {
    int leader = 0;  ///< the node that runs, or will
    std::vector<int> twins;
  };
  std::unordered_map<Digest, Flight> inFlight_;  ///< by key
  std::vector<const NodeReport*> outbox_;        ///< reports that the listener hasn't heard of
  EvalReport report_;
};

}  // namespace sherd
