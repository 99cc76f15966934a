// Random nested subgraphs against a direct evaluation.
#include <cmath>
#include <limits>

#include "base/rng.h"
#include "runtime/subgraph_graphs.h"

namespace sherd::test {
namespace {

/// A random library of subgraphs that each use only those before them, its text, and what it computes.
class RandomLibrary {
 public:
  explicit RandomLibrary(std::uint64_t seed) : rng_(seed) {
    const int count = 1 + static_cast<int>(rng_.below(5));
    for (int i = 0; i < count; ++i) add();
  }

  std::string text() const {
    std::string text;
    for (std::size_t i = 0; i < list_.size(); ++i) text += (i > 0 ? ",\n" : "") + textOf(i);
    return text;
  }
  std::size_t size() const { return list_.size(); }
  /// Outputs of subgraph i for its two inputs; NaN stands for the second where it is open.
  std::vector<double> outputs(std::size_t i, double x, double y, double by) const {
    const Definition& definition = list_[i];
    std::vector<std::vector<double>> values;  // per node
    auto read = [&](const Link& link) {
      if (link.node == kX) return x;
      if (link.node == kY) return y;
      return values[static_cast<std::size_t>(link.node)][link.output];
    };
    for (const Node& node : definition.nodes) {
      const double a = read(node.a), b = node.hasB ? read(node.b) : kOpen;
      const double own = node.passesBy ? by : node.value;
      if (node.use < 0)
        values.push_back({a + (std::isnan(b) ? 0 : b) + own});
      else
        values.push_back(outputs(static_cast<std::size_t>(node.use), a, b, own));
    }
    std::vector<double> result;
    for (const Link& link : definition.outputs) result.push_back(read(link));
    return result;
  }

 private:
  static constexpr int kX = -1, kY = -2;
  static constexpr double kOpen = std::numeric_limits<double>::quiet_NaN();
  struct Link {
    int node = kX;
    std::size_t output = 0;
  };
  struct Node {
    int use = -1;  ///< a subgraph, or −1: an Add
    Link a, b;
    bool hasB = false, passesBy = false;
    double value = 0;
  };
  struct Definition {
    std::vector<Node> nodes;
    std::vector<Link> outputs;
  };

  Link randomLink(const Definition& definition) {
    const auto count = definition.nodes.size();
    const auto pick = rng_.below(count + 1);
    if (pick == count) return {};
    const int use = definition.nodes[pick].use;
    const std::size_t outputs = use < 0 ? 1 : list_[static_cast<std::size_t>(use)].outputs.size();
    return {static_cast<int>(pick), rng_.below(outputs)};
  }
  void add() {
    Definition definition;
    const auto nodes = 1 + rng_.below(4);
    for (std::uint64_t n = 0; n < nodes; ++n) {
      Node node;
      if (!list_.empty() && rng_.below(2) == 0) node.use = static_cast<int>(rng_.below(list_.size()));
      node.a = randomLink(definition);
      node.hasB = rng_.below(2) == 0;
      node.b = rng_.below(2) == 0 ? Link{kY, 0} : randomLink(definition);
      node.passesBy = rng_.below(2) == 0;
      node.value = static_cast<double>(rng_.below(9));
      definition.nodes.push_back(node);
    }
    const auto outputs = 1 + rng_.below(2);
    for (std::uint64_t o = 0; o < outputs; ++o) definition.outputs.push_back(randomLink(definition));
    list_.push_back(std::move(definition));
  }
  std::string linkText(const Link& link, const Definition& definition) const {
    if (link.node == kX) return "\"in.x\"";
    if (link.node == kY) return "\"in.y\"";
    const int use = definition.nodes[static_cast<std::size_t>(link.node)].use;
    return "\"n" + std::to_string(link.node) + (use < 0 ? ".sum" : ".o" + std::to_string(link.output)) + '"';
  }
  std::string textOf(std::size_t i) const {
    const Definition& definition = list_[i];
    std::string text = "\"S" + std::to_string(i) + R"(": {"vars": {"by": 0}, "inputs": {"x": "Number",
        "y": {"type": "Number", "optional": true}}, "outputs": {)";
    for (std::size_t o = 0; o < definition.outputs.size(); ++o)
      text += (o > 0 ? ", " : "") + ("\"o" + std::to_string(o)) +
              "\": " + linkText(definition.outputs[o], definition);
    text += "}, \"nodes\": {";
    for (std::size_t n = 0; n < definition.nodes.size(); ++n) {
      const Node& node = definition.nodes[n];
      const bool isAdd = node.use < 0;
      text += (n > 0 ? ",\n" : "") + ("\"n" + std::to_string(n)) + "\": {\"type\": \"" +
              (isAdd ? "Add@1" : "S" + std::to_string(node.use)) + "\", \"in\": {\"" + (isAdd ? "a" : "x") +
              "\": " + linkText(node.a, definition);
      if (node.hasB)
        text += std::string(", \"") + (isAdd ? "b" : "y") + "\": " + linkText(node.b, definition);
      text += std::string("}, \"params\": {\"") + (isAdd ? "offset" : "by") +
              "\": " + (node.passesBy ? "\"${by}\"" : std::to_string(static_cast<int>(node.value))) + "}}";
    }
    return text + "}}";
  }

  Rng rng_;
  std::vector<Definition> list_;
};

TEST(Subgraphs, ComputeWhatDirectEvaluationDoes) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomLibrary library(seed);
    const std::size_t last = library.size() - 1;
    const std::string use = "S" + std::to_string(last);
    const Graph graph = good(graphWith(library.text(), R"("x": {"type": "Constant@1", "params": {"value": 3}},
        "y": {"type": "Constant@1", "params": {"value": 40}},
        "one": {"type": ")" + use + R"(", "in": {"x": "x"}, "params": {"by": 2}},
        "two": {"type": ")" + use + R"(", "in": {"x": "x", "y": "y"}},
        "e": {"type": "Add@1", "in": {"a": "one.o0", "b": "two.o0"}})"));
    const double open = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(valueOf(graph, "e"), library.outputs(last, 3, open, 2)[0] + library.outputs(last, 3, 40, 0)[0])
        << seed << '\n'
        << library.text();
  }
}

}  // namespace
}  // namespace sherd::test
