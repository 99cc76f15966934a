#include "cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>

#include "base/parallel.h"
#include "cli/json_events.h"
#include "cli/usage.h"
#include "cli/verbs.h"
#include "graph/suggest.h"
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
  PlanOptions plan;
  ShotOptions check;
  NodesOptions nodes;
  CacheOptions cache;
  FmtOptions fmt;
  UpgradeOptions upgrade;
  int threads = 0;
  CLI::App *runApp = nullptr, *planApp = nullptr, *checkApp = nullptr, *nodesApp = nullptr,
           *cacheApp = nullptr;
  CLI::App *fmtApp = nullptr, *upgradeApp = nullptr;

  Commands() {
    app.set_version_flag("--version", std::string("sherd ") + SHERD_VERSION);
    app.require_subcommand(1);
    addRun();
    addPlan();
    addCheck();
    addNodes();
    addCache();
    addFmt();
    addUpgrade();
  }

 private:
  /// Options that may be repeated take one value each time, so that the graph may stand behind them.
  static void addRepeated(CLI::App& verb, const char* name, std::vector<std::string>& list, const char* form,
                          const char* help) {
    verb.add_option(name, list, help)->type_name(form)->allow_extra_args(false);
  }

  /// What the verbs that open graphs have in common.
  static void addShots(CLI::App& verb, ShotOptions& options) {
    verb.add_option("GRAPH", options.graphs, "graph files, directories of them, or patterns with * and ?")
        ->type_name("")
        ->required();
    addRepeated(verb, "--set", options.sets, "NODE.PARAM=VALUE", "set a parameter");
    addRepeated(verb, "--var", options.vars, "NAME=VALUE", "set a variable of the graph");
    verb.add_option("--frames", options.frames, "frames in place of the graph's own, as 1001-1100x2")
        ->type_name("RANGE");
    addRepeated(verb, "--allow-write", options.allowWrite, "DIR",
                "allow the graph to write there, besides its own folder");
  }
  static void addEvaluation(CLI::App& verb, ShotOptions& options) {
    auto* target = verb.add_option("--target", options.target, "only what this target of the graph names")
                       ->type_name("TARGET");
    verb.add_option("--to", options.to, "only this node and what it needs")
        ->type_name("NODE")
        ->excludes(target);
    auto* cache =
        verb.add_option(
                "--cache", options.cache,
                "where results are kept between runs; otherwise $SHERD_CACHE, $XDG_CACHE_HOME/sherd or "
                "~/.cache/sherd")
            ->type_name("DIR");
    auto* size =
        verb.add_option("--cache-size", options.cacheSize,
                        "how large the cache may be, such as 500M; otherwise $SHERD_CACHE_SIZE or 10G")
            ->type_name("SIZE");
    verb.add_flag("--no-cache", options.noCache, "look up nothing and keep nothing")
        ->excludes(cache)
        ->excludes(size);
  }

  void addRun() {
    runApp = app.add_subcommand("run", "evaluate graphs");
    addShots(*runApp, run);
    addEvaluation(*runApp, run);
    runApp->add_option("--threads", threads, "threads to use, up to 1024; 0: all of the machine's")
        ->type_name("NUMBER")
        ->check(CLI::Range(0, 1024).description(""));
    runApp->add_flag("--keep-going", run.keepGoing, "after a failure, go on with what doesn't depend on it");
    runApp->add_flag("--json", run.json, "print one JSON object a line");
    runApp->add_flag("--quiet", run.quiet, "print warnings and errors only");
    runApp->add_option("--report", run.report, "write a page that shows what happened")
        ->type_name("FILE.html");
  }

  void addPlan() {
    planApp = app.add_subcommand("plan", "tell what a run would do, and why, without doing it");
    addShots(*planApp, plan);
    addEvaluation(*planApp, plan);
    planApp->add_flag("--json", plan.json, "print one JSON object a line");
  }

  void addNodes() {
    nodesApp = app.add_subcommand("nodes", "list the node types, or tell all about one");
    auto* type = nodesApp->add_option("TYPE", nodes.type, "a node type");
    auto* json = nodesApp->add_flag("--json", nodes.json, "as JSON");
    auto* schema =
        nodesApp->add_flag("--schema", nodes.schema, "print a JSON Schema of graph files, for editors");
    auto* markdown = nodesApp->add_flag("--markdown", nodes.markdown, "print the node reference as Markdown");
    schema->excludes(type)->excludes(json)->excludes(markdown);
    markdown->excludes(type)->excludes(json);
  }

  void addCheck() {
    checkApp = app.add_subcommand("check", "find all errors of graphs without running them");
    addShots(*checkApp, check);
  }

  void addFmt() {
    fmtApp = app.add_subcommand("fmt", "lay out graph files, showing what changes");
    fmtApp->add_option("GRAPH", fmt.files, "graph files")->type_name("")->required();
    auto* check = fmtApp->add_flag("--check", fmt.check, "end with exit code 1 if anything would change");
    fmtApp->add_flag("--write", fmt.write, "write the changes that are shown")->excludes(check);
  }

  void addUpgrade() {
    upgradeApp = app.add_subcommand("upgrade", "rewrite nodes of older versions, showing what changes");
    upgradeApp->add_option("GRAPH", upgrade.files, "graph files")->type_name("")->required();
    upgradeApp->add_flag("--write", upgrade.write, "write the changes that are shown");
  }

  void addCache() {
    cacheApp = app.add_subcommand("cache", "look after the results that are kept on disk");
    cacheApp->add_option("ACTION", cache.action,
                         "stat: how much there is; gc: make it fit into --max; verify: read all and remove "
                         "what is damaged; clear: remove everything");
    cacheApp
        ->add_option("--cache", cache.directory,
                     "the cache's directory; otherwise $SHERD_CACHE, $XDG_CACHE_HOME/sherd or ~/.cache/sherd")
        ->type_name("DIR");
    cacheApp
        ->add_option("--max", cache.max,
                     "what gc leaves at most, such as 500M; otherwise $SHERD_CACHE_SIZE or 10G")
        ->type_name("SIZE");
  }
};

/// Says what ended the program before a verb could; to a reader of events as such, "done" being the last.
int refuse(const Error& error, bool events, Console& console, ExitCode code = kWrongInput) {
  Diagnostics diagnostics;
  diagnostics.add({}, "", error);
  printDiagnostics(diagnostics, console.err);
  if (events) {
    jsonErrors(diagnostics, console.out);
    jsonDone(false, 0, {}, console.out);
  }
  return code;
}

std::vector<std::string> optionNames(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// What the parser found wrong.
Error parseError(const Commands& commands, const CLI::ParseError& error) {
  for (const CLI::App* verb : {commands.runApp, commands.planApp, commands.checkApp, commands.fmtApp,
                               commands.upgradeApp, commands.nodesApp, commands.cacheApp}) {
    if (!verb->parsed()) continue;
    if (const std::vector<std::string> left = verb->remaining(); !left.empty())
      return unexpectedArgument(verb->get_name(), left.front(), optionNames(*verb));
    const CLI::Option* graph = verb->get_option_no_throw("GRAPH");
    const bool needsGraph = graph != nullptr && graph->count() == 0;
    if (needsGraph && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
      return missingGraph(verb->get_name());
    return Error{
        error.what(), "`sherd " + verb->get_name() + " --help` tells what it takes", {}, Error::Kind::Input};
  }
  return Error{error.what(), "`sherd --help` tells what it takes", {}, Error::Kind::Input};
}

Result<Environment> makeEnvironment() {
  const std::string variable = environmentVariable("SHERD_ASSETS");
  std::error_code problem;
  if (!variable.empty() && !std::filesystem::is_directory(variable, problem))
    return Error{"the environment variable SHERD_ASSETS is " + inQuotes(variable) + ", which is no directory",
                 "set it to the folder of assets, or unset it to use those that come with sherd",
                 {},
                 Error::Kind::Input};
  return Environment::ofProcess(findAssets(variable, programDirectory()));
}

int runVerbOf(Commands& commands, const std::vector<std::string>& arguments, Console& console) {
  commands.run.command = "sherd";
  for (const std::string& argument : arguments) commands.run.command += ' ' + argument;
  setThreadLimit(commands.threads);
  if (commands.cacheApp->parsed()) return cacheVerb(commands.cache, Environment::ofProcess({}), console);
  if (commands.fmtApp->parsed()) return fmtVerb(commands.fmt, console);
  const auto registry = loadNodes();
  if (!registry.ok()) return refuse(registry.error(), commands.run.json, console);
  if (commands.upgradeApp->parsed()) return upgradeVerb(commands.upgrade, *registry, console);
  if (commands.nodesApp->parsed()) return nodesVerb(commands.nodes, *registry, console);
  const auto found = makeEnvironment();
  if (!found.ok()) return refuse(found.error(), commands.run.json, console);
  const Environment& environment = *found;
  if (commands.runApp->parsed()) return runVerb(commands.run, *registry, environment, console);
  if (commands.planApp->parsed()) return planVerb(commands.plan, *registry, environment, console);
  return checkVerb(commands.check, *registry, environment, console);
}

}  // namespace

int runCommandLine(const std::vector<std::string>& arguments, Console& console) {
  const bool events = asksForEvents(arguments);
  try {
    if (const auto verb = checkVerbName(arguments); !verb.ok()) return refuse(verb.error(), events, console);
    Commands commands;
    try {
      std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());  // as CLI11 takes them
      commands.app.parse(std::move(reversed));
    } catch (const CLI::Success& help) {
      return commands.app.exit(help, console.out, console.err) == 0 ? kOk : kWrongInput;
    } catch (const CLI::ParseError& e) {
      return refuse(parseError(commands, e), events, console);
    }
    return runVerbOf(commands, arguments, console);
  } catch (const std::bad_alloc&) {
    return refuse(failure("out of memory", "close other programs or use a smaller model"), events, console,
                  kNodeFailed);
  } catch (const std::exception& e) {
    return refuse(failure(std::string("a mistake in this program: ") + e.what(), "please report it"), events,
                  console, kNodeFailed);
  }
}

}  // namespace sherd
