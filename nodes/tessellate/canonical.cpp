#include "tessellate/canonical.h"

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <unordered_map>

#include "geometry/exact_points.h"

namespace sherd {
namespace {

constexpr double kMargin = 0.01;  ///< least barycentric coordinate of a vertex within its simplex

/// Builds the complex; simplices are keyed by their sorted nodes, padded with −1.
class Builder {
 public:
  explicit Builder(const Partition& partition)
      : partition_(partition), tets_(*partition.embedding->tets), body_(centroidOf(partition)) {}

  Sheets build() {
    for (std::size_t t = 0; t < tets_.tets.size(); ++t) addTet(static_cast<Index>(t));
    markCage();
    for (const CrackTriangle& t : triangles_) {
      sheets_.polygons.push_back({static_cast<Index>(sheets_.corners.size()), 3, t.front, t.back, t.tet});
      sheets_.corners.insert(sheets_.corners.end(), t.corners.begin(), t.corners.end());
    }
    sheets_.connect();
    return std::move(sheets_);
  }

 private:
  struct CrackTriangle {
    Triangle corners;
    Index front, back, tet;
  };
  using Key = Tetra;
  struct KeyHash {
    std::size_t operator()(const Key& k) const {
      std::size_t h = 0;
      for (const Index i : k)
        h = (h ^ static_cast<std::size_t>(static_cast<std::uint32_t>(i))) * 0x9E3779B97F4A7C15ULL;
      return h ^ (h >> 29);
    }
  };

  static Eigen::VectorXd centroidOf(const Partition& p) { return p.embedding->coordinates.rowwise().mean(); }

  Index label(Index node) const { return partition_.label[at(node)]; }

  /// g_j at a node: squared distance to site j without the term common to all sites, about the body's
  /// centroid.
  double affineDistance(Index node, Index site) const {
    const auto p = partition_.sites.col(site) - body_;
    const auto x = partition_.embedding->coordinates.col(node) - body_;
    return p.squaredNorm() - 2 * x.dot(p);
  }

  /// Barycentric coordinates of the point of the simplex (a face or a tetrahedron) that is equally far from
  /// its nodes' sites: the null vector of the differences to the first site, by cofactors, so that no unit
  /// enters. Empty where there is no such point.
  Eigen::VectorXd solveEquidistance(const std::vector<Index>& nodes) const {
    const auto m = static_cast<Eigen::Index>(nodes.size());
    Eigen::Matrix<double, 3, 4> differences = Eigen::Matrix<double, 3, 4>::Zero();
    for (Eigen::Index j = 1; j < m; ++j)
      for (Eigen::Index i = 0; i < m; ++i) {
        const Index node = nodes[static_cast<std::size_t>(i)];
        differences(j - 1, i) = affineDistance(node, label(nodes[static_cast<std::size_t>(j)])) -
                                affineDistance(node, label(nodes[0]));
      }
    const double largest = differences.cwiseAbs().maxCoeff();
    if (!(largest > 0)) return {};
    differences /= largest;
    Eigen::VectorXd solution(m);
    if (m == 3) {
      const Vec3 first = differences.row(0).head<3>(), second = differences.row(1).head<3>();
      solution = first.cross(second);
    } else {
      for (Eigen::Index i = 0; i < 4; ++i) {
        Mat3 minor;
        for (Eigen::Index k = 0, column = 0; k < 4; ++k)
          if (k != i) minor.col(column++) = differences.col(k);
        solution[i] = (i % 2 == 0 ? 1 : -1) * minor.determinant();
      }
    }
    const double sum = solution.sum();
    if (!(std::abs(sum) > 1e-12 * solution.cwiseAbs().maxCoeff())) return {};
    return solution / sum;
  }

  /// Draws the solution into the simplex, towards an inner point.
  static Eigen::VectorXd drawInside(const Eigen::VectorXd& solution, const Eigen::VectorXd& inner) {
    if (solution.size() == 0) return inner;
    double share = 1;
    for (Eigen::Index i = 0; i < inner.size(); ++i)
      if (solution[i] < kMargin) share = std::min(share, (inner[i] - kMargin) / (inner[i] - solution[i]));
    return inner + std::max(0.0, share) * (solution - inner);
  }

  Eigen::VectorXd edgeWeights(Index a, Index b) const {
    const double atA =
        affineDistance(a, label(b)) - affineDistance(a, label(a));  // ≥ 0 with nearest-site labels
    const double atB = affineDistance(b, label(a)) - affineDistance(b, label(b));
    const double sum = atA + atB;
    const double share = sum > 0 ? std::clamp(atA / sum, kMargin, 1 - kMargin) : 0.5;
    return Eigen::Vector2d(1 - share, share);
  }

  /// Mean of the vertices of the simplex's edges, in its barycentric coordinates: symmetric in the nodes.
  Eigen::VectorXd meanOfEdges(const std::vector<Index>& nodes) const {
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(nodes.size()));
    int edges = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = i + 1; j < nodes.size(); ++j) {
        const Eigen::VectorXd w = edgeWeights(nodes[i], nodes[j]);
        mean[static_cast<Eigen::Index>(i)] += w[0];
        mean[static_cast<Eigen::Index>(j)] += w[1];
        ++edges;
      }
    return mean / edges;
  }

  /// The crack vertex of an edge, face or tetrahedron whose nodes all carry different labels. `nodes` in any
  /// order.
  Index vertexOf(std::initializer_list<Index> simplex) {
    std::vector<Index> nodes(simplex);
    std::sort(nodes.begin(), nodes.end());
    Key key{-1, -1, -1, -1};
    std::copy(nodes.begin(), nodes.end(), key.begin());
    const auto [found, isNew] = known_.emplace(key, static_cast<Index>(sheets_.vertices.size()));
    if (isNew) {
      const Eigen::VectorXd w = nodes.size() == 2 ? edgeWeights(nodes[0], nodes[1])
                                                  : drawInside(solveEquidistance(nodes), meanOfEdges(nodes));
      Vec3 point = Vec3::Zero();
      for (std::size_t i = 0; i < nodes.size(); ++i)
        point += w[static_cast<Eigen::Index>(i)] * tets_.nodes[at(nodes[i])];
      sheets_.vertices.push_back(point);
      sheets_.simplexOf.push_back(key);
    }
    return found->second;
  }

  void addTriangle(Index a, Index b, Index c, Index back, Index front, Index tet) {
    triangles_.push_back({{a, b, c}, front, back, tet});
  }

  /// A quad of a sheet, split along its shorter diagonal.
  void addQuad(const std::array<Index, 4>& q, Index back, Index front, Index tet) {
    auto length = [&](Index a, Index b) {
      return (sheets_.vertices[at(a)] - sheets_.vertices[at(b)]).squaredNorm();
    };
    const std::size_t s = length(q[0], q[2]) <= length(q[1], q[3]) ? 0 : 1;
    addTriangle(q[s], q[s + 1], q[s + 2], back, front, tet);
    addTriangle(q[s], q[s + 2], q[(s + 3) % 4], back, front, tet);
  }

  /// Reorders the corners so that equal labels stand first, keeping the orientation.
  Tetra sortedByLabel(Tetra tet) const {
    std::array<int, 4> count{};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) count[i] += label(tet[i]) == label(tet[j]);
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::tuple(-count[a], label(tet[a]), tet[a]) < std::tuple(-count[b], label(tet[b]), tet[b]);
    });
    int inversions = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) inversions += order[i] > order[j];
    Tetra result;
    for (std::size_t i = 0; i < 4; ++i) result[i] = tet[order[i]];
    // An odd reordering is made even by swapping two corners of one label, or any two where all differ.
    if (inversions % 2 == 1) std::swap(result[0], result[1]);
    return result;
  }

  void addTet(Index t) {
    const Tetra& corners = tets_.tets[at(t)];
    std::array<Index, 4> labels;
    for (std::size_t i = 0; i < 4; ++i) labels[i] = label(corners[i]);
    std::sort(labels.begin(), labels.end());
    const auto distinct = std::unique(labels.begin(), labels.end()) - labels.begin();
    if (distinct == 1) return;
    ++sheets_.cutTets;
    const Tetra s = sortedByLabel(corners);
    if (distinct == 4) return addFourLabels(s, t);
    if (distinct == 3) return addThreeLabels(s, t);
    if (label(s[2]) == label(s[0])) return addCorner(s, t);
    const Index back = label(s[0]), front = label(s[2]);
    addQuad({vertexOf({s[0], s[3]}), vertexOf({s[1], s[3]}), vertexOf({s[1], s[2]}), vertexOf({s[0], s[2]})},
            back, front, t);
  }

  /// (3, 1): one triangle around the single corner s[3].
  void addCorner(const Tetra& s, Index t) {
    // (s3, s2, s1, s0) is an even reordering of (s0, s1, s2, s3).
    addTriangle(vertexOf({s[3], s[2]}), vertexOf({s[3], s[1]}), vertexOf({s[3], s[0]}), label(s[3]),
                label(s[0]), t);
  }

  /// (2, 1, 1): s[0], s[1] carry label A, s[2] B, s[3] C.
  void addThreeLabels(const Tetra& s, Index t) {
    const Index a = label(s[0]), b = label(s[2]), c = label(s[3]);
    const Index f0 = vertexOf({s[0], s[2], s[3]}), f1 = vertexOf({s[1], s[2], s[3]});
    const Index bc = vertexOf({s[2], s[3]}), a0b = vertexOf({s[0], s[2]}), a1b = vertexOf({s[1], s[2]}),
                a0c = vertexOf({s[0], s[3]}), a1c = vertexOf({s[1], s[3]});
    const std::size_t first = triangles_.size();
    addTriangle(bc, f0, f1, b, c, t);
    addQuad({a0b, f0, f1, a1b}, a, b, t);
    addQuad({a1c, f1, f0, a0c}, a, c, t);
    if (!crossThemselves(first)) return;
    triangles_.resize(first);
    const Index centre = static_cast<Index>(sheets_.vertices.size());
    Vec3 mean = Vec3::Zero();
    for (const Index v : {f0, f1, bc, a0b, a1b, a0c, a1c}) mean += sheets_.vertices[at(v)] / 7;
    sheets_.vertices.push_back(mean);
    Tetra all = s;
    std::sort(all.begin(), all.end());
    sheets_.simplexOf.push_back(all);
    const std::array<std::array<Index, 4>, 8> fan{{{bc, f0, b, c},
                                                   {f1, bc, b, c},
                                                   {a0b, f0, a, b},
                                                   {f1, a1b, a, b},
                                                   {a1b, a0b, a, b},
                                                   {a1c, f1, a, c},
                                                   {f0, a0c, a, c},
                                                   {a0c, a1c, a, c}}};
    for (const auto& [x, y, back, front] : fan) addTriangle(x, y, centre, back, front, t);
  }

  /// (1, 1, 1, 1): two triangles for each edge.
  void addFourLabels(const Tetra& s, Index t) {
    const Index centre = vertexOf({s[0], s[1], s[2], s[3]});
    static constexpr int kEven[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                        {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
    for (const auto& e : kEven) {
      const Index i = s[static_cast<std::size_t>(e[0])], j = s[static_cast<std::size_t>(e[1])],
                  k = s[static_cast<std::size_t>(e[2])], l = s[static_cast<std::size_t>(e[3])];
      const Index edge = vertexOf({i, j});
      addTriangle(edge, vertexOf({i, j, k}), centre, label(i), label(j), t);
      addTriangle(edge, centre, vertexOf({i, j, l}), label(i), label(j), t);
    }
  }

  /// Does an edge of one of the triangles from `first` on pass through another of them?
  bool crossThemselves(std::size_t first) const {
    const ExactPoints points(sheets_.vertices);
    for (std::size_t i = first; i < triangles_.size(); ++i)
      for (std::size_t j = first; j < triangles_.size(); ++j) {
        const Triangle &s = triangles_[i].corners, &t = triangles_[j].corners;
        for (std::size_t e = 0; e < 3; ++e) {
          const Index p = s[e], q = s[(e + 1) % 3];
          const bool shares =
              std::find(t.begin(), t.end(), p) != t.end() || std::find(t.begin(), t.end(), q) != t.end();
          if (!shares && points.crosses(p, q, t)) return true;
        }
      }
    return false;
  }

  void markCage() {
    sheets_.onCage.assign(sheets_.vertices.size(), 0);
    auto mark = [&](Key key) {
      std::sort(key.begin(), key.end());
      // Padding sorts to the front; keys hold it at the back.
      std::rotate(key.begin(), std::find_if(key.begin(), key.end(), [](Index i) { return i >= 0; }),
                  key.end());
      if (const auto found = known_.find(key); found != known_.end()) sheets_.onCage[at(found->second)] = 1;
    };
    for (const Triangle& f : tets_.boundary) {
      mark({f[0], f[1], f[2], -1});
      mark({f[0], f[1], -1, -1});
      mark({f[1], f[2], -1, -1});
      mark({f[2], f[0], -1, -1});
    }
  }

  const Partition& partition_;
  const TetMesh& tets_;
  Eigen::VectorXd body_;
  Sheets sheets_;
  std::vector<CrackTriangle> triangles_;
  std::unordered_map<Key, Index, KeyHash> known_;
};

}  // namespace

Sheets canonicalSheets(const Partition& partition) { return Builder(partition).build(); }

}  // namespace sherd
