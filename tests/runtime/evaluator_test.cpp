// Evaluation: what runs, how often, in what order, and what becomes of failures.
#include "eval/evaluator.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <new>
#include <set>
#include <stdexcept>
#include <thread>

#include "base/parallel.h"
#include "eval/key.h"
#include "graph/instances.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

struct None {};
using Run = std::function<Result<void>(NodeIo&)>;

/// A node with an optional Number input "a" and a Number output "out" that does as told.
NodeType custom(const std::string& name, Run run) {
  return NodeBuilder<None>(name, 1, "Custom.")
      .optionalInput<double>("a", "")
      .output<double>("out", "")
      .run([run = std::move(run)](const None&, NodeIo& io) { return run(io); });
}

class Evaluator : public ::testing::Test {
 protected:
  ~Evaluator() override { setThreadLimit(0); }

  EvalReport evaluateNodes(const Graph& graph, const std::vector<std::string>& names,
                           EvalOptions options = {}) {
    CancelToken token;
    return evaluate(graph, nodesOf(graph, names), cache, token, options);
  }
  void add(NodeType type) { ASSERT_TRUE(registry.add(std::move(type)).ok()); }

  std::shared_ptr<Counters> counters = std::make_shared<Counters>();
  Registry registry = madeUpNodes(counters);
  Cache cache;
};

TEST_F(Evaluator, RunsOnlyWhatIsNeeded) {
  const Graph graph = graphOf(
      R"("a": {"type": "Constant@1", "params": {"value": 3}}, "b": {"type": "Constant@1", "params": {"value": 4}},
      "x": {"type": "Add@1", "in": {"a": "a"}, "params": {"offset": 1}}, "y": {"type": "Add@1", "in": {"a": "b", "b": "x"}})",
      registry);
  const EvalReport report = evaluateNodes(graph, {"x"});
  EXPECT_TRUE(report.ok());
  EXPECT_EQ(numberAt(graph, report, "x", "sum"), 4);
  EXPECT_EQ(report.nodes.size(), 2u);
  EXPECT_EQ(stateOf(graph, report, "b"), "absent");
  EXPECT_EQ(counters->constants, 1);
  EXPECT_EQ(numberAt(graph, evaluateNodes(graph, {"y"}), "y", "sum"), 8);
}

TEST_F(Evaluator, WiredParametersAreReadAndChecked) {
  const Graph graph = graphOf(
      R"("a": {"type": "Constant@1", "params": {"value": 3}}, "x": {"type": "Add@1", "in": {"a": "a", "offset": "a"}},
      "w": {"type": "Constant@1", "params": {"value": 100}}, "y": {"type": "Add@1", "in": {"a": "a", "offset": "w.whole"}})",
      registry);
  EXPECT_EQ(numberAt(graph, evaluateNodes(graph, {"x"}), "x", "sum"), 6);
  const EvalReport report = evaluateNodes(graph, {"y"});
  EXPECT_EQ(stateOf(graph, report, "y"), "failed");
  EXPECT_EQ(report.nodes.back().error->text(),
            "100 is out of range; it would have to be at least -100 and below 100 m");
  EXPECT_EQ(report.nodes.back().error->port, "offset");
}

TEST_F(Evaluator, HitsTheCacheBySameContent) {
  const std::string tail = R"("x": {"type": "Add@1", "in": {"a": "a"}})";
  const Graph first = graphOf(R"("a": {"type": "Constant@1", "params": {"value": 3}},)" + tail, registry);
  evaluateNodes(first, {"x"});
  const EvalReport again = evaluateNodes(first, {"x"});
  EXPECT_EQ(again.count(NodeState::Hit), 2);
  EXPECT_EQ(numberAt(first, again, "x", "sum"), 3);
  // Another way to the same number: the change stops there.
  const Graph second = graphOf(R"("z": {"type": "Constant@1", "params": {"value": 2}},
      "a": {"type": "Add@1", "in": {"a": "z"}, "params": {"offset": 1}},)" +
                                   tail,
                               registry);
  const EvalReport other = evaluateNodes(second, {"x"});
  EXPECT_EQ(stateOf(second, other, "a"), "run");
  EXPECT_EQ(stateOf(second, other, "x"), "hit");
  const Graph changed = graphOf(R"("a": {"type": "Constant@1", "params": {"value": 4}},)" + tail, registry);
  EXPECT_EQ(evaluateNodes(changed, {"x"}).count(NodeState::Run), 2);
}

TEST_F(Evaluator, FilesCountByContent) {
  const TemporaryDirectory directory;
  directory.write("t.txt", "one");
  const Graph graph =
      graphOf(R"("r": {"type": "ReadText@1", "params": {"file": "t.txt"}})", registry, directory.path());
  evaluateNodes(graph, {"r"});
  directory.write("t.txt", "one");
  EXPECT_EQ(evaluateNodes(graph, {"r"}).count(NodeState::Hit), 1);
  directory.write("t.txt", "two");
  const EvalReport report = evaluateNodes(graph, {"r"});
  EXPECT_EQ(report.count(NodeState::Run), 1);
  EXPECT_EQ(*report.outputs.at(0).at(0).value.as<std::string>(), "two");
  fs::remove(directory.path() / "t.txt");
  const EvalReport gone = evaluateNodes(graph, {"r"});
  EXPECT_EQ(gone.count(NodeState::Failed), 1);
  EXPECT_NE(gone.nodes[0].error->what.find("can't be opened: No such file"), std::string::npos);
}

TEST_F(Evaluator, SameKeysComputeOnce) {
  std::string nodes;
  for (int i = 0; i < 50; ++i)
    nodes += "\"b" + std::to_string(i) + R"(": {"type": "MakeBlob@1", "params": {"size": 20000}}, "s)" +
             std::to_string(i) + R"(": {"type": "SumBlob@1", "in": {"blob": "b)" + std::to_string(i) +
             "\"}},";
  nodes += R"("end": {"type": "Constant@1"})";
  for (const int threads : {1, 2, 4}) {
    setThreadLimit(threads);
    Cache fresh;
    counters->blobs = 0;
    CancelToken token;
    const Graph graph = graphOf(nodes, registry);
    const auto wanted = wantedNodes(graph, "", "");
    const EvalReport report = evaluate(graph, *wanted, fresh, token);
    EXPECT_EQ(counters->blobs, 1);
    EXPECT_EQ(report.count(NodeState::Run), 3);
    EXPECT_EQ(report.count(NodeState::Hit), 98);
    EXPECT_EQ(numberAt(graph, report, "s0", "sum"), numberAt(graph, report, "s49", "sum"));
  }
}

TEST_F(Evaluator, ExportersRunUntilTheirFilesAreThere) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "out/value.txt").string();
  const Graph graph = graphOf(R"("c": {"type": "Constant@1", "params": {"value": 5}},
      "s": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "out"}})",
                              registry, directory.path());
  EXPECT_EQ(stateOf(graph, evaluateNodes(graph, {"s"}), "s"), "run");
  const EvalReport again = evaluateNodes(graph, {"s"});
  EXPECT_EQ(stateOf(graph, again, "s"), "hit");
  EXPECT_EQ(again.nodes.back().written, std::vector<std::string>{file});
  fs::remove(file);
  EXPECT_EQ(stateOf(graph, evaluateNodes(graph, {"s"}), "s"), "run");
  directory.write("out/value.txt", "altered");
  EXPECT_EQ(stateOf(graph, evaluateNodes(graph, {"s"}), "s"), "run");
  EXPECT_EQ(stateOf(graph, evaluateNodes(graph, {"s"}), "s"), "hit");
  EXPECT_EQ(counters->sinks, 3);
  EXPECT_EQ(counters->constants, 1);
}

TEST_F(Evaluator, SameResultForAnyThreads) {
  std::string nodes;
  for (int i = 0; i < 8; ++i)
    nodes += "\"b" + std::to_string(i) + R"(": {"type": "MakeBlob@1", "params": {"size": 5000, "seed": )" +
             std::to_string(i) + "}}, \"p" + std::to_string(i) +
             R"(": {"type": "PassBlob@1", "in": {"blob": "b)" + std::to_string(i) + "\"}}, \"s" +
             std::to_string(i) + R"(": {"type": "SumBlob@1", "in": {"blob": "p)" + std::to_string(i) +
             "\"}},";
  nodes += R"("end": {"type": "Add@1", "in": {"a": "s3", "b": "s7"}})";
  const Graph graph = graphOf(nodes, registry);
  std::set<double> sums;
  std::set<Digest> digests;
  for (const int threads : {1, 2, 4}) {
    setThreadLimit(threads);
    Cache fresh;
    CancelToken token;
    const EvalReport report = evaluate(graph, nodesOf(graph, {"end", "p3"}), fresh, token);
    EXPECT_TRUE(report.ok());
    sums.insert(numberAt(graph, report, "end", "sum"));
    digests.insert(report.outputs.at(graph.find("p3")).at(0).digest);
  }
  EXPECT_EQ(sums.size(), 1u);
  EXPECT_EQ(digests.size(), 1u);
}

TEST_F(Evaluator, IndependentBranchesRunAtTheSameTime) {
  setThreadLimit(2);
  std::atomic<int> inside{0};
  std::atomic<bool> met{false};
  auto meet = [&](NodeIo& io) -> Result<void> {
    ++inside;
    for (int i = 0; i < 5000 && !met; ++i) {
      if (inside == 2) met = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    io.out("out", 1.0);
    return {};
  };
  add(custom("Left", meet));
  add(custom("Right", meet));
  const Graph graph = graphOf(
      R"("l": {"type": "Left@1"}, "r": {"type": "Right@1"}, "e": {"type": "Add@1", "in": {"a": "l", "b": "r"}})",
      registry);
  EXPECT_TRUE(evaluateNodes(graph, {"e"}).ok());
  EXPECT_TRUE(met);
}

TEST_F(Evaluator, FailuresNameTheNodeAndStopWhatNeedsIt) {
  add(custom("Fails", [](NodeIo&) -> Result<void> { return failure("it broke", "mend it", "a"); }));
  const Graph graph = graphOf(R"("f": {"type": "Fails@1"}, "x": {"type": "Add@1", "in": {"a": "f"}},
      "y": {"type": "Add@1", "in": {"a": "x"}}, "c": {"type": "Constant@1"}, "z": {"type": "Add@1", "in": {"a": "c"}})",
                              registry);
  setThreadLimit(1);
  const EvalReport goingOn = evaluateNodes(graph, {"y", "z"}, {.keepGoing = true});
  EXPECT_FALSE(goingOn.ok());
  EXPECT_FALSE(goingOn.cancelled);
  EXPECT_EQ(goingOn.nodes.size(), 5u);
  EXPECT_EQ(stateOf(graph, goingOn, "f"), "failed");
  EXPECT_EQ(stateOf(graph, goingOn, "x"), "skipped");
  EXPECT_EQ(stateOf(graph, goingOn, "y"), "skipped");
  EXPECT_EQ(stateOf(graph, goingOn, "z"), "run");
  EXPECT_EQ(graph.nameOf(0, goingOn.nodes[0].error->port), "f.a");
  const EvalReport stopping = evaluateNodes(graph, {"y", "z"});
  EXPECT_FALSE(stopping.cancelled);
  EXPECT_EQ(stateOf(graph, stopping, "y"), "skipped");
  EXPECT_EQ(stateOf(graph, stopping, "z"), "hit");  // known before anything could fail
  cache.clear();
  EXPECT_EQ(stateOf(graph, evaluateNodes(graph, {"y", "z"}), "z"), "skipped");
}

TEST_F(Evaluator, AFailureStopsRunningNodes) {
  setThreadLimit(2);
  std::atomic<bool> waiting{false}, sawCancel{false};
  add(custom("Waits", [&](NodeIo& io) -> Result<void> {
    waiting = true;
    for (int i = 0; i < 60'000 && !io.exec().cancelled(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    sawCancel = io.exec().cancelled();
    return cancelledError();
  }));
  add(custom("Fails", [&](NodeIo&) -> Result<void> {
    for (int i = 0; i < 60'000 && !waiting; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return failure("it broke");
  }));
  const Graph graph = graphOf(R"("w": {"type": "Waits@1"}, "f": {"type": "Fails@1"})", registry);
  const EvalReport report = evaluateNodes(graph, {"w", "f"});
  EXPECT_TRUE(sawCancel);
  EXPECT_EQ(report.count(NodeState::Failed), 1);
  EXPECT_EQ(stateOf(graph, report, "w"), "skipped");
}

TEST_F(Evaluator, ExceptionsAreFailures) {
  add(custom("Throws", [](NodeIo&) -> Result<void> { throw std::runtime_error("library trouble"); }));
  add(custom("Exhausts", [](NodeIo&) -> Result<void> { throw std::bad_alloc(); }));
  add(custom("ThrowsInt", [](NodeIo&) -> Result<void> { throw 3; }));
  add(custom("ThrowsInLoop", [](NodeIo& io) -> Result<void> {
    parallelFor(io.exec(), 1000, 1, [](std::size_t begin, std::size_t) {
      if (begin == 500) throw std::runtime_error("in a loop");
    });
    return {};
  }));
  const Graph graph = graphOf(
      R"("a": {"type": "Throws@1"}, "b": {"type": "Exhausts@1"}, "c": {"type": "ThrowsInt@1"}, "d": {"type": "ThrowsInLoop@1"})",
      registry);
  auto errorOf = [&](const std::string& name) {
    return evaluateNodes(graph, {name}).nodes.at(0).error->text();
  };
  EXPECT_EQ(errorOf("a"),
            "an exception that the node didn't catch: library trouble; this is a mistake in Throws, please "
            "report it");
  EXPECT_EQ(errorOf("b"), "out of memory; use a smaller model or a coarser resolution");
  EXPECT_EQ(
      errorOf("c"),
      "an unknown exception that the node didn't catch; this is a mistake in ThrowsInt, please report it");
  EXPECT_NE(errorOf("d").find("in a loop"), std::string::npos);
}

TEST_F(Evaluator, OutputsMustBeDeclaredAndThere) {
  add(custom("Undeclared", [](NodeIo& io) -> Result<void> {
    io.out("other", 1.0);
    return {};
  }));
  add(custom("Mistyped", [](NodeIo& io) -> Result<void> {
    io.out<std::int64_t>("out", 1);
    return {};
  }));
  add(custom("Empty", [](NodeIo&) -> Result<void> { return {}; }));
  const Graph graph =
      graphOf(R"("u": {"type": "Undeclared@1"}, "m": {"type": "Mistyped@1"}, "e": {"type": "Empty@1"},
      "x": {"type": "Add@1", "in": {"a": "e"}}, "c": {"type": "Constant@1"}, "y": {"type": "Add@1", "in": {"a": "c", "b": "e"}},
      "z": {"type": "Add@1", "in": {"a": "c", "offset": "e"}})",
              registry);
  EXPECT_NE(evaluateNodes(graph, {"u"}).nodes[0].error->what.find("output \"other\" that it doesn't declare"),
            std::string::npos);
  EXPECT_EQ(evaluateNodes(graph, {"m"}).nodes[0].error->what,
            "the node set a Integer where it declares a Number");
  EXPECT_EQ(evaluateNodes(graph, {"x"}).nodes.back().error->port, "a");
  EXPECT_TRUE(evaluateNodes(graph, {"y"}).ok());
  EXPECT_EQ(evaluateNodes(graph, {"z"}).nodes.back().error->port, "offset");
}

TEST_F(Evaluator, CancellationEndsTheRun) {
  CancelToken token;
  add(custom("Cancels", [&](NodeIo& io) -> Result<void> {
    token.cancel();
    io.out("out", 1.0);
    return {};
  }));
  const Graph graph =
      graphOf(R"("k": {"type": "Cancels@1"}, "x": {"type": "Add@1", "in": {"a": "k"}})", registry);
  const EvalReport report = evaluate(graph, nodesOf(graph, {"x"}), cache, token);
  EXPECT_TRUE(report.cancelled);
  EXPECT_FALSE(report.ok());
  EXPECT_EQ(report.count(NodeState::Skipped), 2);
  EXPECT_EQ(cache.size(), 0u);  // what a cancelled node returns may be half a result
  EXPECT_TRUE(evaluate(graph, {0}, cache, token).cancelled);
}

TEST_F(Evaluator, MessagesAndProgressArrive) {
  struct Listener : EvalListener {
    void started(int) override { ++starts; }
    void progress(int, double share) override { shares.push_back(share); }
    void finished(const NodeReport& report) override { messages += report.messages.size(); }
    int starts = 0;
    std::vector<double> shares;
    std::size_t messages = 0;
  } listener;
  add(custom("Talks", [](NodeIo& io) -> Result<void> {
    io.exec().info("hello");
    io.exec().warn("careful");
    parallelFor(io.exec(), 1000, 1, [&](std::size_t begin, std::size_t) {
      io.exec().progress(static_cast<double>(begin) / 1000);
    });
    io.exec().progress(std::numeric_limits<double>::quiet_NaN());
    io.exec().progress(7);
    io.out("out", 1.0);
    return {};
  }));
  const Graph graph = graphOf(R"("t": {"type": "Talks@1"})", registry);
  CancelToken token;
  const EvalReport report = evaluate(graph, {0}, cache, token, {}, &listener);
  ASSERT_EQ(report.nodes[0].messages.size(), 2u);
  EXPECT_EQ(report.nodes[0].messages[1].level, LogLevel::Warning);
  EXPECT_EQ(listener.starts, 1);
  EXPECT_LE(listener.shares.size(), 100u);
  EXPECT_EQ(listener.shares.back(), 1);
  EXPECT_EQ(evaluateNodes(graph, {"t"}).nodes[0].messages.size(), 2u);  // a hit says it again
  EXPECT_EQ(listener.messages, 2u);
}

TEST_F(Evaluator, ChainsOfAnyLengthNeedNoStack) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  constexpr int kLength = 20000;  // their frames are larger, and minutes are dear
#else
  constexpr int kLength = 100000;
#endif
  std::string nodes = R"("n0": {"type": "Constant@1", "params": {"value": 0}})";
  for (int i = 1; i <= kLength; ++i)
    nodes += ",\"n" + std::to_string(i) + R"(": {"type": "Add@1", "in": {"a": "n)" + std::to_string(i - 1) +
             R"("}, "params": {"offset": 1}})";
  const Graph graph = graphOf(nodes, registry);
  for (const int threads : {1, 2}) {
    setThreadLimit(threads);
    Cache fresh;
    CancelToken token;
    const std::string last = "n" + std::to_string(kLength);
    const EvalReport report = evaluate(graph, nodesOf(graph, {last}), fresh, token);
    EXPECT_EQ(report.count(NodeState::Run), kLength + 1);
    EXPECT_EQ(numberAt(graph, report, last, "sum"), kLength);
  }
}

TEST_F(Evaluator, TakesManyInputs) {
  constexpr int kInputs = 10000;
  NodeBuilder<None> builder("Many", 1, "Adds up many.");
  std::string nodes =
      R"("c": {"type": "Constant@1", "params": {"value": 2}}, "m": {"type": "Many@1", "in": {)";
  for (int i = 0; i < kInputs; ++i) {
    builder.input<double>("p" + std::to_string(i), "");
    nodes += (i > 0 ? ",\"p" : "\"p") + std::to_string(i) + "\": \"c\"";
  }
  add(builder.output<double>("sum", "").run([](const None&, NodeIo& io) -> Result<void> {
    double sum = 0;
    for (int i = 0; i < kInputs; ++i) sum += *io.in<double>("p" + std::to_string(i));
    io.out("sum", sum);
    return {};
  }));
  const Graph graph = graphOf(nodes + "}}", registry);
  EXPECT_EQ(numberAt(graph, evaluateNodes(graph, {"m"}), "m", "sum"), 2 * kInputs);
}

TEST_F(Evaluator, TakesManyOutputsButNotTooMany) {
  const auto typeWith = [](int outputs) {
    NodeBuilder<None> builder("Fan" + std::to_string(outputs), 1, "Many outputs.");
    for (int i = 0; i < outputs; ++i) builder.output<double>("o" + std::to_string(i), "");
    return builder.run([outputs](const None&, NodeIo& io) -> Result<void> {
      for (int i = 0; i < outputs; ++i) io.out("o" + std::to_string(i), static_cast<double>(i));
      return {};
    });
  };
  add(typeWith(64));
  const auto refused = registry.add(typeWith(65));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().text(), "node type \"Fan65\" has 65 outputs; 64 is the most");
  const Graph graph = graphOf(
      R"("f": {"type": "Fan64@1"}, "x": {"type": "Add@1", "in": {"a": "f.o63", "b": "f.o1"}})", registry);
  EXPECT_EQ(numberAt(graph, evaluateNodes(graph, {"x"}), "x", "sum"), 64);
}

TEST(EvalCache, IsBoundedAndDropsTheLeastRecentlyUsed) {
  auto result = [](std::uint64_t key, std::size_t numbers) {
    CachedResult made;
    made.record.key = {0, key};
    made.outputs = {{Value::of<Blob>(std::make_shared<const Blob>(Blob{std::vector<double>(numbers)})), {}}};
    return made;
  };
  Cache cache(10000);
  cache.insert(result(1, 400));
  cache.insert(result(2, 400));
  EXPECT_TRUE(cache.find({0, 1}));
  cache.insert(result(3, 400));  // 2 was used longest ago
  EXPECT_TRUE(cache.find({0, 1}));
  EXPECT_FALSE(cache.find({0, 2}));
  EXPECT_TRUE(cache.find({0, 3}));
  cache.insert(result(4, 4000));  // larger than all
  EXPECT_FALSE(cache.find({0, 4}));
  EXPECT_EQ(cache.size(), 2u);
  EXPECT_LE(cache.bytes(), 10000u);
}

TEST(EvalKey, DependsOnAllThatMatters) {
  Registry registry = madeUpNodes();
  Graph::Node node;
  NodeType type = *registry.find("Add");
  node.type = &type;
  const auto recipe = [&](double offset) {
    node.params = {{"offset", offset}};
    writeRecipe(node);
    return node.recipe;
  };
  const Digest one = recipe(1);
  EXPECT_EQ(recipe(1), one);
  EXPECT_NE(recipe(2), one);
  EXPECT_EQ(recipe(0.0), recipe(-0.0));
  type.implementation = 2;
  EXPECT_NE(recipe(1), one);
  const std::vector<KeyInput> inputs{{0, {}, {1, 2}}};
  const Digest key = resultKey(one, inputs);
  EXPECT_EQ(resultKey(one, inputs), key);
  EXPECT_NE(resultKey(recipe(3), inputs), key);
  for (const KeyInput& other :
       std::vector<KeyInput>{{1, {}, {1, 2}}, {0, {}, {1, 3}}, {0, {5, 5}, {1, 2}}, {kKeyParam, {}, {1, 2}}})
    EXPECT_NE(resultKey(one, std::vector<KeyInput>{other}), key);
  EXPECT_NE(resultKey(one, {}), key);
  const std::vector<KeyInput> many(1000, {0, {}, {1, 2}});
  EXPECT_NE(resultKey(one, many), resultKey(recipe(3), many));
}

}  // namespace
}  // namespace sherd::test
