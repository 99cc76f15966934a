#include "tetrahedralize/graded_minimum.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sherd {
namespace {

constexpr double kDominated = 0.85;

std::uint64_t pack(const Eigen::Vector3i& cell) {
  constexpr int kShift = 1 << 20;
  const auto part = [](int i) { return static_cast<std::uint64_t>(i + kShift) & 0x1fffff; };
  return part(cell.x()) | part(cell.y()) << 21 | part(cell.z()) << 42;
}

Eigen::Vector3i gridCell(const Vec3& x, double side) {
  return (x / side).array().floor().matrix().cast<int>();
}

}  // namespace

GradedMinimum::GradedMinimum(double top, double slope, std::vector<Spot> spots)
    : top_(top), slope_(slope), lowest_(top), cell_(top / (3 * slope)) {
  // The smallest first, so that those that they bound are never added. Ties by place: the order of the input
  // must not matter.
  std::sort(spots.begin(), spots.end(), [](const Spot& a, const Spot& b) {
    return std::make_tuple(a.value, a.place.x(), a.place.y(), a.place.z()) <
           std::make_tuple(b.value, b.place.x(), b.place.y(), b.place.z());
  });
  for (const Spot& spot : spots)
    if (spot.value < kDominated * (*this)(spot.place)) add(spot);
}

void GradedMinimum::add(const Spot& spot) {
  lowest_ = std::min(lowest_, spot.value);
  const Vec3 reach = Vec3::Constant((top_ - spot.value) / slope_);
  const Eigen::Vector3i low = gridCell(spot.place - reach, cell_), high = gridCell(spot.place + reach, cell_);
  for (int i = low.x(); i <= high.x(); ++i)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int k = low.z(); k <= high.z(); ++k) addTo({i, j, k}, spot);
}

void GradedMinimum::addTo(const Eigen::Vector3i& cell, const Spot& spot) {
  const Vec3 half = Vec3::Constant(0.5 * cell_), centre = cell_ * cell.cast<double>() + half;
  const Vec3 apart = (spot.place - centre).cwiseAbs();
  const double nearest = spot.value + slope_ * (apart - half).cwiseMax(0.0).norm();
  const double farthest = spot.value + slope_ * (apart + half).norm();
  if (nearest >= top_) return;
  Cell& entry = cells_.try_emplace(pack(cell), Cell{{}, top_}).first->second;
  if (nearest >= entry.bound) return;
  entry.spots.push_back(spot);
  entry.bound = std::min(entry.bound, farthest);
}

double GradedMinimum::operator()(const Vec3& x) const {
  const auto found = cells_.find(pack(gridCell(x, cell_)));
  if (found == cells_.end()) return top_;
  double least = top_;
  for (const Spot& spot : found->second.spots) {
    if (spot.value >= least) break;  // ascending: no later one can be smaller
    least = std::min(least, spot.value + slope_ * (x - spot.place).norm());
  }
  return least;
}

}  // namespace sherd
