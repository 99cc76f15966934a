// Subgraphs in files of their own.
#include "cli/verbs.h"
#include "runtime/subgraph_graphs.h"

namespace sherd::test {
namespace {

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

}  // namespace
}  // namespace sherd::test
