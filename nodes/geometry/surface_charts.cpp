#include "geometry/surface_charts.h"

#include <algorithm>

#include "geometry/edge_table.h"

namespace sherd {
namespace {

class Grower {
 public:
  Grower(const ChartedSurface& surface, const Exec& exec)
      : s_(surface), exec_(exec), edges_(buildEdgeTable(surface.triangles, surface.vertexCount)) {
    const std::size_t count = s_.triangles.size();
    charts_.of.assign(count, -1);
    visit_.assign(count, 0);
    normals_.reserve(count);
    for (std::size_t t = 0; t < count; ++t)
      normals_.push_back(s_.isFirm[t] ? s_.areaVectors[t].normalized() : Vec3(Vec3::Zero()));
  }

  SurfaceCharts run() {
    std::vector<Index> order(s_.triangles.size());
    for (std::size_t t = 0; t < order.size(); ++t) order[t] = static_cast<Index>(t);
    std::vector<double> size(order.size());
    for (std::size_t t = 0; t < order.size(); ++t) size[t] = s_.isFirm[t] ? s_.areaVectors[t].norm() : 0;
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return size[at(a)] > size[at(b)]; });
    std::vector<char> wasWhole(order.size(), 0);
    for (const Index seed : order) {
      if (charts_.of[at(seed)] >= 0) continue;
      if (exec_.cancelled()) break;
      if (!wasWhole[at(seed)]) {
        const std::vector<Index> part = flood(seed, Vec3::Zero(), -1);
        for (const Index t : part) wasWhole[at(t)] = 1;
        const Vec3 axis = meanNormal(part);
        if (std::all_of(part.begin(), part.end(), [&](Index t) { return fits(t, axis, kLeastChartScale); })) {
          close(part, axis);
          continue;
        }
      }
      grow(seed);
    }
    return std::move(charts_);
  }

 private:
  bool fits(Index t, const Vec3& axis, double least) const {
    return !s_.isFirm[at(t)] || normals_[at(t)].dot(axis) >= least;
  }

  /// Triangles without a chart that are reached from the seed over edges, none tilted beyond `least`.
  std::vector<Index> flood(Index seed, const Vec3& axis, double least) {
    ++stamp_;
    std::vector<Index> region{seed};
    visit_[at(seed)] = stamp_;
    for (std::size_t i = 0; i < region.size(); ++i)
      for (const Index edge : edges_.ofTriangle[at(region[i])]) {
        const auto users = edges_.trianglesOf(edge);
        if (users.size() != 2) continue;
        const Index next = users[0] == region[i] ? users[1] : users[0];
        if (visit_[at(next)] == stamp_ || charts_.of[at(next)] >= 0 || !fits(next, axis, least)) continue;
        visit_[at(next)] = stamp_;
        region.push_back(next);
      }
    return region;
  }

  /// Towards which the region faces; some direction where it has none.
  Vec3 meanNormal(const std::vector<Index>& region) const {
    Vec3 sum = Vec3::Zero();
    for (const Index t : region)
      if (s_.isFirm[at(t)]) sum += s_.areaVectors[at(t)];
    const double largest = sum.cwiseAbs().maxCoeff();
    return largest > 0 ? Vec3((sum / largest).normalized()) : Vec3::UnitY();
  }

  double areaOf(const std::vector<Index>& region) const {
    double area = 0;
    for (const Index t : region) area += s_.areaVectors[at(t)].norm();
    return area;
  }

  void grow(Index seed) {
    Vec3 axis = s_.isFirm[at(seed)] ? normals_[at(seed)] : Vec3(Vec3::UnitY());
    std::vector<Index> region = flood(seed, axis, kLeastChartScale);
    double area = areaOf(region);
    for (int round = 0; round < 4; ++round) {
      const Vec3 better = meanNormal(region);
      if (!fits(seed, better, kLeastChartScale)) break;
      std::vector<Index> larger = flood(seed, better, kLeastChartScale);
      const double largerArea = areaOf(larger);
      if (!(largerArea > area)) break;
      axis = better, region = std::move(larger), area = largerArea;
    }
    close(region, axis);
  }

  void close(const std::vector<Index>& region, const Vec3& axis) {
    for (const Index t : region) charts_.of[at(t)] = static_cast<Index>(charts_.axes.size());
    charts_.axes.push_back(axis);
  }

  const ChartedSurface& s_;
  const Exec& exec_;
  EdgeTable edges_;
  std::vector<Vec3> normals_;
  std::vector<Index> visit_;  ///< per triangle: the flood that came by last
  Index stamp_ = 0;
  SurfaceCharts charts_;
};

}  // namespace

SurfaceCharts growCharts(const ChartedSurface& surface, const Exec& exec) {
  return Grower(surface, exec).run();
}

}  // namespace sherd
