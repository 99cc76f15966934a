// Keeps painted regions whole: no crack can pass through them.
//
// A tetrahedron is protected where the field reaches the threshold in it: at a node, at the middle of an edge
// or of the whole, or anywhere on the part of the surface that it holds, which is sampled at its vertices
// and, in triangles longer than a quarter of the mean edge of the tetrahedra, at that distance; a tetrahedron
// within reach of a sample that is protected (0.58 of the distance between samples) is protected too.
// Protected tetrahedra that share a node are one region, and all nodes of a region get one place in the
// embedding: the mean of theirs by volume. In such a tetrahedron every site is as far from all four corners,
// so that the same site is nearest all over it: exactly, since equal coordinates give equal distances. Cracks
// run around.
#pragma once

#include <memory>

#include "base/exec.h"
#include "base/result.h"
#include "types/partition.h"
#include "types/scalar_grid.h"

namespace sherd {

struct ProtectParams {
  double threshold = 0.5;  ///< finite; the field protects from here on
};

/// Says how many regions there are and what share of the body they hold; warns where nothing or everything is
/// protected (then the embedding has one place). Without protection the result has the bits of the input.
/// Errors: an embedding without its tetrahedra, or whose coordinates don't belong to them; a field that isn't
/// finite on the body. Cost O(samples + tets · triangles held).
Result<Embedding> protect(const Embedding& embedding, const ScalarGrid& field, const ProtectParams& params,
                          const Exec& exec);

}  // namespace sherd
