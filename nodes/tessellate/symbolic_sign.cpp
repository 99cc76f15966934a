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

/// A product of displacements: per row the axis along which its point is displaced, −1 for none.
struct Term {
  std::array<int, 3> axis{-1, -1, -1};
  std::uint32_t weight =
      0;  ///< exponent of the infinitely small number: the smaller, the greater the product
};

/// For one to three rows by ascending number of their points, from the greatest product (none) to the least.
/// Two rows displaced along one axis are equal and contribute nothing.
const std::vector<Term>& terms(std::size_t rows) {
  static const std::array<std::vector<Term>, 4> all = [] {
    std::array<std::vector<Term>, 4> lists;
    lists[0].push_back({});
    for (std::size_t n = 1; n <= 3; ++n) {
      for (std::uint32_t code = 0; code < (1u << (2 * n)); ++code) {
        Term term;
        std::array<int, 3> uses{};
        for (std::size_t row = 0; row < n; ++row) {
          term.axis[row] = static_cast<int>((code >> (2 * row)) & 3) - 1;
          if (term.axis[row] < 0) continue;
          ++uses[static_cast<std::size_t>(term.axis[row])];
          term.weight += 1u << (3 * row + static_cast<std::size_t>(term.axis[row]));
        }
        if (*std::max_element(uses.begin(), uses.end()) <= 1) lists[n].push_back(term);
      }
      std::sort(lists[n].begin(), lists[n].end(),
                [](const Term& a, const Term& b) { return a.weight < b.weight; });
    }
    return lists;
  }();
  return all[rows];
}

/// One function at all points: values, the gradient where points can be displaced, and the sites whose change
/// it follows.
struct Column {
  std::array<Exact, 4> value;
  ExactVec gradient;
  Index plus = -1, minus = -1;

  static Column ones() {
    Column c;
    c.value.fill(Exact(1));
    c.gradient.fill(Exact(0));
    return c;
  }
};

/// The matrix of columns at rows, of which any part can be asked for its symbolic determinant.
class SymbolicMatrix {
 public:
  explicit SymbolicMatrix(std::vector<Column> columns) : columns_(std::move(columns)) {
    for (const Column& c : columns_)
      for (const Index site : {c.plus, c.minus})
        if (site >= 0) sites_.push_back(site);
    std::sort(sites_.begin(), sites_.end());
    sites_.erase(std::unique(sites_.begin(), sites_.end()), sites_.end());
  }

  /// Sites by rank, from the one whose change is greatest; −1 stands for no change.
  std::vector<Index> levels() const {
    std::vector<Index> all{-1};
    all.insert(all.end(), sites_.begin(), sites_.end());
    return all;
  }

  /// The determinant's coefficient of (change of `site`) · `term`, over `rows`, as many as columns. axis[row]
  /// is for the row's place in `rows`.
  Exact coefficient(std::span<const int> rows, Index site, const Term& term) const {
    if (site < 0) return determinant(columns_, rows, term);
    Exact sum = 0;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (columns_[c].plus != site && columns_[c].minus != site) continue;
      std::vector<Column> changed = columns_;
      changed[c] = Column::ones();
      const Exact d = determinant(changed, rows, term);
      // g_site is lowered.
      if (columns_[c].plus == site) sum -= d;
      if (columns_[c].minus == site) sum += d;
    }
    return sum;
  }

 private:
  static Exact entry(const Column& column, int row, int axis) {
    return axis < 0 ? column.value[static_cast<std::size_t>(row)]
                    : column.gradient[static_cast<std::size_t>(axis)];
  }

  static Exact determinant(const std::vector<Column>& columns, std::span<const int> rows, const Term& term) {
    const std::size_t n = rows.size();
    std::array<std::array<Exact, 4>, 4> m;
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t c = 0; c < n; ++c) m[r][c] = entry(columns[c], rows[r], r < 3 ? term.axis[r] : -1);
    std::array<std::size_t, 4> left{0, 1, 2, 3};
    return expand(m, std::span(left).first(n), 0);
  }

  static Exact expand(const std::array<std::array<Exact, 4>, 4>& m, std::span<const std::size_t> columns,
                      std::size_t row) {
    if (columns.size() == 1) return m[row][columns[0]];
    Exact sum = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (m[row][columns[i]] == 0) continue;
      std::array<std::size_t, 4> rest{};
      for (std::size_t k = 0, out = 0; k < columns.size(); ++k)
        if (k != i) rest[out++] = columns[k];
      const Exact d = m[row][columns[i]] * expand(m, std::span(rest).first(columns.size() - 1), row + 1);
      sum += i % 2 == 0 ? d : Exact(-d);
    }
    return sum;
  }

  std::vector<Column> columns_;
  std::vector<Index> sites_;
};

int signOf(const Exact& x) { return static_cast<int>(CGAL::sign(x)); }

/// `displaced`: rows are points that are displaced, numbered in ascending order.
int symbolicSign(const SymbolicMatrix& matrix, std::span<const int> rows, bool displaced) {
  for (const Index site : matrix.levels())
    for (const Term& term : terms(displaced ? rows.size() : 0))
      if (const int s = signOf(matrix.coefficient(rows, site, term)); s != 0) return s;
  return 1;  // two columns are one and the same function: the caller never asks
}

/// Weights with a common denominator.
template <std::size_t Size>
struct Weights {
  std::array<Exact, Size> part;
  Exact sum;

  double ratio(std::size_t i) const { return CGAL::to_double(part[i]) / CGAL::to_double(sum); }
};

/// Null vector of the n × (n − 1) matrix by its minors, from the greatest term in which it does not vanish.
template <std::size_t Size>
Weights<Size> symbolicWeights(const SymbolicMatrix& matrix, std::size_t n, bool displaced) {
  Weights<Size> weights;
  for (const Term& term : terms(displaced ? n : 0)) {
    weights.sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      std::array<int, Size> rows{};
      Term own;
      bool without = true;  // a displacement of the row that is left out does not count
      for (std::size_t k = 0, out = 0; k < n; ++k) {
        if (k == i) {
          without = !displaced || term.axis[k] < 0;
          continue;
        }
        if (out < 3) own.axis[out] = k < 3 ? term.axis[k] : -1;
        rows[out++] = static_cast<int>(k);
      }
      const Exact d = without ? matrix.coefficient(std::span(rows).first(n - 1), -1, own) : Exact(0);
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

  Column column(const AffineFunction& f, std::span<const SurfaceVertex> vertices) const {
    Column c;
    c.gradient.fill(Exact(0));
    for (std::size_t i = 0; i < 4; ++i) {
      Exact weight = i == static_cast<std::size_t>(f.corner) ? 1 : 0;
      if (f.corner < 0) weight = Exact(*f.plusAt[i]) - Exact(*f.minusAt[i]);
      if (weight == 0) continue;
      for (std::size_t k = 0; k < 3; ++k) c.gradient[k] += weight * gradient_[i][k];
      for (std::size_t r = 0; r < vertices.size(); ++r)
        c.value[r] += weight * coordinate(i, vertices[r].point);
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

/// Vertices by ascending number, as the displacements want them.
struct OrderedVertices {
  std::array<SurfaceVertex, 3> list;
  std::array<std::size_t, 3> place{0, 1, 2};  ///< per entry of list, where it stood
  int sign = 1;                               ///< of the reordering

  explicit OrderedVertices(std::span<const SurfaceVertex> vertices) {
    const std::size_t n = vertices.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j + 1 < n - i; ++j)
        if (vertices[place[j]].index > vertices[place[j + 1]].index) {
          std::swap(place[j], place[j + 1]);
          sign = -sign;
        }
    for (std::size_t i = 0; i < n; ++i) list[i] = vertices[place[i]];
  }
};

SymbolicMatrix vertexMatrix(const std::array<Vec3, 4>& tet, std::span<const SurfaceVertex> vertices,
                            std::span<const AffineFunction> functions) {
  const ExactTet exact(tet);
  std::vector<Column> columns;
  for (const AffineFunction& f : functions) columns.push_back(exact.column(f, vertices));
  return SymbolicMatrix(std::move(columns));
}

constexpr std::array<int, 4> kRows{0, 1, 2, 3};

/// The limit point where two functions vanish on a triangle, over its weights' sum.
struct MeetingPoint {
  ExactVec point{0, 0, 0};
  Exact sum;
};

MeetingPoint meetingPoint(const std::array<Vec3, 4>& tet, std::span<const AffineFunction> functions,
                          std::span<const SurfaceVertex> triangle) {
  const OrderedVertices ordered(triangle);
  const auto weights = symbolicWeights<3>(vertexMatrix(tet, ordered.list, functions), 3, true);
  MeetingPoint result;
  result.sum = weights.sum;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      result.point[k] += weights.part[i] * Exact(ordered.list[i].point[static_cast<Eigen::Index>(k)]);
  return result;
}

}  // namespace

int nodeDeterminantSign(std::span<const int> nodes, std::span<const AffineFunction> functions) {
  return symbolicSign(SymbolicMatrix(nodeColumns(nodes, functions)), std::span(kRows).first(nodes.size()),
                      false);
}

std::array<double, 4> nodeWeights(std::span<const int> nodes, std::span<const AffineFunction> functions) {
  const auto local = symbolicWeights<4>(SymbolicMatrix(nodeColumns(nodes, functions)), nodes.size(), false);
  std::array<double, 4> weights{};
  for (std::size_t i = 0; i < nodes.size(); ++i) weights[static_cast<std::size_t>(nodes[i])] = local.ratio(i);
  return weights;
}

int vertexDeterminantSign(const std::array<Vec3, 4>& tet, std::span<const SurfaceVertex> vertices,
                          std::span<const AffineFunction> functions) {
  const OrderedVertices ordered(vertices);
  const std::span<const SurfaceVertex> list(ordered.list.data(), vertices.size());
  return ordered.sign *
         symbolicSign(vertexMatrix(tet, list, functions), std::span(kRows).first(vertices.size()), true);
}

std::array<double, 3> vertexWeights(const std::array<Vec3, 4>& tet, std::span<const SurfaceVertex> vertices,
                                    std::span<const AffineFunction> functions) {
  const OrderedVertices ordered(vertices);
  const std::span<const SurfaceVertex> list(ordered.list.data(), vertices.size());
  const auto local = symbolicWeights<3>(vertexMatrix(tet, list, functions), vertices.size(), true);
  std::array<double, 3> weights{};
  for (std::size_t i = 0; i < vertices.size(); ++i) weights[ordered.place[i]] = local.ratio(i);
  return weights;
}

int compareAlongEdge(std::span<const SurfaceVertex> vertices, const std::array<Vec3, 4>& tetOfF,
                     const AffineFunction& f, const std::array<Vec3, 4>& tetOfG, const AffineFunction& g) {
  // By the weights of q in the two points.
  const auto weights = [&](const std::array<Vec3, 4>& tet, const AffineFunction& function) {
    return symbolicWeights<3>(vertexMatrix(tet, vertices, std::span(&function, 1)), 2, true);
  };
  const auto a = weights(tetOfF, f), b = weights(tetOfG, g);
  return signOf(Exact(a.part[1] * b.sum - b.part[1] * a.sum)) * signOf(a.sum) * signOf(b.sum);
}

int compareAlongLine(const std::array<Vec3, 4>& tet, const AffineFunction& f, const AffineFunction& g,
                     std::span<const SurfaceVertex> first, std::span<const SurfaceVertex> second) {
  const ExactTet exact(tet);
  const ExactVec a = exact.column(g, {}).gradient, b = exact.column(f, {}).gradient;
  const std::array<AffineFunction, 2> functions{f, g};
  const MeetingPoint from = meetingPoint(tet, functions, first), to = meetingPoint(tet, functions, second);
  Exact along = 0;
  for (std::size_t k = 0; k < 3; ++k)
    along += (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]) *
             (to.point[k] * from.sum - from.point[k] * to.sum);
  return -signOf(along) * signOf(from.sum) * signOf(to.sum);
}

}  // namespace sherd
