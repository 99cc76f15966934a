// Examples of fracture for learning: the body is dropped in many ways, and searched in each for its degree.
// Schvartzman and Otaduy (2014), section 3.2: drops from six heights with 64 uniformly distributed
// orientations, each searched three times.
//
// Cheaper than that many fractures: all drops are solved with one factorization (simulate/simulate.h);
// heights that differ in the strength of the hit alone share a search (train_degree/growth_path.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "learn_degree/learn_degree.h"
#include "simulate/simulate.h"
#include "types/scalar_grid.h"

namespace sherd {

/// m: what no list of heights means.
inline const std::vector<double> kDropHeights{0.5, 1, 1.5, 2, 2.5, 3};

struct TrainDegreeParams {
  SimulateParams drop;          ///< scene Floor; height and orientation don't matter
  std::vector<double> heights;  ///< m, > 0; empty: kDropHeights
  int orientations = 64;        ///< ≥ 1
  int repeats = 3;              ///< ≥ 1: searches of a drop, with the seeds seed, seed + 1, …
  double alpha = 1;             ///< of the weights
  double gamma = 1e-4;          ///< J·m², > 0
  int maxDegree = 1000;         ///< ≥ 1: a search that is not below γ by then is left out
  std::int64_t seed = 1;        ///< also of the orientations
  LearnDegreeParams learn;
};

/// One drop, and what it came to.
struct DropExample {
  Vec3 orientation = Vec3::Zero();  ///< degrees, as RigidParams takes them
  double height = 0;                ///< m
  double strainEnergy = 0;          ///< J
  double wholeEnergy = 0;           ///< J·m², E_D of one site
  DegreeExample example;            ///< no searches where one of them was left out
};

struct DropExamples {
  std::vector<DropExample> drops;  ///< by orientation, then height
  std::vector<double> volume;      ///< m³, per node
  DegreeValidity validFor;
  std::size_t paths = 0;  ///< searches that were made; fewer than drops · repeats where heights share one
};

/// Drops and searches. `beta`: null for 1 everywhere. Deterministic for any number of threads. Errors:
/// parameters out of range; those of dropUntilImpact, impactEnergies, weights and the search; a drop that
/// never lands; cancelled. Cost: one factorization, O(nodes^4/3) per drop, and orientations · repeats
/// searches, in parallel.
Result<DropExamples> dropExamples(const std::shared_ptr<const TetMesh>& tets,
                                  const std::shared_ptr<const Embedding>& embedding, const ScalarGrid* beta,
                                  const TrainDegreeParams& params, const Exec& exec);

struct TrainDegreeOutput {
  DegreeModel model;
  std::string table;  ///< CSV: a line per drop with its searches and what the model says of it
};

/// Learns from these drops. Says how many there were and how far off the model is on orientations left out;
/// warns of drops left out. Errors: those of dropExamples and learnDegree; no drop that falls below γ.
Result<TrainDegreeOutput> trainDegree(const std::shared_ptr<const TetMesh>& tets,
                                      const std::shared_ptr<const Embedding>& embedding,
                                      const ScalarGrid* beta, const TrainDegreeParams& params,
                                      const Exec& exec);

/// The same from drops at hand.
Result<TrainDegreeOutput> learnFromDrops(const DropExamples& drops, const Embedding& embedding,
                                         const LearnDegreeParams& params, const Exec& exec);

}  // namespace sherd
