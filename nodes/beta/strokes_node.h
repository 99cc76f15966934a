// Strokes as an artist writes them in a graph.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "beta/stroke.h"

namespace sherd {

/// From a JSON list of objects:
///   { "points": [[0, 0.4, 0.1], [0.1, 0.5, 0]], "radius": 0.05, "value": 8, "falloff": 0.5, "blend": "max" }
/// `points` may be one point, [0, 0.4, 0.1]; `falloff` (0.5) and `blend` ("replace") may be left out. Errors
/// name the stroke by its place in the list, from 1, and the field.
Result<std::vector<Stroke>> readStrokes(const std::string& json);

}  // namespace sherd
