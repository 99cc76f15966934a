// Bodies of any size for scaling measurements: spheres in a block of tetrahedra, made in linear time.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "types/tet_mesh.h"
#include "types/tri_mesh.h"

namespace sherd::bench {

/// A sphere of about `triangles` triangles of equal size, made of a cube's sides.
TriMesh roundedCube(const Vec3& centre, double radius, std::size_t triangles);

/// A block of cubes around the surface, n along its longest side, six tetrahedra each. Cost O(tetrahedra +
/// triangles).
std::shared_ptr<const TetMesh> blockAround(TriMesh surface, int n);

/// `count` points drawn uniformly from the ball.
std::vector<Vec3> sitesInBall(const Vec3& centre, double radius, std::size_t count, std::uint64_t seed);

}  // namespace sherd::bench
