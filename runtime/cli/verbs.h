// The program's verbs. Each returns the exit code and prints only to its console.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/console.h"
#include "graph/registry.h"
#include "graph/variables.h"

namespace sherd {

struct RunOptions {
  std::string graph;
  std::string target, to;         ///< what to evaluate; both empty: the default of wantedNodes
  std::vector<std::string> sets;  ///< "node.param=value"
  std::vector<std::string> vars;  ///< "name=value"
  bool keepGoing = false;
  bool json = false;   ///< one object a line instead of text
  bool quiet = false;  ///< warnings and errors only
};
int runVerb(const RunOptions& options, const Registry& registry, const Environment& environment,
            Console& console);

struct CheckOptions {
  std::vector<std::string> graphs;
  std::vector<std::string> sets, vars;
};
int checkVerb(const CheckOptions& options, const Registry& registry, const Environment& environment,
              Console& console);

struct NodesOptions {
  std::string type = {};  ///< "Name" or "Name@N"; empty: all
  bool json = false;      ///< as JSON
  bool schema = false;    ///< a JSON Schema of graph files instead, of all types
  bool markdown = false;  ///< the node reference instead, of all types
};
int nodesVerb(const NodesOptions& options, const Registry& registry, Console& console);

struct CacheOptions {
  std::string action;     ///< stat, gc, verify or clear
  std::string directory;  ///< empty: DiskStore::defaultDirectory
  std::string max;        ///< of gc, as parseSize takes it; empty: DiskStoreOptions::mostBytes
};
/// A directory that doesn't exist is an empty cache, and isn't made.
int cacheVerb(const CacheOptions& options, const Environment& environment, Console& console);

/// "1000", "64K", "500M", "2.5G", "1T", also with "B" or "iB" behind: bytes, by powers of 1024.
Result<std::uint64_t> parseSize(const std::string& text);

}  // namespace sherd
