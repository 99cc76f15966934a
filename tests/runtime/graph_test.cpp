// Checking graphs: every message once where it belongs, and the same graph without the mistake passing.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "base/rng.h"
#include "graph/param.h"
#include "graph/suggest.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

/// A graph in which only `node` (the text of one node "n") matters; "c" is a Constant, "k" a Kinds, "s" a
/// Word.
std::vector<std::string> errorsOf(const std::string& node, const std::vector<std::string>& sets = {}) {
  return check(
             "{\"format\": 1, \"nodes\": {\n\"c\": {\"type\": \"Constant@1\"}, \"s\": {\"type\": "
             "\"Word@1\"},\n\"n\": " +
                 node + "}}",
             madeUpNodes(), sets)
      .errors;
}

/// The only error stands at the ^ of `node` (without one: at the node's name), which is not part of the text.
void expectError(std::string node, const std::string& expected) {
  constexpr std::size_t kBefore = 5;  // "n": and a space
  const std::size_t mark = node.find('^');
  if (mark != std::string::npos) node.erase(mark, 1);
  const std::size_t column = mark == std::string::npos ? 1 : kBefore + mark + 1;
  const auto errors = errorsOf(node);
  ASSERT_EQ(errors.size(), 1u) << node << '\n' << joined(errors);
  EXPECT_EQ(errors[0], "test.json:3:" + std::to_string(column) + ": " + expected) << node;
}

void expectGood(const std::string& node) {
  const auto errors = errorsOf(node);
  EXPECT_TRUE(errors.empty()) << node << '\n' << joined(errors);
}

TEST(Suggest, MeasuresEditDistance) {
  EXPECT_EQ(editDistance("", "abc"), 3u);
  EXPECT_EQ(editDistance("mesh", "mesh"), 0u);
  EXPECT_EQ(editDistance("mehs", "mesh"), 1u);
  EXPECT_EQ(editDistance("Mesh", "mesh"), 0u);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(closest("degre", {"seed", "degree", "labels"}), "degree");
  EXPECT_EQ(closest("x", {"y"}), "");
  EXPECT_EQ(closest("", {"y"}), "");
}

TEST(Suggest, FindsNamesThatHaveAPartInCommon) {
  const std::vector<std::string> known{"density", "youngs_modulus", "yield", "tip_toughness", "mesh"};
  EXPECT_EQ(closest("young", known), "youngs_modulus");
  EXPECT_EQ(closest("Modulus", known), "youngs_modulus");
  EXPECT_EQ(closest("yuongs", known), "youngs_modulus");
  EXPECT_EQ(closest("toughness", known), "tip_toughness");
  EXPECT_EQ(closest("densty", known), "density");
  EXPECT_EQ(closest("densty", {"mesh", "density_of_air"}), "density_of_air");
  EXPECT_EQ(closest("the_mesh", known), "mesh");
  EXPECT_EQ(closest("e", known), "");
  EXPECT_EQ(closest("mu", known), "");
  EXPECT_EQ(closest("viscosity", known), "");
}

TEST(Suggest, AlwaysSaysWhatWouldBeRight) {
  std::vector<std::string> known;
  EXPECT_EQ(suggestion("x", known, "nodes"), "there are no nodes");
  for (int i = 10; i < 22; ++i) known.push_back("n" + std::to_string(i));
  EXPECT_EQ(suggestion("wall", known, "nodes").substr(0, 27), "the known nodes are \"n10\", ");
  EXPECT_EQ(suggestion("wall", known, "nodes", "sherd nodes").substr(0, 19), "the known nodes are");
  known.insert(known.end(), {"n22", "n23"});
  EXPECT_EQ(suggestion("wall", known, "nodes", "sherd nodes"), "`sherd nodes` lists the known nodes");
  const std::string list = suggestion("wall", known, "nodes");
  EXPECT_NE(list.find(", \"n21\" and 2 more"), std::string::npos) << list;
}

TEST(GraphCheck, TellsOfNodeTypes) {
  expectError(R"({"type": ^"Constnat@1"})",
              "n: there is no node type \"Constnat\"; did you mean \"Constant\"?");
  expectError(R"({"type": ^"Constant"})", "n: \"Constant\" names no version; write \"Constant@1\"");
  expectError(R"({"type": ^"Constant@2"})",
              "n: \"Constant@2\" is newer than this program; write \"Constant@1\", or update sherd");
  expectError(R"({"type": ^"Kinds@1"})",
              "n: \"Kinds@1\" is an old interface; write \"Kinds@2\" and adapt the node to what `sherd "
              "nodes Kinds` says");
  expectError(R"({"type": ^"Constant@x"})",
              "n: \"Constant@x\" names no version of a type; a whole number follows the @: \"Constant@1\"");
  expectError(R"({"type": ^""})", "n: \"\" names no node type; write \"SomeType@1\"");
  expectError(R"({"type": ^"@1"})", "n: \"@1\" names no node type; write \"SomeType@1\"");
  expectError(R"({"params": {}})", "n: the key \"type\" is missing; add \"type\": \"SomeType@1\"");
  expectError(R"({"type": ^3})", "n: this is an integer; it would have to be a string");
  expectError(R"(^[])", "n: this is a list; it would have to be an object");
  expectGood(R"({"type": "Kinds@2"})");
}

TEST(GraphCheck, TellsOfLinks) {
  expectError(R"({"type": "Add@1"})", "n.a: the input is not connected; wire an output of type Number to it");
  expectError(R"({"type": "Add@1", "in": {"a": ^"d"}})",
              "n.a: there is no node \"d\"; the known nodes are \"c\", \"s\", \"n\"");
  expectError(R"({"type": "Add@1", "in": {"a": ^"c.valu"}})",
              "n.a: Constant has no output \"valu\"; did you mean \"value\"?");
  expectError(R"({"type": "Add@1", "in": {"a": ^"s"}})",
              "n.a: \"s.text\" is of type String; it would have to be Number");
  expectError(R"({"type": "Add@1", "in": {"a": ^"c.whole"}})",
              "n.a: \"c.whole\" is of type Integer; it would have to be Number, as \"c.value\" is");
  expectError(R"({"type": "Add@1", "in": {"a": "c", "x": ^"c"}})",
              "n.x: Add has no input \"x\"; the known inputs and parameters are \"a\", \"b\", \"offset\"");
  expectError(R"({"type": "Add@1", "in": {"a": ^"c."}})",
              "n.a: \"c.\" is no link; write \"node\" or \"node.port\"");
  expectError(R"({"type": "Add@1", "in": {"a": ^1}})",
              "n.a: this is an integer; it would have to be a string");
  expectGood(R"({"type": "Add@1", "in": {"a": "c"}})");
  expectGood(R"({"type": "Add@1", "in": {"a": "c.value", "b": "c"}})");
}

TEST(GraphCheck, TellsOfParameters) {
  expectError(R"({"type": "Kinds@2", "params": {^"cuont": 3}})",
              "n.cuont: Kinds has no parameter \"cuont\"; did you mean \"count\"?");
  expectError(R"({"type": "Kinds@2", "params": {"count": ^11}})",
              "n.count: 11 is out of range; it would have to be at least 1 and at most 10");
  expectError(R"({"type": "Kinds@2", "params": {"count": ^1.5}})",
              "n.count: this is 1.5; it would have to be an integer, at least 1 and at most 10");
  expectError(R"({"type": "Kinds@2", "params": {"length": ^0}})",
              "n.length: 0 is out of range; it would have to be above 0 m");
  expectError(R"({"type": "Kinds@2", "params": {"length": ^"long"}})",
              "n.length: this is the string \"long\"; it would have to be a number, above 0 m");
  expectError(R"({"type": "Kinds@2", "params": {"flag": ^1}})",
              "n.flag: this is 1; it would have to be true or false");
  expectError(R"({"type": "Kinds@2", "params": {"direction": ^[1, 2]}})",
              "n.direction: this is a list of 2; it would have to be a list of three numbers, at least "
              "-1 and at most 1");
  expectError(R"({"type": "Kinds@2", "params": {"direction": ^[0, 0, 2]}})",
              "n.direction: 2 is out of range; it would have to be at least -1 and at most 1");
  expectError(R"({"type": "Kinds@2", "params": {"mode": ^"exakt"}})",
              "n.mode: \"exakt\" is none of its words; did you mean \"exact\"?");
  expectError(R"({"type": "Kinds@2", "params": {"text": ^null}})",
              "n.text: this is null; leave the parameter out for its default");
  expectError(R"({"type": "Kinds@2", "params": {"text": ^3}})",
              "n.text: this is 3; it would have to be a string");
  expectError(R"({"type": "Kinds@2", ^"parms": {}})", "n: unknown key \"parms\"; did you mean \"params\"?");
  expectError(R"({"type": "ReadText@1"})",
              "n.file: the parameter is missing; it would have to be a string, the path of a file to read");
  expectError(R"({"type": "ReadText@1", "params": {"file": ^""}})",
              "n.file: this is empty; it would have to be a string, the path of a file to read");
  expectError(R"({"type": "Add@1", "in": {"a": "c"}, "params": {^"b": 1}})",
              "n.b: Add has no parameter \"b\"; it is an input: wire it in \"in\"");
  expectGood(
      R"({"type": "Kinds@2", "params": {"flag": true, "count": 10, "length": 0.5, "direction": [0, -1, 1],
                 "text": "x", "mode": "exact"}})");
}

TEST(GraphCheck, AListKeepsItsItemsAsJsonAndSaysWhatIsWrongWithThem) {
  ParamInfo info;
  info.name = "items";
  info.kind = ParamKind::List;
  info.fallback = std::string("[]");
  info.accepts = [](const std::string& json) -> Result<void> {
    return json.find("bad") == std::string::npos ? Result<void>{} : failure("item 1 is bad", "make it good");
  };
  const auto read = [&](const std::string& typed) {
    return readParam(info, parseTyped(typed, std::make_shared<const Source>()), "/");
  };
  EXPECT_EQ(std::get<std::string>(*read(R"([{"a":1.50,"b":["x"]}, 2,])")),
            R"([{ "a": 1.5, "b": ["x"] }, 2])");
  EXPECT_EQ(read("[\"bad\"]").error().text(), "item 1 is bad; make it good");
  EXPECT_EQ(read("{}").error().text(), "this is an object; it would have to be a list");
  EXPECT_EQ(read("null").error().text(), "this is null; leave the parameter out for its default");
  EXPECT_EQ(wireType(ParamKind::List), "");
}

TEST(GraphCheck, ParametersMayBeWired) {
  const Registry registry = madeUpNodes();
  const Graph graph = graphOf(
      R"("c": {"type": "Constant@1"}, "n": {"type": "Kinds@2", "in": {"length": "c", "count": "c.whole"}},
      "m": {"type": "Kinds@2", "in": {"length": "c.whole"}})",
      registry);
  EXPECT_EQ(graph.nodes[1].wiredParams.size(), 2u);
  expectError(R"({"type": "Kinds@2", "in": {"count": ^"c"}})",
              "n.count: \"c.value\" is of type Number; it would have to be Integer, as \"c.whole\" is");
  expectError(R"({"type": "Kinds@2", "in": {"direction": ^"c"}})",
              "n.direction: a parameter of three numbers can't be wired; set it in \"params\"");
  expectError(R"({"type": "Kinds@2", "in": {"count": "c.whole"}, "params": {^"count": 3}})",
              "n.count: the parameter is both set and wired; keep one of the two");
  expectGood(R"({"type": "ReadText@1", "in": {"file": "s"}})");
}

TEST(GraphCheck, NamesTheLoop) {
  const auto errors = check(R"({"format": 1, "nodes": {
"a": {"type": "Add@1", "in": {"a": "b"}},
"b": {"type": "Add@1", "in": {"a": "c"}},
"c": {"type": "Add@1", "in": {"a": "a"}},
"d": {"type": "Add@1", "in": {"a": "a"}},
"e": {"type": "Add@1", "in": {"a": "e"}}}})",
                            madeUpNodes())
                          .errors;
  ASSERT_EQ(errors.size(), 2u) << joined(errors);
  EXPECT_EQ(errors[0], "test.json:4:36: c.a: the wires form a loop: c → b → a → c; unplug one of them");
  EXPECT_EQ(errors[1], "test.json:6:36: e.a: the wires form a loop: e → e; unplug one of them");
}

TEST(GraphCheck, TellsOfTheFileAsAWhole) {
  auto errorsIn = [](const std::string& text) { return check(text, madeUpNodes()).errors; };
  const std::string nodes = R"("nodes": {"c": {"type": "Constant@1"}})";
  EXPECT_EQ(errorsIn("{" + nodes + "}"),
            std::vector<std::string>{"test.json:1:1: the key \"format\" is missing; add \"format\": 1"});
  EXPECT_EQ(errorsIn("{\"format\": 2, " + nodes + "}"),
            std::vector<std::string>{
                "test.json:1:12: format: the format 2 is unknown; this program reads format 1"});
  EXPECT_EQ(
      errorsIn("{\"format\": \"1\", " + nodes + "}"),
      std::vector<std::string>{"test.json:1:12: format: this is the string \"1\"; write \"format\": 1"});
  EXPECT_EQ(errorsIn("{\"format\": 1}"),
            std::vector<std::string>{"test.json:1:1: the key \"nodes\" is missing; a graph has nodes"});
  EXPECT_EQ(errorsIn("{\"format\": 1, \"nodes\": {}}"),
            std::vector<std::string>{"test.json:1:24: nodes: there are none; a graph has nodes"});
  EXPECT_EQ(errorsIn("[]"),
            std::vector<std::string>{"test.json:1:1: this is a list; it would have to be an object"});
  EXPECT_EQ(errorsIn("{\"format\": 1, \"nods\": {}, " + nodes + "}"),
            std::vector<std::string>{"test.json:1:15: unknown key \"nods\"; did you mean \"nodes\"?"});
  EXPECT_EQ(errorsIn("{\"format\": 1, \"fps\": 0, " + nodes + "}"),
            std::vector<std::string>{"test.json:1:22: fps: this is 0; it would have to be a number above 0"});
  EXPECT_EQ(errorsIn("{\"format\": 1, \"frames\": [3], " + nodes + "}"),
            std::vector<std::string>{"test.json:1:25: frames: this is a list; it would have to be a string"});
  EXPECT_EQ(errorsIn("{\"format\": 1, \"targets\": {\"t\": [\"d\"]}, " + nodes + "}"),
            std::vector<std::string>{
                "test.json:1:33: targets.t: there is no node \"d\"; the known nodes are \"c\""});
  EXPECT_EQ(errorsIn("{\"format\": 1, \"vars\": {\"frame\": 1}, " + nodes + "}"),
            std::vector<std::string>{
                "test.json:1:24: vars.frame: this variable is set by the program; choose another name"});
  EXPECT_EQ(errorsIn("{\"format\": 1, \"vars\": {\"a.b\": 1}, " + nodes + "}").size(), 1u);
  EXPECT_EQ(errorsIn("{\"format\": 1, \"vars\": {\"a\": null}, " + nodes + "}").size(), 1u);
  EXPECT_EQ(errorsIn("{\"format\": 1, \"nodes\": {\"a.b\": {\"type\": \"Constant@1\"}}}").size(), 1u);
  EXPECT_TRUE(
      errorsIn(
          "{\"format\": 1, \"fps\": 25, \"frames\": \"1-5\", \"vars\": {\"a\": 1}, \"wedge\": {\"a\": [1]}, "
          "\"targets\": {\"t\": \"c\", \"u\": []}, " +
          nodes + "}")
          .empty());
}

TEST(GraphCheck, TellsAllErrorsAtOnceInTheOrderOfTheFile) {
  const auto errors = check(R"({"format": 1, "nodes": {
    "a": {"type": "Add@1", "in": {"a": "x"}, "params": {"offset": 1e9, "ofset": 1}},
    "b": {"type": "Ad@1"},
    "c": {"type": "Add@1"}}})",
                            madeUpNodes())
                          .errors;
  ASSERT_EQ(errors.size(), 5u) << joined(errors);
  EXPECT_TRUE(std::is_sorted(errors.begin(), errors.end()));
}

TEST(GraphCheck, AWrongVersionHidesNoOtherError) {
  for (const char* type : {"Kinds", "Kinds@1", "Kinds@3", "Kinds@x"}) {
    const auto errors = errorsOf("{\"type\": \"" + std::string(type) +
                                 "\", \"in\": {\"cuont\": \"c\"}, \"params\": {\"length\": 0}}");
    ASSERT_EQ(errors.size(), 3u) << type << '\n' << joined(errors);
    EXPECT_NE(errors[0].find("n: \"Kinds"), std::string::npos) << errors[0];
    EXPECT_NE(errors[1].find("n.cuont: Kinds has no input \"cuont\""), std::string::npos) << errors[1];
    EXPECT_NE(errors[2].find("n.length: 0 is out of range"), std::string::npos) << errors[2];
  }
}

TEST(GraphCheck, WhatIsWrittenInTheWrongFormIsNotAlsoMissing) {
  expectError(R"({"type": "Add@1", "in": ^["c"]})", "n.in: this is a list; it would have to be an object");
  expectError(R"({"type": "ReadText@1", "params": ^["x"]})",
              "n.params: this is a list; it would have to be an object");
  expectError(R"({"type": "ReadText@1", "in": ^"s"})",
              "n.in: this is a string; it would have to be an object");
}

TEST(GraphCheck, CommandLineOverridesAndIsNamedInItsErrors) {
  const std::string kinds = R"({"type": "Kinds@2", "params": {"count": 99}})";
  EXPECT_TRUE(errorsOf(kinds, {"n.count=5"}).empty());
  EXPECT_TRUE(errorsOf(R"({"type": "Kinds@2", "in": {"length": "c"}})", {"n.length=5", "n.text=12"}).empty());
  EXPECT_EQ(
      errorsOf(kinds, {"n.count=50"}),
      std::vector<std::string>{
          "--set n.count=50: n.count: 50 is out of range; it would have to be at least 1 and at most 10"});
  EXPECT_EQ(errorsOf(kinds, {"n.count=5", "n.cont=5"}),
            std::vector<std::string>{
                "--set n.cont=5: n.cont: Kinds has no parameter \"cont\"; did you mean \"count\"?"});
  EXPECT_EQ(errorsOf(kinds, {"n.count=5", "m.count=5"}),
            std::vector<std::string>{
                "--set m.count=5: the graph has no node \"m\"; the known nodes are \"c\", \"s\", \"n\""});
  EXPECT_EQ(
      errorsOf(kinds, {"n.count=5", "count=5"}),
      std::vector<std::string>{"--set count=5: \"count\" is no parameter; write --set node.param=value"});
  EXPECT_EQ(parseAssignment("--set", "n.count", environment()).error().text(),
            "--set n.count sets nothing; write --set node.param=value");
  EXPECT_EQ(parseAssignment("--var", "=1", environment()).error().text(),
            "--var =1 sets nothing; write --var name=value");
  const Checked checked =
      check(R"({"format": 1, "nodes": {"n": {"type": "Word@1"}}})", madeUpNodes(), {"n.text=12"});
  EXPECT_EQ(std::get<std::string>(checked.graph.nodes[0].params.at("text")), "12");
}

TEST(GraphCheck, ChoosesWhatIsWanted) {
  const Registry registry = madeUpNodes();
  const std::string nodes =
      R"("nodes": {"a": {"type": "Constant@1"}, "b": {"type": "Add@1", "in": {"a": "a"}},
      "s": {"type": "Sink@1", "in": {"value": "a"}, "params": {"directory": "out"}}})";
  const Graph plain = check("{\"format\": 1, " + nodes + "}", registry).graph;
  EXPECT_EQ(*wantedNodes(plain, "", ""), std::vector<int>{2});
  EXPECT_EQ(*wantedNodes(plain, "", "b"), std::vector<int>{1});
  EXPECT_EQ(neededNodes(plain, {1}), (std::vector<int>{0, 1}));
  EXPECT_EQ(wantedNodes(plain, "", "bb").error().text(), "the graph has no node \"bb\"; did you mean \"b\"?");
  EXPECT_EQ(wantedNodes(plain, "t", "").error().text(),
            "the graph has no target \"t\"; there are no targets");
  const Graph targets =
      check("{\"format\": 1, \"targets\": {\"t\": [\"b\"], \"u\": \"a\"}, " + nodes + "}", registry).graph;
  EXPECT_EQ(*wantedNodes(targets, "", ""), (std::vector<int>{0, 1}));
  EXPECT_EQ(*wantedNodes(targets, "t", ""), std::vector<int>{1});
  const Graph noSink =
      graphOf(R"("a": {"type": "Constant@1"}, "b": {"type": "Add@1", "in": {"a": "a"}})", registry);
  EXPECT_EQ(*wantedNodes(noSink, "", ""), std::vector<int>{1});
}

TEST(GraphCheck, LooksForFiles) {
  const TemporaryDirectory directory;
  directory.write("model.obj", "v 0 0 0");
  const Registry registry = madeUpNodes();
  auto errorsWith = [&](const std::string& nodes) {
    Diagnostics diagnostics;
    const Graph graph = graphOf(nodes, registry, directory.path());
    std::vector<int> all(graph.nodes.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    checkFiles(graph, all, {}, diagnostics);
    std::vector<std::string> errors;
    for (const Diagnostic& d : diagnostics.sorted()) errors.push_back(d.text());
    return errors;
  };
  const std::string at = "\"" + directory.path().string();
  EXPECT_TRUE(errorsWith(R"("r": {"type": "ReadText@1", "params": {"file": "./model.obj"}})").empty());
  EXPECT_EQ(errorsWith(R"("r": {"type": "ReadText@1", "params": {"file": "modle.obj"}})"),
            std::vector<std::string>{"test.json:1:72: r.file: there is no file " + at +
                                     "/modle.obj\"; did you mean \"model.obj\"?"});
  EXPECT_EQ(errorsWith(R"("r": {"type": "ReadText@1", "params": {"file": "x/model.obj"}})"),
            std::vector<std::string>{"test.json:1:72: r.file: there is no file " + at +
                                     "/x/model.obj\"; correct the path: there is no directory " + at +
                                     "/x\" either"});
  EXPECT_EQ(errorsWith(R"("r": {"type": "ReadText@1", "params": {"file": "."}})"),
            std::vector<std::string>{"test.json:1:72: r.file: " + at + "\" is a directory; name a file"});
  const std::string constant = R"("c": {"type": "Constant@1"},)";
  EXPECT_TRUE(
      errorsWith(constant +
                 R"("s": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "new/deep/"}})")
          .empty());
  const auto blocked = errorsWith(
      constant +
      R"("s": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "model.obj/out"}})");
  ASSERT_EQ(blocked.size(), 1u);
  EXPECT_NE(blocked[0].find("s.directory: " + at + "/model.obj\" is there and is no directory; choose"),
            std::string::npos);
  const auto shared =
      errorsWith(constant + R"("s": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "o"}},
     "t": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "./o/"}})");
  ASSERT_EQ(shared.size(), 1u);
  EXPECT_NE(shared[0].find("t.directory: s.directory writes to the same path; give each a path of its own"),
            std::string::npos);
}

TEST(GraphCheck, TellsOfOutputsWithoutPermission) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const Registry registry = madeUpNodes();
  Diagnostics diagnostics;
  const Graph graph = graphOf(
      R"("c": {"type": "Constant@1"}, "s": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "/usr/out"}})",
      registry);
  checkFiles(graph, {0, 1}, {"/"}, diagnostics);
  EXPECT_EQ(diagnostics.count(), 1u);
}

TEST(GraphCheck, LargeGraphsWithManyErrorsStayFast) {
  std::string nodes;
  for (int i = 0; i < 5000; ++i)
    nodes +=
        (i > 0 ? "," : "") + ("\"n" + std::to_string(i)) + R"(": {"type": "Add@1", "in": {"a": "missing"}})";
  Diagnostics diagnostics;
  const GraphFile file = readGraph("{\"format\": 1, \"nodes\": {" + nodes + "}}",
                                   std::make_shared<const Source>(Source{"f", "/"}), diagnostics);
  checkGraph(file, madeUpNodes(), {}, environment(), diagnostics);
  EXPECT_EQ(diagnostics.count(), 5000u);
  EXPECT_EQ(diagnostics.sorted().size(), Diagnostics::kMostKept);
}

TEST(GraphCheck, SurvivesAnyGraph) {
  const Registry registry = madeUpNodes();
  const std::string good =
      R"({"format": 1, "fps": 24, "vars": {"v": 1, "w": "${v}x"}, "targets": {"t": ["y"]}, "nodes": {
      "c": {"type": "Constant@1", "params": {"value": "${v}"}}, "y": {"type": "Add@1", "in": {"a": "c", "b": "c.value"},
      "params": {"offset": 2}}, "k": {"type": "Kinds@2", "in": {"length": "y"}, "params": {"text": "${w}", "mode": "exact"}}}})";
  ASSERT_TRUE(check(good, registry).errors.empty());
  const std::vector<std::string> pieces{"\"c\"",     "\"y\"", "\"${w}\"", "\"${\"",     "{}",   "[]",
                                        "null",      "1e308", "-1",       "\"k.text\"", "true", "\"\"",
                                        "\"Add@1\"", "\"@\"", "\".\"",    "\"in\""};
  Rng rng(5);
  for (int round = 0; round < 5000; ++round) {
    std::string text = good;
    for (std::uint64_t edits = 1 + rng.below(3); edits > 0; --edits) {
      // Exchanges one string for a piece, which mostly leaves the syntax whole.
      const std::size_t begin = text.find('"', rng.below(text.size()));
      const std::size_t end = begin == std::string::npos ? begin : text.find('"', begin + 1);
      if (end != std::string::npos) text.replace(begin, end - begin + 1, pieces[rng.below(pieces.size())]);
    }
    const Checked checked = check(text, registry);
    if (!checked.errors.empty()) continue;
    Cache cache;
    CancelToken token;
    const auto wanted = wantedNodes(checked.graph, "", "");
    ASSERT_TRUE(wanted.ok());
    evaluate(checked.graph, *wanted, cache, token);
  }
}

TEST(Registry, RefusesBrokenTables) {
  struct None {};
  auto run = [](const None&, NodeIo&) -> Result<void> { return {}; };
  Registry registry;
  EXPECT_TRUE(
      registry.add(NodeBuilder<None>("A", 1, "").input<double>("x", "").output<double>("x", "").run(run))
          .ok());
  EXPECT_FALSE(registry.add(NodeBuilder<None>("A", 1, "").run(run)).ok());
  EXPECT_FALSE(registry.add(NodeBuilder<None>("B", 0, "").run(run)).ok());
  EXPECT_FALSE(registry.add(NodeBuilder<None>("B@", 1, "").run(run)).ok());
  EXPECT_FALSE(
      registry.add(NodeBuilder<None>("B", 1, "").input<double>("x", "").input<double>("x", "").run(run))
          .ok());
  EXPECT_FALSE(registry.add(NodeType{}).ok());
  EXPECT_TRUE(registry.add(NodeBuilder<None>("A", 2, "").run(run)).ok());
  EXPECT_EQ(registry.find("A")->version, 2);
  EXPECT_EQ(registry.find("B"), nullptr);
  EXPECT_EQ(registry.all().size(), 1u);
}

}  // namespace
}  // namespace sherd::test
