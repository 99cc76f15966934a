#include "tessellate/tet_envelope.h"

#include <algorithm>
#include <cmath>

#include "tessellate/symbolic_sign.h"

namespace sherd {
namespace {

/// A polygon's edges by the faces that they lie on.
struct Start {
  std::size_t count = 0;
  std::array<Index, 4> lines{};
};

/// The plane between two cells in a tetrahedron, by which corners of that are in the back cell (bits).
constexpr std::array<Start, 16> kStart = [] {
  std::array<Start, 16> starts{};
  for (int back = 1; back < 15; ++back) {
    std::array<Index, 4> order{};
    int low = 0, high = 3;
    for (int i = 0; i < 4; ++i) order[at((back >> i & 1) != 0 ? low++ : high--)] = i;
    // Corners in the back cell first; an odd reordering is made even within one cell.
    int inversions = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) inversions += order[i] > order[j];
    if (inversions % 2 == 1) low == 1 ? std::swap(order[2], order[3]) : std::swap(order[0], order[1]);
    const auto [a, b, c, d] = order;
    if (low == 1)  // corners on ab, ac, ad
      starts[at(back)] = {3, {d, b, c}};
    else if (low == 3)  // bd, cd, ad
      starts[at(back)] = {3, {a, b, c}};
    else  // ad, bd, bc, ac
      starts[at(back)] = {4, {c, a, d, b}};
  }
  return starts;
}();

}  // namespace

class TetEnvelope::Impl {
 public:
  Impl(const TetMesh& tets, const SiteValues& values) : tets_(tets), values_(values) {}

  void addPolygons(Index tet, std::span<const Index> candidates, BlockPolygons& out) {
    begin(tet);
    reserve(candidates.size() + 4);  // each clip adds at most one corner
    const std::size_t before = out.polygons.size();
    for (std::size_t a = 0; a < candidates.size(); ++a)
      for (std::size_t b = a + 1; b < candidates.size(); ++b) {
        back_ = candidates[a], front_ = candidates[b];
        if (!startPolygon()) continue;
        bool empty = false;
        for (std::size_t l = 0; l < candidates.size() && !empty; ++l)
          if (l != a && l != b) empty = !clipBy(candidates[l]);
        if (!empty) emit(out);
      }
    out.cutTets += out.polygons.size() > before;
  }

 private:
  /// An edge's line: 0…3 a face, from 4 on a rank + 4. Corner i of the polygon lies between lines i − 1 and
  /// i.
  using Line = Index;
  static bool isFace(Line l) { return l < 4; }

  /// Per two faces the two corners that lie on both.
  static constexpr std::array<std::array<std::array<unsigned char, 2>, 4>, 4> kRest{
      {{{{0, 0}, {2, 3}, {1, 3}, {1, 2}}},
       {{{2, 3}, {0, 0}, {0, 3}, {0, 2}}},
       {{{1, 3}, {0, 3}, {0, 0}, {0, 1}}},
       {{{1, 2}, {0, 2}, {0, 1}, {0, 0}}}}};

  /// Where a corner is, as the nodes' weights, each off by no more than `error`; what the filters go by.
  struct Corner {
    std::array<double, 4> weight{};
    double error = 0;
  };

  void reserve(std::size_t corners) {
    if (lines_.size() >= corners) return;
    for (auto* v : {&lines_, &clippedLines_}) v->resize(corners);
    for (auto* v : {&corners_, &clippedCorners_}) v->resize(corners);
    valueAt_.resize(corners), errorAt_.resize(corners), signs_.resize(corners);
  }

  void begin(Index tet) {
    tet_ = tet;
    nodes_ = tets_.tets[at(tet)];
    ascending_ = {0, 1, 2, 3};
    std::sort(ascending_.begin(), ascending_.end(),
              [&](Line a, Line b) { return nodes_[at(a)] < nodes_[at(b)]; });
    for (std::size_t i = 0; i < 4; ++i) {
      g_[i] = values_.at(nodes_[i]);
      atBoundary_[i] = !tets_.neighbours.empty() && tets_.neighbours[at(tet)][i] < 0;
    }
  }

  /// The plane g_back = g_front in the tetrahedron; false where it misses that.
  bool startPolygon() {
    std::size_t back = 0;
    for (std::size_t i = 0; i < 4; ++i)  // ties go to the lower rank, the back
      back |= static_cast<std::size_t>(g_[i][front_] >= g_[i][back_]) << i;
    const Start& start = kStart[back];
    count_ = start.count;
    std::copy(start.lines.begin(), start.lines.end(), lines_.begin());
    for (std::size_t i = 0; i < count_; ++i) placeOnEdge(lines_[before(i)], lines_[i], corners_[i]);
    return count_ > 0;
  }

  /// Where the plane meets the edge that two faces share.
  void placeOnEdge(Line one, Line other, Corner& corner) const {
    const std::array<unsigned char, 2>& ends = kRest[at(one)][at(other)];
    const double from = g_[ends[0]][front_] - g_[ends[0]][back_],
                 to = g_[ends[1]][front_] - g_[ends[1]][back_];
    const double t = from != to ? from / (from - to) : 0.5;
    // Differences are off by a unit each, and there are three roundings; where both are 0 it may be anywhere.
    corner.error = from != to ? 0x1p-50 : 1;
    corner.weight = {};
    corner.weight[ends[0]] = 1 - t;
    corner.weight[ends[1]] = t;
  }

  /// Between corners where a function is `from` > 0 and `to` < 0, each off by no more than `error`.
  static void placeBetween(const Corner& a, const Corner& b, double from, double to, double error,
                           Corner& corner) {
    from = std::max(from, 0.0), to = std::min(to, 0.0);
    const double length = from - to;
    if (!(length > 8 * error)) {
      corner.error = 1;
      for (std::size_t i = 0; i < 4; ++i) corner.weight[i] = 0.5 * (a.weight[i] + b.weight[i]);
      return;
    }
    const double t = from / length;
    double apart = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      apart = std::max(apart, std::abs(b.weight[i] - a.weight[i]));
      corner.weight[i] = a.weight[i] + t * (b.weight[i] - a.weight[i]);
    }
    const double inherited = std::max(a.error, b.error);
    corner.error = inherited + (apart + 2 * inherited) * (4 * error / length) + 0x1p-50;
  }

  /// det and what it would be with all its products positive, of the differences' rounded values.
  struct Rough {
    double value = 0, size = 0;
  };
  using Entries = std::array<std::array<double, 4>, 4>;

  static Rough expand2(const Entries& m, std::size_t row, std::size_t a, std::size_t b) {
    const double x = m[row][a] * m[row + 1][b], y = m[row][b] * m[row + 1][a];
    return {x - y, std::abs(x) + std::abs(y)};
  }
  static Rough expand3(const Entries& m, std::size_t row, const std::array<std::size_t, 3>& c) {
    const Rough x = expand2(m, row + 1, c[1], c[2]), y = expand2(m, row + 1, c[0], c[2]),
                z = expand2(m, row + 1, c[0], c[1]);
    const double p = m[row][c[0]], q = m[row][c[1]], r = m[row][c[2]];
    return {p * x.value - q * y.value + r * z.value,
            std::abs(p) * x.size + std::abs(q) * y.size + std::abs(r) * z.size};
  }
  static Rough roughDeterminant(const Entries& m, std::size_t n) {
    if (n == 1) return {m[0][0], std::abs(m[0][0])};
    if (n == 2) return expand2(m, 0, 0, 1);
    if (n == 3) return expand3(m, 0, {0, 1, 2});
    Rough sum;
    constexpr std::array<std::array<std::size_t, 3>, 4> rest{{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};
    for (std::size_t c = 0; c < 4; ++c) {
      const Rough d = expand3(m, 1, rest[c]);
      sum.value += (c % 2 == 0 ? m[0][c] : -m[0][c]) * d.value;
      sum.size += std::abs(m[0][c]) * d.size;
    }
    return sum;
  }

  int determinantSign(std::span<const int> nodes, std::span<const std::array<Index, 2>> pairs) const {
    Entries m;
    for (std::size_t r = 0; r < nodes.size(); ++r) {
      const double* g = g_[static_cast<std::size_t>(nodes[r])];
      for (std::size_t c = 0; c < pairs.size(); ++c) m[r][c] = g[pairs[c][0]] - g[pairs[c][1]];
    }
    // Each product has at most four factors off by a unit each, three roundings, and five more in the sums.
    const Rough rough = roughDeterminant(m, nodes.size());
    if (std::abs(rough.value) > 16 * 0x1p-53 * rough.size + 0x1p-1000) return rough.value > 0 ? 1 : -1;
    return exactSign(nodes, pairs);
  }

  int exactSign(std::span<const int> nodes, std::span<const std::array<Index, 2>> pairs) const {
    std::array<AffineFunction, 4> functions;
    for (std::size_t c = 0; c < pairs.size(); ++c) {
      functions[c].plus = pairs[c][0];
      functions[c].minus = pairs[c][1];
      for (std::size_t i = 0; i < 4; ++i)
        functions[c].plusAt[i] = g_[i] + pairs[c][0], functions[c].minusAt[i] = g_[i] + pairs[c][1];
    }
    return nodeDeterminantSign(nodes, std::span(functions).first(pairs.size()));
  }

  /// Sign of g_third − g_back at the corner between two lines.
  int signAtCorner(Line one, Line other, Index third) const {
    std::array<int, 4> nodes{};
    std::size_t n = 0;
    for (int i = 0; i < 4; ++i)
      if (one != i && other != i) nodes[n++] = i;
    std::array<std::array<Index, 2>, 4> pairs{{{front_, back_}}};
    std::size_t functions = 1;
    for (const Line l : {one, other})
      if (!isFace(l)) pairs[functions++] = {l - 4, back_};
    pairs[functions] = {third, back_};
    // The corner's weights are the cofactors of the last column, up to a sign that they share.
    const std::span<const int> all(nodes.data(), n);
    const int sign =
        determinantSign(all.subspan(1), std::span(pairs).first(functions)) * (n % 2 == 0 ? -1 : 1);
    return sign * determinantSign(all, std::span(pairs).first(functions + 1));
  }

  /// The signs of g_third − g_back at all corners; returns how many are positive. Branches that go either
  /// way would take most of the time.
  std::size_t evaluate(Index third) {
    std::array<double, 4> difference;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      difference[i] = g_[i][third] - g_[i][back_];
      sum += std::abs(difference[i]);
    }
    std::size_t positive = 0;
    bool isOpen = false;
    for (std::size_t i = 0; i < count_; ++i) {
      const Corner& c = corners_[i];
      const auto term = [&](std::size_t k) { return c.weight[k] * difference[k]; };
      const double value = (term(0) + term(2)) + (term(1) + term(3));
      const double error = 1.01 * ((8 * 0x1p-53 + c.error) * sum) + 0x1p-1000;  // weights are at most 1
      valueAt_[i] = value, errorAt_[i] = error;
      signs_[i] = static_cast<int>(value > error) - static_cast<int>(value < -error);
      positive += value > error;
      isOpen |= signs_[i] == 0;
    }
    for (std::size_t i = 0; isOpen && i < count_; ++i)
      if (signs_[i] == 0) {
        signs_[i] = signAtCorner(lines_[before(i)], lines_[i], third);
        positive += signs_[i] > 0;
      }
    return positive;
  }

  /// Keeps where g_third ≥ g_back; false where nothing is left.
  bool clipBy(Index third) {
    const std::size_t n = count_, kept = evaluate(third);
    if (kept == n) return true;
    if (kept == 0) return false;
    // The kept corners follow one another; begin with the first of them.
    std::size_t first = 0;
    while (!(signs_[first] > 0 && signs_[before(first)] < 0)) ++first;
    std::size_t last = first + kept - 1;
    if (last >= n) last -= n;
    const std::size_t outBefore = before(first), outAfter = last + 1 == n ? 0 : last + 1;
    const auto place = [&](std::size_t in, std::size_t out, Corner& corner) {
      placeBetween(corners_[in], corners_[out], valueAt_[in], valueAt_[out],
                   std::max(errorAt_[in], errorAt_[out]), corner);
    };
    // The new line leads from where the kept corners end to where they begin.
    clippedLines_.front() = lines_[outBefore];
    place(first, outBefore, clippedCorners_.front());
    for (std::size_t i = 0, from = first; i < kept; ++i, from = from + 1 == n ? 0 : from + 1) {
      clippedLines_[i + 1] = lines_[from];
      clippedCorners_[i + 1] = corners_[from];
    }
    clippedLines_[kept + 1] = third + 4;
    place(last, outAfter, clippedCorners_[kept + 1]);
    count_ = kept + 2;
    lines_.swap(clippedLines_);
    corners_.swap(clippedCorners_);
    return true;
  }

  void emit(BlockPolygons& out) const {
    out.polygons.push_back({tet_, back_, front_, static_cast<Index>(count_)});
    for (std::size_t i = 0; i < count_; ++i) {
      const Line into = lines_[before(i)], from = lines_[i];
      out.corners.push_back(nameOf(into, from));
      out.lines.push_back({isFace(from) ? from : -1, isFace(from) ? -1 : from - 4});
      const auto isOutside = [&](Line l) { return isFace(l) && atBoundary_[static_cast<std::size_t>(l)]; };
      out.onCage.push_back(isOutside(into) || isOutside(from));
    }
  }

  std::size_t before(std::size_t corner) const { return corner == 0 ? count_ - 1 : corner - 1; }

  VertexName nameOf(Line one, Line other) const {
    VertexName name;
    std::size_t n = 0;
    for (const Line i : ascending_)
      if (one != i && other != i) name.nodes[n++] = nodes_[at(i)];
    name.ranks[0] = back_;  // back_ < front_
    name.ranks[1] = front_;
    n = 2;
    for (const Line l : {one, other}) {
      if (isFace(l)) continue;
      std::size_t place = n++;
      for (; place > 0 && name.ranks[place - 1] > l - 4; --place) name.ranks[place] = name.ranks[place - 1];
      name.ranks[place] = l - 4;
    }
    return name;
  }

  const TetMesh& tets_;
  const SiteValues& values_;
  Index tet_ = -1;
  Tetra nodes_{};
  std::array<Line, 4> ascending_{};  ///< the corners by their nodes' numbers
  std::array<const double*, 4> g_{};
  std::array<bool, 4> atBoundary_{};
  Index back_ = -1, front_ = -1;
  // The polygon has `count_` corners; the vectors are longer, so that they need not grow in between.
  std::size_t count_ = 0;
  std::vector<Line> lines_, clippedLines_;
  std::vector<Corner> corners_, clippedCorners_;
  std::vector<double> valueAt_, errorAt_;
  std::vector<int> signs_;
};

TetEnvelope::TetEnvelope(const TetMesh& tets, const SiteValues& values)
    : impl_(std::make_unique<Impl>(tets, values)) {}
TetEnvelope::~TetEnvelope() = default;

void TetEnvelope::addPolygons(Index tet, std::span<const Index> candidates, BlockPolygons& out) {
  impl_->addPolygons(tet, candidates, out);
}

}  // namespace sherd
