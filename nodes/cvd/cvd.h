// Centroidal Voronoi diagram of the body in its embedding: Lloyd's method on the nodes of the cage.
// Schvartzman and Otaduy (2014), section 2.2, Algorithm 2, equation (4).
//
//   E_D = Σ_n w_n ‖x̄_n − p̄_label(n)‖²     (J·m²)
//
// Deviations from the paper
// - A site moves to Σ w x̄ / Σ w, the minimiser of E_D; equation (4) divides by the number of nodes. A cell
//   whose weights are all zero takes volumes V_n as weights; one without either, or without nodes, stays.
// - Labels are the nearest sites (`exact`); the paper's flooding (`flood`) is there to compare with. There,
//   distances and queue start anew in every pass (the listing never resets them), and W in line 11, which
//   cancels where two sites are compared at one node and breaks where W = 0, plays no part. It visits what
//   the graph of the mesh connects to a site's nearest node; nodes that no flood reaches take their nearest
//   site.
// - The paper's 1e-7 is relative to the embedding's diameter; unchanged labels also end the iteration.
// - Sites move farther than to their centroids while many labels change (LloydLimits::relaxation).
// - A diagram of one cell has its site at the body's centroid by volume, wherever the energy is.
// - Sites are added one at a time, drawn with probability ∝ w ‖x̄ − p̄‖² (the paper: all at once, ∝ w), with a
//   few passes of Lloyd's iteration after each. E_D can then not rise with their number, which a search for a
//   threshold relies on.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/exec.h"
#include "base/result.h"
#include "types/fields.h"
#include "types/partition.h"

namespace sherd {

enum class Labels { Exact, Flood };

/// How far sites move in a pass, and when Lloyd's iteration ends: no label changed, no site moved farther
/// than tolerance · Embedding::diameter, or after so many passes.
///
/// relaxation ω: sites move ω times as far as to their centroids until one label in a hundred or fewer
/// changes in a pass; from then on just to them, so that all ends at centroids. For fixed labels a site's
/// share of E_D is W ‖p − c‖² and a constant, and (1 − ω)² ≤ 1: for ω in (0, 2] E_D doesn't rise either.
/// Measured (tests/bench): with 1.8 E_D at the end is 1 to 5 % lower than with 1, in fewer passes or about as
/// many.
struct LloydLimits {
  double tolerance = 1e-7;
  int maxIterations = 1000;
  double relaxation = 1.8;
};

struct CvdParams {
  int degree = 0;         ///< N ≥ 0; 0: as many as the sites given
  std::int64_t seed = 1;  ///< of the draw of further sites
  Labels labels = Labels::Exact;
  double tolerance = LloydLimits{}.tolerance;
  int maxIterations = LloydLimits{}.maxIterations;
};

/// `start`: d × N sites of the same embedding, or null. With `degree` 0 or N they are where the iteration
/// starts; with a higher degree, more are grown from them; with a lower one, or null, all are grown from one,
/// or from those pinned. (Growing from one, or from those pinned, to N gives what PredictDegree's search
/// gives at N for the same seed.) Pinned ones never move; a warning says which of them are nearest to no
/// node. More sites than there are distinct nodes are not grown; a warning says so.
/// Sites given may coincide, and cells may be empty. γ is that of the sites given, unless `degree` asks for
/// another number. Says N, E_D, γ and how it ended. The result's sites are its cells' centroids (within the
/// tolerance), where they aren't pinned, and its labels exactly the nearest of these sites, the lower index
/// where two are equally near (`exact`). Errors: sizes or dimensions that don't match; coordinates, weights
/// or sites that are not finite; a body narrower than 1e-150 m or wider than 1e150 m, whose squares aren't
/// numbers; neither sites nor degree; more pinned sites than the degree. Cost per pass O(nodes · N · d) at
/// worst, far less where few sites move.
Result<Partition> cvd(const std::shared_ptr<const Embedding>& embedding, const WeightField& weights,
                      const Sites* start, const CvdParams& params, const Exec& exec);

// What the search for the degree shares.

/// Are these of one body, and finite?
Result<void> checkLloydInput(const Embedding& embedding, const WeightField& weights);

/// Are these sites of this embedding, finite, and at least one? Errors are of the port named.
Result<void> checkSites(const Embedding& embedding, const Sites& sites, const char* port);

/// Σ V x̄ / Σ V, m; the mean of the nodes where all volumes are zero.
Eigen::VectorXd bodyCentroid(const Embedding& embedding, const WeightField& weights);

struct LloydState;

/// Sites, and every node's nearest of them, kept exact while sites are added and moved.
///
/// Same labels, sites and energies to the last bit as comparing all nodes with all sites in every pass: what
/// is left out is proved not to matter. Nodes are compared in blocks of sixteen and in single precision, with
/// a bound of its error; only where that leaves two sites possible are exact squares compared
/// (cvd/distance.h). Where their own site stayed nodes are compared only with sites that moved; per (node,
/// site) a lower bound of the distance, lessened by how far the site has moved since, rules out most of the
/// others (Elkan, ICML 2003); and from 2¹⁸ pairs on a cell's nodes are compared only with sites within twice
/// its radius. Centroids: Σ w x̄ and Σ w over the cell's nodes in each block of sixteen in ascending order,
/// these sums added over the blocks, and divided. Bounds take 4 to 8 bytes · nodes · N; beyond 256 MB they
/// are not kept, which costs time only. The sums take 8 (d + 1) bytes for each pair of a block and a cell in
/// it, some 1.3 pairs a block where nodes are numbered along a space-filling curve, as Tetrahedralize does;
/// in random order all costs more, though nothing else changes.
class Lloyd {
 public:
  /// Input that passes checkLloydInput; kept by reference. Where `exec` is cancelled, here or below, labels
  /// are incomplete from then on: there is nothing to do but to end.
  Lloyd(const Embedding& embedding, const WeightField& weights, const Exec& exec = {});
  ~Lloyd();
  Lloyd(Lloyd&&) noexcept;

  struct End {
    int iterations = 0;
    bool converged = false;
  };

  /// One site more; labels follow. `position`: d numbers, m.
  void addSite(const Eigen::Ref<const Eigen::VectorXd>& position, const Exec& exec);
  /// From now on the first `count` sites stay where they are: no iteration moves them.
  void pin(std::size_t count);
  /// Lloyd's iteration from the sites as they are, with exact labels. The energy doesn't rise.
  Result<End> run(const LloydLimits& limits, const Exec& exec);
  /// The same with labels by flooding over the edges of the embedding's mesh. May end without converging.
  Result<End> runFlood(const LloydLimits& limits, const Exec& exec);

  std::size_t siteCount() const;
  std::size_t pinnedCount() const;
  std::size_t nodeCount() const;
  Eigen::MatrixXd sites() const;                        ///< d × N, m
  const std::vector<Index>& labels() const;             ///< per node
  const std::vector<double>& squaredDistances() const;  ///< m², per node, to its site
  double energy() const;                                ///< J·m²: E_D

 private:
  std::unique_ptr<LloydState> state_;
};

enum class Growth {
  ByEnergy,  ///< only where a new site lowers E_D
  ByVolume,  ///< also where there is no energy: then ∝ V ‖x̄ − p̄‖², and at last ∝ ‖x̄ − p̄‖²
};

/// What growth begins with: the pinned ones of `pinned`, which stay where they are; where that is null or has
/// none, one site at the body's centroid.
Lloyd firstSites(const Embedding& embedding, const WeightField& weights, const Sites* pinned,
                 const Exec& exec);

/// Draws a node by `seed` and the number of sites so far. None where every node (that weighs) has a site of
/// its own place, or where there are as many sites as nodes.
std::optional<Index> drawSite(const Lloyd& lloyd, const Embedding& embedding, const WeightField& weights,
                              Growth growth, std::int64_t seed);

/// Passes of Lloyd's iteration after each site that is added. Measured on horse, bunny, mushroom and wall
/// (tests/bench): reaching N takes 1 to 5 times one iteration at N, against up to twice that where each
/// addition is followed to its end; E_D at the end and the N found for a γ differ by less than another seed
/// makes.
inline constexpr int kGrowthPasses = 3;

/// Adds a drawn site and runs kGrowthPasses of Lloyd's iteration: run() afterwards for the end of it. False
/// where none could be drawn: nothing has changed then.
Result<bool> growSite(Lloyd& lloyd, const Embedding& embedding, const WeightField& weights, Growth growth,
                      std::int64_t seed, const Exec& exec);

}  // namespace sherd
