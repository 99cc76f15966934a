// What a run would do, and why, without doing any of it.
#pragma once

#include <string>
#include <vector>

#include "eval/evaluator.h"
#include "eval/history.h"
#include "graph/graph.h"

namespace sherd {

enum class PlanState {
  Hit,        ///< will be a hit
  Run,        ///< will run
  Follows,    ///< runs unless what it waits for makes the same result as before, which nobody can know
  NotNeeded,  ///< nothing that is wanted needs it
};
/// "hit", "run", "follows", "not needed".
const char* planStateName(PlanState state);

struct PlanEntry {
  int node = 0;
  PlanState state = PlanState::NotNeeded;
  std::string why;          ///< "young_modulus 2e6 → 3e6"; empty for a plain hit
  double ms = 0;            ///< what it took when it last ran, of those that will run; 0: unknown
  std::uint64_t bytes = 0;  ///< of the known outputs
};

/// One entry per node of the graph, in its order. evaluate() with the same arguments and nothing changed in
/// between does what this says: what is Hit is a hit, what is Run runs (or fails), and what Follows does
/// either. Runs no node; reads input files that the store doesn't know by identity. O(nodes + wires).
/// `histories` has one entry per shot of the graph, or none.
std::vector<PlanEntry> planRun(const Graph& graph, const std::vector<int>& wanted, Cache& cache,
                               const EvalOptions& options, const std::vector<History>& histories);

}  // namespace sherd
