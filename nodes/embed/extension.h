// Values on a closed surface, carried to points inside it.
#pragma once

#include <Eigen/Core>
#include <span>

#include "base/exec.h"
#include "base/result.h"
#include "types/tet_mesh.h"
#include "types/vec.h"

namespace sherd {

/// Mean value coordinates of `point` with respect to a closed, outward-oriented triangle surface (Ju,
/// Schaefer and Warren 2005, in the vector form of their section 3): one weight per vertex, summing to 1 and
/// reproducing linear functions to rounding. A point on a face gets that face's barycentric coordinates.
/// Weights are negative where the surface faces away. All weights are NaN where they cancel (a point
/// outside). Cost O(triangles).
Eigen::VectorXd meanValueCoordinates(const Vec3& point, std::span<const Vec3> positions,
                                     std::span<const Triangle> triangles);

/// u harmonic in the mesh (linear finite elements) with the given values at some nodes.
/// `given`: per node, whether its row of `values` (nodes × k) is given; the other rows are filled in.
/// `stretch`: as in solidLaplacian.
Result<void> extendHarmonically(std::span<const Vec3> nodes, std::span<const Tetra> tets,
                                const std::vector<char>& given, Eigen::MatrixXd& values,
                                std::span<const double> stretch = {});

}  // namespace sherd
