#include "eval/plan.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "eval/lookup.h"
#include "eval/node_run.h"
#include "graph/instances.h"

namespace sherd {
namespace {

class Planner {
 public:
  Planner(const Graph& graph, const std::vector<int>& wanted, Cache& cache, const EvalOptions& options,
          const std::vector<History>& histories)
      : graph_(graph),
        cache_(cache),
        options_(options),
        histories_(histories),
        files_(options.disk),
        slots_(graph.nodes.size()),
        digests_(graph.nodes.size()) {
    for (const int i : neededNodes(graph, wanted)) slot(i).needed = true;
    place_.assign(graph.nodes.size(), -1);
    for (const int i : topologicalOrder(graph)) {
      if (!slot(i).needed) continue;
      place_[static_cast<std::size_t>(i)] = static_cast<int>(order_.size());
      order_.push_back(i);
    }
    wanted_ = wanted;
  }

  std::vector<PlanEntry> plan() {
    for (const int i : order_) resolve(i);
    if (options_.values)
      for (const int i : order_)
        if (std::binary_search(wanted_.begin(), wanted_.end(), i)) askAll(i);
    for (std::size_t k = 0; k < toCount_.size(); ++k)
      if (slot(toCount_[k]).state == PlanState::Run) askSources(toCount_[k], PlanState::Run);
    // What may run may ask for values that were not kept.
    for (std::size_t k = 0; k < following_.size(); ++k) askSources(following_[k], PlanState::Follows);
    std::vector<PlanEntry> entries;
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) entries.push_back(entryOf(static_cast<int>(i)));
    return entries;
  }

 private:
  struct Slot {
    bool needed = false;
    bool known = false;  ///< its digests are
    PlanState state = PlanState::Hit;
    Digest recipe, key;
    Outputs outputs;
    double ms = 0;
    std::uint64_t bytes = 0;
    std::vector<std::uint64_t> outputBytes;
    std::string why;
    WiredFiles wiredFiles;
  };

  Slot& slot(int i) { return slots_[static_cast<std::size_t>(i)]; }
  const Graph::Node& node(int i) const { return graph_.nodes[static_cast<std::size_t>(i)]; }

  bool sourcesKnown(int i) {
    bool known = true;
    forEachWire(node(i), [&](const Graph::Wire& wire, bool) { known = known && slot(wire.node).known; });
    return known;
  }

  void resolve(int i) {
    Slot& s = slot(i);
    const Graph::Node& n = node(i);
    const bool isReady = sourcesKnown(i);
    const auto names = n.wiredFiles && isReady ? wiredValues(i) : std::nullopt;
    if (n.wiredFiles && !names) return follow(i);
    const auto recipe = recipeOf(i, names);
    s.recipe = recipe.ok() ? *recipe : Digest{};
    if (!recipe.ok()) return mustRun(i, recipe.error().what);
    if (!isReady) return follow(i);
    std::vector<KeyInput> inputs;
    forEachWire(n, [&](const Graph::Wire& wire, bool isParam) {
      inputs.push_back({static_cast<std::uint64_t>(wire.to) + (isParam ? kKeyParam : 0),
                        labelDigest(graph_, n, wire, isParam),
                        slot(wire.node).outputs[static_cast<std::size_t>(wire.output)].digest});
    });
    s.key = resultKey(s.recipe, inputs);
    if (auto found = lookUp(*n.type, s.key, {cache_, options_.disk, abandoned_})) {
      s.known = true;
      s.outputs = std::move(found->outputs);
      s.ms = found->record.ms;
      for (const OutputRecord& output : found->record.outputs) {
        s.outputBytes.push_back(output.bytes);
        s.bytes += output.bytes;
      }
      for (const Output& output : s.outputs) digests_[static_cast<std::size_t>(i)].push_back(output.digest);
    } else {
      mustRun(i, {});
    }
  }

  /// What comes over the wires to parameters; nothing where a value of them isn't there.
  std::optional<std::vector<WireValue>> wiredValues(int i) {
    std::vector<WireValue> values;
    for (const Graph::Wire& wire : node(i).wiredParams) {
      const auto o = static_cast<std::size_t>(wire.output);
      const Output& output = slot(wire.node).outputs[o];
      Value value = output.value;
      if (value.empty() && options_.disk != nullptr && output.digest != Digest{})
        value = options_.disk->load(*node(wire.node).type->outputs[o].value, output.digest);
      if (value.empty() && output.digest != Digest{}) return std::nullopt;
      values.push_back({std::move(value), output.digest});
    }
    return values;
  }

  /// `wired` is what names files among its parameters, if anything does.
  Result<Digest> recipeOf(int i, const std::optional<std::vector<WireValue>>& wired) {
    if (!wired) return recipeWithFiles(node(i), node(i).params, files_);
    SHERD_ASSIGN(const ParamValues params, finalParams(node(i), *wired));
    slot(i).wiredFiles = wiredFilesOf(node(i), params);
    return recipeWithFiles(node(i), params, files_);
  }

  /// Its key isn't known yet. With a recipe that never ran, no key of it can be known.
  void follow(int i) {
    Slot& s = slot(i);
    const bool isNew = options_.disk != nullptr && cache_.size() == 0 && !node(i).wiredFiles &&
                       !options_.disk->knowsRecipe(s.recipe) && !runningRecipes_.contains(s.recipe);
    if (isNew) return mustRun(i, {});
    s.state = PlanState::Follows;
    following_.push_back(i);
    runningRecipes_.insert(s.recipe);
  }

  void mustRun(int i, const std::string& why) {
    Slot& s = slot(i);
    s.why = why;
    if (s.key != Digest{}) {
      const auto [leader, isFirst] = running_.try_emplace(s.key, i);
      if (!isFirst && leader->second != i) {  // the first in the order runs, as in evaluate()
        const bool leads =
            place_[static_cast<std::size_t>(i)] < place_[static_cast<std::size_t>(leader->second)];
        const int twin = leads ? std::exchange(leader->second, i) : i;
        slot(twin).state = PlanState::Hit;
        slot(twin).why = "the same as " + sourceName(graph_, twin, leader->second);
        if (!leads) return;
      }
    }
    s.state = PlanState::Run;
    runningRecipes_.insert(s.recipe);
    toCount_.push_back(i);
  }

  void askAll(int i) {
    for (std::size_t o = 0; o < slot(i).outputs.size(); ++o) ask(i, static_cast<int>(o), PlanState::Run);
  }

  void askSources(int i, PlanState asker) {
    forEachWire(node(i), [&](const Graph::Wire& wire, bool) { ask(wire.node, wire.output, asker); });
  }

  /// A node that runs, or may run, wants the value of a known node's output.
  void ask(int i, int output, PlanState asker) {
    Slot& s = slot(i);
    if (!s.known || s.state == PlanState::Run ||
        (s.state == PlanState::Follows && asker == PlanState::Follows))
      return;
    const auto o = static_cast<std::size_t>(output);
    const Output& wanted = s.outputs[o];
    if (wanted.digest == Digest{} || !wanted.value.empty()) return;
    if (options_.disk != nullptr && options_.disk->hasObject(wanted.digest)) return;
    const bool isEvicted = worthKeeping(s.ms, s.outputBytes[o]);
    const std::string why = isEvicted ? "its result was evicted" : "quicker to make again than to keep";
    if (asker == PlanState::Run) return mustRun(i, why);
    s.state = PlanState::Follows;
    s.why = why;
    following_.push_back(i);
    // One of the same key that would run is a hit where this one comes before it.
    const auto twin = running_.find(s.key);
    if (twin == running_.end() || slot(twin->second).state != PlanState::Run) return;
    slot(twin->second).state = PlanState::Follows;
    slot(twin->second).why += (slot(twin->second).why.empty() ? "unless " : ", unless ") +
                              sourceName(graph_, twin->second, i) + ", which is the same, does";
  }

  PlanEntry entryOf(int i) {
    Slot& s = slot(i);
    if (!s.needed) return {i, PlanState::NotNeeded, {}, 0, 0};
    PlanEntry entry{i, s.state, s.why, s.ms, s.bytes};
    if (s.state == PlanState::Hit) return entry;
    if (entry.why.empty()) entry.why = explain(i);
    if (entry.ms == 0) entry.ms = lastTime(i);
    return entry;
  }

  const PastNode* pastOf(int i) const {
    const auto shot = static_cast<std::size_t>(node(i).shot);
    if (shot >= histories_.size()) return nullptr;
    const auto past = histories_[shot].find(graph_.labelOf(i));
    return past == histories_[shot].end() ? nullptr : &past->second;
  }

  /// What the node took when it was last run, with whatever it was made of then; 0 where that isn't known.
  double lastTime(int i) const {
    const PastNode* past = pastOf(i);
    if (past == nullptr || options_.disk == nullptr) return 0;
    const auto record = options_.disk->find(past->key);
    return record ? record->ms : 0;
  }

  std::string explain(int i) {
    const PastNode* past = pastOf(i);
    if (past == nullptr) return upstream(i).value_or("never run");
    const std::string changed =
        difference(*past, describe(graph_, i, digests_, slot(i).wiredFiles, files_), *node(i).type);
    if (!changed.empty()) return changed;
    if (const auto source = upstream(i)) return *source;
    if (auto record = options_.disk == nullptr ? std::nullopt : options_.disk->find(slot(i).key))
      if (const WrittenFile* file = firstChanged(*record, abandoned_))
        return file->path + whatBecameOf(*file);
    return "its record was evicted";
  }

  /// Of the file that firstChanged() found.
  static std::string whatBecameOf(const WrittenFile& file) {
    const FileIdentity now = FileIdentity::of(file.path);
    if (!now.exists()) return " is missing";
    return now == file.identity ? " was being written when a run was killed" : " has been changed";
  }

  /// The first of its sources that doesn't stay as it is.
  std::optional<std::string> upstream(int i) {
    std::optional<std::string> found;
    forEachWire(node(i), [&](const Graph::Wire& wire, bool) {
      const Slot& source = slot(wire.node);
      if (!found && !source.known) found = "upstream: " + sourceName(graph_, i, wire.node);
    });
    return found;
  }

  const Graph& graph_;
  Cache& cache_;
  const EvalOptions& options_;
  const std::vector<History>& histories_;
  FileDigests files_;
  AbandonedFiles abandoned_;
  std::vector<Slot> slots_;
  std::vector<std::vector<Digest>> digests_;
  std::vector<int> order_, place_, wanted_, toCount_, following_;
  std::unordered_map<Digest, int> running_;
  std::unordered_set<Digest> runningRecipes_;
};

}  // namespace

const char* planStateName(PlanState state) {
  switch (state) {
    case PlanState::Hit:
      return "hit";
    case PlanState::Run:
      return "run";
    case PlanState::Follows:
      return "follows";
    case PlanState::NotNeeded:
      return "not needed";
  }
  return "";
}

std::vector<PlanEntry> planRun(const Graph& graph, const std::vector<int>& wanted, Cache& cache,
                               const EvalOptions& options, const std::vector<History>& histories) {
  return Planner(graph, wanted, cache, options, histories).plan();
}

}  // namespace sherd
