// A surface triangle or a sheet polygon with the half-edges on its border and across it.
#pragma once

#include <algorithm>
#include <span>
#include <tuple>
#include <vector>

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
  void addHalfEdge(Index from, Index to, Index region) { halfEdges_.push_back({from, to, numberOf(region)}); }

  /// Calls emit(triangle, region) for every triangle; returns how many had to be forced.
  template <class Emit>
  int triangulate(Emit emit) {
    std::sort(halfEdges_.begin(), halfEdges_.end(), [](const HalfEdge& a, const HalfEdge& b) {
      return std::tuple(a.region, a.from, a.to) < std::tuple(b.region, b.from, b.to);
    });
    int forced = 0;
    for (std::size_t first = 0; first < halfEdges_.size();) {
      std::size_t last = first;
      while (last < halfEdges_.size() && halfEdges_[last].region == halfEdges_[first].region) ++last;
      loops_.clear();
      traceLoops(std::span(halfEdges_).subspan(first, last - first));
      const Index region = regions_[at(halfEdges_[first].region)];
      first = last;
      if (loops_.empty()) continue;
      const PolygonTriangulation result = triangulatePolygon(planar_, loops_);
      forced += result.forced;
      for (const Triangle& t : result.triangles)
        emit(Triangle{ids_[at(t[0])], ids_[at(t[1])], ids_[at(t[2])]}, region);
    }
    return forced;
  }

 private:
  struct HalfEdge {
    Index from, to, region;  ///< by its number in regions_
  };

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
  std::vector<std::vector<Index>> loops_;
};

}  // namespace sherd
