// Subgraphs: what they expand to.
#include "runtime/subgraph_graphs.h"

namespace sherd::test {
namespace {

TEST(Subgraphs, TwoUsesWithTheirOwnParameters) {
  const Graph graph = good(graphWith(kRaise, R"("c": {"type": "Constant@1", "params": {"value": 10}},
      "one": {"type": "Raise", "in": {"x": "c"}},
      "two": {"type": "Raise", "in": {"x": "one", "extra": "c"}, "params": {"by": "${n}"}},
      "end": {"type": "Add@1", "in": {"a": "two.same", "b": "one.y"}})",
                                     R"("vars": {"n": 5}, )"));
  EXPECT_EQ(namesIn(graph), (Lines{"c", "one/add", "two/add", "end"}));
  EXPECT_EQ(valueOf(graph, "one/add"), 11);
  EXPECT_EQ(valueOf(graph, "two/add"), 26);
  EXPECT_EQ(valueOf(graph, "end"), 37);
  EXPECT_EQ(graph.nodes[1].inputs.size(), 1u);  // the open optional input left no wire
}

TEST(Subgraphs, NestAndFindTheirNamesOutwards) {
  const std::string outer = R"("Twice": {
    "vars": {"step": 2}, "inputs": {"x": "Number"}, "outputs": {"y": "b"},
    "subgraphs": {"Own": {"inputs": {"x": "Number"}, "outputs": {"y": "r.same"},
                          "nodes": {"r": {"type": "Raise", "in": {"x": "in.x"}, "params": {"by": 90}}}}},
    "nodes": {"a": {"type": "Raise", "in": {"x": "in.x"}, "params": {"by": "${step}"}},
              "b": {"type": "Own", "in": {"x": "a"}}}}, )";
  const Graph graph = good(graphWith(outer + kRaise, R"("c": {"type": "Constant@1"},
      "t": {"type": "Twice", "in": {"x": "c"}, "params": {"step": 7}}, "e": {"type": "Add@1", "in": {"a": "t"}})"));
  EXPECT_EQ(namesIn(graph), (Lines{"c", "t/a/add", "t/b/r/add", "e"}));
  EXPECT_EQ(valueOf(graph, "e"), 97);
  EXPECT_EQ(errorsOf(graphWith(outer + kRaise, R"("o": {"type": "Own"})")),
            (Lines{"test.json:11:25: o: there is no node type \"Own\"; the known node types are \"Add\", "
                   "\"Constant\", \"Kinds\", \"MakeBlob\", \"PassBlob\", \"ReadText\", \"Sink\", "
                   "\"SumBlob\", \"Word\", \"Twice\", \"Raise\""}));
}

TEST(Subgraphs, InputsMayPassStraightToOutputs) {
  const std::string pass = R"("Pass": {"inputs": {"x": {"type": "Number", "optional": true}},
      "outputs": {"y": "in.x"}, "nodes": {"unused": {"type": "Constant@1"}}})";
  const Graph graph = good(graphWith(pass, R"("c": {"type": "Constant@1", "params": {"value": 4}},
      "p": {"type": "Pass", "in": {"x": "c"}}, "q": {"type": "Pass", "in": {"x": "p.y"}}, "open": {"type": "Pass"},
      "e": {"type": "Add@1", "in": {"a": "q", "b": "open"}})"));
  EXPECT_EQ(valueOf(graph, "e"), 4);
  EXPECT_EQ(errorsOf(graphWith(pass, R"("p": {"type": "Pass", "in": {"x": "q"}},
"q": {"type": "Pass", "in": {"x": "p"}}, "e": {"type": "Add@1", "in": {"a": "q"}})"))
                .size(),
            1u);
  std::string chain = R"("n0": {"type": "Pass", "in": {"x": "c"}}, )";
  for (int i = 1; i < 20000; ++i)
    chain += "\"n" + std::to_string(i) + R"(": {"type": "Pass", "in": {"x": "n)" + std::to_string(i - 1) +
             "\"}},\n";
  EXPECT_EQ(valueOf(good(graphWith(pass, chain + R"("c": {"type": "Constant@1", "params": {"value": 9}},
      "e": {"type": "Add@1", "in": {"a": "n19999"}})")),
                    "e"),
            9);
}

TEST(Subgraphs, MayBeWiredToParameters) {
  const Graph graph = good(graphWith(R"("S": {"inputs": {"o": {"type": "Number", "optional": true}},
      "outputs": {"y": "a"}, "nodes": {"k": {"type": "Constant@1", "params": {"value": 1}},
      "a": {"type": "Add@1", "in": {"a": "k", "offset": "in.o"}}}})",
                                     R"("c": {"type": "Constant@1", "params": {"value": 3.5}},
      "s": {"type": "S", "in": {"o": "c"}}, "t": {"type": "S"}, "u": {"type": "S", "in": {"o": "c.whole"}})"));
  EXPECT_EQ(valueOf(graph, "s/a"), 4.5);
  EXPECT_EQ(valueOf(graph, "t/a"), 1);
  EXPECT_EQ(valueOf(graph, "u/a"), 4);
}

TEST(Subgraphs, TargetsAndTheCommandLineNameThemByTheirNode) {
  const std::string text = graphWith(kRaise, R"("c": {"type": "Constant@1"},
      "r": {"type": "Raise", "in": {"x": "c"}}, "e": {"type": "Add@1", "in": {"a": "r"}})",
                                     R"("targets": {"all": ["r", "e"], "inner": "r/add"}, )");
  const Graph graph = good(text, "/graphs", {"r.by=20"});
  EXPECT_EQ(graph.targets[0].nodes, nodesOf(graph, {"r/add", "e"}));
  EXPECT_EQ(graph.targets[1].nodes, nodesOf(graph, {"r/add"}));
  EXPECT_EQ(wantedNodes(graph, "", "r").value(), nodesOf(graph, {"r/add"}));
  EXPECT_EQ(valueOf(graph, "e"), 20);
  EXPECT_EQ(valueOf(good(text, "/graphs", {"r/add.offset=30"}), "e"), 30);
  EXPECT_EQ(valueOf(good(text, "/graphs", {}, {"r/by=40"}), "e"), 40);
  EXPECT_EQ(errorsOf(text, "/graphs", {"r.bye=1"}),
            (Lines{"--set r.bye=1: r.bye: Raise has no parameter \"bye\"; did you mean \"by\"?"}));
  EXPECT_EQ(wantedNodes(graph, "", "rr").error().remedy, "did you mean \"r\"?");
  EXPECT_EQ(errorsOf(graphWith(
                kRaise, R"("c": {"type": "Constant@1"}, "raised": {"type": "Raise", "in": {"x": "c"}})",
                R"("targets": {"t": "raisd"}, )")),
            (Lines{"test.json:1:32: targets.t: there is no node \"raisd\"; did you mean \"raised\"?"}));
}

TEST(Subgraphs, WithoutOutputsStandForAllTheirNodes) {
  const Graph graph = good(graphWith(R"("W": {"inputs": {"x": "Number"}, "nodes": {
      "one": {"type": "Sink@1", "in": {"value": "in.x"}, "params": {"directory": "a"}},
      "two": {"type": "Sink@1", "in": {"value": "in.x"}, "params": {"directory": "b"}}}})",
                                     R"("c": {"type": "Constant@1"}, "w": {"type": "W", "in": {"x": "c"}})",
                                     R"("targets": {"t": "w"}, )"));
  EXPECT_EQ(graph.targets[0].nodes, nodesOf(graph, {"w/one", "w/two"}));
}

TEST(Subgraphs, GroupsTellWhatStoodWhere) {
  Diagnostics diagnostics;
  GraphFile file = readGraph(
      graphWith(
          R"("T": {"inputs": {"x": "Number"}, "outputs": {"z": "r"}, "nodes": {"r": {"type": "Raise", "in": {"x": "in.x"}}}}, )" +
              kRaise,
          R"("c": {"type": "Constant@1"}, "t": {"type": "T", "in": {"x": "c"}})"),
      std::make_shared<const Source>(Source{"test.json", "/graphs"}), diagnostics);
  expandSubgraphs(file, diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  ASSERT_EQ(file.groups.size(), 2u);
  EXPECT_EQ(file.groups[0].name, "t");
  EXPECT_EQ(file.groups[0].subgraph, "T");
  EXPECT_EQ(file.groups[1].name, "t/r");
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(file.groups[0].outputs, (Pairs{{"z", "t/r/add.sum"}}));
  EXPECT_EQ(file.groups[1].outputs, (Pairs{{"y", "t/r/add.sum"}, {"same", "t/r/add"}}));
  EXPECT_EQ(file.nodes[1].scope, "t/r/");
}

TEST(Names, MayHoldSpacesAndUnicode) {
  const Graph graph = good(graphWith(
      R"("Äste brechen": {"vars": {"größe 2": 3}, "inputs": {"x y": "Number"}, "outputs": {"日本": "a b"},
      "nodes": {"a b": {"type": "Add@1", "in": {"a": "in.x y"}, "params": {"offset": "${größe 2}"}}}})",
      R"("0 ünï": {"type": "Constant@1"},
      "b c": {"type": "Äste brechen", "in": {"x y": "0 ünï"}, "params": {"größe 2": "${v w}"}},
      "e": {"type": "Add@1", "in": {"a": "b c.日本"}})",
      R"("vars": {"v w": 8}, "targets": {"ça va": "b c"}, )"));
  EXPECT_EQ(valueOf(graph, "e"), 8);
  EXPECT_EQ(wantedNodes(graph, "ça va", "").value(), nodesOf(graph, {"b c/a b"}));
}

TEST(Names, MayNotHoldWhatMeansSomething) {
  for (const std::string name : {"", " a", "a ", "a.b", "a/b", "a@1", "$a", "{", "}", "a:b", "a=b", "a\\\"b",
                                 "it's", "a\\tb", "\\u0085", "\\u00a0a", "a\\u3000", "a\\u2003"}) {
    const Lines errors = errorsOf("{\"format\": 1, \"vars\": {\"" + name + "\": 1}, \"targets\": {\"" + name +
                                  "\": []}, \"nodes\": {\"" + name + "\": {\"type\": \"Constant@1\"}}}");
    ASSERT_EQ(errors.size(), 3u) << name;
    EXPECT_NE(errors[0].find("this is no name for a variable; a name holds letters"), std::string::npos)
        << errors[0];
    EXPECT_NE(errors[1].find("this is no name for a target; a name holds letters"), std::string::npos)
        << errors[1];
    EXPECT_NE(errors[2].find("this is no name for a node; a name holds letters"), std::string::npos)
        << errors[2];
  }
}

}  // namespace
}  // namespace sherd::test
