#include "tessellate/symbolic_sign.h"

#include <CGAL/Mpzf.h>
#ifndef CGAL_HAS_MPZF
#include <CGAL/Exact_rational.h>
#endif

#include <algorithm>
#include <optional>
#include <vector>

namespace sherd {
namespace {

// Sums and products of doubles are all that is needed; no division.
#ifdef CGAL_HAS_MPZF
using Exact = CGAL::Mpzf;
#else
using Exact = CGAL::Exact_rational;
#endif
using ExactVec = std::array<Exact, 3>;

/// One function at all points: values, the gradient where points are moved, and the sites whose change it
/// follows.
struct Column {
  std::array<Exact, 4> value;
  ExactVec gradient{0, 0, 0};
  Index plus = -1, minus = -1;
};

/// What is small: nothing (the given doubles), a coordinate of the translation, or a site's change.
struct Level {
  int axis = -1;
  Index site = -1;
};

int signOf(const Exact& x) { return static_cast<int>(CGAL::sign(x)); }

/// The matrix of columns at rows, of which any part can be asked for its symbolic determinant.
class SymbolicMatrix {
 public:
  /// `moves`: the rows are points of the surface.
  SymbolicMatrix(std::vector<Column> columns, bool moves) : columns_(std::move(columns)) {
    levels_.push_back({});
    for (int axis = 0; axis < (moves ? 3 : 0); ++axis) levels_.push_back({axis, -1});
    std::vector<Index> sites;
    for (const Column& c : columns_)
      for (const Index site : {c.plus, c.minus})
        if (site >= 0) sites.push_back(site);
    std::sort(sites.begin(), sites.end());
    sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
    for (const Index site : sites) levels_.push_back({-1, site});
  }

  /// From the greatest to the least.
  const std::vector<Level>& levels() const { return levels_; }

  /// The coefficient of `level` in the determinant over `rows`, as many as columns.
  Exact coefficient(std::span<const int> rows, const Level& level) const {
    const std::size_t none = columns_.size();
    if (level.axis < 0 && level.site < 0) return determinant(rows, none);
    Exact sum = 0;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const Exact change = level.axis >= 0 ? columns_[c].gradient[static_cast<std::size_t>(level.axis)]
                                           : changeBySite(columns_[c], level.site);
      if (change != 0) sum += change * determinant(rows, c);
    }
    return sum;
  }

 private:
  /// g_site is lowered.
  static Exact changeBySite(const Column& c, Index site) {
    return Exact(static_cast<int>(c.minus == site) - static_cast<int>(c.plus == site));
  }

  /// With column `ones` replaced by ones; none where that is beyond the last.
  Exact determinant(std::span<const int> rows, std::size_t ones) const {
    std::array<std::size_t, 4> left{0, 1, 2, 3};
    return expand(rows, std::span(left).first(rows.size()), ones);
  }

  Exact expand(std::span<const int> rows, std::span<const std::size_t> columns, std::size_t ones) const {
    const auto entry = [&](std::size_t c) -> Exact {
      return c == ones ? Exact(1) : columns_[c].value[static_cast<std::size_t>(rows[0])];
    };
    if (columns.size() == 1) return entry(columns[0]);
    Exact sum = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Exact own = entry(columns[i]);
      if (own == 0) continue;
      std::array<std::size_t, 4> rest{};
      for (std::size_t k = 0, out = 0; k < columns.size(); ++k)
        if (k != i) rest[out++] = columns[k];
      const Exact d = own * expand(rows.subspan(1), std::span(rest).first(columns.size() - 1), ones);
      if (i % 2 == 0)
        sum += d;
      else
        sum -= d;
    }
    return sum;
  }

  std::vector<Column> columns_;
  std::vector<Level> levels_;
};

/// 0 where two columns are one and the same function.
int symbolicSign(const SymbolicMatrix& matrix, std::span<const int> rows) {
  for (const Level& level : matrix.levels())
    if (const int s = signOf(matrix.coefficient(rows, level)); s != 0) return s;
  return 0;
}

/// Weights with a common denominator.
template <std::size_t Size>
struct Weights {
  std::array<Exact, Size> part;
  Exact sum;

  double ratio(std::size_t i) const { return CGAL::to_double(part[i]) / CGAL::to_double(sum); }
};

/// Null vector of the n × (n − 1) matrix by its minors, from the first level at which it does not vanish.
template <std::size_t Size>
Weights<Size> symbolicWeights(const SymbolicMatrix& matrix, std::size_t n) {
  Weights<Size> weights;
  for (const Level& level : matrix.levels()) {
    weights.sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      std::array<int, Size> rows{};
      for (std::size_t k = 0, out = 0; k < n; ++k)
        if (k != i) rows[out++] = static_cast<int>(k);
      const Exact d = matrix.coefficient(std::span(rows).first(n - 1), level);
      weights.part[i] = i % 2 == 0 ? d : Exact(-d);
      weights.sum += weights.part[i];
    }
    if (weights.sum != 0) return weights;
  }
  for (std::size_t i = 0; i < n; ++i) weights.part[i] = 1;
  weights.sum = static_cast<int>(n);
  return weights;
}

std::vector<Column> nodeColumns(std::span<const int> nodes, std::span<const AffineFunction> functions) {
  std::vector<Column> columns(functions.size());
  for (std::size_t c = 0; c < functions.size(); ++c) {
    const AffineFunction& f = functions[c];
    columns[c].plus = f.plus;
    columns[c].minus = f.minus;
    for (std::size_t r = 0; r < nodes.size(); ++r) {
      const auto node = static_cast<std::size_t>(nodes[r]);
      columns[c].value[r] = Exact(*f.plusAt[node]) - Exact(*f.minusAt[node]);
    }
  }
  return columns;
}

/// The tetrahedron's four barycentric coordinates times six volumes, as base point and gradient each.
class ExactTet {
 public:
  explicit ExactTet(const std::array<Vec3, 4>& corners) {
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<ExactVec, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = exact(corners[static_cast<std::size_t>(kTetraFace[i][k])]);
      base_[i] = p[0];
      // The face turns counter-clockwise from outside; the coordinate grows inward.
      const ExactVec u = difference(p[2], p[0]), v = difference(p[1], p[0]);
      for (std::size_t k = 0; k < 3; ++k)
        gradient_[i][k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
  }

  Column column(const AffineFunction& f, std::span<const Vec3> points) const {
    Column c;
    for (std::size_t i = 0; i < 4; ++i) {
      Exact weight = i == static_cast<std::size_t>(f.corner) ? 1 : 0;
      if (f.corner < 0) weight = Exact(*f.plusAt[i]) - Exact(*f.minusAt[i]);
      if (weight == 0) continue;
      for (std::size_t k = 0; k < 3; ++k) c.gradient[k] += weight * gradient_[i][k];
      for (std::size_t r = 0; r < points.size(); ++r) c.value[r] += weight * coordinate(i, points[r]);
    }
    if (f.corner < 0) c.plus = f.plus, c.minus = f.minus;
    return c;
  }

 private:
  static ExactVec exact(const Vec3& p) { return {Exact(p.x()), Exact(p.y()), Exact(p.z())}; }
  static ExactVec difference(const ExactVec& a, const ExactVec& b) {
    return {Exact(a[0] - b[0]), Exact(a[1] - b[1]), Exact(a[2] - b[2])};
  }
  Exact coordinate(std::size_t i, const Vec3& point) const {
    const ExactVec d = difference(exact(point), base_[i]);
    return gradient_[i][0] * d[0] + gradient_[i][1] * d[1] + gradient_[i][2] * d[2];
  }

  std::array<ExactVec, 4> base_, gradient_;
};

SymbolicMatrix vertexMatrix(const std::array<Vec3, 4>& tet, std::span<const Vec3> points,
                            std::span<const AffineFunction> functions) {
  const ExactTet exact(tet);
  std::vector<Column> columns;
  for (const AffineFunction& f : functions) columns.push_back(exact.column(f, points));
  return {std::move(columns), true};
}

/// Six times the volume of each point over a triangle: positive in front of it.
Column heights(std::span<const Vec3> triangle, std::span<const Vec3> points) {
  // That triangle as the face opposite to a tetrahedron's corner 3, which the sought height is the coordinate
  // of.
  const ExactTet exact({triangle[0], triangle[1], triangle[2], triangle[0]});
  AffineFunction f;
  f.corner = 3;
  Column c = exact.column(f, points);
  c.gradient.fill(Exact(0));  // both triangles move together
  return c;
}

constexpr std::array<int, 4> kRows{0, 1, 2, 3};

}  // namespace

int nodeDeterminantSign(std::span<const int> nodes, std::span<const AffineFunction> functions) {
  return symbolicSign({nodeColumns(nodes, functions), false}, std::span(kRows).first(nodes.size()));
}

std::array<double, 4> nodeWeights(std::span<const int> nodes, std::span<const AffineFunction> functions) {
  const auto local = symbolicWeights<4>({nodeColumns(nodes, functions), false}, nodes.size());
  std::array<double, 4> weights{};
  for (std::size_t i = 0; i < nodes.size(); ++i) weights[static_cast<std::size_t>(nodes[i])] = local.ratio(i);
  return weights;
}

int vertexDeterminantSign(const std::array<Vec3, 4>& tet, std::span<const Vec3> points,
                          std::span<const AffineFunction> functions) {
  return symbolicSign(vertexMatrix(tet, points, functions), std::span(kRows).first(points.size()));
}

std::array<double, 3> vertexWeights(const std::array<Vec3, 4>& tet, std::span<const Vec3> points,
                                    std::span<const AffineFunction> functions) {
  const auto local = symbolicWeights<3>(vertexMatrix(tet, points, functions), points.size());
  std::array<double, 3> weights{};
  for (std::size_t i = 0; i < points.size(); ++i) weights[i] = local.ratio(i);
  return weights;
}

int compareAlongEdge(std::span<const Vec3> points, const std::array<Vec3, 4>& tetOfF, const AffineFunction& f,
                     const std::array<Vec3, 4>& tetOfG, const AffineFunction& g) {
  const SymbolicMatrix matrix({ExactTet(tetOfF).column(f, points), ExactTet(tetOfG).column(g, points)}, true);
  const SymbolicMatrix onlyF({ExactTet(tetOfF).column(f, points)}, true),
      onlyG({ExactTet(tetOfG).column(g, points)}, true);
  // With f of one sign at p and the other at q, the meeting point is at f(p) / (f(p) − f(q)).
  const int atP =
      symbolicSign(onlyF, std::span(kRows).first(1)) * symbolicSign(onlyG, std::span(kRows).first(1));
  return -atP * symbolicSign(matrix, std::span(kRows).first(2));
}

int sideOfMeeting(const std::array<Vec3, 4>& tet, const AffineFunction& f, const AffineFunction& g,
                  std::span<const Vec3> triangle, std::span<const Vec3> other) {
  const ExactTet exact(tet);
  const Column first = exact.column(f, triangle), second = exact.column(g, triangle);
  const SymbolicMatrix line({first, second}, true), all({first, second, heights(other, triangle)}, true);
  // The meeting point's weights are the cofactors of the last column, up to a sign that they share.
  const std::array<int, 2> rest{1, 2};
  return symbolicSign(line, rest) * symbolicSign(all, std::span(kRows).first(3));
}

}  // namespace sherd
