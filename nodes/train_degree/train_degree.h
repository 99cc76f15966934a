// Examples of fracture for learning: the body is hit in many ways, and searched in each for its degree.
// Schvartzman and Otaduy (2014), section 3.2: drops from six heights with 64 uniformly distributed
// orientations, each searched three times; or balls thrown at it with several speeds (their wall). Impacts
// of an earlier shot may be added.
//
// Cheaper than that many fractures: all hits are solved with one factorization (simulate/simulate.h); those
// that differ in strength alone share a solution (train_degree/unit_load.h) and a search
// (train_degree/growth_path.h). An example depends on nothing of the others, and is kept where there is a
// memo: further heights cost what is new, another γ no drop and no solution, and a training that was killed
// goes on. The result is the same to the bit, however much of it was kept.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/exec.h"
#include "base/memo.h"
#include "base/result.h"
#include "learn_degree/learn_degree.h"
#include "simulate/simulate.h"
#include "train_degree/ball_hits.h"
#include "types/scalar_grid.h"

namespace sherd {

/// m: what no list of heights means.
inline const std::vector<double> kDropHeights{0.5, 1, 1.5, 2, 2.5, 3};
/// m/s: what no list of speeds means.
inline const std::vector<double> kBallSpeeds{2.5, 5, 7.5, 10, 12.5, 15};

struct TrainDegreeParams {
  /// What all hits have in common: materials, gravity, the ball, contacts. Scene, height, orientation,
  /// velocities and where a ball comes from don't matter.
  SimulateParams drop;
  std::vector<double> heights;     ///< m, > 0; empty: kDropHeights
  int orientations = 64;           ///< ≥ 0: of drops, each from all heights
  std::vector<BallHit> ballHits;   ///< each with all speeds
  int balls = 0;                   ///< ≥ 0: further hits, of spreadBallHits
  std::vector<double> ballSpeeds;  ///< m/s, > 0; empty: kBallSpeeds
  std::vector<Impact> impacts;     ///< of this body; those that hit nothing are left out
  int repeats = 3;                 ///< ≥ 1: searches of an example, with the seeds seed, seed + 1, …
  double alpha = 1;                ///< of the weights
  double gamma = 1e-4;             ///< J·m², > 0
  int maxDegree = 1000;            ///< ≥ 1: a search that is not below γ by then is left out
  std::int64_t seed = 1;           ///< also of the orientations and of the hits
  LearnDegreeParams learn;
};

enum class ExampleSource { Drop, Ball, Impact };

/// One hit, and what it came to.
struct DropExample {
  ExampleSource source = ExampleSource::Drop;
  Vec3 orientation = Vec3::Zero();  ///< of a drop: degrees, as RigidParams takes them
  double height = 0;                ///< of a drop: m
  BallHit hit;                      ///< of a ball
  double speed = 0;                 ///< of a ball: m/s
  std::size_t impact = 0;           ///< of an impact: its place among those given
  double strainEnergy = 0;          ///< J
  double wholeEnergy = 0;           ///< J·m², E_D of one site
  DegreeExample example;            ///< no searches where one of them was left out
};

struct DropExamples {
  std::vector<DropExample> drops;  ///< drops by orientation, then height; balls by hit, then speed; impacts
  std::vector<double> volume;      ///< m³, per node
  DegreeValidity validFor;
  /// What had to be computed: impacts of drops and balls, deformations, growth paths. Fewer than there are
  /// examples where some differ in strength alone, or were kept.
  std::size_t impacts = 0, solves = 0, paths = 0;
};

/// Hits and searches. `beta`: null for 1 everywhere. `memo`: where parts are kept, or null. Deterministic for
/// any number of threads, and whatever was kept. Errors: parameters out of range; those of dropUntilImpact,
/// eachImpactEnergy, weights and the search; a drop that never lands, a ball that misses; impacts of another
/// body; nothing to learn from; cancelled. Cost: one factorization, O(nodes^4/3) per hit, and a search per
/// orientation, hit or impact and repeat, in parallel. Memory: O(nodes) per example.
Result<DropExamples> dropExamples(const std::shared_ptr<const TetMesh>& tets,
                                  const std::shared_ptr<const Embedding>& embedding, const ScalarGrid* beta,
                                  const TrainDegreeParams& params, const Exec& exec, Memo* memo = nullptr);

struct TrainDegreeOutput {
  DegreeModel model;
  std::string table;  ///< CSV: a line per example with its searches and what the model says of it
};

/// Learns from these. Says how many there were and how far off the model is on orientations left out;
/// warns of examples left out. Errors: those of dropExamples and learnDegree; none that falls below γ.
Result<TrainDegreeOutput> trainDegree(const std::shared_ptr<const TetMesh>& tets,
                                      const std::shared_ptr<const Embedding>& embedding,
                                      const ScalarGrid* beta, const TrainDegreeParams& params,
                                      const Exec& exec, Memo* memo = nullptr);

/// The same from examples at hand.
Result<TrainDegreeOutput> learnFromDrops(const DropExamples& drops, const Embedding& embedding,
                                         const LearnDegreeParams& params, const Exec& exec);

}  // namespace sherd
