// The fracture degree as a function of the strain energy, learned from examples.
// Schvartzman and Otaduy (2014), section 3: principal components of the weights of all examples, and a
// network of radial basis functions φ(r) = r with a bias on them.
//
// What it learns from. An example is one field of weights w and the degrees that searches with several seeds
// found for it. Of each search it takes, beside the degree N, the place ν in (N − 1, N] where the line
// through log E_D(N − 1) and log E_D(N) over log N falls to γ: N = ⌈ν⌉.
//
// Three methods.
// - `Process`: a Gaussian process for y = log ν − log ν_t. ν_t is the number of cells of a fixed tree over
//   the nodes that brings the energy below γ (learn_degree/split_tree.h): a stand-in for the search that
//   takes microseconds and is off by a fifth. What is learned is by how much, from the logarithms of
//     ν_t, and ν_t for 4 γ
//     E_1 / γ   E_1 = Σ w ‖x̄ − c‖²: E_D of the whole body, c its centroid by volume
//     S / γ     S = Σ w ‖x̄ − c_w‖² about the weighted centroid
//     Z_p / γ   Z_p = V^(2−(1−p)/p) … (Σ V_n^(1−p) w_n^p)^(1/p), p = 3/4 and 1/2, scaled to J·m² by powers of
//               V = ΣV_n: how concentrated the weights are. With p = d/(d + 2), what E_D of the best N sites
//               in d dimensions tends to, but for a constant, times N^(-2/d) (Zador 1982, "Asymptotic
//               quantization error of continuous signals")
//   and the principal components of w / Σw. The covariance is Matérn's with ν = 5/2 over all inputs around an
//   unknown mean, so that far from all examples the ratio is their mean's, and the stand-in carries the law;
//   lengths and noise are those of the largest marginal likelihood on a grid. E_1 < γ is known at once to
//   give one piece.
// - `Network`: the paper's. Inputs are the principal components of w, the output is N. Centres are examples,
//   added by orthogonal least squares (Chen, Cowan and Grant 1991) until the error on the examples falls
//   below `trainingError` of the mean degree, and no more of them than give the least error on groups left
//   out.
// - `Exact`: what the paper's `newrbe` does: a centre at every distinct example, interpolating the mean of
//   its degrees.
//
// Principal components are taken until what is left of the centred examples X, ‖X − X_k‖_F, is at most
// `tolerance` · ‖X‖_F: with 2 %, the components hold all but 0.0004 of the variance. At least one is kept.
//
// All inputs are ratios: the model does not depend on units.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/degree_model.h"
#include "types/fields.h"
#include "types/partition.h"

namespace sherd {

struct DegreeExample {
  std::vector<double> weight;    ///< J, per node
  std::vector<int> degree;       ///< N ≥ 1, per search; at least one
  std::vector<double> crossing;  ///< ν > 0, per search
  int group = 0;  ///< examples that resemble each other (an orientation's heights): left out together
};

struct LearnDegreeParams {
  DegreeMethod method = DegreeMethod::Process;
  double tolerance = 0.02;      ///< of the principal components, in [0, 1)
  double trainingError = 0.01;  ///< of a network, share of the mean degree, ≥ 0
};

/// Finds the model for these examples, valid for `validFor`, with errors by fitting five times without a
/// fifth of the groups, with the number of centres or the lengths found for all (none where there is one
/// group: `errors.examples` is 0). `examples`: of the body of `embedding`, whose nodes have these `volume`s
/// (m³); they may repeat, be proportional, or be all alike. At most 512 of them, evenly chosen, shape the
/// components and may be centres; a network's coefficients are fitted to all. Errors: no example; one that
/// has not a finite weight ≥ 0 per node, or no search, by its number from 1; γ not above 0; parameters out of
/// range; cancelled. Cost: O(examples · nodes · components) and 60 · 512³.
Result<DegreeModel> learnDegree(std::span<const DegreeExample* const> examples, const Embedding& embedding,
                                const std::vector<double>& volume, const DegreeValidity& validFor,
                                const LearnDegreeParams& params, const Exec& exec);
Result<DegreeModel> learnDegree(const std::vector<DegreeExample>& examples, const Embedding& embedding,
                                const std::vector<double>& volume, const DegreeValidity& validFor,
                                const LearnDegreeParams& params, const Exec& exec);

struct DegreeEstimate {
  int degree = 1;  ///< N ≥ 1
  /// Standard deviation of the N that one search would find, its seed's share in it; 0 where it isn't asked
  /// for, or the method knows none.
  double deviation = 0;
  double distance = 0;     ///< to the nearest example, in what the model compares
  bool isOutside = false;  ///< distance > reach: nothing like it was learned
};

enum class Deviation { Unknown, Known };

/// `weights` and `embedding` that checkValidity accepts. No more than 2^20 pieces are foretold. Cost O(nodes
/// · (components + dimensions) + examples · components + N (dimensions + log N)); with the deviation also
/// O(centres²).
DegreeEstimate estimateDegree(const DegreeModel& model, const WeightField& weights,
                              const Embedding& embedding, Deviation deviation = Deviation::Unknown);

/// What a degree for these depends on.
DegreeValidity validityOf(const WeightField& weights, const std::shared_ptr<const Embedding>& embedding,
                          double gamma);
/// An error that names all that differs from what the model was made for.
Result<void> checkValidity(const DegreeModel& model, const DegreeValidity& wanted);

}  // namespace sherd
