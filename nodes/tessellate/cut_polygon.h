// A surface triangle or a sheet polygon with the half-edges on its border and across it.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "tessellate/parted_triangles.h"
#include "tessellate/polygon.h"
#include "types/vec.h"

namespace sherd {

class CutPolygon {
 public:
  /// `same`: per vertex the least-numbered one on the same spot.
  CutPolygon(std::span<const Vec3> positions, std::span<const Index> same)
      : positions_(positions), same_(same) {}

  /// Begins with a polygon of these corners, whose border turns counter-clockwise.
  void begin(std::span<const Index> corners);
  void addBorderVertex(Index vertex, std::size_t side) { addVertex(vertex, lineOf(side)); }
  void addInnerVertex(Index vertex) { addVertex(vertex, 0); }
  /// A directed edge with the region `region` on its left.
  void addHalfEdge(Index from, Index to, Index region) {
    halfEdges_.push_back({key(numberOf(region), from), to});
  }

  /// Adds make(triangle, region) for every triangle; returns how many had to be forced.
  template <class T, class Make>
  int triangulate(PartedTriangles<T>& out, Make make) {
    std::sort(halfEdges_.begin(), halfEdges_.end(), [](const HalfEdge& a, const HalfEdge& b) {
      return a.key != b.key ? a.key < b.key : a.to < b.to;
    });
    int forced = 0;
    for (std::size_t first = 0; first < halfEdges_.size();) {
      std::size_t last = first;
      while (last < halfEdges_.size() && halfEdges_[last].region() == halfEdges_[first].region()) ++last;
      traceLoops(std::span(halfEdges_).subspan(first, last - first));
      const Index region = regions_[halfEdges_[first].region()];
      first = last;
      if (loopCount_ == 0) continue;
      const PolygonTriangulation& result =
          triangulator_.triangulate(planar_, std::span(loops_).first(loopCount_));
      forced += result.forced;
      add(result, out, [&](const Triangle& t) { return make(t, region); });
    }
    return forced;
  }

 private:
  /// Ordered by region (its number in regions_), then by where it comes from.
  struct HalfEdge {
    std::uint64_t key;
    Index to;
    Index from() const { return static_cast<Index>(key & 0xFFFFFFFFu); }
    std::size_t region() const { return key >> 32; }
  };
  static std::uint64_t key(Index region, Index from) {
    return static_cast<std::uint64_t>(region) << 32 | static_cast<std::uint32_t>(from);
  }

  /// One loop bounds one part; of several it is not known here which belong together.
  template <class T, class Make>
  void add(const PolygonTriangulation& result, PartedTriangles<T>& out, Make make) {
    const auto ids = [&](const Triangle& t) {
      return Triangle{ids_[at(t[0])], ids_[at(t[1])], ids_[at(t[2])]};
    };
    if (loopCount_ > 1) {
      for (const Triangle& t : result.triangles) out.addAlone(make(ids(t)));
      return;
    }
    for (Index& v : loops_[0]) v = ids_[at(v)];
    out.startPart(loops_[0]);
    for (const Triangle& t : result.triangles) out.triangles.push_back(make(ids(t)));
  }

  /// Regions are numbered as they come, so that their names play no part in the order of the triangles.
  Index numberOf(Index region) {
    const auto place = std::find(regions_.begin(), regions_.end(), region) - regions_.begin();
    if (static_cast<std::size_t>(place) == regions_.size()) regions_.push_back(region);
    return static_cast<Index>(place);
  }

  /// The bit of a side; those of polygons with many sides go without.
  static std::uint32_t lineOf(std::size_t side) { return side < 32 ? 1u << side : 0; }
  void addVertex(Index vertex, std::uint32_t lines);
  Index local(Index vertex) const;
  void traceLoops(std::span<const HalfEdge> region);

  std::span<const Vec3> positions_;
  std::span<const Index> same_;
  int drop_ = 0;
  bool flip_ = false;
  std::vector<Index> ids_;
  std::vector<PlanarCorner> planar_;
  std::vector<HalfEdge> halfEdges_;
  std::vector<Index> regions_;
  std::vector<std::vector<Index>> loops_;  ///< the first loopCount_ count
  std::size_t loopCount_ = 0;
  std::vector<unsigned char> used_;
  PolygonTriangulator triangulator_;
};

}  // namespace sherd
