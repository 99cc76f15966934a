// Triangles that rounding laid on one another.
#pragma once

#include "tessellate/clip.h"

namespace sherd {

constexpr Index kOutsideCell = -1;

/// Takes equal vertices together: triangles that lose a corner vanish, on both sides of a sheet alike, and
/// what is left closes as before. Where a layer of a cell has become so thin that the triangles on its two
/// sides have the same three corners, the layer goes: what lies on one side of it then touches what lies on
/// the other (or the outside, if the layer was the skin). `isCut`: per surface triangle; those that a layer
/// covered are marked, and what takes their place is in the skin. Of a stack that amounts to more than one
/// layer those go that undo each other. Cost O(surface) where vertices were taken together, nothing else.
void removeThinLayers(const Arrangement& arrangement, ClippedMeshes& meshes,
                      std::vector<unsigned char>& isCut);

}  // namespace sherd
