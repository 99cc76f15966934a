// Older versions of nodes: read as current ones, rewritten in files, and refused where somebody must decide.
#include "graph/migrate.h"

#include <gtest/gtest.h>

#include <fstream>

#include "cli/verbs.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

using Lines = std::vector<std::string>;

struct MeshParams {
  double size = 1;
  std::int64_t count = 3;
  std::string mode = "new";
};
struct NoParams {};

/// Converts millimetres to metres.
std::optional<std::string> toMetres(const std::string& json) {
  char* end = nullptr;
  const double number = std::strtod(json.c_str(), &end);
  return *end == '\0' ? std::optional<std::string>(numberText(number / 1000)) : std::nullopt;
}

/// Mesh@3, once Mesher: 1 → 2 renames "len" to "size" and "solid" to "mesh", 2 → 3 turns "size" from mm to m,
/// drops "quality" and keeps the default of "mode". Later@3 has no way from version 1.
Registry makeRegistry() {
  Registry registry = madeUpNodes();
  auto add = [&](NodeType type) {
    const auto added = registry.add(std::move(type));
    if (!added.ok()) ADD_FAILURE() << added.error().text();
  };
  add(NodeBuilder<MeshParams>("Mesh", 3, "A mesh.")
          .formerly("Mesher")
          .migrate(1,
                   {renameParam("len", "size"), renameOutput("solid", "mesh"), renameInput("from", "base")})
          .migrate(2, {convertParam("size", toMetres), removeParam("quality", "the mesher now chooses it"),
                       keepDefault("mode", "\"old\"")})
          .optionalInput<double>("base", "")
          .number("size", &MeshParams::size, {.unit = "m", .min = 0, .max = 10})
          .integer("count", &MeshParams::count, {.min = 0})
          .text("mode", &MeshParams::mode, "")
          .output<double>("mesh", "")
          .output<double>("area", "")
          .run([](const MeshParams& params, NodeIo& io) -> Result<void> {
            const auto base = io.in<double>("base");
            io.out<double>("mesh", params.size + (base ? *base : 0) + (params.mode == "old" ? 100 : 0));
            io.out<double>("area", 1);
            return {};
          }));
  add(NodeBuilder<NoParams>("Later", 3, "")
          .migrate(2, {})
          .output<double>("x", "")
          .run([](const NoParams&, NodeIo& io) -> Result<void> {
            io.out<double>("x", 1);
            return {};
          }));
  return registry;
}

const Registry& registry() {
  static const Registry known = makeRegistry();
  return known;
}

std::string graphOfNodes(const std::string& content) {
  return "{\"format\": 1, \"nodes\": {\n" + content + "}}";
}

TEST(Migrate, ReadsOldNodesAsCurrentOnes) {
  const Checked checked = check(graphOfNodes(R"("c": {"type": "Constant@1", "params": {"value": 5}},
"m": {"type": "Mesh@1", "in": {"from": "c"}, "params": {"len": 2000, "quality": 3}},
"a": {"type": "Add@1", "in": {"a": "m.solid", "b": "m.area"}})"),
                                registry());
  EXPECT_EQ(checked.errors, Lines{});
  EXPECT_EQ(
      checked.notes,
      (Lines{"test.json:3:15: m: Mesh@1 is read as Mesh@3; \"quality\" is gone: the mesher now chooses it; "
             "`sherd upgrade test.json` rewrites it"}));
  Cache cache;
  CancelToken token;
  EXPECT_EQ(numberAt(checked.graph, evaluate(checked.graph, nodesOf(checked.graph, {"a"}), cache, token), "a",
                     "sum"),
            108);
}

TEST(Migrate, KnowsFormerNamesAndLeavesCurrentNodesAlone) {
  const Checked checked = check(graphOfNodes(R"("x": {"type": "Mesher@3"}, "y": {"type": "Mesh@3"},
"z": {"type": "Mesher@1"})"),
                                registry());
  EXPECT_EQ(checked.errors, Lines{});
  ASSERT_EQ(checked.notes.size(), 2u);
  EXPECT_EQ(checked.notes[0],
            "test.json:2:15: x: Mesher@3 is read as Mesh@3; `sherd upgrade test.json` rewrites it");
  EXPECT_EQ(std::get<std::string>(checked.graph.nodes[0].params.at("mode")), "new");
  EXPECT_EQ(std::get<std::string>(checked.graph.nodes[2].params.at("mode")), "old");
}

TEST(Migrate, WiredParametersMoveWithTheirNames) {
  const std::string c = R"("c": {"type": "Constant@1"}, )";
  EXPECT_EQ(
      check(
          graphOfNodes(
              c + R"("m": {"type": "Mesh@2", "in": {"mode": "w", "quality": "c"}}, "w": {"type": "Word@1"})"),
          registry())
          .errors,
      Lines{});
  EXPECT_EQ(
      check(graphOfNodes(c + R"("m": {"type": "Mesh@1", "in": {"len": "c"}})"), registry()).errors,
      (Lines{
          "test.json:2:68: m.len: what is wired to it has another meaning now; write the value by hand, as "
          "`sherd nodes Mesh` explains it, and the type as \"Mesh@3\""}));
}

TEST(Migrate, SaysWhatCannotBeTold) {
  EXPECT_EQ(
      check(graphOfNodes(R"("m": {"type": "Mesh@1", "params": {"len": "${SET_TO_SEVEN}"}})"), registry())
          .errors,
      (Lines{"test.json:2:43: m.len: what \"${SET_TO_SEVEN}\" is for Mesh@3 can't be told; write the value "
             "by hand, as `sherd nodes Mesh` explains it, and the type as \"Mesh@3\""}));
  EXPECT_EQ(
      check(graphOfNodes(R"("l": {"type": "Later@1"})"), registry()).errors,
      (Lines{
          "test.json:2:15: l: \"Later@1\" is an old interface; write \"Later@3\" and adapt the node to what "
          "`sherd nodes Later` says"}));
  EXPECT_EQ(check(graphOfNodes(R"("l": {"type": "Later@2"})"), registry()).errors, Lines{});
  EXPECT_EQ(
      check(graphOfNodes(R"("l": {"type": "Later@4"})"), registry()).errors,
      (Lines{
          "test.json:2:15: l: \"Later@4\" is newer than this program; write \"Later@3\", or update sherd"}));
}

TEST(Migrate, ReachesIntoSubgraphsAndTellsOnce) {
  const Checked checked = check(
      R"({"format": 1, "subgraphs": {"S": {"outputs": {"y": {"from": "m.solid", "type": "Number"}},
"nodes": {"m": {"type": "Mesh@1"}}}}, "nodes": {"a": {"type": "S"}, "b": {"type": "S"},
"e": {"type": "Add@1", "in": {"a": "a", "b": "b.y"}}}})",
      registry());
  EXPECT_EQ(checked.errors, Lines{});
  EXPECT_EQ(checked.notes,
            (Lines{"test.json:2:25: a/m: Mesh@1 is read as Mesh@3; `sherd upgrade test.json` rewrites it"}));
}

class Upgrade : public testing::Test {
 protected:
  int upgrade(const std::string& text, bool write = true) {
    path = directory.write("old.json", text);
    out.str("");
    err.str("");
    Console console{out, err, cancel, false, 80};
    UpgradeOptions options;
    options.files = {path};
    options.write = write;
    return upgradeVerb(options, registry(), console);
  }
  std::string content() const {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  TemporaryDirectory directory;
  std::string path;
  std::ostringstream out, err;
  CancelToken cancel;
};

TEST_F(Upgrade, RewritesTheNodeAndNothingElse) {
  const std::string before = R"(// keep me
{ "format": 1,
  "subgraphs": { "S": { "outputs": { "y": { "from": "m.solid" } }, "nodes": { "m": { "type": "Mesher@1" } } } },
  "nodes": {
    "m":   { "type": "Mesh@1",   "in": { "from": "c" },  // odd   spacing
             "params": { "len": 2.50e3, /* why */ "count": 7,
                         "quality": 3 } },
    "c":   {"type":"Constant@1"},
    "a":   {"type":"Add@1", "in": {"a":"m.solid","b":"m.area",},},
  }
}
)";
  const std::string after = R"(// keep me
{ "format": 1,
  "subgraphs": { "S": { "outputs": { "y": { "from": "m.mesh" } }, "nodes": { "m": { "type": "Mesh@3", "params": { "mode": "old" } } } } },
  "nodes": {
    "m":   { "type": "Mesh@3",   "in": { "base": "c" },  // odd   spacing
             "params": { "mode": "old", "size": 2.5, /* why */ "count": 7 } },
    "c":   {"type":"Constant@1"},
    "a":   {"type":"Add@1", "in": {"a":"m.mesh","b":"m.area",},},
  }
}
)";
  EXPECT_EQ(upgrade(before, false), kOk) << err.str();
  EXPECT_EQ(content(), before);
  EXPECT_NE(out.str().find("\n-    \"a\":   {\"type\":\"Add@1\", \"in\": {\"a\":\"m.solid\""),
            std::string::npos);
  EXPECT_EQ(upgrade(before), kOk) << err.str();
  EXPECT_EQ(content(), after);
  EXPECT_EQ(check(content(), registry()).errors, Lines{});
  EXPECT_EQ(check(content(), registry()).notes, Lines{});
  EXPECT_EQ(upgrade(content()), kOk);
  EXPECT_EQ(out.str(), path + ": all nodes are current\n");
}

TEST_F(Upgrade, TextAndMemoryAgree) {
  for (const char* params :
       {"", R"(, "params": {})", R"(, "params": {"quality": 1})", R"(, "params": {"len": 4})",
        R"(, "params": {"quality": 1, "len": 3})", R"(, "params": {"count": 2, "quality": 1})",
        "\n, \"params\": {\n\"quality\": 1\n}", R"(, "params": {"mode": "x", "quality": 1,})"}) {
    const std::string text = graphOfNodes(std::string(R"("m": {"type": "Mesh@1")") + params + "}");
    const Checked before = check(text, registry());
    EXPECT_EQ(before.errors, Lines{}) << text;
    EXPECT_EQ(upgrade(text), kOk) << err.str();
    const Checked after = check(content(), registry());
    EXPECT_EQ(after.errors, Lines{}) << content();
    EXPECT_EQ(after.notes, Lines{}) << content();
    EXPECT_EQ(after.graph.nodes[0].params, before.graph.nodes[0].params) << content();
  }
}

TEST_F(Upgrade, LeavesWhatNeedsADecision) {
  const std::string text = graphOfNodes(
      "\"m\": {\"type\": \"Mesh@1\", \"params\": {\"len\": \"${x}\"}},\n\"l\": {\"type\": \"Later@1\"}");
  EXPECT_EQ(upgrade(text), kWrongInput);
  EXPECT_EQ(content(), text);
  EXPECT_NE(err.str().find(":2:15: m.len: what \"${x}\" is for Mesh@3 can't be told; write"),
            std::string::npos)
      << err.str();
  EXPECT_NE(err.str().find(":3:15: l: there is no way from \"Later@1\" to version 3; adapt the node"),
            std::string::npos)
      << err.str();
  EXPECT_EQ(upgrade("{"), kWrongInput);
}

}  // namespace
}  // namespace sherd::test
