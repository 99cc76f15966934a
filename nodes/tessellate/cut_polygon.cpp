#include "tessellate/cut_polygon.h"

namespace sherd {

void CutPolygon::begin(std::span<const Index> corners) {
  ids_.clear();
  planar_.clear();
  halfEdges_.clear();
  regions_.clear();
  const Vec3& origin = positions_[at(corners[0])];
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    normal += (positions_[at(corners[i])] - origin).cross(positions_[at(corners[i + 1])] - origin);
  normal.cwiseAbs().maxCoeff(&drop_);
  flip_ = normal[drop_] < 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    addVertex(corners[i], lineOf(i) | lineOf((i + corners.size() - 1) % corners.size()));
}

/// Vertices on one spot are one corner, which then lies on all their lines.
void CutPolygon::addVertex(Index vertex, std::uint32_t lines) {
  vertex = same_[at(vertex)];
  const auto found = std::find(ids_.begin(), ids_.end(), vertex);
  if (found != ids_.end()) {
    planar_[static_cast<std::size_t>(found - ids_.begin())].lines |= lines;
    return;
  }
  const Vec3& p = positions_[at(vertex)];
  const int x = (drop_ + 1) % 3, y = (drop_ + 2) % 3;
  ids_.push_back(vertex);
  planar_.push_back({flip_ ? Vec2(p[y], p[x]) : Vec2(p[x], p[y]), lines});
}

Index CutPolygon::local(Index vertex) const {
  return static_cast<Index>(std::find(ids_.begin(), ids_.end(), same_[at(vertex)]) - ids_.begin());
}

/// In one region a vertex begins at most one half-edge, since the cells around a crack edge all differ.
/// Followed by the vertices' own numbers; only then are those on one spot taken together.
void CutPolygon::traceLoops(std::span<const HalfEdge> region) {
  used_.assign(region.size(), 0);
  loopCount_ = 0;
  for (std::size_t first = 0; first < region.size(); ++first) {
    if (used_[first]) continue;
    if (loopCount_ == loops_.size()) loops_.emplace_back();
    auto& loop = loops_[loopCount_];
    loop.clear();
    std::size_t i = first;
    while (i < region.size() && !used_[i]) {
      used_[i] = 1;
      const Index corner = local(region[i].from());
      if (loop.empty() || loop.back() != corner) loop.push_back(corner);
      const std::uint64_t sought = key(static_cast<Index>(region[i].region()), region[i].to);
      const auto next = std::lower_bound(region.begin(), region.end(), sought,
                                         [](const HalfEdge& h, std::uint64_t k) { return h.key < k; });
      i = next != region.end() && next->key == sought ? static_cast<std::size_t>(next - region.begin())
                                                      : region.size();
    }
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    loopCount_ += loop.size() >= 3;  // fewer are nothing, or two edges that cancel
  }
}

}  // namespace sherd
