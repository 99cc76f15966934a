// Frames and wedges: what is there how often, and what it reads.
#include <gtest/gtest.h>

#include "runtime/made_up.h"

namespace sherd::test {
namespace {

std::string framesOf(const std::string& text) {
  const auto list = parseFrames(text);
  if (!list.ok()) return list.error().what;
  std::string shown;
  for (const std::int64_t frame : list->frames) shown += std::to_string(frame) + ' ';
  return shown + "= " + framesText(list->frames);
}

TEST(Frames, AreReadAndWritten) {
  EXPECT_EQ(framesOf("7"), "7 = 7");
  EXPECT_EQ(framesOf("1-3"), "1 2 3 = 1-3");
  EXPECT_EQ(framesOf("1-9x4"), "1 5 9 = 1-9x4");
  EXPECT_EQ(framesOf("3, 1-2,8"), "1 2 3 8 = 1-3,8");
  EXPECT_EQ(framesOf("-3--1"), "-3 -2 -1 = -3--1");
  EXPECT_EQ(framesOf("1,9"), "1 9 = 1,9");
  for (const char* wrong : {"", "x", "3-1", "1-", "1-5x0", "1-5x", "1,,2", "1-5y2", "99999999999"})
    EXPECT_NE(framesOf(wrong).find("is no range of frames"), std::string::npos) << wrong;
  EXPECT_NE(framesOf("1-9000000").find("more than a million frames"), std::string::npos);
}

class Sweeps : public ::testing::Test {
 protected:
  EvalReport run(const Graph& graph, const std::string& to) {
    CancelToken token;
    return evaluate(graph, *wantedNodes(graph, "", to), cache, token);
  }
  std::vector<double> numbersAt(const Graph& graph, const std::string& node) {
    const EvalReport report = run(graph, node);
    std::vector<double> numbers;
    for (const auto& [i, outputs] : report.outputs) numbers.push_back(*outputs.at(0).value.as<double>());
    return numbers;
  }
  std::shared_ptr<Counters> counters = std::make_shared<Counters>();
  Registry registry = madeUpNodes(counters);
  Cache cache;
};

TEST_F(Sweeps, WhatReadsTheFrameIsThereOncePerFrame) {
  const Graph graph = graphOf(R"("c": {"type": "Constant@1", "params": {"value": "${frame}"}},
      "fixed": {"type": "Constant@1", "params": {"value": 100}},
      "sum": {"type": "Add@1", "in": {"a": "c", "b": "fixed"}}, "time": {"type": "Constant@1", "params": {"value": "${time}"}})",
                              registry, "/graphs", R"("frames": "1-3", "fps": 2, )");
  EXPECT_EQ(graph.index.at("c").count, 3);
  EXPECT_EQ(graph.index.at("fixed").count, 1);
  EXPECT_EQ(graph.index.at("sum").count, 3);
  EXPECT_EQ(numbersAt(graph, "sum"), (std::vector<double>{101, 102, 103}));
  EXPECT_EQ(numbersAt(graph, "time"), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(counters->constants, 6);  // 3 + 1 + 3, two of which are 1
  EXPECT_EQ(graph.labelOf(graph.find("sum") + 1), "sum (frame 2)");
  EXPECT_EQ(graph.labelOf(graph.find("fixed")), "fixed");
}

TEST_F(Sweeps, WedgesMultiplyWhatTheyTouch) {
  const Graph graph = graphOf(
      R"("a": {"type": "Constant@1", "params": {"value": "${x}"}}, "b": {"type": "Constant@1", "params": {"value": "${y2}"}},
      "sum": {"type": "Add@1", "in": {"a": "a", "b": "b"}}, "c": {"type": "Constant@1"})",
      registry, "/graphs",
      R"("vars": {"x": 1, "y": 2, "y2": "${y}", "z": 3}, "wedge": {"x": [10, 20], "y": [1, 2, 3], "z": [1, 2]}, )");
  EXPECT_EQ(graph.index.at("a").count, 2);
  EXPECT_EQ(graph.index.at("b").count, 3);
  EXPECT_EQ(graph.index.at("sum").count, 6);
  EXPECT_EQ(graph.index.at("c").count, 1);
  EXPECT_EQ(numbersAt(graph, "sum"), (std::vector<double>{11, 12, 13, 21, 22, 23}));
  EXPECT_EQ(graph.labelOf(graph.find("sum") + 5), "sum (x 20, y 3)");
  Checked pinned = check(R"({"format": 1, "vars": {"x": 1}, "wedge": {"x": [10, 20]},
      "nodes": {"a": {"type": "Constant@1", "params": {"value": "${x}"}}}})",
                         registry, {}, {"x=5"});
  EXPECT_TRUE(pinned.errors.empty());
  EXPECT_EQ(numbersAt(pinned.graph, "a"), std::vector<double>{5});
}

TEST_F(Sweeps, GatheringTakesAllInOrder) {
  struct None {};
  ASSERT_TRUE(registry
                  .add(NodeBuilder<None>("Join", 1, "")
                           .gatheredInput<double>("all", "")
                           .output<std::string>("text", "")
                           .run([](const None&, NodeIo& io) -> Result<void> {
                             std::string text;
                             for (const auto& [value, label] : io.all<double>("all"))
                               text += label + '=' + std::to_string(static_cast<int>(*value)) + ';';
                             io.out("text", text);
                             return {};
                           }))
                  .ok());
  const std::string nodes = R"("c": {"type": "Constant@1", "params": {"value": "${frame}"}},
      "d": {"type": "Constant@1", "params": {"value": "${x}"}}, "sum": {"type": "Add@1", "in": {"a": "c", "b": "d"}},
      "join": {"type": "Join@1", "in": {"all": "sum"}}, "one": {"type": "Constant@1"}, "alone": {"type": "Join@1", "in": {"all": "one"}})";
  const Graph graph =
      graphOf(nodes, registry, "/graphs", R"("frames": "1-2", "vars": {"x": 0}, "wedge": {"x": [10, 20]}, )");
  EXPECT_EQ(graph.index.at("join").count, 1);
  const EvalReport report = run(graph, "join");
  EXPECT_EQ(*valueAt(graph, report, "join", "text").as<std::string>(),
            "frame 1, x 10=11;frame 1, x 20=21;frame 2, x 10=12;frame 2, x 20=22;");
  EXPECT_EQ(*valueAt(graph, run(graph, "alone"), "alone", "text").as<std::string>(), "=0;");
}

TEST_F(Sweeps, WrongOnesAreTold) {
  auto errorsOf = [&](const std::string& more) {
    return check("{\"format\": 1, " + more + R"("nodes": {"a": {"type": "Constant@1"}}})", registry).errors;
  };
  using Errors = std::vector<std::string>;
  EXPECT_EQ(
      errorsOf(R"("frames": "5-1", )"),
      Errors{
          "test.json:1:25: frames: \"5-1\" is no range of frames; write \"1001-1040\", \"1001-1100x2\" for "
          "every second one, or \"1,5,8-10\""});
  EXPECT_TRUE(errorsOf(R"("frames": 3, )").empty());
  EXPECT_EQ(errorsOf(R"("vars": {"seed": 1}, "wedge": {"sead": [1]}, )"),
            Errors{"test.json:1:46: wedge.sead: the graph has no variable \"sead\"; did you mean \"seed\"?"});
  EXPECT_EQ(errorsOf(R"("vars": {"s": 1}, "wedge": {"s": 1}, )"),
            Errors{"test.json:1:48: wedge.s: this is 1; it would have to be a list of the values to try, as "
                   "[1, 2, 3]"});
  EXPECT_EQ(errorsOf(R"("vars": {"s": 1}, "wedge": {"s": [1, 1]}, )"),
            Errors{"test.json:1:52: wedge.s: 1 is in the list already; leave one of the two out"});
  const Checked marked = check(R"({"format": 1, "frames": "1", "nodes": {"a": {"type": "Constant@1",
      "params": {"value": "${frame:x}"}}}})",
                               registry);
  ASSERT_EQ(marked.errors.size(), 1u);
  EXPECT_NE(marked.errors[0].find("has a format that is unknown; write \"${frame:04}\""), std::string::npos);
}

}  // namespace
}  // namespace sherd::test
