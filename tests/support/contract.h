// What every registered node must keep to, for any pack: load it into a Registry, write one graph in which
// each of its node types occurs with quick parameters, and hold each type to the rules below.
//
//   SHERD_ASSIGN(auto examples, Examples::read("examples.json", registry, environment, {"out=/tmp/…"}));
//   for (const NodeType* type : registry.all())
//     for (const std::string& fault : documentationFaults(*type, exceptions)) …
//
// A rule returns what breaks it, a line each that begins with "Type" or "Type.port"; nothing where it is
// kept.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "eval/cache.h"
#include "eval/node_run.h"
#include "graph/graph.h"
#include "graph/registry.h"

namespace sherd::test {

using Faults = std::vector<std::string>;

/// What is right although it looks wrong, decided by a person.
struct ContractExceptions {
  /// Numbers without a dimension, as "Type.param" or, of an output, "Type.port".
  std::set<std::string> dimensionless = {};
  /// First words of help texts that are capitalised: proper names and symbols.
  std::set<std::string> names = {};
  /// Variables of the environment that libraries read, by how they begin. What is listed must not change
  /// results.
  std::set<std::string> variables = {};
  /// Files that libraries open by themselves, by how their paths begin. What is listed must not change
  /// results.
  std::set<std::string> files = {};
};

// ---- Of the table alone. O(its size).

/// Names are words of [a-z][a-z0-9_]*; the node, every port and every parameter has help, which starts with a
/// small letter and ends without a full stop (the node's own is sentences); numbers have a unit (outputs at
/// the end of the help: "…, J"); defaults are in their ranges; choices are there.
Faults documentationFaults(const NodeType& type, const ContractExceptions& exceptions);

/// Dimensionless ones of this type's that don't apply: no such number, or one that has a unit.
Faults staleExceptions(const NodeType& type, const ContractExceptions& exceptions);

using RecipeWriter = std::function<void(Graph::Node&)>;
/// Each parameter alone changes the recipe; files to read do by content, wherever they are. `scratch`: an
/// existing directory, for such files. The recipe is writeRecipe()'s where no other is given.
Faults keyFaults(const NodeType& type, const std::string& scratch, const RecipeWriter& writer = {});

/// A wrong kind, and values just outside the range, are rejected with "file:line:column: node.param: ".
/// `registry`: where the graph that is checked finds the type.
Faults badValueFaults(const NodeType& type, const Registry& registry);

// ---- Of a node that runs.

/// A node of an example graph with all that it needs to run.
struct Example {
  const Graph* graph = nullptr;
  int node = 0;
  ParamValues params;
  std::vector<WireValue> inputs;

  const NodeType& type() const { return *graph->nodes[static_cast<std::size_t>(node)].type; }
  const std::string& name() const { return graph->nodes[static_cast<std::size_t>(node)].name; }
};

/// A graph in which every node type of a pack is to occur, and the values on its wires.
class Examples {
 public:
  /// Reads and checks the graph. `vars`: "name=value" each.
  static Result<std::unique_ptr<Examples>> read(const std::string& path, const Registry& registry,
                                                const Environment& environment,
                                                const std::vector<std::string>& vars);
  /// All nodes of this type, with inputs: what these need is evaluated, once for all calls. An Error where
  /// there is none, or where that fails.
  Result<std::vector<Example>> of(const NodeType& type);
  /// Types of the registry that occur nowhere.
  Faults missing(const Registry& registry) const;

 private:
  std::string path_;
  Graph graph_;
  Cache cache_;
};

/// Files and variables that the node reads without declaring them, on any thread. Needs read_watch.cpp in the
/// executable.
Faults undeclaredReads(const Example& example, const ContractExceptions& exceptions);

/// Outputs and written files are the same with one, two and four threads, and the second time. Sets the
/// thread limit, and sets it back.
Faults nondeterminism(const Example& example);

/// Saved on disk, read by another store and digested anew, outputs are what they were. `scratch`: an existing
/// directory.
Faults roundTripFaults(const Example& example, const std::string& scratch);

struct CancelTrial {
  std::uint64_t seed = 1;
  int delays = 6;  ///< one in each of so many equal parts of the node's usual duration, drawn by the seed
  double mostMs = 100;  ///< from the cancellation to the end
  int repetitions = 3;  ///< of a trial that took longer; the quickest counts, since the machine may be busy
};
struct CancelResult {
  Faults faults;
  double usualMs = 0;    ///< of an undisturbed run
  double longestMs = 0;  ///< from a cancellation to the end
  double longestAt = 0;  ///< what share of usualMs that cancellation came at
  int cancelled = 0;     ///< runs that were told to end before they were done
};
/// The node ends, as cancelled or done, soon after it is told to: in mostMs, or in three times the longest of
/// its uninterruptible calls where that is more. What counts is the lesser of time and processor time, the
/// latter over all threads.
CancelResult cancelling(const Example& example, const CancelTrial& trial = {});

}  // namespace sherd::test
