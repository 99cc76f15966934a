// The program's verbs. Each returns the exit code and prints only to its console.
#pragma once

#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/shots.h"
#include "graph/registry.h"
#include "graph/variables.h"

namespace sherd {

struct RunOptions : ShotOptions {
  bool keepGoing = false;
  bool json = false;    ///< one object a line instead of text
  bool quiet = false;   ///< warnings and errors only
  std::string report;   ///< an HTML file to write; empty: none
  std::string command;  ///< as it was typed, for the report
};
int runVerb(const RunOptions& options, const Registry& registry, const Environment& environment,
            Console& console);

struct PlanOptions : ShotOptions {
  bool json = false;  ///< one object a line instead of text
};
int planVerb(const PlanOptions& options, const Registry& registry, const Environment& environment,
             Console& console);

int checkVerb(const ShotOptions& options, const Registry& registry, const Environment& environment,
              Console& console);

struct NodesOptions {
  std::string type = {};  ///< "Name" or "Name@N"; empty: all
  bool json = false;      ///< as JSON
  bool schema = false;    ///< a JSON Schema of graph files instead, of all types
  bool markdown = false;  ///< the node reference instead, of all types
};
int nodesVerb(const NodesOptions& options, const Registry& registry, Console& console);

struct FmtOptions {
  std::vector<std::string> files;
  bool check = false;  ///< end with 1 where anything would change
  bool write = false;  ///< make the changes that are shown
};
int fmtVerb(const FmtOptions& options, Console& console);

struct UpgradeOptions {
  std::vector<std::string> files;
  bool write = false;  ///< make the changes that are shown
};
int upgradeVerb(const UpgradeOptions& options, const Registry& registry, Console& console);

struct CacheOptions {
  std::string action;     ///< stat, gc, verify or clear
  std::string directory;  ///< empty: DiskStore::defaultDirectory
  std::string max;        ///< of gc, as cacheSize takes it
};
/// A directory that doesn't exist is an empty cache, and isn't made.
int cacheVerb(const CacheOptions& options, const Environment& environment, Console& console);

}  // namespace sherd
