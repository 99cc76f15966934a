#include "tessellate/clip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "tessellate/crossing_order.h"
#include "tessellate/cut_polygon.h"

namespace sherd {
namespace {

constexpr std::size_t kBlock = 128;  ///< triangles or polygons a task

class Clipper {
 public:
  Clipper(const Arrangement& a, const Sheets& sheets, const Exec& exec)
      : a_(a), sheets_(sheets), exec_(exec) {}

  ClippedMeshes run() {
    const std::size_t skin = blocksOf(a_.cutTriangles.size()), all = skin + blocksOf(sheets_.polygons.size());
    std::vector<PartedTriangles<SkinTriangle>> skinBlocks(skin);
    std::vector<PartedTriangles<SheetTriangle>> sheetBlocks(all - skin);
    std::vector<int> forced(all, 0);
    std::vector<std::size_t> flat(all, 0);
    parallelFor(exec_, all, 1, [&](std::size_t begin, std::size_t end) {
      CutPolygon cut(a_.positions, a_.same);
      for (std::size_t b = begin; b < end; ++b)
        if (b < skin) {
          forced[b] = splitBlock(b, cut, skinBlocks[b]);
          flat[b] = countFlat(skinBlocks[b]);
        } else {
          forced[b] = clipBlock(b - skin, cut, sheetBlocks[b - skin]);
          flat[b] = countFlat(sheetBlocks[b - skin]);
        }
    });
    gather(skinBlocks, result_.skin);
    gather(sheetBlocks, result_.sheet);
    result_.forced = static_cast<std::size_t>(std::accumulate(forced.begin(), forced.end(), 0));
    result_.flat = std::accumulate(flat.begin(), flat.end(), std::size_t{0});
    return std::move(result_);
  }

 private:
  template <class T>
  std::size_t countFlat(const PartedTriangles<T>& block) const {
    return static_cast<std::size_t>(std::ranges::count_if(block.triangles, [this](const T& t) {
      const auto& [a, b, c] = t.corners;
      return isFlat(a_.positions[at(a)], a_.positions[at(b)], a_.positions[at(c)], a_.spot);
    }));
  }

  static std::size_t blocksOf(std::size_t n) { return (n + kBlock - 1) / kBlock; }

  /// Both return how many triangles were forced.
  int splitBlock(std::size_t block, CutPolygon& cut, PartedTriangles<SkinTriangle>& out) const {
    out.reserve(4 * kBlock, 2 * kBlock, 8 * kBlock);
    int forced = 0;
    for (std::size_t i = block * kBlock; i < std::min(a_.cutTriangles.size(), (block + 1) * kBlock); ++i)
      if (!splitAtOnce(i, out)) forced += splitSurfaceTriangle(i, cut, out);
    return forced;
  }
  int clipBlock(std::size_t block, CutPolygon& cut, PartedTriangles<SheetTriangle>& out) const {
    out.reserve(4 * kBlock, kBlock, 8 * kBlock);
    std::vector<Index> corners;
    int forced = 0;
    for (std::size_t p = block * kBlock; p < std::min(sheets_.polygons.size(), (block + 1) * kBlock); ++p)
      forced += clipPolygon(static_cast<Index>(p), corners, cut, out);
    return forced;
  }

  template <class T>
  static void gather(const std::vector<PartedTriangles<T>>& blocks, PartedTriangles<T>& out) {
    std::size_t triangles = 0, parts = 0, border = 0;
    for (const auto& block : blocks)
      triangles += block.triangles.size(), parts += block.parts(), border += block.border.size();
    out.reserve(triangles, parts, border);
    for (const auto& block : blocks) out.append(block);
  }

  std::span<const Crossing> crossingsOn(Index cutEdge) const {
    return cutEdge < 0 ? std::span<const Crossing>() : a_.surfaceCrossings.on(cutEdge);
  }

  double squaredDistance(Index v, Index w) const {
    return (a_.positions[at(v)] - a_.positions[at(w)]).squaredNorm();
  }

  /// One segment from side to side: a corner's triangle and two of what is left, along the shorter diagonal.
  /// False where it is not that simple.
  bool splitAtOnce(std::size_t cut, PartedTriangles<SkinTriangle>& out) const {
    if (a_.segmentBegin[cut + 1] - a_.segmentBegin[cut] != 1) return false;
    const Segment& segment = a_.segments[at(a_.segmentBegin[cut])];
    const std::array<Index, 3>& sides = a_.edgesOfCut[cut];
    std::size_t whole = 3;  // the side without a crossing; the corner opposite of it is alone
    for (std::size_t c = 0; c < 3; ++c)
      if (sides[c] < 0)
        whole = whole == 3 ? c : 4;
      else if (crossingsOn(sides[c]).size() != 1)
        return false;
    if (whole > 2) return false;
    const Triangle& t = a_.surface[at(segment.surface)];
    const Index a = t[(whole + 2) % 3], b = t[whole], c = t[(whole + 1) % 3];
    const Index x = crossingsOn(sides[(whole + 2) % 3])[0].vertex,
                y = crossingsOn(sides[(whole + 1) % 3])[0].vertex;
    for (const Index v : {x, y})
      if (a_.same[at(v)] != v) return false;
    const SheetPolygon& p = sheets_.polygons[at(segment.polygon)];
    // From the crossing on ab to that on ca the lone corner is on the left.
    const Index cellA = segment.from == x ? p.back : p.front, cellB = segment.from == x ? p.front : p.back;
    out.addAlone({{a, x, y}, segment.surface, cellA});
    const bool fromX = squaredDistance(x, c) <= squaredDistance(b, y);
    out.startPart(std::array{x, b, c, y});
    out.triangles.push_back({fromX ? Triangle{x, b, c} : Triangle{x, b, y}, segment.surface, cellB});
    out.triangles.push_back({fromX ? Triangle{x, c, y} : Triangle{b, c, y}, segment.surface, cellB});
    return true;
  }

  /// Walks one side of a border, from `from` to `to`, and the regions that its crossings separate.
  template <class AcrossOf>
  static void walkSide(std::span<const Crossing> on, bool forward, Index from, Index to, std::size_t side,
                       Index region, AcrossOf across, bool allRegions, CutPolygon& cut) {
    const auto step = [&](Index next) {
      if (allRegions || region == 0) cut.addHalfEdge(from, next, region);
    };
    for (std::size_t k = 0; k < on.size(); ++k) {
      const Crossing& x = forward ? on[k] : on[on.size() - 1 - k];
      cut.addBorderVertex(x.vertex, side);
      step(x.vertex);
      from = x.vertex;
      region = across(x)[forward ? 1 : 0];
    }
    step(to);
  }

  int splitSurfaceTriangle(std::size_t cutNumber, CutPolygon& cut, PartedTriangles<SkinTriangle>& out) const {
    const Index s = a_.cutTriangles[cutNumber];
    const Triangle& corners = a_.surface[at(s)];
    cut.begin(corners);
    for (std::size_t side = 0; side < 3; ++side) {
      const Index from = corners[side], to = corners[(side + 1) % 3];
      walkSide(
          crossingsOn(a_.edgesOfCut[cutNumber][side]), from < to, from, to, side, a_.surfaceLabel[at(from)],
          [this](const Crossing& x) { return cellsAcross(sheets_, x); }, true, cut);
    }
    for (Index i = a_.segmentBegin[cutNumber]; i < a_.segmentBegin[cutNumber + 1]; ++i) {
      const Segment& segment = a_.segments[at(i)];
      const SheetPolygon& p = sheets_.polygons[at(segment.polygon)];
      cut.addInnerVertex(segment.from);
      cut.addInnerVertex(segment.to);
      cut.addHalfEdge(segment.from, segment.to, p.back);
      cut.addHalfEdge(segment.to, segment.from, p.front);
    }
    return cut.triangulate(out, [&](const Triangle& t, Index region) { return SkinTriangle{t, s, region}; });
  }

  /// `corners` keeps its memory from polygon to polygon.
  int clipPolygon(Index polygon, std::vector<Index>& corners, CutPolygon& cut,
                  PartedTriangles<SheetTriangle>& out) const {
    const SheetPolygon& p = sheets_.polygons[at(polygon)];
    const std::span<const Index> own = sheets_.cornersOf(p);
    const Index first = a_.byPolygonBegin[at(polygon)], last = a_.byPolygonBegin[at(polygon) + 1];
    const bool crossed = first != last;
    if (!crossed && !a_.sheetInside[at(own[0])]) return 0;
    corners.assign(own.begin(), own.end());
    for (Index& v : corners) v += a_.firstCrack;
    const std::size_t border = out.border.size();
    if (!crossed && fan(corners, p, out)) {
      nameAllEdges(p, std::span(out.border).subspan(border));
      return 0;
    }
    const int forced = clipCorners(polygon, corners, cut, out);
    nameWholeEdges(p, corners, std::span(out.border).subspan(border));
    return forced;
  }

  int clipCorners(Index polygon, std::span<const Index> corners, CutPolygon& cut,
                  PartedTriangles<SheetTriangle>& out) const {
    const SheetPolygon& p = sheets_.polygons[at(polygon)];
    const std::span<const Index> own = sheets_.cornersOf(p), edges = sheets_.edgesOf(p);
    cut.begin(corners);
    for (std::size_t side = 0; side < corners.size(); ++side)
      walkSide(a_.sheetCrossings.on(edges[side]), sheets_.forward(p, static_cast<Index>(side)), corners[side],
               corners[(side + 1) % corners.size()], side, a_.sheetInside[at(own[side])] ? 0 : 1, sidesAcross,
               false, cut);
    // On the sheet, seen from its front, a segment has the inside on its left when run backwards.
    for (Index i = a_.byPolygonBegin[at(polygon)]; i < a_.byPolygonBegin[at(polygon) + 1]; ++i) {
      const Segment& segment = a_.segments[at(a_.byPolygon[at(i)])];
      cut.addInnerVertex(segment.from);
      cut.addInnerVertex(segment.to);
      cut.addHalfEdge(segment.to, segment.from, 0);
    }
    return cut.triangulate(out, [&](const Triangle& t, Index) { return SheetTriangle{t, p.front, p.back}; });
  }

  /// Of a border between two corners of the sheets.
  bool isOnCage(const BorderEdge& e) const {
    return sheets_.onCage[at(e.from - a_.firstCrack)] && sheets_.onCage[at(e.to - a_.firstCrack)];
  }

  /// Those that run from corner to corner, but for those on the cage's boundary, along which the skin may
  /// lie.
  void nameWholeEdges(const SheetPolygon& p, std::span<const Index> corners,
                      std::span<BorderEdge> border) const {
    for (BorderEdge& e : border)
      for (std::size_t i = 0; i < corners.size(); ++i)
        if (corners[i] == e.from && corners[(i + 1) % corners.size()] == e.to && !isOnCage(e))
          e.corner = p.first + static_cast<Index>(i);
  }
  /// Of a border that is the polygon's.
  void nameAllEdges(const SheetPolygon& p, std::span<BorderEdge> border) const {
    for (std::size_t i = 0; i < border.size(); ++i)
      if (!isOnCage(border[i])) border[i].corner = p.first + static_cast<Index>(i);
  }

  /// A whole polygon, which is convex, by a fan from the corner that makes its smallest triangle largest.
  /// False where rounding leaves that flat.
  bool fan(std::span<const Index> corners, const SheetPolygon& p, PartedTriangles<SheetTriangle>& out) const {
    if (!differ(corners)) return false;
    const std::size_t n = corners.size();
    const auto corner = [&](std::size_t i) { return corners[i % n]; };
    std::size_t best = 0;
    double largest = 0, longest = 0;
    for (std::size_t apex = 0; apex < (n == 3 ? 0 : n == 4 ? 2 : n); ++apex) {
      double least = std::numeric_limits<double>::infinity();
      const Vec3& origin = a_.positions[at(corner(apex))];
      for (std::size_t i = 1; i + 1 < n; ++i) {
        const Vec3 u = a_.positions[at(corner(apex + i))] - origin,
                   v = a_.positions[at(corner(apex + i + 1))] - origin;
        least = std::min(least, u.cross(v).squaredNorm());
        longest = std::max({longest, u.squaredNorm(), v.squaredNorm()});
      }
      if (least > largest) best = apex, largest = least;
    }
    if (n > 3 && !(largest > 1e-16 * longest * longest)) return false;
    out.startPart(corners);
    for (std::size_t i = 1; i + 1 < n; ++i)
      out.triangles.push_back({{corner(best), corner(best + i), corner(best + i + 1)}, p.front, p.back});
    return true;
  }

  bool differ(std::span<const Index> corners) const {
    return std::all_of(corners.begin(), corners.end(), [this](Index v) { return a_.same[at(v)] == v; });
  }

  const Arrangement& a_;
  const Sheets& sheets_;
  const Exec& exec_;
  ClippedMeshes result_;
};

}  // namespace

ClippedMeshes clip(const Arrangement& arrangement, const Sheets& sheets, const Exec& exec) {
  return Clipper(arrangement, sheets, exec).run();
}

bool isFlat(const Vec3& a, const Vec3& b, const Vec3& c, double spot) {
  const Vec3 u = b - a, v = c - a;
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (c - b).squaredNorm()});
  return u.cross(v).squaredNorm() <= 4 * spot * spot * longest;
}

CornerWeights onSide(const Vec3& from, const Vec3& to, Eigen::Index p, Eigen::Index q, const Vec3& point) {
  const Vec3 side = to - from;
  const double length2 = side.squaredNorm();
  CornerWeights weights = CornerWeights::Unit(p);
  if (length2 > 0) weights[q] = std::clamp((point - from).dot(side) / length2, 0.0, 1.0);
  weights[p] = 1 - weights[q];
  return weights;
}

CornerWeights barycentric(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  const std::array<Vec3, 3> corner{a, b, c};
  const auto residual = [&](const CornerWeights& w) {
    return (w[0] * (a - point) + w[1] * (b - point) + w[2] * (c - point)).squaredNorm();
  };
  CornerWeights best = CornerWeights::Constant(1.0 / 3);
  const Vec3 normal = (b - a).cross(c - a);
  if (const double area2 = normal.squaredNorm(); area2 > 0) {
    best[1] = (point - a).cross(c - a).dot(normal) / area2;
    best[2] = (b - a).cross(point - a).dot(normal) / area2;
    best[0] = 1 - best[1] - best[2];
    best = best.cwiseMax(0.0);
    best /= best.sum();
  }
  // In a sliver areas lose their digits, and the nearest point of a side serves better.
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index j = (i + 1) % 3;
    const CornerWeights w =
        onSide(corner[static_cast<std::size_t>(i)], corner[static_cast<std::size_t>(j)], i, j, point);
    if (residual(w) < residual(best)) best = w;
  }
  return best;
}

}  // namespace sherd
