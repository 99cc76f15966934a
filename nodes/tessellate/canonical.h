// The paper's cells: four schemes on the labels at the nodes (paper section 4, Figure 10).
#pragma once

#include "tessellate/sheets.h"
#include "types/partition.h"

namespace sherd {

/// The paper's four schemes on the labels at the nodes. With s_ij = ‖x̄_i − p̄_j‖² the vertex of a simplex
/// whose nodes i carry different labels solves Sᵀ b = d 1, Σ b = 1 (squared distances, which are affine up to
/// a common term, instead of the paper's distances; Dᵀ instead of its D, so that the vertex of an edge lies
/// on that edge). A solution outside of its simplex, or within a hundredth of its border, is drawn towards
/// the mean of the vertices of the simplex's edges as far as needed. Where the five triangles of the (2, 1,
/// 1) scheme would cross each other, eight that meet in an inner vertex take their place. Cost O(tetrahedra).
Sheets canonicalSheets(const Partition& partition);

}  // namespace sherd
