// Every message about subgraphs, at its place and once.
#include <cmath>
#include <limits>

#include "runtime/subgraph_graphs.h"

namespace sherd::test {
namespace {

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

}  // namespace
}  // namespace sherd::test
