#include "embed/landmarks.h"

#include <algorithm>
#include <limits>

#include "embed/paths.h"

namespace sherd {
namespace {

constexpr std::size_t kLandmarks = 64;

std::vector<Landmark> farthestFirst(const PathGraph& graph, std::size_t nodes, const Exec& exec) {
  std::vector<Landmark> marks;
  std::vector<double> nearest(nodes, std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  while (marks.size() < std::min(kLandmarks, nodes) && !exec.cancelled()) {
    marks.push_back({next, graph.lengthsFrom(static_cast<Index>(next))});
    for (std::size_t n = 0; n < nodes; ++n) nearest[n] = std::min(nearest[n], marks.back().length[n]);
    // The first of those about as far: rounding must not choose between places that mirror each other.
    const double farthest = *std::max_element(nearest.begin(), nearest.end());
    next = static_cast<std::size_t>(
        std::find_if(nearest.begin(), nearest.end(), [&](double d) { return d >= farthest * (1 - 1e-9); }) -
        nearest.begin());
    if (!(nearest[next] > 0)) break;
  }
  return marks;
}

/// How much longer paths are than the straight lines of pairs so near that they mostly see each other.
double zigzag(const BodyPart& part, const std::vector<Landmark>& marks, double link) {
  std::vector<double> ratio;
  for (const Landmark& mark : marks)
    for (std::size_t n = 0; n < part.positions.size(); ++n)
      if (mark.length[n] > 3 * link && mark.length[n] < 8 * link)
        ratio.push_back(mark.length[n] / (part.positions[n] - part.positions[mark.node]).norm());
  if (ratio.empty()) return 1;
  const auto middle = ratio.begin() + static_cast<std::ptrdiff_t>(ratio.size() / 2);
  std::nth_element(ratio.begin(), middle, ratio.end());
  return *middle;
}

}  // namespace

Result<std::vector<Landmark>> landmarksOf(const BodyPart& part, const Exec& exec) {
  const PathGraph graph(part.positions, part.tets, part.neighbours);
  if (exec.cancelled()) return cancelledError();
  std::vector<Landmark> marks = farthestFirst(graph, part.positions.size(), exec);
  if (exec.cancelled()) return cancelledError();
  const double longer = zigzag(part, marks, graph.meanLink());
  if (!part.stretch.empty()) {
    const PathGraph stretched(part.positions, part.tets, part.neighbours, part.stretch);
    for (Landmark& mark : marks) {
      if (exec.cancelled()) return cancelledError();
      mark.length = stretched.lengthsFrom(static_cast<Index>(mark.node));
    }
  }
  for (Landmark& mark : marks)
    for (double& length : mark.length) length /= longer;
  return marks;
}

}  // namespace sherd
