// The verbs, without a process: exit codes and what is printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "cli/command_line.h"
#include "cli/progress.h"
#include "cli/verbs.h"
#include "runtime/made_up.h"

namespace sherd::test {
namespace {

ShotOptions shots(std::vector<std::string> graphs) {
  ShotOptions options;
  options.graphs = std::move(graphs);
  return options;
}

class Verbs : public ::testing::Test {
 protected:
  /// Writes a graph of the given nodes (and other keys) and returns its path.
  std::string graph(const std::string& nodes, const std::string& more = "") {
    return directory.write("g.json", "{\"format\": 1, " + more + "\"nodes\": {" + nodes + "}}");
  }
  int run(RunOptions options) {
    out.str("");
    err.str("");
    Console console{out, err, cancel, terminal, 80};
    return runVerb(options, registry, environment(directory.path()), console);
  }
  int run(const std::string& path, const std::string& to = "") {
    RunOptions options;
    options.graphs = {path};
    options.to = to;
    return run(options);
  }
  std::string atGraph() const { return (directory.path() / "g.json").string(); }

  TemporaryDirectory directory;
  std::shared_ptr<Counters> counters = std::make_shared<Counters>();
  Registry registry = madeUpNodes(counters);
  CancelToken cancel;
  bool terminal = false;
  std::ostringstream out, err;
  const std::string sink = R"("c": {"type": "Constant@1", "params": {"value": 5}},
      "s": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "out"}})";
};

TEST_F(Verbs, RunSaysWhatItDidAndWrote) {
  EXPECT_EQ(run(graph(sink)), kOk) << err.str();
  EXPECT_EQ(err.str(), "");
  EXPECT_NE(out.str().find("c  Constant  "), std::string::npos) << out.str();
  EXPECT_NE(out.str().find("s  Sink      "), std::string::npos);
  EXPECT_NE(
      out.str().find("wrote 1 file in " + shownPath((directory.path() / "out").string()) + ": value.txt\n"),
      std::string::npos);
  EXPECT_NE(out.str().find("done in "), std::string::npos);
  EXPECT_EQ(out.str().find('\x1b'), std::string::npos);
  EXPECT_TRUE(fs::exists(directory.path() / "out/value.txt"));
}

TEST_F(Verbs, RunWritesOneLineOverOnATerminal) {
  terminal = true;
  EXPECT_EQ(run(graph(sink)), kOk);
  EXPECT_NE(out.str().find("\r\x1b[K  0 %  c"), std::string::npos) << out.str();
}

TEST_F(Verbs, RunSummarisesManyFiles) {
  struct None {};
  ASSERT_TRUE(
      registry
          .add(
              NodeBuilder<None>("Many", 1, "").writesFiles().run([](const None&, NodeIo& io) -> Result<void> {
                for (int i = 0; i < 134; ++i) io.wrote("/o/piece_" + std::to_string(i) + ".obj");
                io.wrote("/o/pieces.json");
                for (int i = 0; i < 100; ++i) io.exec().info("line " + std::to_string(i));
                return {};
              }))
          .ok());
  EXPECT_EQ(run(graph(R"("m": {"type": "Many@1"})")), kOk);
  EXPECT_NE(out.str().find("wrote 135 files in /o: pieces.json, …\n"), std::string::npos) << out.str();
  EXPECT_NE(out.str().find("    … and 80 more messages\n"), std::string::npos);
  const std::string text = out.str();
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 30);
}

TEST_F(Verbs, RunRefusesWrongGraphsWithoutRunning) {
  EXPECT_EQ(run(graph(R"("c": {"type": "Constant@1", "params": {"vlue": 5}})")), kWrongInput);
  EXPECT_EQ(err.str(),
            atGraph() + ":1:64: c.vlue: Constant has no parameter \"vlue\"; did you mean \"value\"?\n");
  EXPECT_EQ(counters->constants, 0);
  EXPECT_EQ(run((directory.path() / "gone.json").string()), kWrongInput);
  EXPECT_NE(
      err.str().find("gone.json: the graph can't be opened: No such file or directory; name a graph file"),
      std::string::npos);
  const TemporaryDirectory empty;
  EXPECT_EQ(run(empty.path().string()), kWrongInput);
  EXPECT_NE(err.str().find("is a directory without graphs; graphs are named *.json"), std::string::npos);
  EXPECT_EQ(run(graph(sink), "d"), kWrongInput);
  EXPECT_NE(err.str().find("g.json: the graph has no node \"d\"; the known nodes are"), std::string::npos);
  EXPECT_EQ(run(directory.write("g.json", "no graph")), kWrongInput);
  EXPECT_EQ(err.str(), atGraph() + ":1:1: unexpected word \"no\"; strings and keys stand in double quotes\n");
}

TEST_F(Verbs, RunLooksForFilesOfWhatIsNeededOnly) {
  const std::string path =
      graph(R"("r": {"type": "ReadText@1", "params": {"file": "gone"}}, "c": {"type": "Constant@1"})");
  EXPECT_EQ(run(path, "c"), kOk) << err.str();
  EXPECT_EQ(run(path, "r"), kWrongInput);
  EXPECT_NE(err.str().find("r.file: there is no file"), std::string::npos);
}

TEST_F(Verbs, FramesThatWriteOneFileAreRefused) {
  const std::string swept = R"("c": {"type": "Constant@1", "params": {"value": "${frame}"}},
      "s": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "out"}})";
  const std::string path = graph(swept, R"("frames": "1-5", )");
  EXPECT_EQ(run(path), kWrongInput);
  EXPECT_NE(
      err.str().find("s.directory: frame 1 and frame 2 write to the same path; put ${frame:04} into it"),
      std::string::npos)
      << err.str();
  EXPECT_EQ(run(graph(sink, R"("frames": "1-5", )")), kOk) << err.str();  // nothing depends on the frame
  EXPECT_NE(out.str().find("(2 nodes)"), std::string::npos) << out.str();
}

TEST_F(Verbs, GraphsThatWriteOneDirectoryAreNamed) {
  const auto graphInto = [&](const std::string& name, const std::string& node, const std::string& folder) {
    return directory.write(
        name, R"({"format": 1, "nodes": {"c": {"type": "Constant@1"}, ")" + node +
                  R"(": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": ")" + folder +
                  R"("}}}})");
  };
  const auto runAll = [&](const std::vector<std::string>& paths) {
    RunOptions options;
    options.graphs = paths;
    return run(options);
  };
  const std::string a = graphInto("a.json", "s", "out"), b = graphInto("b.json", "s", "./out/"),
                    c = graphInto("c.json", "t", "out"), d = graphInto("d.json", "s", "other");
  EXPECT_EQ(runAll({a, b}), kWrongInput);
  EXPECT_NE(err.str().find("s.directory: " + a + " and " + b +
                           " write to the same path; give each graph a path of its own"),
            std::string::npos)
      << err.str();
  EXPECT_EQ(runAll({a, c}), kWrongInput);
  EXPECT_NE(err.str().find("t.directory: s.directory of " + a + " writes to the same path; give each"),
            std::string::npos)
      << err.str();
  EXPECT_EQ(runAll({a, d}), kOk) << err.str();
}

TEST_F(Verbs, OutputsOutsideOfTheGraphsFolderMustBeAllowed) {
  const TemporaryDirectory elsewhere;
  const std::string there = elsewhere.path().string();
  RunOptions options;
  options.graphs = {graph(R"("c": {"type": "Constant@1"},
      "s": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "${out}"}})",
                          "\"vars\": {\"out\": \"" + there + "/x\"}, ")};
  EXPECT_EQ(run(options), kWrongInput);
  EXPECT_NE(
      err.str().find("s.directory: \"" + there + "/x\" is outside of the graph's folder; write below it"),
      std::string::npos)
      << err.str();
  options.vars = {"out=" + there + "/y"};  // the user says so
  EXPECT_EQ(run(options), kOk) << err.str();
  options.vars.clear();
  options.allowWrite = {there};
  EXPECT_EQ(run(options), kOk) << err.str();
  fs::create_directory_symlink(elsewhere.path(), directory.path() / "link");
  options.allowWrite.clear();
  options.graphs = {graph(R"("c": {"type": "Constant@1"},
      "s": {"type": "Sink@1", "in": {"value": "c"}, "params": {"directory": "link/z"}})")};
  EXPECT_EQ(run(options), kWrongInput) << "a link must not lead out";
}

TEST_F(Verbs, SeveralGraphsRunAsOneAndShare) {
  directory.write("shots/a.json", R"({"format": 1, "nodes": {
      "b": {"type": "MakeBlob@1", "params": {"size": 1000}}, "n": {"type": "SumBlob@1", "in": {"blob": "b"}},
      "s": {"type": "Sink@1", "in": {"value": "n"}, "params": {"directory": "a"}}}})");
  directory.write("shots/b.json", R"({"format": 1, "nodes": {
      "b": {"type": "MakeBlob@1", "params": {"size": 1000}}, "n": {"type": "SumBlob@1", "in": {"blob": "b"}},
      "s": {"type": "Sink@1", "in": {"value": "n"}, "params": {"directory": "b"}}}})");
  RunOptions options;
  options.graphs = {(directory.path() / "shots").string()};
  EXPECT_EQ(run(options), kOk) << err.str();
  EXPECT_EQ(counters->blobs, 1);
  EXPECT_TRUE(fs::exists(directory.path() / "shots/a/value.txt"));
  EXPECT_TRUE(fs::exists(directory.path() / "shots/b/value.txt"));
  EXPECT_NE(out.str().find("  graph  ran  cached  failed"), std::string::npos) << out.str();
  options.graphs = {(directory.path() / "shots/*.json").string(),
                    (directory.path() / "shots/a.json").string()};
  EXPECT_EQ(run(options), kOk) << err.str();
  options.graphs = {(directory.path() / "*.nothing").string()};
  EXPECT_EQ(run(options), kWrongInput);
  EXPECT_NE(err.str().find("no file is like"), std::string::npos);
  directory.write("shots/c.json",
                  R"({"format": 1, "nodes": {"s": {"type": "Sink@1", "params": {"directory": "c"}}}})");
  options.graphs = {(directory.path() / "shots").string()};
  EXPECT_EQ(run(options), kWrongInput);
  EXPECT_NE(err.str().find("c.json"), std::string::npos);
}

TEST_F(Verbs, PlanSaysWhatRunWillDoAndWhy) {
  PlanOptions plan;
  const TemporaryDirectory cache;
  plan.graphs = {graph(R"("c": {"type": "Constant@1", "params": {"value": 5}}, "x": {"type": "Constant@1"},
      "a": {"type": "Add@1", "in": {"a": "c"}},
      "s": {"type": "Sink@1", "in": {"value": "a"}, "params": {"directory": "out"}})")};
  plan.cache = (cache.path() / "store").string();
  const auto lineOf = [&](const std::string& node) {
    out.str("");
    err.str("");
    Console console{out, err, cancel, false, 200};
    EXPECT_EQ(planVerb(plan, registry, environment(directory.path()), console), kOk) << err.str();
    std::istringstream lines(out.str());
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("  " + node + ' ')) return line;
    return std::string();
  };
  EXPECT_NE(lineOf("c").find("run         never run"), std::string::npos) << out.str();
  EXPECT_NE(lineOf("x").find("not needed"), std::string::npos) << out.str();
  RunOptions options;
  static_cast<ShotOptions&>(options) = plan;
  EXPECT_EQ(run(options), kOk) << err.str();
  EXPECT_NE(lineOf("s").find("hit"), std::string::npos) << out.str();
  plan.sets = {"c.value=6"};
  EXPECT_NE(lineOf("c").find("run         value 5 → 6"), std::string::npos) << out.str();
  EXPECT_NE(lineOf("a").find("may run     upstream: c"), std::string::npos) << out.str();
  plan.sets = {};
  fs::remove(directory.path() / "out/value.txt");
  EXPECT_NE(lineOf("s").find("value.txt is missing"), std::string::npos) << out.str();
  plan.json = true;
  out.str("");
  Console console{out, err, cancel, false, 80};
  EXPECT_EQ(planVerb(plan, registry, environment(directory.path()), console), kOk);
  const auto first = nlohmann::json::parse(out.str().substr(0, out.str().find('\n')));
  EXPECT_EQ(first["event"], "plan");
  EXPECT_EQ(first["name"], "c");
}

TEST_F(Verbs, RunNamesTheNodeThatFailed) {
  struct None {};
  ASSERT_TRUE(registry
                  .add(NodeBuilder<None>("Fails", 1, "")
                           .optionalInput<double>("a", "")
                           .run([](const None&, NodeIo&) -> Result<void> {
                             return failure("it broke", "mend it", "a");
                           }))
                  .ok());
  const std::string path =
      graph(R"("c": {"type": "Constant@1"}, "f": {"type": "Fails@1", "in": {"a": "c"}})");
  EXPECT_EQ(run(path), kNodeFailed);
  EXPECT_EQ(err.str(), atGraph() + ":1:91: f.a: it broke; mend it\n");
  EXPECT_NE(out.str().find("failed after "), std::string::npos);
}

TEST_F(Verbs, RunIsCancelled) {
  cancel.cancel();
  EXPECT_EQ(run(graph(sink)), kCancelled);
  EXPECT_NE(out.str().find("cancelled after "), std::string::npos);
  EXPECT_FALSE(fs::exists(directory.path() / "out"));
}

TEST_F(Verbs, RunTakesOverridesAndQuiet) {
  RunOptions options;
  options.graphs = {graph(sink, R"("vars": {"v": 1}, )")};
  options.sets = {"c.value=7", "s.directory=there"};
  options.vars = {"v=2"};
  options.quiet = true;
  EXPECT_EQ(run(options), kOk) << err.str();
  EXPECT_EQ(out.str(), "");
  EXPECT_TRUE(fs::exists(directory.path() / "there/value.txt"));
  options.sets = {"c.value"};
  EXPECT_EQ(run(options), kWrongInput);
  EXPECT_EQ(err.str(), "--set c.value sets nothing; write --set node.param=value\n");
}

TEST_F(Verbs, RunPrintsJsonEvents) {
  RunOptions options;
  options.graphs = {graph(sink)};
  options.json = true;
  EXPECT_EQ(run(options), kOk);
  std::istringstream lines(out.str());
  std::vector<nlohmann::json> events;
  for (std::string line; std::getline(lines, line);) events.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0]["event"], "node");
  EXPECT_EQ(events[0]["name"], "c");
  EXPECT_EQ(events[0]["type"], "Constant");
  EXPECT_EQ(events[0]["state"], "run");
  EXPECT_TRUE(events[0]["ms"].is_number() && events[0]["threads"].is_number() &&
              events[0]["message"].is_string());
  EXPECT_EQ(events[2]["event"], "done");
  EXPECT_EQ(events[2]["ok"], true);
  EXPECT_EQ(events[2]["outputs"].size(), 1u);
  options.to = "gone";
  EXPECT_EQ(run(options), kWrongInput);
  const auto error = nlohmann::json::parse(out.str().substr(0, out.str().find('\n')));
  EXPECT_EQ(error["event"], "error");
}

TEST_F(Verbs, CheckTellsOfAllGraphs) {
  const std::string good =
      directory.write("good.json", "{\"format\": 1, \"nodes\": {\"c\": {\"type\": \"Constant@1\"}}}");
  const std::string bad =
      directory.write("bad.json",
                      "{\"format\": 1, \"nodes\": {\"c\": {\"type\": \"Constnt@1\"},\n\"r\": {\"type\": "
                      "\"ReadText@1\", \"params\": {\"file\": \"gone\"}}}}");
  Console console{out, err, cancel, false, 80};
  EXPECT_EQ(checkVerb(shots({good}), registry, environment(), console), kOk);
  EXPECT_EQ(out.str(), good + ": 1 node, no errors\n");
  EXPECT_EQ(checkVerb(shots({bad, good}), registry, environment(), console), kWrongInput);
  EXPECT_NE(err.str().find(bad + ":1:39: c: there is no node type"), std::string::npos) << err.str();
  EXPECT_NE(err.str().find(bad + ":2:48: r.file: there is no file"), std::string::npos) << err.str();
  EXPECT_EQ(counters->constants, 0);
}

TEST_F(Verbs, NodesListsAndExplains) {
  Console console{out, err, cancel, false, 80};
  EXPECT_EQ(nodesVerb({}, registry, console), kOk);
  EXPECT_NE(out.str().find("  Constant@1  A number.\n"), std::string::npos) << out.str();
  out.str("");
  EXPECT_EQ(nodesVerb({"Kinds", false}, registry, console), kOk);
  EXPECT_NE(out.str().find("  length     number         1 m        a length; above 0 m\n"), std::string::npos)
      << out.str();
  EXPECT_NE(out.str().find("a mode; one of \"fast\", \"exact\""), std::string::npos);
  EXPECT_EQ(nodesVerb({"Kind", false}, registry, console), kWrongInput);
  EXPECT_EQ(err.str(), "there is no node type \"Kind\"; did you mean \"Kinds\"?\n");
  out.str("");
  EXPECT_EQ(nodesVerb({"", true}, registry, console), kOk);
  EXPECT_EQ(nlohmann::json::parse(out.str()).size(), registry.all().size());
}

TEST(CommandLine, TellsVersionHelpAndMistakes) {
  auto run = [](const std::vector<std::string>& arguments) {
    std::ostringstream out, err;
    CancelToken cancel;
    Console console{out, err, cancel, false, 80};
    const int code = runCommandLine(arguments, console);
    return std::tuple(code, out.str(), err.str());
  };
  EXPECT_EQ(std::get<0>(run({"--version"})), kOk);
  EXPECT_EQ(std::get<1>(run({"--version"})).substr(0, 6), "sherd ");
  EXPECT_NE(std::get<1>(run({"run", "--help"})).find("--target"), std::string::npos);
  EXPECT_EQ(std::get<0>(run({})), kWrongInput);
  EXPECT_EQ(std::get<0>(run({"walk"})), kWrongInput);
  EXPECT_EQ(std::get<0>(run({"run"})), kWrongInput);
  EXPECT_EQ(std::get<0>(run({"run", "g.json", "--threads", "-1"})), kWrongInput);
  EXPECT_EQ(std::get<0>(run({"run", "g.json", "--target", "a", "--to", "b"})), kWrongInput);
  EXPECT_EQ(std::get<0>(run({"run", "--help"})), kOk);
  auto errorOf = [&](const std::vector<std::string>& arguments) {
    const auto [code, out, err] = run(arguments);
    EXPECT_EQ(code, kWrongInput) << err;
    EXPECT_EQ(out, "");
    return err;
  };
  const std::string verbs =
      "the verbs are run, plan, check, fmt, upgrade, nodes and cache; `sherd --help` explains them\n";
  EXPECT_EQ(errorOf({}), "sherd needs a verb; " + verbs);
  EXPECT_EQ(errorOf({"foo"}), "there is no verb \"foo\"; " + verbs);
  EXPECT_EQ(errorOf({"rnu", "g.json"}), "there is no verb \"rnu\"; did you mean \"run\"? " + verbs);
  EXPECT_EQ(errorOf({"g.json"}), "\"g.json\" is no verb; did you mean `sherd run g.json`?\n");
  EXPECT_EQ(errorOf({"--bogus", "run"}), "\"--bogus\" stands where a verb belongs; " + verbs);
  EXPECT_EQ(errorOf({"run"}), "run needs a graph file; e.g. sherd run graphs/first_fracture.json\n");
  EXPECT_EQ(errorOf({"check"}), "check needs a graph file; e.g. sherd check graphs/first_fracture.json\n");
  EXPECT_EQ(errorOf({"run", "g.json", "--bogus"}),
            "run has no option \"--bogus\"; `sherd run --help` lists what it takes\n");
  EXPECT_EQ(errorOf({"run", "--quite"}), "run has no option \"--quite\"; did you mean \"--quiet\"?\n");
  EXPECT_EQ(errorOf({"nodes", "Add", "Word"}),
            "nodes doesn't take \"Word\"; `sherd nodes --help` lists what it takes\n");
  EXPECT_NE(errorOf({"run", "g.json", "--threads", "x"}).find("`sherd run --help`"), std::string::npos);
}

TEST(CommandLine, EndsEventsWithDoneAlsoWhereItCannotBeParsed) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"run", "--json", "--bogus"},
                                             {"run", "--json"},
                                             {"rn", "g.json", "--json"},
                                             {"run", "g.json", "--json", "--threads", "-1"}}) {
    std::ostringstream out, err;
    CancelToken cancel;
    Console console{out, err, cancel, false, 80};
    EXPECT_EQ(runCommandLine(arguments, console), kWrongInput);
    std::istringstream lines(out.str());
    std::string first, last;
    std::getline(lines, first);
    std::getline(lines, last);
    const auto error = nlohmann::json::parse(first);
    EXPECT_EQ(error["event"], "error");
    EXPECT_EQ(error["message"].get<std::string>() + '\n', err.str());
    const auto done = nlohmann::json::parse(last);
    EXPECT_EQ(done["event"], "done");
    EXPECT_EQ(done["ok"], false);
  }
}

TEST(CommandLine, RefusesAssetsThatAreNoDirectory) {
  std::ostringstream out, err;
  CancelToken cancel;
  Console console{out, err, cancel, false, 80};
  setenv("SHERD_NODE_PATH", (std::string(SHERD_TEST_PACKS) + "/good/good_nodes.so").c_str(), 1);
  setenv("SHERD_ASSETS", "/nonexist", 1);
  EXPECT_EQ(runCommandLine({"check", "g.json"}, console), kWrongInput);
  EXPECT_EQ(err.str(),
            "the environment variable SHERD_ASSETS is \"/nonexist\", which is no directory; set it to the "
            "folder of assets, or unset it to use those that come with sherd\n");
  unsetenv("SHERD_ASSETS");
  unsetenv("SHERD_NODE_PATH");
}

TEST(CommandLine, LoadsPacksOfTheSearchPath) {
  const TemporaryDirectory directory;
  const std::string path = directory.write(
      "g.json", R"({"format": 1, "vars": {"x": 1, "y": 2}, "nodes": {"p": {"type": "Packed@1"}}})");
  std::ostringstream out, err;
  CancelToken cancel;
  Console console{out, err, cancel, false, 80};
  setenv("SHERD_NODE_PATH", (std::string(SHERD_TEST_PACKS) + "/good/good_nodes.so").c_str(), 1);
  EXPECT_EQ(runCommandLine({"run", "--var", "x=3", "--var", "y=4", path, "--threads", "1"}, console), kOk)
      << err.str();
  setenv("SHERD_NODE_PATH", (std::string(SHERD_TEST_PACKS) + "/other_abi").c_str(), 1);
  EXPECT_EQ(runCommandLine({"run", path}, console), kWrongInput);
  EXPECT_NE(err.str().find("other_abi_nodes.so"), std::string::npos);
  unsetenv("SHERD_NODE_PATH");
  setThreadLimit(0);
}

TEST(Texts, OfDurations) {
  EXPECT_EQ(durationText(3.14), "3.1 ms");
  EXPECT_EQ(durationText(123.4), "123 ms");
  EXPECT_EQ(durationText(12345), "12.3 s");
  EXPECT_EQ(durationText(125e3), "2 min 5 s");
  EXPECT_EQ(durationText(3 * 3600e3), "3 h 0 min");
  EXPECT_EQ(timeLeftText(0.5, 100), "");
  EXPECT_EQ(timeLeftText(0.5, 20000), "about 20.0 s left");
}

}  // namespace
}  // namespace sherd::test
