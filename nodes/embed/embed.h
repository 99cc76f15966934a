// Coordinates in which straight distances are the body's distances.
// Schvartzman and Otaduy (2014), section 2.2; Rustamov, Lipman and Funkhouser (2009), "Interior
// distance using barycentric coordinates".
//
// A convex body has its positions about the centroid for coordinates: nothing else is computed.
// Any other gets combinations of its positions X and the lowest eigenmodes φ_k of a Laplacian for coordinates
// x̄_n, such that ‖x̄_i − x̄_j‖ is about the length of the shortest way from i to j inside (m).
//
// Choices
// - filter unfolded: the linear map of (X, φ_1, …, φ_K) to at most eight dimensions that comes closest to the
//   lengths of ways inside (unfold.h).
// - filter fitted: x̄_n = (f_0 X_n, f_1 φ_1(n), f_2 φ_2(n), …) with factors fitted to these lengths.
// - filter diffusion: f_0 = 0, f_k = exp(−λ_k t), t = time / λ_1, scaled so that embedded edges match
//   edge lengths in the least-squares sense (Rustamov et al.).
// - source solid: modes of the tetrahedral mesh itself. There is nothing to extend, and a void's
//   shell hangs together with the outer one.
// - source surface: modes of the cage's boundary, carried inward by mean value coordinates or
//   harmonically. From one side of a thin wall to the other it leads over the rim: with the diffusion
//   filter cells split the wall in its thickness. A part with a void always takes solid.
// - source fine: modes of the model's own surface (fine_source.h); nodes outside of it get those of its
//   closest point. Not for rest shapes, which have no surface of their own.
//
// Measured as stress: root mean square error of distances over that of lengths, after the best scaling.
// Bodies over a plan, against exact shortest ways, and cages of 5,000 tetrahedra, against paths (tests/bench,
// with times; 32 modes of the solid, horse 74, bunny 147):
//
//                               L     U     ring  spiral  horse  bunny
//   straight distances         0.069 0.332  0.095  0.556  0.134  0.077
//   unfolded                   0.029 0.031  0.077  0.023  0.032  0.019
//   fitted                     0.046 0.110  0.074  0.098  0.079  0.049
//   diffusion, time ½          0.210 0.179  0.141  0.112  0.351  0.485
//   diffusion, surface         0.166 0.161  0.115  0.108  0.158  0.227
//
// No flat space holds the distances around a ring. More than 32 modes gain next to nothing under any filter;
// source surface or fine, and the way of extension, change unfolded by 0.001. Edge lengths are met within 4
// to 11 % rms (fitted: 3 to 50 %). For diffusion no other time tried (⅛ to 1/128) and no power of λ (−½ to
// −3/2) is good on all: long bodies keep no coordinate across. One γ gives 7, 32, 126, 366 pieces of a 3:2:2
// box under unfolded where straight distances give 7, 33, 125, 364 (7:1:1 bar: 2, 5, 20, 49 and 2, 5, 20, 48;
// under diffusion 7, 21, 66, 144 and 3, 5, 6, 9).
//
// Deviation from the paper: the defaults are solid and unfolded, for these reasons.
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
// convex body's short cut is not taken. Under the filters `unfolded` and `fitted` coordinates from the
// lengths of paths (unfold.h) stand for the modes, whatever the source: a band's stiffness hides from low
// modes how far it is across.
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
  enum class Source { Solid, Surface, Fine };
  enum class Filter { Unfolded, Fitted, Diffusion };
  enum class Extension { MeanValue, Harmonic };  ///< of Source::Surface and Fine to interior nodes
  Metric metric = Metric::Auto;
  Source source = Source::Solid;
  Filter filter = Filter::Unfolded;
  Extension extension = Extension::Harmonic;
  int dimensions = 32;      ///< ≥ 1: modes computed, at most
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
