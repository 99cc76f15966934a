#include "graph/instances.h"

#include <algorithm>

#include "base/processor.h"
#include "graph/param.h"

namespace sherd {
namespace {

constexpr std::int64_t kMostNodes = 5000000;

template <class F>
void forEachWire(const Graph::Node& node, F&& f) {
  for (const Graph::Wire& wire : node.inputs) f(wire);
  for (const Graph::Wire& wire : node.wiredParams) f(wire);
}

class Multiplier {
 public:
  Multiplier(Graph& graph, const Sweep& sweep, const std::vector<std::uint64_t>& own,
             const RereadParams& reread)
      : graph_(graph), sweep_(sweep), own_(own), reread_(reread) {
    sizes_.push_back(std::max<std::size_t>(sweep.frames.size(), 1));
    for (const Sweep::Dimension& dimension : sweep.wedge) sizes_.push_back(dimension.values.size());
  }

  void multiply(Diagnostics& diagnostics) {
    findDependencies();
    std::int64_t count = 0;
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      first_.push_back(count);
      count += combinations(total_[i]);
      if (count > kMostNodes)
        return diagnostics.add(graph_.nodes[i].origin, graph_.nodes[i].name,
                               "frames and wedges make more than 5,000,000 nodes of this graph",
                               "run fewer frames at once, with --frames");
    }
    std::vector<Graph::Node> made;
    made.reserve(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      std::vector<int> at(sizes_.size(), 0);
      do made.push_back(instance(static_cast<int>(i), at));
      while (advance(at, total_[i]));
      graph_.index[graph_.nodes[i].name] = {static_cast<int>(first_[i]), combinations(total_[i])};
    }
    for (Graph::Target& target : graph_.targets) retarget(target);
    graph_.nodes = std::move(made);
  }

 private:
  static bool has(std::uint64_t mask, std::size_t dimension) { return (mask >> dimension & 1) != 0; }

  void findDependencies() {
    total_ = own_;
    for (const int i : topologicalOrder(graph_)) {
      const Graph::Node& node = graph_.nodes[static_cast<std::size_t>(i)];
      std::uint64_t& mask = total_[static_cast<std::size_t>(i)];
      for (const Graph::Wire& wire : node.inputs)
        if (!gathers(node, wire)) mask |= total_[static_cast<std::size_t>(wire.node)];
      for (const Graph::Wire& wire : node.wiredParams) mask |= total_[static_cast<std::size_t>(wire.node)];
    }
  }

  static bool gathers(const Graph::Node& node, const Graph::Wire& wire) {
    return node.type->inputs[static_cast<std::size_t>(wire.to)].gathers;
  }

  int combinations(std::uint64_t mask) const {
    std::int64_t count = 1;
    for (std::size_t d = 0; d < sizes_.size() && count <= kMostNodes; ++d)
      if (has(mask, d)) count *= static_cast<std::int64_t>(sizes_[d]);
    return static_cast<int>(std::min(count, kMostNodes + 1));
  }

  /// The next combination of the dimensions in `mask`, the last of them running fastest; false after the
  /// last.
  bool advance(std::vector<int>& at, std::uint64_t mask) const {
    for (std::size_t d = at.size(); d-- > 0;) {
      if (!has(mask, d)) continue;
      if (++at[d] < static_cast<int>(sizes_[d])) return true;
      at[d] = 0;
    }
    return false;
  }

  int indexOf(int node, const std::vector<int>& at) const {
    std::int64_t rank = 0;
    for (std::size_t d = 0; d < at.size(); ++d)
      if (has(total_[static_cast<std::size_t>(node)], d))
        rank = rank * static_cast<std::int64_t>(sizes_[d]) + at[d];
    return static_cast<int>(first_[static_cast<std::size_t>(node)] + rank);
  }

  Graph::Node instance(int i, const std::vector<int>& at) {
    const auto n = static_cast<std::size_t>(i);
    const Graph::Node& original = graph_.nodes[n];
    Graph::Node node = original;
    node.context = contextOf(total_[n], at);
    if (own_[n] != 0) {
      reread_(i, at, node);
      writeRecipe(node);
    }
    node.inputs.clear();
    for (const Graph::Wire& wire : original.inputs) {
      if (!gathers(original, wire)) {
        node.inputs.push_back({wire.to, indexOf(wire.node, at), wire.output});
        continue;
      }
      const std::uint64_t free = total_[static_cast<std::size_t>(wire.node)] & ~total_[n];
      std::vector<int> source = at;
      do node.inputs.push_back({wire.to, indexOf(wire.node, source), wire.output});
      while (advance(source, free));
    }
    for (Graph::Wire& wire : node.wiredParams) wire.node = indexOf(wire.node, at);
    return node;
  }

  int contextOf(std::uint64_t mask, const std::vector<int>& at) {
    if (mask == 0) return 0;
    std::vector<int> key;
    for (std::size_t d = 0; d < at.size(); ++d) key.push_back(has(mask, d) ? at[d] : -1);
    const auto [found, isNew] =
        contextIndex_.emplace(std::move(key), static_cast<int>(graph_.contexts.size()));
    if (!isNew) return found->second;
    Graph::Context context;
    if (has(mask, 0)) {
      context.frame = sweep_.frames[static_cast<std::size_t>(at[0])];
      context.label = "frame " + std::to_string(*context.frame);
    }
    for (std::size_t d = 1; d < at.size(); ++d) {
      if (!has(mask, d)) continue;
      const Sweep::Dimension& dimension = sweep_.wedge[d - 1];
      const std::string value = scalarText(dimension.values[static_cast<std::size_t>(at[d])]).value_or("?");
      context.label += (context.label.empty() ? "" : ", ") + dimension.name + ' ' + value;
      context.values.emplace_back(dimension.name, value);
    }
    graph_.contexts.push_back(std::move(context));
    return found->second;
  }

  void retarget(Graph::Target& target) const {
    std::vector<int> nodes;
    for (const int i : target.nodes) {
      const auto n = static_cast<std::size_t>(i);
      for (int k = 0; k < combinations(total_[n]); ++k) nodes.push_back(static_cast<int>(first_[n]) + k);
    }
    target.nodes = std::move(nodes);
  }

  Graph& graph_;
  const Sweep& sweep_;
  const std::vector<std::uint64_t>& own_;
  const RereadParams& reread_;
  std::vector<std::size_t> sizes_;
  std::vector<std::uint64_t> total_;
  std::vector<std::int64_t> first_;
  std::map<std::vector<int>, int> contextIndex_;
};

}  // namespace

void multiply(Graph& graph, const Sweep& sweep, const std::vector<std::uint64_t>& own,
              const RereadParams& reread, Diagnostics& diagnostics) {
  const bool none = std::all_of(own.begin(), own.end(), [](std::uint64_t mask) { return mask == 0; });
  if (!none) Multiplier(graph, sweep, own, reread).multiply(diagnostics);
}

std::vector<int> topologicalOrder(const Graph& graph) {
  std::vector<int> missing(graph.nodes.size(), 0), begin(graph.nodes.size() + 1, 0), order;
  for (const Graph::Node& node : graph.nodes)
    forEachWire(node, [&](const Graph::Wire& wire) { ++begin[static_cast<std::size_t>(wire.node) + 1]; });
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<int> consumers(static_cast<std::size_t>(begin.back())), next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    forEachWire(graph.nodes[i], [&](const Graph::Wire& wire) {
      consumers[static_cast<std::size_t>(next[static_cast<std::size_t>(wire.node)]++)] = static_cast<int>(i);
      ++missing[i];
    });
  order.reserve(graph.nodes.size());
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    if (missing[i] == 0) order.push_back(static_cast<int>(i));
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto i = static_cast<std::size_t>(order[k]);
    for (int c = begin[i]; c < begin[i + 1]; ++c) {
      const int consumer = consumers[static_cast<std::size_t>(c)];
      if (--missing[static_cast<std::size_t>(consumer)] == 0) order.push_back(consumer);
    }
  }
  return order;
}

void writeRecipe(Graph::Node& node) {
  const NodeType& type = *node.type;
  std::vector<bool> wired(type.params.size(), false);
  for (const Graph::Wire& wire : node.wiredParams) wired[static_cast<std::size_t>(wire.to)] = true;
  node.readsFiles = node.wiredFiles = false;
  Hasher hasher;
  hasher.add(std::string_view(type.name)).add(type.version).add(type.implementation);
  hasher.add(std::string_view(processorLevel()));
  for (std::size_t p = 0; p < type.params.size(); ++p) {
    const ParamInfo& info = type.params[p];
    const bool isFile = info.kind == ParamKind::InputFile;
    const auto* path = isFile && !wired[p] ? std::get_if<std::string>(&node.params.at(info.name)) : nullptr;
    node.wiredFiles = node.wiredFiles || (isFile && wired[p]);
    node.readsFiles = node.readsFiles || node.wiredFiles || (path != nullptr && !path->empty());
    hasher.add(std::string_view(info.name)).add(wired[p]);
    if (!wired[p] && !isFile) hashParam(hasher, node.params.at(info.name));
  }
  node.recipe = hasher.digest();
}

}  // namespace sherd
