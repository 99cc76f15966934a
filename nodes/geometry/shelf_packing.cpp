#include "geometry/shelf_packing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sherd {

std::vector<Vec2> packShelves(const std::vector<Vec2>& sizes) {
  std::vector<Vec2> places(sizes.size(), Vec2::Zero());
  if (sizes.empty()) return places;
  double sides = 0, area = 0, widest = 0;
  for (const Vec2& size : sizes) sides += size.sum();
  const double gap = 0.02 * sides / (2 * static_cast<double>(sizes.size()));
  for (const Vec2& size : sizes) {
    area += (size.x() + gap) * (size.y() + gap);
    widest = std::max(widest, size.x());
  }
  const double width = std::max(widest, std::sqrt(area));
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sizes[a].y() > sizes[b].y(); });
  Vec2 pen = Vec2::Zero();
  double shelf = sizes[order.front()].y();
  for (const std::size_t i : order) {
    if (pen.x() > 0 && pen.x() + sizes[i].x() > width) {
      pen = Vec2(0, pen.y() + shelf + gap);
      shelf = sizes[i].y();
    }
    places[i] = pen;
    pen.x() += sizes[i].x() + gap;
  }
  return places;
}

}  // namespace sherd
