// The graphs of a command line, opened and put together so that they can be planned and run as one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "eval/disk_store.h"
#include "eval/history.h"
#include "graph/graph.h"

namespace sherd {

/// What `run`, `plan` and `check` have in common.
struct ShotOptions {
  std::vector<std::string> graphs;  ///< files, directories (all *.json in them) and patterns with * ? [ ]
  std::string target, to;           ///< what to evaluate; both empty: the default of wantedNodes
  std::vector<std::string> sets;    ///< "node.param=value"
  std::vector<std::string> vars;    ///< "name=value"
  std::optional<std::string> frames;
  std::vector<std::string> allowWrite;  ///< directories that may be written into besides the graph's own
  std::string cache;                    ///< directory; empty: the default one
  std::string cacheSize;                ///< its bound, as cacheSize() takes it
  bool noCache = false;
};

/// One graph of several, or the only one.
struct Shot {
  std::string path;  ///< as it was named
  std::string name;  ///< for messages and tables: the file's name without its ending, or more of the path
                     ///< where two agree
};

struct Shots {
  std::vector<Shot> shots;
  Graph graph;                     ///< all of them
  std::vector<int> wanted;         ///< in it
  std::vector<bool> isSubgraph;    ///< per shot: the file holds a subgraph, which only `check` may open
  std::vector<std::string> notes;  ///< for the user, on what is read otherwise than it is written
};

/// The files that the options name, in their order, directories and patterns replaced by what is in them,
/// each once. An argument that names nothing is reported.
std::vector<std::string> graphFiles(const std::vector<std::string>& arguments, Diagnostics& diagnostics);

enum class Opening {
  ToRun,    ///< what is wanted must be sound in its files, too, and no graph may be a subgraph
  ToCheck,  ///< all nodes must
};

/// Opens and checks all graphs. Usable only where `diagnostics` stays empty.
Shots openShots(const ShotOptions& options, Opening opening, const Registry& registry,
                const Environment& environment, Diagnostics& diagnostics);

/// The disk cache that the options ask for; null for none. The default one may be unusable: that is a warning
/// on `err`, and null. One that was asked for by name must work.
Result<std::unique_ptr<DiskStore>> openStore(const ShotOptions& options, const Environment& environment,
                                             std::ostream& err);

/// What the store knows of the last runs, by shot.
std::vector<History> readHistories(const Shots& shots, const DiskStore* store);
/// Keeps what became of this run.
void writeHistories(const Shots& shots, const EvalReport& report, DiskStore& store);
}  // namespace sherd
