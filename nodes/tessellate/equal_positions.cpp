#include "tessellate/equal_positions.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace sherd {
namespace {

/// Found by hashing the cells of a grid so coarse that hardly any vertex is within a spot of another cell.
class EqualPositions {
 public:
  explicit EqualPositions(const Arrangement& a)
      : positions_(a.positions), same_(a.positions.size()), spot_(a.spot), inverseCell_(1 / (1024 * a.spot)) {
    std::iota(same_.begin(), same_.end(), Index{0});
    const std::size_t own = a.positions.size() - at(a.firstCrack);
    slots_.assign(std::bit_ceil(2 * (own + 3 * a.cutTriangles.size()) + 8), -1);
    for (const Index s : a.cutTriangles)
      for (const Index v : a.surface[at(s)]) addCorner(v);
    for (Index v = a.firstCrack; at(v) < a.positions.size(); ++v) add(v);
  }

  std::vector<Index> take() { return std::move(same_); }

 private:
  using Cell = Eigen::Array<double, 3, 1>;

  Cell cellOf(const Vec3& p) const { return (p.array() * inverseCell_).floor(); }

  /// The corners of cut triangles come in no order, and each of them stays what it is.
  void addCorner(Index v) {
    std::size_t slot = hash(cellOf(positions_[at(v)])) & mask();
    while (slots_[slot] >= 0 && slots_[slot] != v) slot = (slot + 1) & mask();
    slots_[slot] = v;
  }

  void add(Index v) {
    const Vec3& p = positions_[at(v)];
    const Cell low = cellOf(p - Vec3::Constant(spot_)), high = cellOf(p + Vec3::Constant(spot_));
    Nearest nearest;
    if ((low == high).all()) {
      look(low, p, nearest);
    } else {
      for (int corner = 0; corner < 8; ++corner) {
        Cell cell = low;
        for (int k = 0; k < 3; ++k)
          if ((corner >> k & 1) != 0) cell[k] = high[k];
        look(cell, p, nearest);
      }
    }
    same_[at(v)] = nearest.vertex >= 0 ? nearest.vertex : v;
    if (nearest.vertex < 0) addCorner(v);
  }

  struct Nearest {
    Index vertex = -1;
    double distance = std::numeric_limits<double>::infinity();
  };

  /// Of those as near as each other the one that was numbered first.
  void look(const Cell& cell, const Vec3& p, Nearest& nearest) const {
    for (std::size_t slot = hash(cell) & mask(); slots_[slot] >= 0; slot = (slot + 1) & mask()) {
      const double distance = (positions_[at(slots_[slot])] - p).cwiseAbs().maxCoeff();
      if (distance > spot_ || distance > nearest.distance) continue;
      if (distance < nearest.distance || slots_[slot] < nearest.vertex) nearest = {slots_[slot], distance};
    }
  }

  std::size_t mask() const { return slots_.size() - 1; }

  static std::size_t hash(const Cell& cell) {
    std::uint64_t h = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      h = (h ^ std::bit_cast<std::uint64_t>(cell[i] + 0.0)) * 0x9E3779B97F4A7C15ULL;  // −0 and 0 are one
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h);
  }

  std::span<const Vec3> positions_;
  std::vector<Index> same_, slots_;
  double spot_, inverseCell_;
};

}  // namespace

std::vector<Index> equalPositions(const Arrangement& arrangement) {
  return EqualPositions(arrangement).take();
}

}  // namespace sherd
