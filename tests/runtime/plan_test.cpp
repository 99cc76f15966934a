// What a plan says, a run does; and a cache changes how long a run takes, never what it makes.
#include "eval/plan.h"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "base/parallel.h"
#include "base/rng.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

/// Slow: a number that takes 3 ms and a blob of that many numbers, which is worth keeping.
struct SlowParams {
  double value = 0;
  std::int64_t size = 100;
};
NodeType slowNode() {
  return NodeBuilder<SlowParams>("Slow", 1, "")
      .optionalInput<double>("a", "")
      .number("value", &SlowParams::value, {})
      .integer("size", &SlowParams::size, {.min = 0, .max = 100000})
      .output<double>("sum", "")
      .output<Blob>("blob", "")
      .run([](const SlowParams& params, NodeIo& io) -> Result<void> {
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
        const auto a = io.in<double>("a");
        const double sum = params.value + (a ? *a : 0);
        io.out("sum", sum);
        io.out("blob", Blob{std::vector<double>(static_cast<std::size_t>(params.size), sum)});
        return {};
      });
}

class Plans : public ::testing::Test {
 protected:
  Plans() { EXPECT_TRUE(registry.add(slowNode()).ok()); }
  ~Plans() override { setThreadLimit(0); }

  std::unique_ptr<DiskStore> open() {
    auto store = DiskStore::open((directory.path() / "store").string());
    EXPECT_TRUE(store.ok());
    return std::move(store).value();
  }
  struct Both {
    std::vector<PlanEntry> plan;
    EvalReport report;
  };
  /// Plans and runs in a process's worth of memory each: nothing but the store is shared.
  Both planAndRun(const Graph& graph, const std::vector<int>& wanted, bool values = true) {
    const auto store = open();
    const EvalOptions options{.keepGoing = true, .values = values, .disk = store.get()};
    Cache forPlan, forRun;
    Both both;
    const std::vector<History> histories{unpack(store->history("g"))};
    both.plan = planRun(graph, wanted, forPlan, options, histories);
    CancelToken token;
    both.report = evaluate(graph, wanted, forRun, token, options);
    History history = histories.front();
    FileDigests files(store.get());
    update(history, graph, 0, both.report, files);
    store->setHistory("g", pack(history));
    return both;
  }
  /// Whether the run did what the plan said.
  void expectAgreement(const Graph& graph, const Both& both, const std::string& what) {
    std::map<int, NodeState> states;
    for (const NodeReport& node : both.report.nodes) states[node.node] = node.state;
    for (const PlanEntry& entry : both.plan) {
      const auto found = states.find(entry.node);
      const std::string name = what + ": " + graph.labelOf(entry.node) + " (" + entry.why + ")";
      if (entry.state == PlanState::NotNeeded) {
        EXPECT_EQ(found, states.end()) << name;
        continue;
      }
      ASSERT_NE(found, states.end()) << name;
      if (entry.state == PlanState::Hit) {
        EXPECT_EQ(found->second, NodeState::Hit) << name;
      } else if (entry.state == PlanState::Run) {
        EXPECT_EQ(found->second, NodeState::Run) << name;
      } else {
        EXPECT_TRUE(found->second == NodeState::Run || found->second == NodeState::Hit) << name;
      }
      EXPECT_TRUE(entry.state == PlanState::Hit || !entry.why.empty()) << name;
    }
  }
  const PlanEntry& entryOf(const Graph& graph, const Both& both, const std::string& node) {
    return both.plan.at(static_cast<std::size_t>(graph.find(node)));
  }

  TemporaryDirectory directory;
  std::shared_ptr<Counters> counters = std::make_shared<Counters>();
  Registry registry = madeUpNodes(counters);
};

TEST_F(Plans, SayWhyANodeRuns) {
  directory.write("in.txt", "one");
  auto graphWith = [&](const std::string& value, const std::string& extra = "") {
    return graphOf(R"("s": {"type": "Slow@1", "params": {"value": )" + value + R"(}},
        "t": {"type": "Slow@1", "in": {"a": "s"}, "params": {"size": 20000}}, "n": {"type": "SumBlob@1", "in": {"blob": "t.blob"}},
        "r": {"type": "ReadText@1", "params": {"file": "in.txt"}})" +
                       extra,
                   registry, directory.path());
  };
  Graph graph = graphWith("1");
  const auto wanted = [&] { return nodesOf(graph, {"n", "r"}); };
  Both both = planAndRun(graph, wanted(), false);
  EXPECT_EQ(entryOf(graph, both, "s").why, "never run");
  EXPECT_EQ(entryOf(graph, both, "t").why, "upstream: s");
  expectAgreement(graph, both, "first");
  both = planAndRun(graph, wanted(), false);
  for (const PlanEntry& entry : both.plan) EXPECT_EQ(entry.state, PlanState::Hit) << entry.why;
  expectAgreement(graph, both, "again");
  graph = graphWith("2");
  both = planAndRun(graph, wanted(), false);
  EXPECT_EQ(entryOf(graph, both, "s").why, "value 1 → 2");
  EXPECT_EQ(entryOf(graph, both, "s").state, PlanState::Run);
  EXPECT_EQ(entryOf(graph, both, "t").state, PlanState::Follows);
  EXPECT_EQ(entryOf(graph, both, "r").state, PlanState::Hit);
  expectAgreement(graph, both, "edited");
  directory.write("in.txt", "two");
  both = planAndRun(graph, wanted(), false);
  EXPECT_EQ(entryOf(graph, both, "r").why, "in.txt has changed");
  expectAgreement(graph, both, "file");
  open()->collect(100000);  // the large value goes, what is known of it stays
  both = planAndRun(graph, nodesOf(graph, {"t"}), true);
  EXPECT_EQ(entryOf(graph, both, "r").state, PlanState::NotNeeded);
  EXPECT_EQ(entryOf(graph, both, "t").why, "its result was evicted");
  expectAgreement(graph, both, "evicted");
  open()->clear().ok();
  both = planAndRun(graph, wanted(), false);
  EXPECT_EQ(entryOf(graph, both, "s").state, PlanState::Run);
  expectAgreement(graph, both, "cleared");
}

TEST_F(Plans, AChangeThatEndsInTheSameResultStopsThere) {
  const auto graphWith = [&](const std::string& a, const std::string& b) {
    return graphOf(R"("s": {"type": "Slow@1", "params": {"value": )" + a + R"(}},
        "t": {"type": "Add@1", "in": {"a": "s"}, "params": {"offset": )" +
                       b + R"(}},
        "u": {"type": "Slow@1", "in": {"a": "t"}})",
                   registry);
  };
  Graph graph = graphWith("1", "4");
  planAndRun(graph, {2});
  graph = graphWith("3", "2");
  const Both both = planAndRun(graph, {2});
  EXPECT_EQ(entryOf(graph, both, "u").state, PlanState::Follows);
  EXPECT_EQ(stateOf(graph, both.report, "t"), "run");
  EXPECT_EQ(stateOf(graph, both.report, "u"), "hit");
  EXPECT_EQ(numberAt(graph, both.report, "u", "sum"), 5);
}

TEST_F(Plans, KnowTheFileWhoseNameComesOverAWire) {
  directory.write("one.txt", "1");
  directory.write("two.txt", "2");
  const auto graphWith = [&](const std::string& name) {
    return graphOf(R"("w": {"type": "Word@1", "params": {"text": ")" + name + R"("}},
        "r": {"type": "ReadText@1", "in": {"file": "w"}})",
                   registry, directory.path());
  };
  Graph graph = graphWith("one.txt");
  expectAgreement(graph, planAndRun(graph, {1}, false), "first");
  Both both = planAndRun(graph, {1}, false);
  for (const PlanEntry& entry : both.plan) EXPECT_EQ(entry.state, PlanState::Hit) << entry.why;
  expectAgreement(graph, both, "again");
  EXPECT_EQ(counters->reads, 1);
  directory.write("one.txt", "other");
  both = planAndRun(graph, {1}, false);
  EXPECT_EQ(entryOf(graph, both, "w").state, PlanState::Hit);
  EXPECT_EQ(entryOf(graph, both, "r").state, PlanState::Run);
  EXPECT_EQ(entryOf(graph, both, "r").why, "one.txt has changed");
  expectAgreement(graph, both, "file");
  graph = graphWith("two.txt");
  both = planAndRun(graph, {1}, false);
  EXPECT_EQ(entryOf(graph, both, "w").why, "text \"one.txt\" → \"two.txt\"");
  EXPECT_EQ(entryOf(graph, both, "r").state, PlanState::Follows);
  expectAgreement(graph, both, "name");
  graph = graphWith("one.txt");
  both = planAndRun(graph, {1}, false);
  for (const PlanEntry& entry : both.plan) EXPECT_EQ(entry.state, PlanState::Hit) << entry.why;
  expectAgreement(graph, both, "back");
  open()->collect(0);  // names, too: the node that makes one runs to find out
  both = planAndRun(graph, {1}, false);
  expectAgreement(graph, both, "evicted");
}

/// A random graph of twenty nodes or so, and random edits of it.
class RandomGraph {
 public:
  RandomGraph(std::uint64_t seed, fs::path directory) : directory_(std::move(directory)), seed_(seed) {
    for (int i = 0; i < 18; ++i) values_.push_back(draw(4));
    for (int i = 0; i < 18; ++i) kinds_.push_back(draw(6));
    for (int i = 0; i < 36; ++i) wires_.push_back(draw(1000));
    writeFile(0);
  }
  void edit() {
    switch (draw(5)) {
      case 0:
        values_[static_cast<std::size_t>(draw(18))] = draw(4);
        break;
      case 1:
        wires_[static_cast<std::size_t>(draw(36))] = draw(1000);
        break;
      case 2:
        kinds_[static_cast<std::size_t>(draw(18))] = draw(6);
        break;
      case 3:
        name_ = draw(2) == 0 ? "in.txt" : "other.txt";
        break;
      default:
        writeFile(draw(3));
    }
  }
  std::string nodes() const {
    std::string text = R"("n0": {"type": "Constant@1", "params": {"value": "${frame}"}},
"v": {"type": "Word@1", "params": {"text": ")" +
                       name_ + R"("}}, "w": {"type": "Word@1", "in": {"text": "v"}})";
    for (int i = 1; i < 18; ++i) text += ",\n\"n" + std::to_string(i) + "\": " + node(i);
    return text;
  }
  int draw(int n) { return static_cast<int>(Rng(seed_).bitsAt(count_++) % static_cast<std::uint64_t>(n)); }

 private:
  std::string node(int i) const {
    const auto at = static_cast<std::size_t>(i);
    const auto source = [&](std::size_t k) { return "\"n" + std::to_string(wires_[k] % i) + '"'; };
    const std::string value = std::to_string(values_[at]);
    switch (kinds_[at]) {
      case 0:
        return R"({"type": "Slow@1", "in": {"a": )" + source(2 * at) + R"(}, "params": {"value": )" + value +
               "}}";
      case 1:
        return R"({"type": "Add@1", "in": {"a": )" + source(2 * at) + R"(, "b": )" + source(2 * at + 1) +
               R"(}, "params": {"offset": )" + value + "}}";
      case 5:
        return R"({"type": "Lines@1", "in": {"file": "w"}, "params": {"factor": )" + value + "}}";
      case 2:
        return R"({"type": "Constant@1", "params": {"value": )" + value + "}}";
      case 3:
        return R"({"type": "Lines@1", "params": {"file": "in.txt", "factor": )" + value + "}}";
      default:
        return R"({"type": "Add@1", "in": {"a": )" + source(2 * at) + "}}";
    }
  }
  void writeFile(int lines) {
    std::ofstream(directory_ / "in.txt", std::ios::binary)
        << std::string(static_cast<std::size_t>(lines), '\n');
    std::ofstream(directory_ / "other.txt", std::ios::binary) << "one\ntwo\n";
  }

  fs::path directory_;
  std::uint64_t seed_, count_ = 0;
  std::string name_ = "in.txt";
  std::vector<int> values_, kinds_, wires_;
};

struct LinesParams {
  std::string file;
  double factor = 1;
};
/// The number of lines of a file.
NodeType linesNode() {
  return NodeBuilder<LinesParams>("Lines", 1, "")
      .inputFile("file", &LinesParams::file, "")
      .number("factor", &LinesParams::factor, {})
      .output<double>("count", "")
      .run([](const LinesParams& params, NodeIo& io) -> Result<void> {
        std::ifstream file(params.file);
        std::string line;
        double count = 0;
        while (std::getline(file, line)) ++count;
        io.out("count", count * params.factor);
        return {};
      });
}

TEST_F(Plans, AndRunsAgreeOnRandomGraphsAndEdits) {
  ASSERT_TRUE(registry.add(linesNode()).ok());
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    RandomGraph random(seed, directory.path());
    setThreadLimit(1 + static_cast<int>(seed % 3));
    for (int round = 0; round < 12; ++round) {
      const Graph graph = graphOf(random.nodes(), registry, directory.path(), R"("frames": "1-2", )");
      std::vector<int> wanted;
      for (const char* name : {"n17", "n11"})
        for (int k = 0; k < graph.index.at(name).count; ++k) wanted.push_back(graph.index.at(name).first + k);
      std::sort(wanted.begin(), wanted.end());
      const Both both = planAndRun(graph, wanted, round % 2 == 0);
      const std::string what = "seed " + std::to_string(seed) + ", round " + std::to_string(round);
      expectAgreement(graph, both, what);
      Cache fresh;
      CancelToken token;
      const EvalReport without = evaluate(graph, wanted, fresh, token);
      for (const EvalReport* report : {&without, &both.report})
        for (const NodeReport& node : report->nodes)
          if (node.error)
            ADD_FAILURE() << what << ": " << graph.labelOf(node.node) << ": " << node.error->text();
      ASSERT_TRUE(without.ok() && both.report.ok()) << what;
      for (const int i : wanted)
        for (std::size_t o = 0; o < without.outputs.at(i).size(); ++o)
          EXPECT_EQ(both.report.outputs.at(i).at(o).digest, without.outputs.at(i).at(o).digest) << what;
      if (HasFailure()) return;
      if (random.draw(5) == 0) open()->collect(0);
      for (int k = random.draw(3); k > 0; --k) random.edit();
    }
  }
}

}  // namespace
}  // namespace sherd::test
