#include "tessellate/clip.h"

#include <algorithm>
#include <map>

#include "base/parallel.h"
#include "tessellate/polygon.h"

namespace sherd {
namespace {

constexpr std::size_t kBlock = 256;  ///< triangles a task

/// A directed edge with the region `region` on its left.
struct HalfEdge {
  Index from, to, region;
};

/// One triangle with the half-edges on its border and across it.
class CutTriangle {
 public:
  CutTriangle(const Arrangement& arrangement, const Triangle& corners)
      : positions_(arrangement.positions), same_(arrangement.same) {
    const Vec3 &a = position(corners[0]), &b = position(corners[1]), &c = position(corners[2]);
    const Vec3 normal = (b - a).cross(c - a);
    normal.cwiseAbs().maxCoeff(&drop_);
    flip_ = normal[drop_] < 0;
    for (std::uint32_t i = 0; i < 3; ++i) addVertex(corners[i], (1u << i) | (1u << ((i + 2) % 3)));
  }

  void addBorderVertex(Index vertex, std::uint32_t side) { addVertex(vertex, 1u << side); }
  void addInnerVertex(Index vertex) { addVertex(vertex, 0); }
  void addHalfEdge(Index from, Index to, Index region) { halfEdges_.push_back({from, to, region}); }

  /// Calls emit(triangle, region) for every triangle; returns how many had to be forced.
  template <class Emit>
  int triangulate(Emit emit) {
    std::sort(halfEdges_.begin(), halfEdges_.end(), [](const HalfEdge& a, const HalfEdge& b) {
      return std::tuple(a.region, a.from, a.to) < std::tuple(b.region, b.from, b.to);
    });
    int forced = 0;
    std::vector<std::vector<Index>> loops;
    for (std::size_t first = 0; first < halfEdges_.size();) {
      std::size_t last = first;
      while (last < halfEdges_.size() && halfEdges_[last].region == halfEdges_[first].region) ++last;
      loops.clear();
      traceLoops(std::span(halfEdges_).subspan(first, last - first), loops);
      const Index regionHere = halfEdges_[first].region;
      first = last;
      if (loops.empty()) continue;
      const PolygonTriangulation result = triangulatePolygon(planar_, loops);
      forced += result.forced;
      for (const Triangle& t : result.triangles)
        emit(Triangle{ids_[at(t[0])], ids_[at(t[1])], ids_[at(t[2])]}, regionHere);
    }
    return forced;
  }

 private:
  const Vec3& position(Index v) const { return positions_[at(v)]; }

  /// Vertices on one spot are one corner, which then lies on all their lines.
  void addVertex(Index vertex, std::uint32_t lines) {
    vertex = same_[at(vertex)];
    const auto found = std::find(ids_.begin(), ids_.end(), vertex);
    if (found != ids_.end()) {
      planar_[static_cast<std::size_t>(found - ids_.begin())].lines |= lines;
      return;
    }
    const Vec3& p = position(vertex);
    const int x = (drop_ + 1) % 3, y = (drop_ + 2) % 3;
    ids_.push_back(vertex);
    planar_.push_back({flip_ ? Vec2(p[y], p[x]) : Vec2(p[x], p[y]), lines});
  }

  Index local(Index vertex) const {
    return static_cast<Index>(std::find(ids_.begin(), ids_.end(), same_[at(vertex)]) - ids_.begin());
  }

  /// In one region a vertex begins at most one half-edge, since the cells around a crack edge all differ.
  /// Followed by the vertices' own numbers; only then are those on one spot taken together.
  void traceLoops(std::span<const HalfEdge> region, std::vector<std::vector<Index>>& loops) const {
    std::vector<bool> used(region.size(), false);
    for (std::size_t first = 0; first < region.size(); ++first) {
      if (used[first]) continue;
      loops.emplace_back();
      std::size_t i = first;
      while (i < region.size() && !used[i]) {
        used[i] = true;
        const Index corner = local(region[i].from);
        if (loops.back().empty() || loops.back().back() != corner) loops.back().push_back(corner);
        const auto next = std::lower_bound(region.begin(), region.end(), region[i].to,
                                           [](const HalfEdge& h, Index v) { return h.from < v; });
        i = next != region.end() && next->from == region[i].to
                ? static_cast<std::size_t>(next - region.begin())
                : region.size();
      }
      auto& loop = loops.back();
      while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
      if (loop.size() < 3) loops.pop_back();  // nothing, or two edges that cancel
    }
  }

  std::span<const Vec3> positions_;
  std::span<const Index> same_;
  int drop_ = 0;
  bool flip_ = false;
  std::vector<Index> ids_;
  std::vector<PlanarCorner> planar_;
  std::vector<HalfEdge> halfEdges_;
};

/// Walks the border of a triangle, counter-clockwise: visit(from, to, region) for each interval between
/// crossings.
template <class Across, class Visit>
void walkBorder(const EdgeTable& edges, const EdgeCrossings& crossings, const Triangle& ownCorners,
                const Triangle& corners, Index triangle, std::array<Index, 3> regionAtCorner, Across across,
                CutTriangle& out, Visit visit) {
  for (std::uint32_t side = 0; side < 3; ++side) {
    const Index edge = edges.ofTriangle[at(triangle)][side];
    const auto on = crossings.on(edge);
    const bool forward = edges.ends[at(edge)][0] == ownCorners[side];
    Index from = corners[side], region = regionAtCorner[side];
    for (std::size_t k = 0; k < on.size(); ++k) {
      const Crossing& x = forward ? on[k] : on[on.size() - 1 - k];
      out.addBorderVertex(x.vertex, side);
      visit(from, x.vertex, region);
      from = x.vertex;
      region = across(x)[forward ? 1 : 0];
    }
    visit(from, corners[(side + 1) % 3], region);
  }
}

class Clipper {
 public:
  Clipper(const Arrangement& a, const CrackComplex& complex, const Exec& exec)
      : a_(a), complex_(complex), exec_(exec) {
    groupSegments();
  }

  ClippedMeshes run() {
    ClippedMeshes result;
    clipSurface(result);
    clipSheets(result);
    return result;
  }

 private:
  void groupSegments() {
    auto group = [&](std::size_t n, auto key, std::vector<Index>& begin, std::vector<Index>& order) {
      begin.assign(n + 1, 0);
      for (const Segment& s : a_.segments) ++begin[at(key(s)) + 1];
      for (std::size_t i = 0; i < n; ++i) begin[i + 1] += begin[i];
      std::vector<Index> fill(begin.begin(), begin.end() - 1);
      order.resize(a_.segments.size());
      for (std::size_t i = 0; i < a_.segments.size(); ++i)
        order[at(fill[at(key(a_.segments[i]))]++)] = static_cast<Index>(i);
    };
    group(
        a_.surface.size(), [](const Segment& s) { return s.surface; }, bySurfaceBegin_, bySurface_);
    group(
        a_.crack.size(), [](const Segment& s) { return s.crack; }, byCrackBegin_, byCrack_);
  }

  template <class T, class F>
  void inBlocks(std::size_t n, std::vector<T>& out, std::size_t& forced, F f) {
    const std::size_t blocks = (n + kBlock - 1) / kBlock;
    std::vector<std::vector<T>> parts(blocks);
    std::vector<std::size_t> forcedParts(blocks, 0);
    parallelFor(exec_, n, kBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        f(static_cast<Index>(i), parts[begin / kBlock], forcedParts[begin / kBlock]);
    });
    std::size_t total = 0;
    for (const auto& part : parts) total += part.size();
    out.reserve(total);
    for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
    for (const std::size_t k : forcedParts) forced += k;
  }

  bool surfaceTriangleCut(Index s) const {
    if (bySurfaceBegin_[at(s)] != bySurfaceBegin_[at(s) + 1]) return true;
    const auto& edges = a_.surfaceEdges.ofTriangle[at(s)];
    return std::any_of(edges.begin(), edges.end(),
                       [&](Index e) { return !a_.surfaceCrossings.on(e).empty(); });
  }

  void clipSurface(ClippedMeshes& result) {
    inBlocks(a_.surface.size(), result.skin, result.forced,
             [&](Index s, std::vector<SkinTriangle>& out, std::size_t& forced) {
               if (!surfaceTriangleCut(s))
                 out.push_back({a_.surface[at(s)], s, a_.surfaceLabel[at(a_.surface[at(s)][0])], false});
               else
                 splitSurfaceTriangle(s, out, forced);
             });
    Index last = -1;
    for (const SkinTriangle& t : result.skin)
      if (t.cut && t.source != last) ++result.cutSurfaceTriangles, last = t.source;
  }

  void splitSurfaceTriangle(Index s, std::vector<SkinTriangle>& out, std::size_t& forced) const {
    const Triangle& corners = a_.surface[at(s)];
    CutTriangle cut(a_, corners);
    const std::array<Index, 3> labels{a_.surfaceLabel[at(corners[0])], a_.surfaceLabel[at(corners[1])],
                                      a_.surfaceLabel[at(corners[2])]};
    walkBorder(
        a_.surfaceEdges, a_.surfaceCrossings, corners, corners, s, labels,
        [&](const Crossing& x) {
          const CrackTriangle& c = complex_.triangles[at(x.triangle)];
          return x.fromFront ? std::array{c.front, c.back} : std::array{c.back, c.front};
        },
        cut, [&](Index from, Index to, Index region) { cut.addHalfEdge(from, to, region); });
    for (Index i = bySurfaceBegin_[at(s)]; i < bySurfaceBegin_[at(s) + 1]; ++i) {
      const Segment& segment = a_.segments[at(bySurface_[at(i)])];
      const CrackTriangle& c = complex_.triangles[at(segment.crack)];
      cut.addInnerVertex(segment.from);
      cut.addInnerVertex(segment.to);
      cut.addHalfEdge(segment.from, segment.to, c.back);
      cut.addHalfEdge(segment.to, segment.from, c.front);
    }
    forced += static_cast<std::size_t>(cut.triangulate([&](const Triangle& t, Index region) {
      out.push_back({t, s, region, true});
    }));
  }

  void clipSheets(ClippedMeshes& result) {
    inBlocks(a_.crack.size(), result.sheet, result.forced,
             [&](Index c, std::vector<SheetTriangle>& out, std::size_t& forced) {
               const CrackTriangle& own = complex_.triangles[at(c)];
               const auto& edges = a_.crackEdges.ofTriangle[at(c)];
               const bool crossed = byCrackBegin_[at(c)] != byCrackBegin_[at(c) + 1] ||
                                    std::any_of(edges.begin(), edges.end(),
                                                [&](Index e) { return !a_.crackCrossings.on(e).empty(); });
               if (crossed)
                 clipCrackTriangle(c, out, forced);
               else if (a_.crackInside[at(own.corners[0])])
                 out.push_back({a_.crack[at(c)], own.front, own.back});
             });
  }

  void clipCrackTriangle(Index c, std::vector<SheetTriangle>& out, std::size_t& forced) const {
    const CrackTriangle& own = complex_.triangles[at(c)];
    const Triangle& corners = a_.crack[at(c)];
    CutTriangle cut(a_, corners);
    std::array<Index, 3> outside{};
    for (std::size_t i = 0; i < 3; ++i) outside[i] = a_.crackInside[at(own.corners[i])] ? 0 : 1;
    walkBorder(
        a_.crackEdges, a_.crackCrossings, own.corners, corners, c, outside,
        [](const Crossing& x) {
          return x.fromFront ? std::array<Index, 2>{1, 0} : std::array<Index, 2>{0, 1};
        },
        cut,
        [&](Index from, Index to, Index isOutside) {
          if (isOutside == 0) cut.addHalfEdge(from, to, 0);
        });
    // On the sheet, seen from its front, a segment has the inside on its left when run backwards.
    for (Index i = byCrackBegin_[at(c)]; i < byCrackBegin_[at(c) + 1]; ++i) {
      const Segment& segment = a_.segments[at(byCrack_[at(i)])];
      cut.addInnerVertex(segment.from);
      cut.addInnerVertex(segment.to);
      cut.addHalfEdge(segment.to, segment.from, 0);
    }
    forced += static_cast<std::size_t>(cut.triangulate([&](const Triangle& t, Index) {
      out.push_back({t, own.front, own.back});
    }));
  }

  const Arrangement& a_;
  const CrackComplex& complex_;
  const Exec& exec_;
  std::vector<Index> bySurfaceBegin_, bySurface_, byCrackBegin_, byCrack_;
};

}  // namespace

ClippedMeshes clip(const Arrangement& arrangement, const CrackComplex& complex, const Exec& exec) {
  return Clipper(arrangement, complex, exec).run();
}

CornerWeights barycentric(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (!(area2 > 0)) return CornerWeights::Constant(1.0 / 3);
  CornerWeights w;
  w[1] = (point - a).cross(c - a).dot(normal) / area2;
  w[2] = (b - a).cross(point - a).dot(normal) / area2;
  w[0] = 1 - w[1] - w[2];
  w = w.cwiseMax(0.0);
  return w / w.sum();
}

}  // namespace sherd
