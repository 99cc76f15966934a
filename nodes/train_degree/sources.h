// Which examples there are to be, from the parameters (train_degree.h).
#pragma once

#include <vector>

#include "base/result.h"
#include "train_degree/train_degree.h"

namespace sherd {

/// m: the diagonal of the surface's bounding box, > 0; 1 for a body without surface.
double sizeOf(const TetMesh& tets);

/// Errors: parameters out of range; impacts of another body, or that make no sense, by their number from 1.
Result<void> checkSources(const TetMesh& tets, const TrainDegreeParams& params);

/// What is dropped, thrown or given, without what it came to. Error: nothing.
Result<std::vector<DropExample>> examplesOf(const TetMesh& tets, const TrainDegreeParams& params);

/// How an example that is no given impact comes about.
RigidParams sceneOf(const DropExample& example, const TrainDegreeParams& params);

}  // namespace sherd
