// Measures what is promised of every fracture anew from the pieces' coordinates, as a reader of the exported
// files would: vertices are the same where their three doubles are, whatever their numbers. Shares nothing
// with the steps but the data types.
#pragma once

#include <cstddef>
#include <string>

#include "types/fragments.h"

namespace sherd::test {

struct FractureCheckParams {
  std::size_t points = 0;  ///< sampled, to lie in exactly one piece inside the body and in none outside
  bool selfIntersections = false;  ///< count the pieces that intersect themselves
  double areaLimit = 1e-9;         ///< of areaError
};

struct FractureCheck {
  std::size_t pieces = 0, triangles = 0, cracks = 0;
  std::size_t openEdges = 0;         ///< of a piece: used a different number of times in each direction
  std::size_t nonManifoldEdges = 0;  ///< used more than once in each direction; allowed
  std::size_t degenerate = 0;        ///< triangles with two corners in one place
  std::size_t severalParts = 0;      ///< pieces without exactly one shell of positive volume
  std::size_t notPositive = 0;       ///< pieces whose volume is not above 0
  std::size_t lonelyCracks = 0;    ///< crack triangles without exactly one twin, in the piece that they name
  std::size_t changedSources = 0;  ///< triangles passed through whose corners are not their source's
  double weightError =
      0;  ///< largest distance of a cut corner from where its weights put it, over the diagonal
  double volumeError = 0;  ///< |Σ pieces − source| / source
  double areaError = 0;    ///< the same for the outer skin
  double areaLimit = 1e-9;
  double offSource = 0;  ///< largest distance of a skin corner from the source, over the body's diagonal
  std::size_t points = 0, pointsInNone = 0, pointsInMany = 0, pointsOutside = 0;
  double rounding = 0;   ///< of the volume, where new vertices stand in the coordinates' own precision
  std::size_t flat = 0;  ///< triangles with three corners on a line; with selfIntersections
  std::size_t selfIntersecting = 0;  ///< pieces; counted, not judged

  bool good() const;
  std::string text() const;  ///< what is wrong, "good" where nothing is
};

/// Cost O(triangles · log triangles) + O(points · triangles).
FractureCheck checkFracture(const Fragments& fragments, const FractureCheckParams& params = {});

/// Does the soup intersect itself, with vertices joined by place? Triangles that share a corner or a side may
/// meet there and nowhere else. Exact.
bool intersectsItself(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

}  // namespace sherd::test
