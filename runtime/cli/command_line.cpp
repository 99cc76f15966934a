#include "cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <new>

#include "base/parallel.h"
#include "cli/verbs.h"
#include "plugin/loader.h"

namespace sherd {
namespace {

std::string environmentVariable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

Result<Registry> loadNodes() {
  Registry registry;
  SHERD_ASSIGN(const std::vector<std::string> packs,
               findPacks(environmentVariable("SHERD_NODE_PATH"), programDirectory()));
  for (const std::string& pack : packs) SHERD_CHECK(loadPack(pack, registry));
  return registry;
}

struct Commands {
  CLI::App app{"sherd breaks things: runs node graphs that fracture models.", "sherd"};
  RunOptions run;
  CheckOptions check;
  NodesOptions nodes;
  int threads = 0;
  CLI::App *runApp = nullptr, *checkApp = nullptr, *nodesApp = nullptr;

  Commands() {
    app.set_version_flag("--version", std::string("sherd ") + SHERD_VERSION);
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::simple);
    addRun();
    addCheck();
    nodesApp = app.add_subcommand("nodes", "list the node types, or tell all about one");
    nodesApp->add_option("TYPE", nodes.type, "a node type");
    nodesApp->add_flag("--json", nodes.json, "as JSON");
  }

 private:
  /// Options that may be repeated take one value each time, so that the graph may stand behind them.
  static void addRepeated(CLI::App& verb, const char* name, std::vector<std::string>& list, const char* form,
                          const char* help) {
    verb.add_option(name, list, help)->type_name(form)->allow_extra_args(false);
  }

  void addRun() {
    runApp = app.add_subcommand("run", "evaluate a graph");
    runApp->add_option("GRAPH", run.graph, "a graph file")->required();
    auto* target = runApp->add_option("--target", run.target, "only what this target of the graph names");
    runApp->add_option("--to", run.to, "only this node and what it needs")->excludes(target);
    addRepeated(*runApp, "--set", run.sets, "NODE.PARAM=VALUE", "set a parameter");
    addRepeated(*runApp, "--var", run.vars, "NAME=VALUE", "set a variable of the graph");
    runApp->add_option("--threads", threads, "threads to use; 0: all of the machine's")
        ->check(CLI::Range(0, 1024));
    runApp->add_flag("--keep-going", run.keepGoing, "after a failure, go on with what doesn't depend on it");
    runApp->add_flag("--json", run.json, "print one JSON object a line");
    runApp->add_flag("--quiet", run.quiet, "print warnings and errors only");
  }

  void addCheck() {
    checkApp = app.add_subcommand("check", "find all errors of graphs without running them");
    checkApp->add_option("GRAPH", check.graphs, "graph files")->required();
    addRepeated(*checkApp, "--set", check.sets, "NODE.PARAM=VALUE", "set a parameter");
    addRepeated(*checkApp, "--var", check.vars, "NAME=VALUE", "set a variable of the graph");
  }
};

int runVerbOf(Commands& commands, Console& console) {
  setThreadLimit(commands.threads);
  const auto registry = loadNodes();
  if (!registry.ok()) {
    console.err << registry.error().text() << '\n';
    return kWrongInput;
  }
  const Environment environment =
      Environment::ofProcess(findAssets(environmentVariable("SHERD_ASSETS"), programDirectory()));
  if (commands.runApp->parsed()) return runVerb(commands.run, *registry, environment, console);
  if (commands.checkApp->parsed()) return checkVerb(commands.check, *registry, environment, console);
  return nodesVerb(commands.nodes, *registry, console);
}

}  // namespace

int runCommandLine(const std::vector<std::string>& arguments, Console& console) {
  try {
    Commands commands;
    try {
      std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());  // as CLI11 takes them
      commands.app.parse(std::move(reversed));
    } catch (const CLI::ParseError& e) {
      return commands.app.exit(e, console.out, console.err) == 0 ? kOk : kWrongInput;
    }
    return runVerbOf(commands, console);
  } catch (const std::bad_alloc&) {
    console.err << "out of memory\n";
  } catch (const std::exception& e) {
    console.err << "a mistake in this program: " << e.what() << "; please report it\n";
  }
  return kNodeFailed;
}

}  // namespace sherd
