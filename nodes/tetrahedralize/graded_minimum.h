// min(top, minᵢ(valueᵢ + slope |x − pᵢ|)): the largest function below the given values that grows no faster
// than `slope`. Carries local sizes (offset, edge length) from where they are known into space.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "types/vec.h"

namespace sherd {

class GradedMinimum {
 public:
  struct Spot {
    Vec3 place;
    double value;
  };

  /// Spots that others bound to within 15 % are left out, which is the function's relative error. Values > 0.
  GradedMinimum(double top, double slope, std::vector<Spot> spots);

  double operator()(const Vec3& x) const;
  double top() const { return top_; }
  double lowest() const { return lowest_; }  ///< the smallest value anywhere

 private:
  struct Cell {
    std::vector<Spot> spots;  ///< that are the least somewhere in the cell, as far as bounds tell; ascending
    double bound;             ///< above the function everywhere in the cell
  };
  void add(const Spot& spot);
  void addTo(const Eigen::Vector3i& cell, const Spot& spot);

  double top_, slope_, lowest_;
  double cell_;  ///< side of the hash's cells
  std::unordered_map<std::uint64_t, Cell> cells_;
};

}  // namespace sherd
