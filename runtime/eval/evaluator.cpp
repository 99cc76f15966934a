#include "eval/evaluator.h"

#include <algorithm>

#include "eval/evaluation.h"
#include "eval/node_memo.h"

namespace sherd {

namespace {

double msSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

EvalReport Evaluation::evaluate() {
  const auto start = Clock::now();
  sweep();
  tellReports(std::move(outbox_));
  outbox_.clear();
  if (!ready_.empty())
    inArena([&] {
      TaskGroup group;
      group_ = &group;
      dispatch();
      group.wait();
    });
  // A failure sets the token as well; only what came from outside counts as cancelled.
  report_.cancelled = token_.cancelled() && !stopped_;
  finalise();
  tellReports(std::move(outbox_));
  report_.ms = msSince(start);
  return std::move(report_);
}

template <class F>
void Evaluation::tell(F&& f) {
  if (listener_ == nullptr) return;
  const std::lock_guard lock(listenerMutex_);
  f(*listener_);
}

void Evaluation::tellReports(std::vector<const NodeReport*> reports) {
  if (listener_ == nullptr || reports.empty()) return;
  const std::lock_guard lock(listenerMutex_);
  for (const NodeReport* report : reports) listener_->finished(*report);
}

/// Starts tasks for ready jobs, at most one per thread: more would only be taken up by threads that wait
/// inside of a node, and nest there.
void Evaluation::dispatch() {
  std::size_t starting = 0;
  {
    const std::lock_guard lock(mutex_);
    const auto limit = static_cast<std::size_t>(threadLimit());
    while (active_ < limit && starting < ready_.size()) {
      ++active_;
      ++starting;
    }
  }
  for (; starting > 0; --starting) group_->run([this] { work(); });
}

/// Does jobs one after the other as long as they are quick: handing each to a new task takes longer than many
/// of them. Not for long, since the thread may be one that waits inside of a node.
void Evaluation::work() {
  constexpr std::chrono::microseconds kShift(500);
  const auto start = Clock::now();
  do {
    Job job;
    bool isMore = false;
    {
      const std::lock_guard lock(mutex_);
      if (ready_.empty()) {
        --active_;
        return;
      }
      job = ready_.back();
      ready_.pop_back();
      isMore = !ready_.empty() && active_ < static_cast<std::size_t>(threadLimit());
    }
    if (isMore) dispatch();
    doJob(job);
  } while (Clock::now() - start < kShift);
  {
    const std::lock_guard lock(mutex_);
    --active_;
  }
  dispatch();
}

void Evaluation::doJob(Job job) {
  std::vector<const NodeReport*> reports;
  {
    const std::lock_guard lock(mutex_);
    const State state = slot(job.node).state;
    const bool isRun = job.output == Job::kRun;
    if (token_.cancelled() || (isRun && state != State::NeedsValues && state != State::NeedsNames)) return;
    slot(job.node).started = slot(job.node).started || (isRun && state == State::NeedsValues);
    if (job.output == Job::kRun && state == State::NeedsNames) {
      lookWith(job.node, gather(node(job.node).wiredParams));
      drain();
      reports.swap(outbox_);
      job.node = -1;
    }
  }
  tellReports(std::move(reports));
  if (job.node < 0) return;
  if (job.output == Job::kRun)
    run(job.node);
  else
    load(job);
}

void Evaluation::load(Job job) {
  const auto o = static_cast<std::size_t>(job.output);
  Digest digest;
  {
    const std::lock_guard lock(mutex_);
    if (slot(job.node).state != State::Known || has(slot(job.node), job.output)) return;
    digest = slot(job.node).outputs[o].digest;
  }
  Value value = options_.disk->load(*node(job.node).type->outputs[o].value, digest);
  std::vector<const NodeReport*> reports;
  {
    const std::lock_guard lock(mutex_);
    Slot& s = slot(job.node);
    if (has(s, job.output)) return;  // it ran meanwhile, for the sake of another output
    if (!value.empty()) {
      s.outputs[o].value = std::move(value);
      signal(job.node, job.output);
    } else {
      s.lost |= std::uint64_t{1} << (o & 63);
      if (s.state == State::Known) mustRun(job.node);
    }
    drain();
    reports.swap(outbox_);
  }
  tellReports(std::move(reports));
}

/// What came over the wires.
std::vector<WireValue> Evaluation::gather(const std::vector<Graph::Wire>& wires) {
  std::vector<WireValue> values;
  values.reserve(wires.size());
  for (const Graph::Wire& wire : wires) {
    const Output& output = slot(wire.node).outputs[static_cast<std::size_t>(wire.output)];
    values.push_back({output.value, output.digest});
  }
  return values;
}

ResultRecord Evaluation::recordOf(int i, const NodeResult& result, double ms) const {
  const Slot& s = slots_[static_cast<std::size_t>(i)];
  ResultRecord record;
  record.key = s.key;
  record.recipe = s.recipe;
  record.ms = ms;
  for (const Output& output : result.outputs)
    record.outputs.push_back({output.digest, output.value.empty() ? 0 : output.value.bytes()});
  record.messages = result.messages;
  for (const std::string& path : result.written) record.written.push_back({path, FileIdentity::of(path)});
  return record;
}

void Evaluation::warnOfDifference(int i, NodeResult& result) {
  const Slot& s = slot(i);
  if (!s.told) return;
  for (std::size_t o = 0; o < s.outputs.size(); ++o)
    if (s.outputs[o].digest != result.outputs[o].digest) {
      result.messages.push_back({LogLevel::Warning,
                                 "ran again and made another result than before from the same "
                                 "input; this is a mistake in " +
                                     node(i).type->name + ", please report it"});
      return;
    }
}

/// Runs the node and tells what came of it: nothing, where it was cancelled.
std::optional<NodeResult> Evaluation::attempt(int i) {
  const Graph::Node& n = node(i);
  tell([i](EvalListener& listener) { listener.started(i); });
  NodeResult result;
  const std::vector<WireValue> inputs = gather(n.inputs);
  std::optional<NodeMemo> memo;
  if (options_.disk != nullptr) memo.emplace(*options_.disk, *n.type);
  const auto runWith = [&](const ParamValues& params) {
    return runNode(
        graph_, i, params, inputs, token_,
        [&](double share) { tell([&](EvalListener& listener) { listener.progress(i, share); }); },
        memo ? &*memo : nullptr);
  };
  if (n.wiredParams.empty()) {
    result = runWith(n.params);
  } else if (auto params = finalParams(n, gather(n.wiredParams)); params.ok()) {
    result = runWith(*params);
  } else {
    result.error = params.error();
  }
  // Under cancellation parallel loops leave blocks out, so neither result nor error of the node means
  // anything; but files that it says it wrote are written.
  if (token_.cancelled() && !(n.type->writesFiles && !result.error)) return std::nullopt;
  if (!result.error) warnOfDifference(i, result);
  return result;
}

void Evaluation::run(int i) {
  const auto start = Clock::now();
  const std::optional<NodeResult> result = attempt(i);
  if (!result) return;  // it is reported as skipped in the end
  const double ms = msSince(start);
  if (result->error) return conclude(i, *result, ms, {}, false);
  const ResultRecord record = recordOf(i, *result, ms);
  bool anyKept = false;
  for (std::size_t o = 0; o < record.outputs.size() && !anyKept; ++o) anyKept = isKept(i, record, o);
  cache_.insert({result->outputs, record});  // before anybody may look for this key again
  if (options_.disk != nullptr && !anyKept) options_.disk->record(record);
  conclude(i, *result, ms, record, anyKept);
  if (!anyKept) return;
  dispatch();  // what waited for this starts while this is written
  const std::uint64_t kept = keep(i, record, result->outputs);
  std::vector<const NodeReport*> reports;
  {
    const std::lock_guard lock(mutex_);
    slot(i).report.kept = kept;
    report(i, NodeState::Run);
    reports.swap(outbox_);
  }
  tellReports(std::move(reports));
}

/// Hands on what came of a node. With `later` its report waits until it is on disk.
void Evaluation::conclude(int i, const NodeResult& result, double ms, const ResultRecord& record,
                          bool later) {
  std::vector<const NodeReport*> reports;
  {
    const std::lock_guard lock(mutex_);
    NodeReport& own = slot(i).report;
    own.ms = ms;
    own.threads = threadLimit();
    own.messages = result.messages;
    own.written = result.written;
    own.bytes = 0;
    for (const OutputRecord& output : record.outputs) own.bytes += output.bytes;
    if (result.error) {
      fail(i, *result.error);
    } else {
      complete(i, result.outputs);
      endTwins(i);
      if (!later) report(i, NodeState::Run);
      slot(i).reported = true;
      release(i);
    }
    drain();
    reports.swap(outbox_);
  }
  tellReports(std::move(reports));
}

/// Names of files are kept whatever that costs: without them no key of their reader is known.
bool Evaluation::isKept(int i, const ResultRecord& record, std::size_t output) {
  const OutputRecord& made = record.outputs[output];
  return options_.disk != nullptr && !made.empty() &&
         (worthKeeping(record.ms, made.bytes) || namesFile(i, static_cast<int>(output)));
}

/// Objects first: a record promises them.
std::uint64_t Evaluation::keep(int i, const ResultRecord& record, const Outputs& outputs) {
  std::uint64_t kept = 0;
  for (std::size_t o = 0; o < outputs.size(); ++o)
    if (isKept(i, record, o) && options_.disk->save(outputs[o].value, outputs[o].digest, record.ms))
      kept += record.outputs[o].bytes;
  options_.disk->record(record);
  return kept;
}

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

bool worthKeeping(double ms, std::uint64_t bytes) {
  // A file costs about 0.1 ms to write and 0.1 ms to read, and a gigabyte a second both ways.
  return ms > 0.2 + 2e-6 * static_cast<double>(bytes);
}

EvalReport evaluate(const Graph& graph, const std::vector<int>& wanted, Cache& cache, CancelToken& token,
                    const EvalOptions& options, EvalListener* listener) {
  return Evaluation(graph, wanted, cache, token, options, listener).evaluate();
}

}  // namespace sherd
