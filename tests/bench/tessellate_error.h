// How far crack vertices lie from where the cells' exact borders are.
#pragma once

#include <array>
#include <vector>

#include "types/fragments.h"
#include "types/partition.h"

namespace sherd::bench {

/// Distances in the embedding, over its diameter.
struct CrackError {
  double rms = 0, maximum = 0;
  std::size_t vertices = 0;  ///< crack vertices, once per pair of cells that they lie between
};

/// A crack vertex between cells i and j should be equally far from both sites, and no nearer to any other.
/// The embedding is interpolated linearly within the tetrahedron that holds the vertex. Its error is the
/// distance to the bisector of i and j, or how deep it lies in the cell of a third site, whichever is more.
CrackError crackError(const Fragments& fragments, const Partition& cells);

/// Volumes of all pieces of each cell, over the body's.
std::vector<double> cellVolumes(const Fragments& fragments);

/// Volumes of the cells within a convex body, over the body's, by clipping every tetrahedron to the body and
/// to each cell. `planes`: n · x ≤ c as (n, c). Cost O(tets · sites).
std::vector<double> convexReference(const Partition& cells, const std::vector<Vec4>& planes);

/// Points in a body, in two sets that have nothing in common.
struct SamplePoints {
  std::array<std::vector<Vec3>, 2> sets;
};
/// In each cube of a grid over the surface's box one random point, kept where it is inside; and once more.
SamplePoints pointsWithin(const TriMesh& surface, int cubesPerAxis);

struct SampledVolumes {
  std::vector<double> volumes;  ///< over the body's
  double bar = 0;               ///< half the largest difference between the two sets
  std::size_t points = 0;
};
/// The points' nearest sites in the embedding, interpolated linearly in the tetrahedron that holds the point.
SampledVolumes sampledVolumes(const Partition& cells, const SamplePoints& points);

/// Largest |a − b|.
double largestDifference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace sherd::bench
