// Coordinates in which straight distances are the body's distances.
// Schvartzman and Otaduy (2014), section 2.2; Rustamov, Lipman and Funkhouser (2009), "Interior
// distance using barycentric coordinates".
//
// A convex body has its positions about the centroid for coordinates: nothing else is computed.
// Any other gets its positions X and the lowest eigenmodes φ_k of a Laplacian, each times a factor:
//
//   x̄_n = (f_0 X_n, f_1 φ_1(n), f_2 φ_2(n), …)
//
// so that ‖x̄_i − x̄_j‖ is about the length of the shortest way from i to j inside (m).
//
// Choices
// - filter fitted: f_k fitted to lengths of paths inside. Where the body is convex f_0 is near 1 and
//   the modes near 0; modes come in where ways lead around something.
// - filter diffusion: f_0 = 0, f_k = exp(−λ_k t), t = time / λ_1, scaled so that embedded edges match
//   edge lengths in the least-squares sense (Rustamov et al.).
// - source solid: modes of the tetrahedral mesh itself. There is nothing to extend, and a void's
//   shell hangs together with the outer one.
// - source surface: modes of the cage's boundary, carried inward by mean value coordinates or
//   harmonically. From one side of a thin wall to the other it leads over the rim: with the diffusion
//   filter cells split the wall in its thickness. A part with a void always takes solid.
//
// Measured as stress: root mean square error of distances over that of lengths of geodesics, after
// the best scaling. Bodies of cubes (U, open box with walls one cube thick, 7:1:1 bar, 3:2:2 box), and
// cages of 5,000 tetrahedra (horse, fertility) against path lengths:
//
//                               U    open box  bar   box   horse  fertility
//   straight distances         0.31    0.12    0.00  0.01   0.12    0.11
//   fitted, solid              0.11    0.08    0.02  0.02   0.07    0.07
//   fitted, surface            0.10    0.11    0.02  0.02   0.06    0.07
//   diffusion, surface, time ½ 0.16    0.36    0.12  0.08   0.16    0.17
//   diffusion, solid, time ½   0.17    0.13    0.13  0.11   0.36    0.20
//
// No other time tried (⅛ to 1/128) and no power of λ tried (−½ to −3/2) is good on all. Fitted takes 6 to 19
// dimensions. Under it edge lengths are met within 3 to 17 % rms (solid); under diffusion they are up to 75 %
// off, since long bodies keep no coordinate across. One γ gives 6, 24, 95, 275 pieces of the box under fitted
// where straight distances give 6, 23, 94, 264 (bar: 2, 4, 13, 35 and 2, 4, 10, 31; diffusion: 3, 4, 6, 8).
// Harmonic extension and mean value coordinates differ by 0.001; the latter dip to −0.007 in the U.
//
// Deviation from the paper: the defaults are solid and fitted, for these reasons.
//
// Rest shapes (the paper's section 2.4). Distances are those of the warped nodes, whatever they are used for:
// straight ones between warped positions where the body as it is is convex (or metric is euclidean),
// otherwise modes, lengths of paths and edges are all taken there. Tetrahedra may come out inside out:
// straight distances don't mind, and interior ones take such a tetrahedron for its mirror image (a warning
// counts them).
//
// Stretch (not in the paper). Lengths count s(x) times as much: the metric is s² I. An edge has the mean of
// its ends' s, a tetrahedron the mean of its corners': stiffness is s and mass s³ as large, path and edge
// lengths s. Where s is large, places are far from each other, so that the middle between two sites, a sheet,
// tends to lie there: painted along a curve, it draws cracks. Straight distances don't know this, so that a
// convex body's short cut is not taken. Under the filter `fitted` coordinates from the lengths of paths
// (filter.h) stand for the modes, whatever the source: a band's stiffness hides from low modes how far it is
// across.
#pragma once

#include <memory>

#include "base/exec.h"
#include "base/result.h"
#include "types/partition.h"
#include "types/rest_shape.h"
#include "types/scalar_grid.h"

namespace sherd {

struct EmbedParams {
  enum class Metric { Auto, Euclidean, Interior };  ///< Auto: Euclidean where the body is convex
  enum class Source { Solid, Surface };
  enum class Filter { Fitted, Diffusion };
  enum class Extension { MeanValue, Harmonic };  ///< of Source::Surface to interior nodes
  Metric metric = Metric::Auto;
  Source source = Source::Solid;
  Filter filter = Filter::Fitted;
  Extension extension = Extension::Harmonic;
  int dimensions = 64;      ///< ≥ 1: modes computed, at most
  double tolerance = 1e-3;  ///< in [0, 1): modes whose part of the coordinates is smaller, relative to the
                            ///< largest, are left out
  double time = 0.5;        ///< > 0: t λ_1 of Filter::Diffusion
};

/// How an artist bends the metric.
struct MetricControls {
  const RestShape* rest = nullptr;      ///< of the same body; null: the body as it is
  const ScalarGrid* stretch = nullptr;  ///< s, in the body as it is, in [0.001, 1000]; null: 1 everywhere
};

/// Convex means that the surface's convex hull holds at most 1e-6 more volume than the surface.
/// Parts of the body that aren't connected share axes, and stand 2 · (size of the body) or more apart along
/// one more. Coordinates are about the mean by volume; signs of modes are fixed; invariant under rigid motion
/// (to rounding, where eigenvalues are distinct), in proportion to the size. Says the metric, and how well
/// edges are met. A rest shape that is the body, and a stretch of 1, give the same bits as none. Errors: an
/// empty mesh; a rest shape of another body; a stretch out of range, or with Metric::Euclidean; parameters
/// out of range; libraries' failures. Cost: hull O(n log n); then that of factoring the Laplacian and
/// `dimensions` modes.
Result<Embedding> embed(const std::shared_ptr<const TetMesh>& tets, const EmbedParams& params,
                        const Exec& exec, const MetricControls& controls = {});

}  // namespace sherd
