#include "geometry/exact_points.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sherd {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Rational = CGAL::Exact_rational;
using Interval = CGAL::Interval_nt<true>;

Kernel::Point_3 toPoint(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// A product of displacements ε(row, column): a matching of rows (points, by ascending number) to
/// coordinates.
struct Term {
  std::array<int, 4> column{-1, -1, -1, -1};  ///< per row, −1: this row is not displaced
  std::uint32_t weight = 0;                   ///< exponent of ε: the smaller, the greater the displacement
};

/// All 73 terms of the determinant's polynomial in ε, from the greatest to the least.
const std::vector<Term>& terms() {
  static const std::vector<Term> all = [] {
    std::vector<Term> list;
    for (int code = 0; code < 256; ++code) {
      Term term;
      std::array<int, 3> uses{};
      for (int row = 0; row < 4; ++row) {
        const int column = ((code >> (2 * row)) & 3) - 1;
        term.column[static_cast<std::size_t>(row)] = column;
        if (column < 0) continue;
        ++uses[static_cast<std::size_t>(column)];
        term.weight += 1u << (3 * row + column);
      }
      if (*std::max_element(uses.begin(), uses.end()) <= 1) list.push_back(term);
    }
    std::sort(list.begin(), list.end(), [](const Term& a, const Term& b) { return a.weight < b.weight; });
    return list;
  }();
  return all;
}

struct Permutation {
  std::array<int, 4> column;
  int sign;
};

const std::vector<Permutation>& permutations() {
  static const std::vector<Permutation> all = [] {
    std::vector<Permutation> list;
    std::array<int, 4> p{0, 1, 2, 3};
    do {
      int sign = 1;
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j)
          if (p[i] > p[j]) sign = -sign;
      list.push_back({p, sign});
    } while (std::next_permutation(p.begin(), p.end()));
    return list;
  }();
  return all;
}

/// The coefficient of `term` in det of the rows (x, y, z, 1): the permutations that contain the matching.
int coefficientSign(const std::array<const Vec3*, 4>& rows, const Term& term) {
  Rational sum = 0;
  for (const Permutation& p : permutations()) {
    bool contains = true;
    Rational product = p.sign;
    for (std::size_t row = 0; row < 4 && contains; ++row) {
      if (term.column[row] >= 0)
        contains = term.column[row] == p.column[row];
      else if (p.column[row] < 3)
        product *= Rational((*rows[row])[p.column[row]]);
    }
    if (contains) sum += product;
  }
  return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

int displacedOrientation(std::array<std::pair<Index, const Vec3*>, 4> points) {
  int sign = -1;  // det of the rows (p, 1) is −det[q−p, r−p, s−p]
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j + 1 < 4 - i; ++j)
      if (points[j].first > points[j + 1].first) {
        std::swap(points[j], points[j + 1]);
        sign = -sign;
      }
  const std::array<const Vec3*, 4> rows{points[0].second, points[1].second, points[2].second,
                                        points[3].second};
  for (const Term& term : terms())
    if (const int s = coefficientSign(rows, term); s != 0) return sign * s;
  return sign;  // not reached: the last terms have coefficient ±1
}

template <class Number>
Number determinant(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<std::array<Number, 3>, 3> m;
  const Vec3* rows[] = {&b, &c, &d};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      m[i][k] = Number((*rows[i])[static_cast<Eigen::Index>(k)]) - Number(a[static_cast<Eigen::Index>(k)]);
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// det[b−a, c−a, d−a] with some points shifted by 1 along an axis. Where neither none nor all are, it is
/// linear in the shift.
int shiftedSign(const std::array<const Vec3*, 4>& points, const std::array<bool, 4>& shifted,
                std::size_t axis) {
  std::array<std::array<Rational, 3>, 4> p;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      p[i][k] = Rational((*points[i])[static_cast<Eigen::Index>(k)]);
      if (shifted[i] && k == axis) p[i][k] += 1;
    }
  std::array<std::array<Rational, 3>, 3> m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) m[i][k] = p[i + 1][k] - p[0][k];
  const Rational d = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                     m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return d > 0 ? 1 : d < 0 ? -1 : 0;
}

/// Distances of p and q from a plane, up to one common factor, both made non-negative.
template <class Number>
struct Depths {
  Number p, q;
};

template <class Number>
Depths<Number> depths(const ExactPoints& points, Index p, Index q, const Triangle& t) {
  const Number dp = determinant<Number>(points[t[0]], points[t[1]], points[t[2]], points[p]);
  const Number dq = determinant<Number>(points[t[0]], points[t[1]], points[t[2]], points[q]);
  return {dp, dq};
}

/// A coordinate of (b − a) × (c − a).
Rational normalCoordinate(const ExactPoints& points, const Triangle& t, std::size_t axis) {
  const Eigen::Index i = static_cast<Eigen::Index>((axis + 1) % 3),
                     j = static_cast<Eigen::Index>((axis + 2) % 3);
  const auto difference = [&](Index to, Eigen::Index k) -> Rational {
    return Rational(points[to][k]) - Rational(points[t[0]][k]);
  };
  return difference(t[1], i) * difference(t[2], j) - difference(t[1], j) * difference(t[2], i);
}

/// Where pq comes nearest to the triangle, which lies on a line or at a point: the share of the way from p.
double shareNearestToLine(const ExactPoints& points, Index p, Index q, const Triangle& t) {
  std::array<std::size_t, 2> ends{0, 1};  // the longest side
  for (std::size_t i = 1; i < 3; ++i)
    if ((points[t[i]] - points[t[(i + 1) % 3]]).squaredNorm() >
        (points[t[ends[0]]] - points[t[ends[1]]]).squaredNorm())
      ends = {i, (i + 1) % 3};
  const Vec3 origin = points[t[ends[0]]], side = points[t[ends[1]]] - origin;
  const Vec3 way = points[q] - points[p], from = points[p] - origin;
  const Vec3 normal = way.cross(side);
  const double n2 = normal.squaredNorm(), length2 = way.squaredNorm();
  if (!(length2 > 0)) return 0.5;
  if (n2 > 0x1p-80 * length2 * side.squaredNorm())
    return std::clamp(side.cross(from).dot(normal) / n2, 0.0, 1.0);
  // Along each other: the middle of what they share.
  const double s = -from.dot(way) / length2, e = (side - from).dot(way) / length2;
  return 0.5 * (std::clamp(std::min(s, e), 0.0, 1.0) + std::clamp(std::max(s, e), 0.0, 1.0));
}

/// The shares of the ways from p and from q at which pq crosses the triangle's plane, off by no more than
/// some 2⁻⁴² of the sizes at hand. Rounded depths don't tell where the segment is all but in the plane: what
/// they give there can lie anywhere on it, far from the triangle.
std::array<double, 2> shares(const ExactPoints& points, Index p, Index q, const Triangle& t) {
  const auto extent = [&](Index to) { return (points[to] - points[t[0]]).cwiseAbs().maxCoeff(); };
  // A depth is six products of three differences, and off by some 2⁻⁴⁸ of this.
  const double size = extent(t[1]) * extent(t[2]) * std::max(extent(p), extent(q));
  const auto divided = [](auto ofP, auto ofQ) {
    const auto sum = ofP + ofQ;
    return std::array{static_cast<double>(ofP / sum), static_cast<double>(ofQ / sum)};
  };
  const auto rough = depths<double>(points, p, q, t);
  if (std::abs(rough.p) + std::abs(rough.q) > 0x1p-6 * size)
    return divided(std::abs(rough.p), std::abs(rough.q));
  const auto fine = depths<long double>(points, p, q, t);
  if (std::abs(fine.p) + std::abs(fine.q) > 0x1p-17L * static_cast<long double>(size))
    return divided(std::abs(fine.p), std::abs(fine.q));
  const auto exact = depths<Rational>(points, p, q, t);
  const Rational ofP = abs(exact.p), ofQ = abs(exact.q), sum = ofP + ofQ;
  if (sum > 0) return {CGAL::to_double(Rational(ofP / sum)), CGAL::to_double(Rational(ofQ / sum))};
  const double share = shareNearestToLine(points, p, q, t);
  return {share, 1 - share};
}

}  // namespace

int ExactPoints::orientation(Index a, Index b, Index c, Index d) const {
  const Vec3 &pa = points_[at(a)], &pb = points_[at(b)], &pc = points_[at(c)], &pd = points_[at(d)];
  const auto exact = CGAL::orientation(toPoint(pa), toPoint(pb), toPoint(pc), toPoint(pd));
  if (exact != CGAL::COPLANAR) return exact == CGAL::POSITIVE ? 1 : -1;
  const std::array<bool, 4> moved{isMoved(a), isMoved(b), isMoved(c), isMoved(d)};
  if (const auto count = std::count(moved.begin(), moved.end(), true); count > 0 && count < 4)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (const int s = shiftedSign({&pa, &pb, &pc, &pd}, moved, axis); s != 0) return s;
  return displacedOrientation({{{a, &pa}, {b, &pb}, {c, &pc}, {d, &pd}}});
}

bool ExactPoints::crosses(Index p, Index q, const Triangle& t) const {
  if (side(t, p) == side(t, q)) return false;
  const int first = orientation(p, q, t[0], t[1]);
  return first == orientation(p, q, t[1], t[2]) && first == orientation(p, q, t[2], t[0]);
}

int ExactPoints::compareCrossings(Index p, Index q, const Triangle& s, const Triangle& t) const {
  // The crossing is at depth_p / (depth_p − depth_q) of the way; compared crosswise to avoid the division.
  auto compare = [&](auto zero) {
    using Number = decltype(zero);
    const auto a = depths<Number>(*this, p, q, s), b = depths<Number>(*this, p, q, t);
    const Number sumA = a.p - a.q, sumB = b.p - b.q;
    return std::array<Number, 3>{a.p * sumB - b.p * sumA, sumA, sumB};
  };
  const auto rough = compare(Interval(0));
  auto known = [](const Interval& i) { return i.inf() > 0 || i.sup() < 0; };
  if (known(rough[0]) && known(rough[1]) && known(rough[2])) {
    int sign = rough[0].inf() > 0 ? 1 : -1;
    if (rough[1].sup() < 0) sign = -sign;
    if (rough[2].sup() < 0) sign = -sign;
    return sign;
  }
  const auto exact = compare(Rational(0));
  auto signOf = [](const Rational& r) { return r > 0 ? 1 : r < 0 ? -1 : 0; };
  const int orientation = (signOf(exact[1]) < 0 ? -1 : 1) * (signOf(exact[2]) < 0 ? -1 : 1);
  if (exact[0] != 0 || isMoved(p) == isMoved(s[0])) return signOf(exact[0]) * orientation;
  // Moved along an axis, all depths change by that coordinate of their plane's normal: linear in the move.
  const Rational direction = isMoved(p) ? 1 : -1;
  const auto a = depths<Rational>(*this, p, q, s), b = depths<Rational>(*this, p, q, t);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Rational ofA = normalCoordinate(*this, s, axis), ofB = normalCoordinate(*this, t, axis);
    const Rational change = direction * (ofA * (b.p - b.q) - ofB * (a.p - a.q));
    if (change != 0) return signOf(change) * orientation;
  }
  return 0;
}

Vec3 ExactPoints::crossing(Index p, Index q, const Triangle& t) const {
  if (p > q) std::swap(p, q);
  const Vec3 &a = (*this)[p], &b = (*this)[q];
  const auto [u, v] = shares(*this, p, q, t);
  // From the nearer end, so that a crossing close to an end is placed with that end's precision.
  Vec3 point = u <= v ? Vec3(a + u * (b - a)) : Vec3(b + v * (a - b));
  point = point.cwiseMax(a.cwiseMin(b)).cwiseMin(a.cwiseMax(b));
  const Vec3 &x = (*this)[t[0]], &y = (*this)[t[1]], &z = (*this)[t[2]];
  for (Eigen::Index k = 0; k < 3; ++k)
    if (x[k] == y[k] && y[k] == z[k]) point[k] = x[k];
  return point;
}

}  // namespace sherd
