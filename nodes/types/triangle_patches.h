// A body's surface in small connected patches, made once: what a cut does not touch it handles by the patch.
#pragma once

#include <span>
#include <vector>

#include "types/solid_sums.h"

namespace sherd {

struct TrianglePatches {
  /// Triangles of patch p: triangles[begin[p]] … triangles[begin[p + 1] − 1], ascending, connected by
  /// TriMesh edges. Every triangle is in one patch.
  std::vector<Index> begin, triangles;
  std::vector<Index> patchOf;                     ///< per triangle
  std::vector<Index> neighbourBegin, neighbours;  ///< per patch: those across its edges, ascending
  /// Per patch: every edge of it is shared by exactly two triangles.
  std::vector<unsigned char> regular;
  std::vector<SolidSums> sums;  ///< per patch, about `origin`
  Vec3 origin = Vec3::Zero();   ///< the centre of the surface's box

  std::size_t count() const { return regular.size(); }
  /// Fills patchOf from the lists.
  void indexTriangles() {
    patchOf.resize(triangles.size());
    for (std::size_t p = 0; p < count(); ++p)
      for (const Index t : trianglesOf(p)) patchOf[at(t)] = static_cast<Index>(p);
  }
  std::span<const Index> trianglesOf(std::size_t patch) const {
    return std::span(triangles).subspan(at(begin[patch]), at(begin[patch + 1] - begin[patch]));
  }
  std::span<const Index> neighboursOf(std::size_t patch) const {
    return std::span(neighbours)
        .subspan(at(neighbourBegin[patch]), at(neighbourBegin[patch + 1] - neighbourBegin[patch]));
  }
};

}  // namespace sherd
