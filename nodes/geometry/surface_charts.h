// Cuts a surface into charts that are flat enough to be laid out by projection.
#pragma once

#include <span>
#include <vector>

#include "base/exec.h"
#include "types/vec.h"

namespace sherd {

/// No triangle of a chart is tilted against the chart's plane by more than this (25°). Projected on the
/// plane, lengths within a triangle therefore shrink to no less than kLeastChartScale and never grow.
inline constexpr double kLeastChartScale = 0.9063;

/// A triangle list and what its charts are judged by.
struct ChartedSurface {
  std::span<const Triangle> triangles;
  std::span<const Vec3> areaVectors;  ///< per triangle, twice its area long
  /// Per triangle: whether its corners are far enough from one line for its plane to mean something. Those
  /// that are not go with any chart beside them, and have no part in its plane.
  std::span<const char> isFirm;
  std::size_t vertexCount = 0;
};

struct SurfaceCharts {
  std::vector<Index> of;   ///< per triangle: its chart, in [0, axes.size())
  std::vector<Vec3> axes;  ///< per chart: the unit normal of its plane, on the triangles' front
};

/// A part joined by edges (of two triangles each) that keeps the limit against its mean normal is one chart.
/// Others are covered greedily: from the largest triangle that is left, a chart grows over edges as far as
/// the limit allows, and again from the mean normal of what it has covered while that gains area. The result
/// depends on the order of the triangles alone. Cost O(n log n). Unfinished when cancelled.
SurfaceCharts growCharts(const ChartedSurface& surface, const Exec& exec);

}  // namespace sherd
