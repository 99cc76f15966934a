// ${…}: kinds, nesting, loops, and what relative paths are relative to.
#include <gtest/gtest.h>

#include "runtime/made_up.h"

namespace sherd::test {
namespace {

/// The value of parameter `param` of a Kinds node, or the first error.
std::string valueOf(const std::string& vars, const std::string& param, const std::string& value,
                    const std::vector<std::string>& options = {}) {
  const Checked checked = check("{\"format\": 1, \"vars\": {" + vars +
                                    "}, \"nodes\": {\"n\": {\"type\": \"Kinds@2\", \"params\": {\"" + param +
                                    "\": " + value + "}}}}",
                                madeUpNodes(), {}, options);
  if (!checked.errors.empty()) return checked.errors[0].substr(checked.errors[0].find(": ") + 2);
  struct Text {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return "i" + std::to_string(v); }
    std::string operator()(double v) const { return "d" + numberText(v); }
    std::string operator()(const std::string& v) const { return v; }
    std::string operator()(const std::vector<double>& v) const {
      return numberText(v[0]) + "," + numberText(v[1]) + "," + numberText(v[2]);
    }
  };
  return std::visit(Text{}, checked.graph.nodes[0].params.at(param));
}

TEST(Variables, KeepTheirKindWhereTheyStandAlone) {
  EXPECT_EQ(valueOf(R"("x": 3)", "count", R"("${x}")"), "i3");
  EXPECT_EQ(valueOf(R"("x": true)", "flag", R"("${x}")"), "true");
  EXPECT_EQ(valueOf(R"("x": [1, 0, -1])", "direction", R"("${x}")"), "1,0,-1");
  EXPECT_EQ(valueOf(R"("x": 0.5)", "direction", R"([0, "${x}", 1])"), "0,0.5,1");
  EXPECT_EQ(valueOf(R"("x": 3)", "text", R"("${x}")"), "n.text: this is 3; it would have to be a string");
}

TEST(Variables, BecomeTextInsideOfText) {
  EXPECT_EQ(valueOf(R"("x": 3, "y": 0.1, "z": "w")", "text", R"("a${x}b${y}c${z}")"), "a3b0.1cw");
  EXPECT_EQ(valueOf("", "text", R"("$5 and $${x}")"), "$5 and ${x}");
  EXPECT_EQ(valueOf(R"("x": [1])", "text", R"("a${x}")"),
            "n.text: the variable \"x\" is a list and can't be part of a text; it would have to stand alone: "
            "\"${x}\"");
  EXPECT_EQ(valueOf("", "text", R"("a${x")"), "n.text: a \"${\" is not closed; it would have to end in }");
}

TEST(Variables, MayUseOthers) {
  EXPECT_EQ(valueOf(R"("a": "${b}/x", "b": "${c}", "c": "y")", "text", R"("${a}")"), "y/x");
  EXPECT_EQ(valueOf(R"("a": "${b}", "b": "${a}")", "text", R"("t")"),
            "vars.a: the variable needs itself: a → b → a; give one of them a value of its own");
  EXPECT_EQ(valueOf(R"("a": "x${a}")", "text", R"("t")"),
            "vars.a: the variable needs itself: a → a; give one of them a value of its own");
}

TEST(Variables, GrowNeitherDeepNorLong) {
  std::string chain, bomb;
  for (int i = 0; i < 20000; ++i)
    chain += "\"v" + std::to_string(i) + "\": \"${v" + std::to_string(i + 1) + "}\", ";
  chain += "\"v20000\": \"end\"";
  EXPECT_NE(valueOf(chain, "text", "\"t\"").find("nested more than 64 deep"), std::string::npos);
  for (int i = 0; i < 40; ++i)
    bomb += "\"b" + std::to_string(i) + "\": \"${b" + std::to_string(i + 1) + "}${b" + std::to_string(i + 1) +
            "}\", ";
  bomb += "\"b40\": \"xxxxxxxx\"";
  EXPECT_NE(valueOf(bomb, "text", "\"t\"").find("longer than 65536 bytes"), std::string::npos);
}

TEST(Variables, ComeFromOutsideToo) {
  EXPECT_EQ(valueOf("", "text", R"("${SET_OUTSIDE}")"), "outside");
  EXPECT_EQ(valueOf("", "count", R"("${SET_TO_SEVEN}")"), "i7");
  EXPECT_EQ(valueOf("", "text", R"("${ASSETS}/vase.obj")"), "/assets/vase.obj");
  EXPECT_EQ(valueOf(R"("mesh": 1)", "text", R"("${mehs}")"),
            "n.text: there is no variable \"mehs\"; did you mean \"mesh\"?");
  EXPECT_EQ(valueOf("", "text", R"("${frame:04}")"),
            "n.text: \"${frame:04}\" stands in a graph without frames; add \"frames\": \"1001-1040\" to the "
            "graph, or say --frames 1001");
  EXPECT_EQ(valueOf(R"("x": 1)", "text", R"("${x:04}")"),
            "n.text: \"${x:04}\" has a format; only ${frame} takes one");
}

TEST(Variables, AreOverriddenFromTheCommandLine) {
  EXPECT_EQ(valueOf(R"("x": 3)", "count", R"("${x}")", {"x=5"}), "i5");
  EXPECT_EQ(valueOf(R"("x": "a")", "text", R"("${x}")", {"x=5"}), "5");
  EXPECT_EQ(valueOf(R"("x": "a")", "text", R"("${x}-${x}")", {"x=05.0"}), "05.0-05.0");
  EXPECT_EQ(
      valueOf(R"("x": 3)", "count", R"("${x}")", {"x=many"}),
      "n.count: this is the string \"many\"; it would have to be an integer, at least 1 and at most 10");
  const Checked checked = check(R"({"format": 1, "vars": {"seed": 1}, "nodes": {"n": {"type": "Kinds@2"}}})",
                                madeUpNodes(), {}, {"sed=2"});
  EXPECT_EQ(checked.errors, std::vector<std::string>{
                                "--var sed=2: the graph has no variable \"sed\"; did you mean \"seed\"?"});
}

/// The absolute path that a ReadText node gets.
std::string pathOf(const std::string& vars, const std::string& value,
                   const std::vector<std::string>& sets = {}, const std::vector<std::string>& options = {}) {
  const Checked checked = check(
      "{\"format\": 1, \"vars\": {" + vars +
          "}, \"nodes\": {\"n\": {\"type\": \"ReadText@1\", \"params\": {\"file\": \"" + value + "\"}}}}",
      madeUpNodes(), sets, options);
  if (!checked.errors.empty()) return checked.errors[0];
  return std::get<std::string>(checked.graph.nodes[0].params.at("file"));
}

TEST(Variables, PathsAreRelativeToWhatNamesThem) {
  EXPECT_EQ(pathOf("", "a/b.obj"), "/graphs/a/b.obj");
  EXPECT_EQ(pathOf("", "/x/../b.obj"), "/b.obj");
  EXPECT_EQ(pathOf(R"("m": "../b.obj")", "${m}"), "/b.obj");
  EXPECT_EQ(pathOf(R"("m": "b.obj")", "${m}", {}, {"m=c.obj"}), "/current/c.obj");
  EXPECT_EQ(pathOf(R"("out": "o")", "${out}/p.png", {}, {"out=here"}), "/current/here/p.png");
  EXPECT_EQ(pathOf(R"("out": "o")", "x/${out}", {}, {"out=here"}), "/graphs/x/here");
  EXPECT_EQ(pathOf(R"("a": "${b}/x", "b": "y")", "${a}", {}, {"b=here"}), "/current/here/x");
  EXPECT_EQ(pathOf("", "b.obj", {"n.file=c.obj"}), "/current/c.obj");
  EXPECT_EQ(pathOf("", "${ASSETS}/vase.obj"), "/assets/vase.obj");
  EXPECT_EQ(pathOf(R"("m": "b.obj")", "${m}", {}, {"m=7"}), "/current/7");
}

}  // namespace
}  // namespace sherd::test
