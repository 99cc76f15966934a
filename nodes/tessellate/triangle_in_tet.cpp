#include "tessellate/triangle_in_tet.h"

#include <algorithm>
#include <cmath>

namespace sherd {
namespace {

constexpr double kUnit = 0x1p-53;
constexpr double kExtended = 0x1p-11;  ///< how much less extended precision is off than doubles are

using Wide = long double;

/// An affine function in extended precision.
class WidePlane {
 public:
  /// Barycentric coordinate `corner` of the tetrahedron, times six volumes.
  WidePlane(const TetFrame& frame, int corner) : base_(frame.base[static_cast<std::size_t>(corner)]) {
    gradient_ = inward(frame, static_cast<std::size_t>(corner));
  }
  /// g_plus − g_minus, times six volumes.
  WidePlane(const TetFrame& frame, Index plus, Index minus) : base_(frame.corners[0]) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Wide d = static_cast<Wide>(frame.g[i][plus]) - static_cast<Wide>(frame.g[i][minus]);
      const std::array<Wide, 3> own = inward(frame, i);
      for (std::size_t k = 0; k < 3; ++k) gradient_[k] += d * own[k];
      if (i == 0) atBase_ = d * along(own, base_, frame.base[0]);
    }
  }

  Wide at(const Vec3& point) const { return atBase_ + along(gradient_, point, base_); }

 private:
  static Wide along(const std::array<Wide, 3>& v, const Vec3& point, const Vec3& base) {
    Wide sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += v[k] * difference(point, base, k);
    return sum;
  }
  static Wide difference(const Vec3& p, const Vec3& q, std::size_t k) {
    const auto i = static_cast<Eigen::Index>(k);
    return static_cast<Wide>(p[i]) - static_cast<Wide>(q[i]);
  }
  static std::array<Wide, 3> inward(const TetFrame& frame, std::size_t corner) {
    const auto& face = kTetraFace[corner];
    const Vec3 &p = frame.corners[static_cast<std::size_t>(face[2])],
               &q = frame.corners[static_cast<std::size_t>(face[1])], &base = frame.base[corner];
    std::array<Wide, 3> u, v, cross;
    for (std::size_t k = 0; k < 3; ++k) u[k] = difference(p, base, k), v[k] = difference(q, base, k);
    for (std::size_t k = 0; k < 3; ++k)
      cross[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    return cross;
  }

  Vec3 base_;
  std::array<Wide, 3> gradient_{};
  Wide atBase_ = 0;
};

}  // namespace

TetFrame::TetFrame(const TetMesh& tets, const SiteValues& values, Index tet) {
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = tets.nodes[at(tets.tets[at(tet)][i])];
    g[i] = values.at(tets.tets[at(tet)][i]);
    for (std::size_t k = 0; k < i; ++k)
      longest = std::max(longest, (corners[i] - corners[k]).cwiseAbs().maxCoeff());
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& face = kTetraFace[i];
    base[i] = corners[static_cast<std::size_t>(face[0])];
    inward[i] = (corners[static_cast<std::size_t>(face[2])] - base[i])
                    .cross(corners[static_cast<std::size_t>(face[1])] - base[i]);
  }
  // Each coordinate of `inward` is at most 2 longest² and off by at most 4 units of that; the product with a
  // rounded difference adds at most another 4.
  error = 20 * kUnit * longest * longest;
}

std::array<Approx, 4> TetFrame::coordinates(const Vec3& point) const {
  std::array<Approx, 4> result;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 d = point - base[i];
    result[i] = {inward[i].dot(d), error * d.cwiseAbs().sum()};
  }
  return result;
}

Approx TetFrame::difference(const std::array<Approx, 4>& coordinates, Index plus, Index minus) const {
  double value = 0, size = 0, inherited = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double d = g[i][plus] - g[i][minus];
    value += coordinates[i].value * d;
    size += std::abs(coordinates[i].value * d);
    inherited += coordinates[i].error * std::abs(d);
  }
  return {value, 8 * kUnit * size + (1 + 8 * kUnit) * inherited + 0x1p-1060};
}

AffineFunction TetFrame::differenceFunction(Index plus, Index minus) const {
  AffineFunction f;
  f.plus = plus;
  f.minus = minus;
  for (std::size_t i = 0; i < 4; ++i) f.plusAt[i] = g[i] + plus, f.minusAt[i] = g[i] + minus;
  return f;
}

AffineFunction TetFrame::cornerFunction(int corner) {
  AffineFunction f;
  f.corner = corner;
  return f;
}

int TetFrame::sign(const Vec3& vertex, const std::array<Approx, 4>& coordinates, Index plus,
                   Index minus) const {
  if (const int s = difference(coordinates, plus, minus).sign(); s != 0) return s;
  const AffineFunction f = differenceFunction(plus, minus);
  return vertexDeterminantSign(corners, std::span(&vertex, 1), std::span(&f, 1));
}

SheetPlane::SheetPlane(const TetFrame& frame, Index back, Index front)
    : base(frame.corners[0]), normal(Vec3::Zero()) {
  double size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double d = frame.g[i][front] - frame.g[i][back];
    normal += d * frame.inward[i];
    size += std::abs(d);
    if (i == 0) offset = d * frame.inward[0].dot(base - frame.base[0]);
  }
  // Twice what the coordinates bring along, for the sums here; corners are at most 3 longest edges apart in
  // this norm.
  error = 2 * frame.error * size;
  errorAtBase = 2 * error * frame.longest;
}

TriangleInTet::TriangleInTet(const TetFrame& frame, const Triangle& corners, std::span<const Vec3> positions)
    : frame_(frame) {
  for (std::size_t c = 0; c < 3; ++c) {
    vertices_[c] = positions[at(corners[c])];
    coordinates_[c] = frame.coordinates(vertices_[c]);
  }
}

Approx TriangleInTet::value(int function, std::size_t corner) const {
  if (function == kSheet) return sheet_[corner];
  const SheetEdgeLine& line = lines_[static_cast<std::size_t>(function)];
  if (line.face >= 0) return coordinates_[corner][static_cast<std::size_t>(line.face)];
  return frame_.difference(coordinates_[corner], line.third, back_);
}

AffineFunction TriangleInTet::affine(int function) const {
  if (function == kSheet) return frame_.differenceFunction(front_, back_);
  const SheetEdgeLine& line = lines_[static_cast<std::size_t>(function)];
  return line.face >= 0 ? TetFrame::cornerFunction(line.face) : frame_.differenceFunction(line.third, back_);
}

int TriangleInTet::determinantSign(std::span<const std::size_t> corners,
                                   std::span<const int> functions) const {
  std::array<std::array<Approx, 3>, 3> m;
  for (std::size_t r = 0; r < corners.size(); ++r)
    for (std::size_t c = 0; c < functions.size(); ++c) m[r][c] = value(functions[c], corners[r]);
  const auto minor = [&](std::size_t row, std::size_t a, std::size_t b) {
    return m[row][a] * m[row + 1][b] - m[row][b] * m[row + 1][a];
  };
  const Approx d = corners.size() == 2
                       ? minor(0, 0, 1)
                       : m[0][0] * minor(1, 1, 2) - m[0][1] * minor(1, 0, 2) + m[0][2] * minor(1, 0, 1);
  if (const int s = d.sign(); s != 0) return s;
  std::array<Vec3, 3> points;
  std::array<AffineFunction, 3> exact;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    points[i] = vertices_[corners[i]];
    exact[i] = affine(functions[i]);
  }
  return vertexDeterminantSign(frame_.corners, std::span(points).first(corners.size()),
                               std::span(exact).first(corners.size()));
}

int TriangleInTet::signAtEnd(const SegmentEnd& end, int function) const {
  // The end's weights are the cofactors of the last column, up to a sign that they share.
  if (end.side >= 0) {
    const auto p = static_cast<std::size_t>(end.side), q = (p + 1) % 3;
    return -signs_[q] * determinantSign(std::array{p, q}, std::array{kSheet, function});
  }
  const int own = static_cast<int>(end.slot);
  const int sign = determinantSign(std::array<std::size_t, 2>{1, 2}, std::array{kSheet, own});
  return sign * determinantSign(std::array<std::size_t, 3>{0, 1, 2}, std::array{kSheet, own, function});
}

void TriangleInTet::take(Index back, Index front, std::span<const SheetEdgeLine> lines) {
  back_ = back, front_ = front, lines_ = lines;
  for (std::size_t c = 0; c < 3; ++c) sheet_[c] = frame_.difference(coordinates_[c], front, back);
}

namespace {

/// Is a function certainly negative at `place` on the way from where it is a to where it is b? A first look.
bool liesBelow(const Approx& a, const Approx& b, const Approx& place) {
  constexpr double roundings = 0x1p-49;
  const double way = b.value - a.value;
  const double error =
      a.error + b.error + place.error * std::abs(way) + roundings * (std::abs(a.value) + std::abs(b.value));
  return a.value + place.value * way < -error;
}

/// Where on the way from a to b, values of different signs, a function vanishes: in [0, 1].
Approx crossing(const Approx& a, const Approx& b) {
  const double from = std::abs(a.value), to = std::abs(b.value), error = std::max(a.error, b.error);
  if (!(from + to > 8 * error)) return {0.5, 0.5};
  return {from / (from + to), 4 * error / (from + to) + 0x1p-50};
}

}  // namespace

bool TriangleInTet::meets(Index back, Index front, std::span<const SheetEdgeLine> lines, SegmentEnd& from,
                          SegmentEnd& to) {
  take(back, front, lines);
  int sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    signs_[c] = sheet_[c].sign();
    if (signs_[c] == 0) signs_[c] = frame_.sign(vertices_[c], coordinates_[c], front, back);
    sum += signs_[c];
  }
  if (sum == 3 || sum == -3) return false;
  // The corner that is alone on its side, with the chord that has the back cell (positive) on its left.
  std::size_t alone = 0;
  while (signs_[alone] == (sum > 0 ? 1 : -1)) ++alone;
  const std::size_t next = (alone + 1) % 3, last = (alone + 2) % 3;
  from = {static_cast<int>(alone), -1}, to = {static_cast<int>(last), -1};
  const bool turned = signs_[alone] < 0;
  if (turned) std::swap(from, to);
  const Approx toNext = crossing(sheet_[alone], sheet_[next]), toLast = crossing(sheet_[alone], sheet_[last]);
  Approx begin = 0, end = 1;  // of what is left of the chord
  for (std::size_t slot = 0; slot < lines.size(); ++slot) {
    const int function = static_cast<int>(slot);
    const Approx own = value(function, alone), atNext = value(function, next), atLast = value(function, last);
    if (liesBelow(own, atNext, toNext) && liesBelow(own, atLast, toLast)) return false;
    Approx first = own + toNext * (atNext - own), second = own + toLast * (atLast - own);
    if (turned) std::swap(first, second);
    const Approx slope = second - first;
    const auto signAt = [&](const Approx& place, const SegmentEnd& where) {
      const int sign = (first + place * slope).sign();
      return sign != 0 ? sign : signAtEnd(where, function);
    };
    const int atFrom = signAt(begin, from), atTo = signAt(end, to);
    if (atFrom < 0 && atTo < 0) return false;
    if (atFrom < 0) from = {-1, static_cast<Index>(slot)}, begin = crossing(first, second);
    if (atTo < 0) to = {-1, static_cast<Index>(slot)}, end = crossing(first, second);
  }
  return true;
}

std::array<double, 3> TriangleInTet::weights(const SegmentEnd& end, double tolerance) const {
  const bool onSide = end.side >= 0;
  const int own = static_cast<int>(end.slot);
  std::array<std::size_t, 3> corners{0, 1, 2};
  if (onSide) corners[0] = static_cast<std::size_t>(end.side), corners[1] = (corners[0] + 1) % 3;
  const std::size_t n = onSide ? 2 : 3;
  // On a side the minors are the other end's values, else those of the sheet and the edge's line.
  const auto minors = [&](auto sheet, auto line) {
    using Number = decltype(sheet(0));
    std::array<Number, 3> m{};
    if (onSide) return std::array<Number, 3>{sheet(corners[1]), -sheet(corners[0]), m[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      m[i] = sheet(j) * line(k) - sheet(k) * line(j);
    }
    return m;
  };
  const auto rough =
      minors([&](std::size_t c) { return sheet_[c]; }, [&](std::size_t c) { return value(own, c); });
  const Approx sum = rough[0] + rough[1] + rough[2];
  const double error = std::max({sum.error, rough[0].error, rough[1].error, rough[2].error});
  double extent = 0;  // between the corners that the point is made of
  for (std::size_t i = 1; i < n; ++i)
    extent = std::max(extent, (vertices_[corners[i]] - vertices_[corners[0]]).cwiseAbs().maxCoeff());
  const double off = 4 * error * extent, allowed = tolerance * std::abs(sum.value);
  std::array<double, 3> result{};
  if (off <= allowed) {
    for (std::size_t i = 0; i < n; ++i) result[corners[i]] = rough[i].value / sum.value;
  } else if (off * kExtended <= allowed) {
    const WidePlane sheet(frame_, front_, back_);
    const auto line = [&] {
      if (onSide) return sheet;
      const SheetEdgeLine& l = lines_[static_cast<std::size_t>(own)];
      return l.face >= 0 ? WidePlane(frame_, l.face) : WidePlane(frame_, l.third, back_);
    }();
    const auto fine = minors([&](std::size_t c) { return sheet.at(vertices_[c]); },
                             [&](std::size_t c) { return line.at(vertices_[c]); });
    const Wide whole = fine[0] + fine[1] + fine[2];
    for (std::size_t i = 0; i < n; ++i) result[corners[i]] = static_cast<double>(fine[i] / whole);
  } else {
    std::array<Vec3, 3> points;
    for (std::size_t i = 0; i < n; ++i) points[i] = vertices_[corners[i]];
    std::array<AffineFunction, 2> functions{affine(kSheet)};
    if (!onSide) functions[1] = affine(own);
    const auto exact =
        vertexWeights(frame_.corners, std::span(points).first(n), std::span(functions).first(n - 1));
    for (std::size_t i = 0; i < n; ++i) result[corners[i]] = exact[i];
  }
  return result;
}

}  // namespace sherd
