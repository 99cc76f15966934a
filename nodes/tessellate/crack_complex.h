// The sheets between the cells, tetrahedron by tetrahedron, before anything is clipped (paper section 4,
// Figure 10).
#pragma once

#include <array>
#include <vector>

#include "types/partition.h"
#include "types/vec.h"

namespace sherd {

/// A triangle of a sheet. Its corners turn counter-clockwise seen from the front.
struct CrackTriangle {
  Triangle corners;   ///< into CrackComplex::vertices
  Index front, back;  ///< the cells on its two sides; they differ
  Index tet;          ///< the tetrahedron that holds it
};

/// All sheets. Triangles meet only in shared vertices and edges, where the vertices are shared by number: a
/// vertex belongs to a tetrahedral edge, face or tetrahedron and is computed once. Around an edge the cells
/// are all different, so that each cell appears there in one wedge.
struct CrackComplex {
  std::vector<Vec3> vertices;  ///< m
  std::vector<CrackTriangle> triangles;
  std::vector<bool> onCage;  ///< per vertex: lies on the cage's boundary, hence outside of the surface
  std::size_t cutTets = 0;   ///< tetrahedra with more than one label
};

/// The paper's four schemes on the labels at the nodes. With s_ij = ‖x̄_i − p̄_j‖² the vertex of a simplex
/// whose nodes i carry different labels solves Sᵀ b = d 1, Σ b = 1 (squared distances, which are affine up to
/// a common term, instead of the paper's distances; Dᵀ instead of its D, so that the vertex of an edge lies
/// on that edge). A solution outside of its simplex, or within a hundredth of its border, is drawn towards
/// the mean of the vertices of the simplex's edges as far as needed. Where the five triangles of the (2, 1,
/// 1) scheme would cross each other, eight that meet in an inner vertex take their place. Cost O(tetrahedra).
CrackComplex canonicalCrackComplex(const Partition& partition);

}  // namespace sherd
