// Subgraphs: what they expand to, and every message about them, at its place and once.
#include "graph/subgraphs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/rng.h"
#include "cli/verbs.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

using Lines = std::vector<std::string>;

/// "Raise": adds `by` (1) to the input "x", and the input "extra" if that is wired.
const std::string kRaise = R"("Raise": {
  "help": "Adds.", "vars": {"by": 1},
  "inputs": {"x": "Number", "extra": {"type": "Number", "optional": true, "help": "more"}},
  "outputs": {"y": "add.sum", "same": {"from": "add", "type": "Number", "help": "the same"}},
  "nodes": {"add": {"type": "Add@1", "in": {"a": "in.x", "b": "in.extra"}, "params": {"offset": "${by}"}}}})";

std::string graphWith(const std::string& subgraphs, const std::string& content,
                      const std::string& more = "") {
  return "{\"format\": 1, " + more + "\"subgraphs\": {" + subgraphs + "},\n\"nodes\": {" + content + "}}";
}

/// Outlives the graphs, which point to its types.
const Registry& nodes() {
  static const Registry registry = madeUpNodes();
  return registry;
}

/// The graph of a file without errors.
Graph good(const std::string& text, const fs::path& directory = "/graphs", const Lines& sets = {},
           const Lines& vars = {}) {
  Checked checked = check(text, nodes(), sets, vars, directory);
  for (const std::string& error : checked.errors) ADD_FAILURE() << error;
  return std::move(checked.graph);
}

Lines errorsOf(const std::string& text, const fs::path& directory = "/graphs", const Lines& sets = {}) {
  return check(text, nodes(), sets, {}, directory).errors;
}

/// Errors of one definition "S" and one use of it, "s", in which "c" is a Constant.
Lines errorsIn(const std::string& definition, const std::string& use = R"({"type": "S"})") {
  return errorsOf("{\"format\": 1, \"subgraphs\": {\n\"S\": " + definition +
                  "},\n\"nodes\": {\"c\": {\"type\": \"Constant@1\"},\n\"s\": " + use + "}}");
}

double valueOf(const Graph& graph, const std::string& node, const std::string& port = "sum") {
  Cache cache;
  CancelToken token;
  const auto wanted = wantedNodes(graph, "", node);
  if (!wanted.ok()) ADD_FAILURE() << wanted.error().text();
  return numberAt(graph, evaluate(graph, *wanted, cache, token), node, port);
}

Lines namesIn(const Graph& graph) {
  Lines names;
  for (const Graph::Node& node : graph.nodes) names.push_back(node.name);
  return names;
}

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

// --- Files

TEST(SubgraphFiles, RelativePathsStartWhereTheyAreWritten) {
  const TemporaryDirectory directory;
  fs::create_directories(directory.path() / "recipes/deep");
  directory.write("recipes/read.json", R"({"format": 1, "vars": {"file": "own.txt"}, "outputs": {"text": "r"},
      "subgraphs": {"Inner": "deep/inner.json"},
      "nodes": {"r": {"type": "ReadText@1", "params": {"file": "${file}"}}, "i": {"type": "Inner"}}})");
  directory.write("recipes/deep/inner.json", R"({"format": 1, "outputs": {"t": "w"}, "nodes": {
      "w": {"type": "ReadText@1", "params": {"file": "deep.txt"}}}})");
  const Graph graph = good(graphWith(R"("Read": "recipes/read.json")", R"("a": {"type": "Read"},
      "b": {"type": "Read", "params": {"file": "mine.txt"}})"),
                           directory.path());
  auto fileOf = [&](const std::string& node) {
    return std::get<std::string>(graph.nodes[static_cast<std::size_t>(graph.find(node))].params.at("file"));
  };
  EXPECT_EQ(fileOf("a/r"), (directory.path() / "recipes/own.txt").string());
  EXPECT_EQ(fileOf("b/r"), (directory.path() / "mine.txt").string());
  EXPECT_EQ(fileOf("a/i/w"), (directory.path() / "recipes/deep/deep.txt").string());
}

TEST(SubgraphFiles, MissingOrWrongOnesAreTold) {
  const TemporaryDirectory directory;
  directory.write("graph.json", R"({"format": 1, "nodes": {"c": {"type": "Constant@1"}}})");
  directory.write("broken.json", "{\"format\": 1,\n \"outputs\": }");
  directory.write("form.json",
                  R"({"format": 1, "inputs": {}, "targets": {}, "nodes": {"in": {"type": "Word@1"}}})");
  const std::string at = directory.path().string();
  EXPECT_EQ(
      errorsOf("{\"format\": 1, \"subgraphs\": {\n\"A\": \"no.json\",\n\"B\": \"graph.json\",\n\"C\": "
               "\"broken.json\",\n\"D\": \"form.json\",\n\"E\": \".\",\n\"F\": \"\",\n\"G\": "
               "\"${x}.json\",\n\"H\": 3,\n"
               "\"I\": \"broken.json\"},\n\"nodes\": {\"a\": {\"type\": \"A\"}, \"c\": {\"type\": \"C\"}}}",
               directory.path()),
      (Lines{
          "test.json:2:6: subgraphs.A: there is no file \"" + at +
              "/no.json\"; correct the path, which is relative to this file",
          "test.json:3:6: subgraphs.B: \"" + at +
              "/graph.json\" is no subgraph: it declares no \"inputs\" and no \"outputs\"; name a file "
              "with a subgraph",
          "test.json:6:6: subgraphs.E: \"" + at + "/\": this is a directory; name a file with a subgraph",
          "test.json:7:6: subgraphs.F: the name of the file is empty; name a file with a subgraph",
          "test.json:8:6: subgraphs.G: a subgraph's file can't be named by variables; write its path, "
          "relative to this file",
          "test.json:9:6: subgraphs.H: this is an integer; it would have to be a subgraph, or the name of "
          "a file that holds one",
          "broken.json:2:13: outputs: a value is missing; a string, number, list or object would have to "
          "stand here",
          "form.json:1:29: unknown key \"targets\"; the known keys of a subgraph are \"help\", \"vars\", "
          "\"inputs\", \"outputs\", \"nodes\", \"subgraphs\", \"format\"",
          "form.json:1:54: in: \"in\" stands for the subgraph's inputs; choose another name for the node",
      }));
}

TEST(SubgraphFiles, ErrorsInsideShowTheFileAndThePath) {
  const TemporaryDirectory directory;
  fs::create_directories(directory.path() / "r");
  directory.write("r/s.json",
                  "{\"format\": 1, \"outputs\": {\"y\": \"a\"}, \"nodes\": {\n"
                  "\"a\": {\"type\": \"Constant@1\", \"params\": {\"value\": 2000}}}}");
  EXPECT_EQ(
      errorsOf(graphWith(R"("S": "r/s.json")", R"("one": {"type": "S"}, "two": {"type": "S"})"),
               directory.path()),
      (Lines{"r/s.json:2:49: one/a.value: 2000 is out of range; it would have to be at least -1000 and at "
             "most 1000"}));
}

TEST(SubgraphFiles, ThatNameThemselvesAreLoopsOnlyWhereTheyAreUsed) {
  const TemporaryDirectory directory;
  const std::string table =
      R"({"format": 1, "outputs": {"y": "a"}, "subgraphs": {"Me": "me.json"}, "nodes": {)";
  directory.write("me.json", table + R"("a": {"type": "Constant@1"}}})");
  const std::string text = graphWith(R"("S": "me.json")", R"("s": {"type": "S"})");
  EXPECT_EQ(errorsOf(text, directory.path()), Lines{});
  directory.write("me.json", table + "\n\"a\": {\"type\": \"Me\"}}}");
  EXPECT_EQ(errorsOf(text, directory.path()),
            (Lines{"me.json:2:15: s/a: the subgraph contains itself: S → Me; take it out of itself"}));
}

TEST(SubgraphFiles, CannotRunByThemselvesButBeChecked) {
  const TemporaryDirectory directory;
  const std::string start =
      R"({"format": 1, "vars": {"by": 1}, "inputs": {"x": "Number"}, "outputs": {"y": "a"}, "nodes": {)";
  const std::string path = directory.write(
      "s.json", start + R"("a": {"type": "Add@1", "in": {"a": "in.x"}, "params": {"offset": "${by}"}}}})");
  const Registry& registry = nodes();
  std::ostringstream out, err;
  CancelToken cancel;
  Console console{out, err, cancel, false, 80};
  ShotOptions options;
  options.graphs = {path};
  EXPECT_EQ(checkVerb(options, registry, environment(directory.path()), console), kOk) << err.str();
  EXPECT_EQ(out.str(), path + ": a subgraph of 1 node, no errors\n");
  RunOptions run;
  run.graphs = {path};
  run.noCache = true;
  EXPECT_EQ(runVerb(run, registry, environment(directory.path()), console), kWrongInput);
  EXPECT_NE(err.str().find(path +
                           ": this is a subgraph, which can't be run by itself; name it in a graph, as in "
                           "\"subgraphs\": { \"Name\": \"" +
                           path + "\" }, and use it with \"type\": \"Name\""),
            std::string::npos)
      << err.str();
  err.str("");
  directory.write("s.json",
                  start + "\n\"a\": {\"type\": \"Add@1\", \"in\": {\"a\": \"in.z\", \"c\": \"in.x\"}}}}");
  EXPECT_EQ(checkVerb(options, registry, environment(directory.path()), console), kWrongInput);
  EXPECT_NE(
      err.str().find("s.json:2:36: a.a: the subgraph declares no input \"z\"; the known inputs are \"x\"\n"),
      std::string::npos)
      << err.str();
  EXPECT_NE(err.str().find("s.json:2:49: a.c: Add has no input \"c\""), std::string::npos) << err.str();
}

// --- Messages

struct Case {
  const char* definition;
  const char* use;
  const char* error;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.error; }

class SubgraphMessages : public testing::TestWithParam<Case> {};

TEST_P(SubgraphMessages, AreTheOnlyOnes) {
  EXPECT_EQ(errorsIn(GetParam().definition, GetParam().use),
            Lines{std::string("test.json:") + GetParam().error});
}

constexpr const char* kOut = R"({"outputs": {"y": "a"}, "nodes": {"a": {"type": "Constant@1"}}})";
constexpr const char* kIn =
    R"({"vars": {"by": 1}, "inputs": {"x": "Number"}, "outputs": {"y": "a"}, "nodes": {"a": {"type": "Add@1", "in": {"a": "in.x"}}}})";
constexpr const char* kPlain = R"({"type": "S"})";
constexpr const char* kWired = R"({"type": "S", "in": {"x": "c"}})";

INSTANTIATE_TEST_SUITE_P(
    Form, SubgraphMessages,
    testing::Values(
        Case{R"({"outptus": {}, "nodes": {"a": {"type": "Constant@1"}}})", kPlain,
             "2:7: S: unknown key \"outptus\"; did you mean \"outputs\"?"},
        Case{R"({"outputs": {"y": "a"}, "frames": "1-2", "nodes": {"a": {"type": "Constant@1"}}})", kPlain,
             "2:30: S: unknown key \"frames\"; the known keys of a subgraph are \"help\", \"vars\", "
             "\"inputs\", \"outputs\", \"nodes\", \"subgraphs\""},
        Case{R"({"outputs": {}})", kPlain, "2:6: S: the key \"nodes\" is missing; a subgraph has nodes"},
        Case{R"({"nodes": {}})", kPlain, "2:16: S/nodes: there are none; a subgraph has nodes"},
        Case{R"({"help": 3, "nodes": {"a": {"type": "Constant@1"}}})", kPlain,
             "2:15: S/help: this is an integer; it would have to be a string"},
        Case{R"({"nodes": {"in": {"type": "Constant@1"}}})", kPlain,
             "2:17: S/in: \"in\" stands for the subgraph's inputs; choose another name for the node"},
        Case{R"({"nodes": {"a": {"type": "Constant@1"}, "a": {"type": "Word@1"}}})", kPlain,
             "2:46: subgraphs.S.nodes.a: the key \"a\" is there twice; the other one is in line 2; keep one "
             "of them"},
        Case{R"({"inputs": {"x": 3}, "nodes": {"a": {"type": "Constant@1"}}})", kWired,
             "2:23: S/inputs.x: this is an integer; it would have to be an object"},
        Case{R"({"inputs": {"x": {"help": ""}}, "nodes": {"a": {"type": "Constant@1"}}})", kWired,
             "2:23: S/inputs.x: the key \"type\" is missing; say what is wired to it, as \"type\": "
             "\"TetMesh\""},
        Case{R"({"inputs": {"x": ""}, "nodes": {"a": {"type": "Constant@1"}}})", kWired,
             "2:23: S/inputs.x: the type is empty; `sherd nodes TYPE` shows the types of ports"},
        Case{
            R"({"inputs": {"x": {"type": "Number", "optional": 1}}, "nodes": {"a": {"type": "Constant@1"}}})",
            kWired, "2:54: S/inputs.x.optional: this is an integer; it would have to be a boolean"},
        Case{R"({"inputs": {"x": {"type": "Number", "default": 1}}, "nodes": {"a": {"type": "Constant@1"}}})",
             kWired,
             "2:42: S/inputs.x: unknown key \"default\"; the known keys of an input are \"type\", "
             "\"optional\", \"help\""},
        Case{R"({"inputs": {"a.b": "Number"}, "nodes": {"a": {"type": "Constant@1"}}})",
             R"({"type": "S", "in": {"a.b": "c"}})",
             "2:18: S/inputs.a.b: this is no name for an input; a name holds letters, digits, spaces and "
             "signs, but "
             "none of . / @ $ { } : = \" ', and no space at its ends"},
        Case{R"({"outputs": {"y": {"type": "Number"}}, "nodes": {"a": {"type": "Constant@1"}}})", kPlain,
             "2:24: S/outputs.y: the key \"from\" is missing; say where it comes from, as \"from\": "
             "\"node.port\""},
        Case{R"({"outputs": {"y": "a."}, "nodes": {"a": {"type": "Constant@1"}}})", kPlain,
             "2:24: S/outputs.y: \"a.\" is no link; write \"node\" or \"node.port\""},
        Case{R"({"outputs": {"y": 5}, "nodes": {"a": {"type": "Constant@1"}}})", kPlain,
             "2:24: S/outputs.y: this is an integer; it would have to be an object"},
        Case{R"({"vars": {"frame": 5}, "nodes": {"a": {"type": "Constant@1"}}})", kPlain,
             "2:16: S/vars.frame: this variable is set by the program; choose another name"},
        Case{R"({"vars": [], "nodes": {"a": {"type": "Constant@1"}}})", kPlain,
             "2:15: S/vars: this is a list; it would have to be an object"}));

INSTANTIATE_TEST_SUITE_P(
    Use, SubgraphMessages,
    testing::Values(
        Case{kIn, kPlain, "4:1: s.x: the input is not connected; wire an output of type Number to it"},
        Case{kIn, R"({"type": "S", "in": 3})",
             "4:26: s.in: this is an integer; it would have to be an object"},
        Case{kIn, R"({"type": "S", "in": {"x": "c", "z": "c"}})",
             "4:42: s.z: S has no input \"z\"; the known inputs are \"x\""},
        Case{kIn, R"({"type": "S", "in": {"x": "c", "by": "c"}})",
             "4:43: s.by: S has no input \"by\"; it is a parameter: set it in \"params\""},
        Case{kIn, R"({"type": "S", "in": {"x": "d"}})",
             "4:32: s.x: there is no node \"d\"; the known nodes are \"c\", \"s\""},
        Case{kIn, R"({"type": "S", "in": {"x": "c.valeu"}})",
             "4:32: s.x: Constant has no output \"valeu\"; did you mean \"value\"?"},
        Case{
            kIn, R"({"type": "S", "in": {"x": "s/a"}})",
            "4:32: s.x: \"s/a\" is inside of a subgraph; declare an output of the subgraph and link to that"},
        Case{kIn, R"({"type": "S", "in": {"x": "c"}, "params": {"bi": 1}})",
             "4:49: s.bi: S has no parameter \"bi\"; did you mean \"by\"?"},
        Case{kIn, R"({"type": "S", "in": {"x": "c"}, "params": {"x": 1}})",
             "4:49: s.x: S has no parameter \"x\"; it is an input: wire it in \"in\""},
        Case{kIn, R"({"type": "S", "in": {"x": "c"}, "params": {"by": null}})",
             "4:55: s.by: this is null; it would have to be a number, string, boolean or list"},
        Case{kIn, R"({"type": "S", "in": {"x": "c"}, "params": {"by": "${none}"}})",
             "4:55: vars.s/by: there is no variable \"none\"; the known variables are \"ASSETS\", \"frame\", "
             "\"time\""},
        Case{kIn, R"({"type": "S@1", "in": {"x": "c"}})",
             "4:15: s: there is no node type \"S\"; it is a subgraph: write \"S\", without a version"},
        Case{kOut, R"({"type": "Add@1", "in": {"a": "t"}}, "t": {"type": "S", "in": {"x": "c"}})",
             "4:74: t.x: S has no input \"x\"; there are no inputs"},
        Case{kOut, R"({"type": "Add@1", "in": {"a": "t.z"}}, "t": {"type": "S"})",
             "4:36: s.a: S has no output \"z\"; the known outputs are \"y\""},
        Case{R"({"nodes": {"a": {"type": "Constant@1"}}})",
             R"({"type": "Add@1", "in": {"a": "t"}}, "t": {"type": "S"})",
             "4:36: s.a: \"t\" is a S, which has no outputs; wire another node"},
        Case{kIn, R"({"type": "S", "in": {"x": "w"}}, "w": {"type": "Word@1"})",
             "4:32: s.x: \"w.text\" is of type String; the subgraph declares type Number"}));

INSTANTIATE_TEST_SUITE_P(
    Inside, SubgraphMessages,
    testing::Values(
        Case{R"({"nodes": {"a": {"type": "Constant@1"}}, "outputs": {"y": "b"}})", kPlain,
             "2:64: s/outputs.y: there is no node \"b\"; the known nodes are \"a\", \"in\""},
        Case{R"({"nodes": {"a": {"type": "Constant@1"}}, "outputs": {"y": {"from": "a", "type": "String"}}})",
             kPlain, "2:73: s/outputs.y: \"s/a.value\" is of type Number; the subgraph declares type String"},
        Case{R"({"nodes": {"a": {"type": "Constant@1"}}, "outputs": {"y": {"from": "a", "type": "Numbr"}}})",
             kPlain, "2:86: s/outputs.y: there is no type \"Numbr\"; did you mean \"Number\"?"},
        Case{R"({"nodes": {"a": {"type": "Add@1", "in": {"a": "b"}}}})", kPlain,
             "2:52: s/a.a: there is no node \"b\"; the known nodes are \"a\", \"in\""},
        Case{R"({"nodes": {"a": {"type": "Add@1", "in": {"a": "c"}}}})", kPlain,
             "2:52: s/a.a: there is no node \"c\"; the known nodes are \"a\", \"in\""},
        Case{R"({"inputs": {"x": "Number"}, "nodes": {"a": {"type": "Add@1", "in": {"a": "in"}}}})", kWired,
             "2:79: s/a.a: \"in\" names no input of the subgraph; write \"in.x\""},
        Case{R"({"nodes": {"a": {"type": "Add@1", "in": {"a": "in"}}}})", kPlain,
             "2:52: s/a.a: \"in\" names no input of the subgraph; declare one in \"inputs\""},
        Case{R"({"inputs": {"xx": "Number"}, "nodes": {"a": {"type": "Add@1", "in": {"a": "in.x"}}}})",
             R"({"type": "S", "in": {"xx": "c"}})",
             "2:80: s/a.a: the subgraph declares no input \"x\"; did you mean \"xx\"?"},
        Case{
            R"({"nodes": {"a": {"type": "Constant@1", "params": {"value": "${val}"}}}, "vars": {"value": 1}})",
            kPlain, "2:65: s/a.value: the subgraph has no variable \"val\"; did you mean \"value\"?"},
        Case{R"({"nodes": {"a": {"type": "Constat@1"}}})", kPlain,
             "2:31: s/a: there is no node type \"Constat\"; did you mean \"Constant\"?"},
        Case{R"({"nodes": {"a": {"type": "Add@1"}}})", kPlain,
             "2:17: s/a.a: the input is not connected; wire an output of type Number to it"},
        Case{
            R"({"inputs": {"x": {"type": "Number", "optional": true}}, "nodes": {"a": {"type": "Add@1", "in": {"a": "in.x"}}}})",
            kPlain, "2:72: s/a.a: the input is not connected; wire an output of type Number to it"},
        Case{R"({"nodes": {"a": {"type": "S"}}})", kPlain,
             "2:31: s/a: the subgraph contains itself: S → S; take it out of itself"}));

TEST(Subgraphs, ThatNobodyUsesAreChecked) {
  const std::string good = R"("nodes": {"c": {"type": "Constant@1"}}})";
  EXPECT_EQ(
      errorsOf("{\"format\": 1, \"subgraphs\": {\"S\": {\"inputs\": {\"x\": \"Numbr\"}, \"nodes\": {\n"
               "\"a\": {\"type\": \"Add@1\", \"in\": {\"a\": \"in.x\"}, \"params\": {\"ofset\": 1}},\n"
               "\"b\": {\"type\": \"T\"}}}, \"T\": {\"nodes\": {\n\"d\": {\"type\": \"Nope@1\"}, \"e\": "
               "{\"type\": \"S\"}}}},\n" +
               good),
      (Lines{"test.json:1:51: S/inputs.x: there is no type \"Numbr\"; did you mean \"Number\"?",
             "test.json:2:56: S/a.ofset: Add has no parameter \"ofset\"; did you mean \"offset\"?",
             "test.json:4:15: S/b/d: there is no node type \"Nope\"; the known node types are \"Add\", "
             "\"Constant\", \"Kinds\", \"MakeBlob\", \"PassBlob\", \"ReadText\", \"Sink\", \"SumBlob\", "
             "\"Word\"",
             "test.json:4:40: S/b/e: the subgraph contains itself: S → T → S; take it out of itself"}));
  EXPECT_EQ(errorsOf("{\"format\": 1, \"subgraphs\": {" + kRaise + "},\n" + good), Lines{});
}

TEST(Subgraphs, DoNotSeeTheGraphsVariables) {
  EXPECT_EQ(
      errorsOf(graphWith(R"("S": {"vars": {"a": "${gamma}"}, "nodes": {"k": {"type": "Constant@1"}}})",
                         R"("s": {"type": "S"})", R"("vars": {"gamma": 1}, )")),
      (Lines{
          "test.json:1:71: vars.s/a: the subgraph has no variable \"gamma\"; that of the graph is not seen "
          "inside: add \"gamma\" to the subgraph's \"vars\" and pass it with \"params\": { \"gamma\": "
          "\"${gamma}\" }"}));
  const Graph graph = good(graphWith(
      R"("S": {"vars": {"a": 2, "b": "${a}"}, "outputs": {"y": "k"}, "nodes": {
         "k": {"type": "Constant@1", "params": {"value": "${b}"}},
         "e": {"type": "Word@1", "params": {"text": "${SET_OUTSIDE}${ASSETS}"}}}})",
      R"("s": {"type": "S"}, "t": {"type": "S", "params": {"a": "${b}"}})",
      R"("vars": {"a": 50, "b": 60}, )"));
  EXPECT_EQ(valueOf(graph, "s/k", "value"), 2);
  EXPECT_EQ(valueOf(graph, "t/k", "value"), 60);
  EXPECT_EQ(std::get<std::string>(graph.nodes[1].params.at("text")), "outside/assets");
}

TEST(Subgraphs, ErrorsInsideAreTheSameThroughEveryUse) {
  EXPECT_EQ(
      errorsOf(graphWith("\"S\": {\"nodes\": {\n\"k\": {\"type\": \"Add@1\", \"params\": {\"ofset\": 1}}}}",
                         R"("s": {"type": "S"}, "t": {"type": "S"}, "u": {"type": "S"})")),
      (Lines{"test.json:2:1: s/k.a: the input is not connected; wire an output of type Number to it",
             "test.json:2:35: s/k.ofset: Add has no parameter \"ofset\"; did you mean \"offset\"?"}));
}

TEST(Subgraphs, GrowToNoMoreThanTheProgramHolds) {
  std::string tables = R"("S0": {"nodes": {"a": {"type": "Constant@1"}, "b": {"type": "Constant@1"}}})";
  for (int i = 1; i < 40; ++i) {
    const std::string inner = "{\"type\": \"S" + std::to_string(i - 1) + "\"}";
    tables += ",\n\"S" + std::to_string(i) + "\": {\"nodes\": {\"a\": " + inner + ", \"b\": " + inner + "}}";
  }
  const Lines errors = errorsOf(graphWith(tables, R"("s": {"type": "S39"})"));
  ASSERT_FALSE(errors.empty());
  EXPECT_NE(errors[0].find("the subgraphs stand for more than 250,000 nodes; use fewer"), std::string::npos);
  std::string deep = R"("D0": {"nodes": {"a": {"type": "Constant@1"}}})";
  for (int i = 1; i < 2000; ++i)
    deep += ",\n\"D" + std::to_string(i) + "\": {\"nodes\": {\"a\": {\"type\": \"D" + std::to_string(i - 1) +
            "\"}}}";
  const Lines nested = errorsOf(graphWith(deep, R"("d": {"type": "D1999"})"));
  ASSERT_FALSE(nested.empty());
  EXPECT_NE(nested[0].find("subgraphs are nested more than 64 deep; nest them less"), std::string::npos);
}

// --- Names

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

// --- Against a direct evaluation of random nested subgraphs

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
