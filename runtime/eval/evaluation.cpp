#include "eval/evaluation.h"

#include <algorithm>
#include <utility>

#include "graph/instances.h"

namespace sherd {

bool Evaluation::has(const Slot& s, int output) const {
  const auto o = static_cast<std::size_t>(output);
  return o < s.outputs.size() && s.told && (s.outputs[o].digest == Digest{} || !s.outputs[o].value.empty());
}

template <class F>
void Evaluation::forEachReader(int i, F&& f) {
  const auto n = static_cast<std::size_t>(i);
  for (int k = firstReader_[n]; k < firstReader_[n + 1]; ++k) f(readers_[static_cast<std::size_t>(k)]);
}

Evaluation::Evaluation(const Graph& graph, const std::vector<int>& wanted, Cache& cache, CancelToken& token,
                       const EvalOptions& options, EvalListener* listener)
    : graph_(graph),
      cache_(cache),
      token_(token),
      options_(options),
      listener_(listener),
      files_(options.disk),
      slots_(graph.nodes.size()) {
  prepare(wanted);
  connect();
}

void Evaluation::prepare(const std::vector<int>& wanted) {
  for (const int i : neededNodes(graph_, wanted)) slot(i).state = State::Waiting;
  for (const int i : wanted) slot(i).wanted = true;
  place_.assign(graph_.nodes.size(), -1);
  for (const int i : topologicalOrder(graph_)) {
    if (slot(i).state == State::NotNeeded) continue;
    place_[static_cast<std::size_t>(i)] = static_cast<int>(order_.size());
    order_.push_back(i);
  }
  report_.nodes.reserve(order_.size());  // the listener is told by pointers into it
}

void Evaluation::connect() {
  firstReader_.assign(graph_.nodes.size() + 1, 0);
  for (const int i : order_)
    forEachWire(node(i), [&](const Graph::Wire& wire, bool) {
      ++firstReader_[static_cast<std::size_t>(wire.node) + 1];
    });
  for (std::size_t i = 1; i < firstReader_.size(); ++i) firstReader_[i] += firstReader_[i - 1];
  readers_.resize(static_cast<std::size_t>(firstReader_.back()));
  std::vector<int> next(firstReader_.begin(), firstReader_.end() - 1);
  for (const int i : order_)
    forEachWire(node(i), [&](const Graph::Wire& wire, bool isParam) {
      readers_[static_cast<std::size_t>(next[static_cast<std::size_t>(wire.node)]++)] = {i, wire.output,
                                                                                         isParam};
      ++slot(i).digests;
      ++slot(wire.node).readers;
    });
  // Somebody will read what is wanted after the end.
  for (const int i : order_)
    if (slot(i).wanted && options_.values) ++slot(i).readers;
}

/// Whether the key of another node needs the value of this output, and not only its digest.
bool Evaluation::namesFile(int i, int output) {
  bool names = false;
  forEachReader(i, [&](const Reader& reader) {
    names = names || (reader.output == output && reader.isParam && node(reader.node).wiredFiles);
  });
  return names;
}

/// Finds out what is known, from the sources on; what is not starts the rest.
void Evaluation::sweep() {
  sweeping_ = true;
  for (const int i : order_)
    if (slot(i).digests == 0) resolve(i);
  sweeping_ = false;
  for (const int i : order_) {
    if (!slot(i).wanted || !options_.values) continue;
    for (std::size_t o = 0; o < node(i).type->outputs.size(); ++o) ask(i, static_cast<int>(o));
  }
  drain();
  std::reverse(ready_.begin(), ready_.end());  // the first in the file is taken first
}

void Evaluation::drain() {
  std::vector<int> hits;
  while (true) {
    if (!toSkip_.empty()) {
      const int i = toSkip_.back();
      toSkip_.pop_back();
      skipReaders(i);
    } else if (!toResolve_.empty()) {
      const int i = toResolve_.back();
      toResolve_.pop_back();
      resolve(i);
    } else if (counted_ < toCount_.size()) {
      countValues(toCount_[counted_++]);
    } else if (!settled_.empty()) {
      const int i = settled_.back();
      settled_.pop_back();
      Slot& s = slot(i);
      if (s.state != State::Known) continue;
      if (!s.reported) hits.push_back(i);
      s.reported = true;
      if (s.readers == 0) release(i);
    } else {
      break;
    }
  }
  toCount_.clear();
  counted_ = 0;
  std::sort(hits.begin(), hits.end(), [this](int a, int b) {
    return place_[static_cast<std::size_t>(a)] < place_[static_cast<std::size_t>(b)];
  });
  for (const int i : hits) report(i, NodeState::Hit);
}

void Evaluation::resolve(int i) {
  Slot& s = slot(i);
  if (s.state != State::Waiting) return;
  if (!node(i).wiredFiles) return look(i, node(i).params);
  // Found out in the nodes' order as far as that can be, so that it doesn't depend on the time which of those
  // that turn out to have one key runs.
  const auto names = sweeping_ ? namesAtHand(i) : std::nullopt;
  if (names)
    lookWith(i, *names);
  else
    countNames(i);
}

/// What comes over the wires to parameters, from memory or disk; nothing where something isn't there.
std::optional<std::vector<WireValue>> Evaluation::namesAtHand(int i) {
  std::vector<WireValue> values = gather(node(i).wiredParams);
  for (std::size_t w = 0; w < values.size(); ++w) {
    WireValue& wired = values[w];
    const Graph::Wire& wire = node(i).wiredParams[w];
    if (!wired.value.empty() || wired.digest == Digest{}) continue;
    if (options_.disk == nullptr) return std::nullopt;
    const auto output = static_cast<std::size_t>(wire.output);
    wired.value = options_.disk->load(*node(wire.node).type->outputs[output].value, wired.digest);
    if (wired.value.empty()) return std::nullopt;
  }
  return values;
}

void Evaluation::lookWith(int i, const std::vector<WireValue>& wired) {
  const auto params = finalParams(node(i), wired);
  if (params.ok())
    look(i, *params);
  else
    fail(i, params.error());
}

/// Makes the key and looks it up.
void Evaluation::look(int i, const ParamValues& params) {
  Slot& s = slot(i);
  const Graph::Node& n = node(i);
  s.recipe = n.recipe;
  if (n.readsFiles) {
    const auto recipe = recipeWithFiles(n, params, files_);
    if (!recipe.ok()) return fail(i, recipe.error());
    s.recipe = *recipe;
    if (n.wiredFiles) s.report.wiredFiles = wiredFilesOf(n, params);
  }
  keyInputs_.clear();
  forEachWire(n, [&](const Graph::Wire& wire, bool isParam) {
    const Output& output = slot(wire.node).outputs[static_cast<std::size_t>(wire.output)];
    keyInputs_.push_back({static_cast<std::uint64_t>(wire.to) + (isParam ? kKeyParam : 0),
                          labelDigest(graph_, n, wire, isParam), output.digest});
  });
  s.key = resultKey(s.recipe, keyInputs_);
  s.report.key = s.key;
  if (auto known = lookUp(*n.type, s.key, {cache_, options_.disk, abandoned_}))
    becomeKnown(i, std::move(*known));
  else
    mustRun(i);
}

/// Of nodes with one key the first in the order runs: one of the others may need its value (a node that hands
/// on what it gets, behind another one), never the other way round.
void Evaluation::mustRun(int i) {
  Slot& s = slot(i);
  const auto [found, isFirst] = inFlight_.try_emplace(s.key, Flight{i, {}});
  Flight& flight = found->second;
  if (!isFirst) {
    const bool leads = !slot(flight.leader).started &&
                       place_[static_cast<std::size_t>(i)] < place_[static_cast<std::size_t>(flight.leader)];
    const int twin = leads ? std::exchange(flight.leader, i) : i;
    slot(twin).state = State::Twin;
    flight.twins.push_back(twin);
    if (!leads) return;
  }
  s.state = State::NeedsValues;
  s.counted = false;
  toCount_.push_back(i);
}

void Evaluation::countNames(int i) {
  Slot& s = slot(i);
  s.state = State::NeedsNames;
  s.values = 0;
  for (const Graph::Wire& wire : node(i).wiredParams) {
    if (has(slot(wire.node), wire.output)) continue;
    ++s.values;
    ask(wire.node, wire.output);
  }
  s.counted = true;
  if (s.values == 0) ready_.push_back({i});
}

void Evaluation::countValues(int i) {
  Slot& s = slot(i);
  if (s.state != State::NeedsValues) return;
  s.values = 0;
  bool lost = false;
  forEachWire(node(i), [&](const Graph::Wire& wire, bool) {
    const Slot& source = slot(wire.node);
    if (has(source, wire.output)) return;
    lost = lost || isDone(source);
    ++s.values;
    ask(wire.node, wire.output);
  });
  s.counted = true;
  if (lost) {
    s.state = State::Skipped;
    report(i, NodeState::Skipped);
    endTwins(i);
    toSkip_.push_back(i);
  } else if (s.values == 0) {
    ready_.push_back({i});
  }
}

/// Somebody wants the value of an output. A node that will run has it then; one that is known loads it or, if
/// that can't be, runs after all.
void Evaluation::ask(int i, int output) {
  Slot& s = slot(i);
  const std::uint64_t bit = std::uint64_t{1} << (output & 63);
  if ((s.asked & bit) != 0) return;
  s.asked |= bit;
  if (s.state == State::Known && !has(s, output)) request(i, output);
}

void Evaluation::request(int i, int output) {
  Slot& s = slot(i);
  const bool isLost = (s.lost >> (output & 63) & 1) != 0;
  if (options_.disk != nullptr && !isLost &&
      options_.disk->hasObject(s.outputs[static_cast<std::size_t>(output)].digest))
    ready_.push_back({i, output});
  else if (s.state == State::Known)
    mustRun(i);
}

/// The value of an output is there.
void Evaluation::signal(int i, int output) {
  forEachReader(i, [&](const Reader& reader) {
    Slot& s = slot(reader.node);
    if (reader.output != output || !s.counted) return;
    if (s.state != State::NeedsValues && !(s.state == State::NeedsNames && reader.isParam)) return;
    if (--s.values == 0) ready_.push_back({reader.node});
  });
}

void Evaluation::becomeKnown(int i, Known known) {
  Slot& s = slot(i);
  s.state = State::Known;
  s.outputs = std::move(known.outputs);
  s.report.messages = std::move(known.record.messages);
  for (WrittenFile& file : known.record.written) s.report.written.push_back(std::move(file.path));
  for (const OutputRecord& output : known.record.outputs) s.report.bytes += output.bytes;
  tellDigests(i);
  for (std::size_t o = 0; o < s.outputs.size() && s.asked != 0; ++o) {
    if ((s.asked >> (o & 63) & 1) == 0) continue;
    if (has(s, static_cast<int>(o)))
      signal(i, static_cast<int>(o));
    else
      request(i, static_cast<int>(o));
  }
  // With all values there, or nobody to ask for them, it will never run: it can be told of.
  bool hasAll = true;
  for (std::size_t o = 0; o < s.outputs.size(); ++o) hasAll = hasAll && has(s, static_cast<int>(o));
  if (hasAll || s.readers == 0) settled_.push_back(i);
}

void Evaluation::tellDigests(int i) {
  Slot& s = slot(i);
  if (s.told) return;
  s.told = true;
  s.report.digests.reserve(s.outputs.size());
  for (const Output& output : s.outputs) s.report.digests.push_back(output.digest);
  forEachReader(i, [&](const Reader& reader) {
    if (--slot(reader.node).digests == 0 && !sweeping_) toResolve_.push_back(reader.node);
  });
}

/// The node ran, or its twin did. Values that were loaded meanwhile stay: others may be reading them.
void Evaluation::complete(int i, const Outputs& outputs) {
  Slot& s = slot(i);
  s.state = State::Known;
  std::vector<bool> had(outputs.size());
  for (std::size_t o = 0; o < outputs.size(); ++o) had[o] = has(s, static_cast<int>(o));
  s.outputs.resize(outputs.size());
  for (std::size_t o = 0; o < outputs.size(); ++o)
    if (!had[o]) s.outputs[o] = outputs[o];
  tellDigests(i);
  for (std::size_t o = 0; o < outputs.size(); ++o)
    if (!had[o]) signal(i, static_cast<int>(o));
}

/// The nodes with the same key end as this one did.
void Evaluation::endTwins(int i) {
  const Slot& self = slot(i);
  const auto found = inFlight_.find(self.key);
  if (found == inFlight_.end() || found->second.leader != i) return;
  const std::vector<int> twins = std::move(found->second.twins);
  inFlight_.erase(found);
  for (const int twin : twins) {
    Slot& s = slot(twin);
    s.report.messages = self.report.messages;
    s.report.written = self.report.written;
    s.report.bytes = self.report.bytes;
    if (self.state == State::Known) {
      complete(twin, self.outputs);
      if (s.readers == 0) settled_.push_back(twin);
      continue;
    }
    s.state = self.state;
    s.report.error = self.report.error;
    report(twin, self.state == State::Failed ? NodeState::Failed : NodeState::Skipped);
    toSkip_.push_back(twin);
  }
}

void Evaluation::fail(int i, const Error& error) {
  Slot& s = slot(i);
  s.state = State::Failed;
  s.report.error = error;
  if (!options_.keepGoing && !stopped_) {
    stopped_ = true;
    token_.cancel();
  }
  endTwins(i);
  report(i, NodeState::Failed);
  toSkip_.push_back(i);
}

/// What waits for a node that failed or was skipped can't run.
void Evaluation::skipReaders(int i) {
  release(i);
  forEachReader(i, [&](const Reader& reader) {
    Slot& s = slot(reader.node);
    const bool waits =
        s.state == State::Waiting || s.state == State::NeedsNames || s.state == State::NeedsValues;
    if (!waits || has(slot(i), reader.output)) return;
    const bool hasKey = s.state == State::NeedsValues;
    s.state = State::Skipped;
    report(reader.node, NodeState::Skipped);
    if (hasKey) endTwins(reader.node);
    toSkip_.push_back(reader.node);
  });
}

/// The node will ask for no more values: those that nobody else reads are let go of.
void Evaluation::release(int i) {
  if (slot(i).released) return;
  slot(i).released = true;
  forEachWire(node(i), [&](const Graph::Wire& wire, bool) {
    Slot& source = slot(wire.node);
    if (--source.readers > 0) return;
    for (Output& output : source.outputs) output.value = {};
    if (source.state == State::Known) settled_.push_back(wire.node);
  });
}

void Evaluation::report(int i, NodeState state) {
  Slot& s = slot(i);
  s.reported = true;
  s.report.node = i;
  s.report.state = state;
  report_.nodes.push_back(std::move(s.report));
  outbox_.push_back(&report_.nodes.back());
}

void Evaluation::finalise() {
  for (const int i : order_) {
    Slot& s = slot(i);
    if (s.wanted && s.state == State::Known) report_.outputs[i] = s.outputs;
    if (s.reported) continue;
    const bool isKnown = s.state == State::Known;
    const bool isLeftOver = !isKnown && !token_.cancelled();
    if (isLeftOver)
      s.report.error = failure("was never started, though nothing stood in its way",
                               "this is a mistake in sherd, please report it");
    report(i, isKnown ? NodeState::Hit : isLeftOver ? NodeState::Failed : NodeState::Skipped);
  }
}

}  // namespace sherd
