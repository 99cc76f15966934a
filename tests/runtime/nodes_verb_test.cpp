// `sherd nodes`: the text of one type, the schema and the reference, all from the types' tables.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/node_words.h"
#include "cli/verbs.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

using Json = nlohmann::json;

struct CutParams {
  double depth = 1;
  std::string file;
};

/// A type with a history, a library that can't be stopped, and something to escape in its help.
NodeType cutNode() {
  return NodeBuilder<CutParams>("CutDXFSheet", 3, "Cuts a sheet | in <two>.")
      .input<Blob>("blob", "the sheet")
      .optionalInput<double>("extra", "more of it")
      .gatheredInput<double>("all", "numbers")
      .number("depth", &CutParams::depth,
              {.unit = "mm", .min = 0, .max = 2.5, .openMax = true, .help = "how deep"})
      .inputFile("file", &CutParams::file, "the outline")
      .output<Blob>("left", "one half")
      .migrate(1, {renameParam("length", "depth"), renameInput("mesh", "blob")})
      .migrate(2, {removeParam("speed", "the cutter finds it"), keepDefault("depth", "0.5")})
      .formerly("Saw")
      .uninterruptible("the cutter's cut()", 420)
      .run([](const CutParams&, NodeIo&) -> Result<void> { return {}; });
}

class NodesVerb : public ::testing::Test {
 protected:
  NodesVerb() { EXPECT_TRUE(registry.add(cutNode()).ok()); }
  std::string print(NodesOptions options, int code = kOk) {
    std::ostringstream out;
    err.str("");
    CancelToken cancel;
    Console console{out, err, cancel, false, 80};
    EXPECT_EQ(nodesVerb(options, registry, console), code);
    return out.str();
  }
  Json schema() { return Json::parse(print({.schema = true})); }

  Registry registry = madeUpNodes();
  std::ostringstream err;
};

void expectHas(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << part << "\n   is not in\n" << text;
}

TEST_F(NodesVerb, TellsAllAboutOneType) {
  const std::string text = print({.type = "CutDXFSheet"});
  expectHas(text, "CutDXFSheet@3\n  Cuts a sheet | in <two>.\n");
  expectHas(text, "  blob   Blob    the sheet\n");
  expectHas(text, "  extra  Number  (optional) more of it\n");
  expectHas(text, "  all    Number  (of all frames and wedges) numbers\n");
  expectHas(text, "  depth  number        1 mm      how deep; at least 0 and below 2.5 mm\n");
  expectHas(text, "  file   file to read  required  the outline\n");
  expectHas(text, "Cancelling waits for\n  the cutter's cut(), 420 ms at most as measured\n");
  expectHas(text, "  1 → 2  parameter \"length\" is now \"depth\"; input \"mesh\" is now \"blob\"\n");
  expectHas(text,
            "  2 → 3  parameter \"speed\" is gone: the cutter finds it; the default of \"depth\"\n         "
            "was 0.5\n");
  expectHas(text, "Former names\n  \"Saw\"\n");
  expectHas(text, R"("cut_dxf_sheet": { "type": "CutDXFSheet@3",
                   "in": { "blob": "make_blob", "all": "constant" },
                   "params": { "file": "FILE" } })");
}

TEST_F(NodesVerb, LeavesOutWhatThereIsNot) {
  const std::string text = print({.type = "Word@1"});
  expectHas(text, "A node of it, to paste\n\"word\": { \"type\": \"Word@1\" }\n");
  for (const char* title : {"Inputs", "Cancelling", "Older versions", "Former names"})
    EXPECT_EQ(text.find(title), std::string::npos) << title;
}

TEST_F(NodesVerb, FindsMisspeltTypesAndOtherVersions) {
  EXPECT_EQ(print({.type = "Constnt"}, kWrongInput), "");
  EXPECT_EQ(err.str(), "there is no node type \"Constnt\"; did you mean \"Constant\"?\n");
  print({.type = "MakBlob@1"}, kWrongInput);
  EXPECT_EQ(err.str(), "there is no node type \"MakBlob@1\"; did you mean \"MakeBlob\"?\n");
  expectHas(print({.type = "CutDXFSheet@2"}), "CutDXFSheet@3\n");
  EXPECT_EQ(err.str(), "this is CutDXFSheet@3; \"CutDXFSheet@2\" is an older version, which still loads\n");
  print({.type = "CutDXFSheet@4"});
  EXPECT_EQ(err.str(), "this is CutDXFSheet@3; \"CutDXFSheet@4\" is not known\n");
  print({.type = "CutDXFSheet@3"});
  EXPECT_EQ(err.str(), "");
}

TEST_F(NodesVerb, SnippetsPastedTogetherMakeAGraph) {
  std::string nodes;
  for (const NodeType* type : registry.all())
    nodes += (nodes.empty() ? "" : ",\n") + snippetText(snippetOf(*type, registry), 80);
  const Checked checked = check("{\"format\": 1, \"nodes\": {" + nodes + "}}", registry);
  EXPECT_TRUE(checked.errors.empty()) << checked.errors.front() << '\n' << nodes;
  EXPECT_EQ(checked.graph.nodes.size(), registry.all().size());
}

TEST_F(NodesVerb, SchemaHasRangesWordsAndDefaults) {
  const Json params = schema()["definitions"]["Kinds@2"]["properties"]["params"];
  EXPECT_EQ(params["additionalProperties"], false);
  const Json& all = params["properties"];
  EXPECT_EQ(all["count"]["type"], Json({"integer", "string"}));
  EXPECT_EQ(all["count"]["minimum"], 1);
  EXPECT_EQ(all["count"]["maximum"], 10);
  EXPECT_EQ(all["count"]["default"], 1);
  EXPECT_EQ(all["length"]["exclusiveMinimum"], 0);
  EXPECT_FALSE(all["length"].contains("minimum"));
  EXPECT_EQ(all["length"]["description"], "a length; above 0 m (number, default: 1 m)");
  EXPECT_EQ(all["direction"]["minItems"], 3);
  EXPECT_EQ(all["direction"]["items"]["minimum"], -1);
  EXPECT_EQ(all["mode"]["anyOf"][0]["enum"], Json({"fast", "exact"}));
  EXPECT_EQ(all["mode"]["default"], "fast");
  EXPECT_EQ(all["flag"]["default"], false);
}

TEST_F(NodesVerb, SchemaLetsParametersBeWired) {
  const Json all = schema()["definitions"];
  const Json& wires = all["Kinds@2"]["properties"]["in"]["properties"];
  EXPECT_TRUE(wires.contains("count") && wires.contains("mode"));
  EXPECT_FALSE(wires.contains("direction")) << "a list can't be wired";
  const Json& cut = all["CutDXFSheet@3"];
  EXPECT_EQ(cut["required"], Json::array({"in"}));
  EXPECT_EQ(cut["properties"]["in"]["required"], Json({"blob", "all"}));
  ASSERT_EQ(cut["allOf"].size(), 1u) << "one required parameter, set or wired";
  EXPECT_EQ(cut["allOf"][0]["anyOf"][0]["properties"]["params"]["required"], Json::array({"file"}));
  EXPECT_EQ(cut["allOf"][0]["anyOf"][1]["properties"]["in"]["required"], Json::array({"file"}));
  EXPECT_FALSE(cut["properties"]["params"]["properties"]["file"].contains("default"));
}

TEST_F(NodesVerb, SchemaKnowsTypesAndTheirOlderVersions) {
  const Json types = schema()["definitions"]["node"]["properties"]["type"]["anyOf"];
  ASSERT_EQ(types.size(), 3u);
  EXPECT_EQ(types[0]["enum"].size(), registry.all().size());
  EXPECT_EQ(types[0]["enum"].size(), types[0]["enumDescriptions"].size());
  EXPECT_EQ(types[1]["pattern"], "^(Saw@3|Saw@1|CutDXFSheet@1|Saw@2|CutDXFSheet@2)$");
}

TEST_F(NodesVerb, ReferenceIsMarkdown) {
  const std::string text = print({.markdown = true});
  expectHas(text, "# Node reference\n");
  expectHas(text, "- [CutDXFSheet@3](#cutdxfsheet3): Cuts a sheet \\| in \\<two\\>.\n");
  expectHas(text, "\n## CutDXFSheet@3\n\nCuts a sheet \\| in \\<two\\>.\n");
  expectHas(text, "| `depth` | number | 1 mm | how deep; at least 0 and below 2.5 mm |\n");
  expectHas(text, "| `file` | file to read | required | the outline |\n");
  expectHas(text, "Cancelling waits for the cutter's cut(), 420 ms at most as measured.\n");
  expectHas(text, "Version 1 → 2: parameter \"length\" is now \"depth\"; input \"mesh\" is now \"blob\".\n");
  expectHas(text, "## Sink@1\n\nWrites a number.\n\nWrites files.\n");
  for (const NodeType* type : registry.all()) expectHas(text, "\n## " + versioned(*type) + "\n");
}

TEST(NodesOptions, ExcludeEachOther) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"nodes", "--schema", "--json"},
                                             {"nodes", "--markdown", "--schema"},
                                             {"nodes", "Add", "--schema"},
                                             {"nodes", "Add", "--markdown"}}) {
    std::ostringstream out, err;
    CancelToken cancel;
    Console console{out, err, cancel, false, 80};
    EXPECT_EQ(runCommandLine(arguments, console), kWrongInput) << arguments[1];
    EXPECT_NE(err.str().find("xcludes"), std::string::npos) << err.str();
    EXPECT_EQ(out.str(), "");
  }
}

}  // namespace
}  // namespace sherd::test
