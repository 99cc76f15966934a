#include "bench/tessellate_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include <Eigen/LU>

#include "base/parallel.h"
#include "base/rng.h"
#include "geometry/surface_tree.h"

namespace sherd::bench {
namespace {

/// Finds the tetrahedron that holds a point.
class Locator {
 public:
  explicit Locator(const TetMesh& mesh) : mesh_(mesh), box_(boxOf(mesh.nodes)) {
    n_ = std::max(1, static_cast<int>(std::cbrt(static_cast<double>(mesh.tets.size()))));
    cells_.resize(static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_));
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      Box box;
      for (const Index n : mesh.tets[t]) box.add(mesh.nodes[at(n)]);
      const auto low = cellOf(box.low), high = cellOf(box.high);
      for (int k = low[2]; k <= high[2]; ++k)
        for (int j = low[1]; j <= high[1]; ++j)
          for (int i = low[0]; i <= high[0]; ++i) cells_[numberOf({i, j, k})].push_back(t);
    }
  }

  /// The tetrahedron in which the least barycentric coordinate is largest, and these coordinates.
  std::pair<std::size_t, Vec4> find(const Vec3& p) const {
    std::pair<std::size_t, Vec4> best{0, Vec4::Constant(-1e30)};
    for (const std::size_t t : cells_[numberOf(cellOf(p))]) {
      const Tetra& tet = mesh_.tets[t];
      const Vec3& o = mesh_.nodes[at(tet[0])];
      Mat3 edges;
      for (int c = 0; c < 3; ++c) edges.col(c) = mesh_.nodes[at(tet[static_cast<std::size_t>(c) + 1])] - o;
      const Vec3 b = edges.inverse() * (p - o);
      const Vec4 all(1 - b.sum(), b[0], b[1], b[2]);
      if (all.minCoeff() > best.second.minCoeff()) best = {t, all};
    }
    return best;
  }

 private:
  std::array<int, 3> cellOf(const Vec3& p) const {
    std::array<int, 3> cell{};
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] = std::clamp(
          static_cast<int>(n_ * (p[axis] - box_.low[axis]) / (box_.high[axis] - box_.low[axis])), 0, n_ - 1);
    return cell;
  }
  std::size_t numberOf(const std::array<int, 3>& c) const {
    return static_cast<std::size_t>(c[0] + n_ * (c[1] + n_ * c[2]));
  }

  const TetMesh& mesh_;
  Box box_;
  int n_ = 1;
  std::vector<std::vector<std::size_t>> cells_;
};

/// Interpolated linearly in a tetrahedron.
Eigen::VectorXd embedded(const Embedding& embedding, std::size_t tet, const Vec4& weights) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(embedding.coordinates.rows());
  for (int c = 0; c < 4; ++c)
    x += weights[c] * embedding.coordinates.col(embedding.tets->tets[tet][static_cast<std::size_t>(c)]);
  return x;
}

/// Of an embedded point between two cells.
double errorOf(const Eigen::VectorXd& x, Index i, Index j, const Eigen::MatrixXd& sites) {
  const Eigen::VectorXd squared = (sites.colwise() - x).colwise().squaredNorm();
  double error = 0;
  const double between = (sites.col(i) - sites.col(j)).norm();
  if (between > 0) error = std::abs(squared[i] - squared[j]) / (2 * between);
  for (Eigen::Index k = 0; k < sites.cols(); ++k) {
    const double apart = (sites.col(i) - sites.col(k)).norm();
    if (k != i && k != j && apart > 0)
      error = std::max(error, (std::min(squared[i], squared[j]) - squared[k]) / (2 * apart));
  }
  return error;
}

using Polygon = std::vector<Vec3>;
using Polyhedron = std::vector<Polygon>;  // convex; sides counter-clockwise from outside

/// What of a convex polyhedron lies where n · x ≤ c.
Polyhedron clipped(const Polyhedron& solid, const Vec3& n, double c) {
  Polyhedron result;
  Polygon cap;
  for (const Polygon& side : solid) {
    Polygon kept;
    for (std::size_t a = 0; a < side.size(); ++a) {
      const Vec3 &p = side[a], &q = side[(a + 1) % side.size()];
      const double dp = n.dot(p) - c, dq = n.dot(q) - c;
      if (dp <= 0) kept.push_back(p);
      if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
        kept.push_back(p + dp / (dp - dq) * (q - p));
        cap.push_back(kept.back());
      } else if (dp == 0) {
        cap.push_back(p);
      }
    }
    if (kept.size() >= 3) result.push_back(std::move(kept));
  }
  if (cap.size() < 3 || result.empty()) return result;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : cap) middle += p / static_cast<double>(cap.size());
  const Vec3 u = n.unitOrthogonal(), v = n.normalized().cross(u);
  std::sort(cap.begin(), cap.end(), [&](const Vec3& a, const Vec3& b) {
    return std::atan2(v.dot(a - middle), u.dot(a - middle)) <
           std::atan2(v.dot(b - middle), u.dot(b - middle));
  });
  result.push_back(std::move(cap));
  return result;
}

double volumeOf(const Polyhedron& solid) {
  if (solid.empty()) return 0;
  const Vec3 o = solid[0][0];
  double sum = 0;
  for (const Polygon& side : solid)
    for (std::size_t k = 2; k < side.size(); ++k)
      sum += (side[0] - o).cross(side[k - 1] - o).dot(side[k] - o);
  return sum / 6;
}

Polyhedron solidOf(const TetMesh& mesh, std::size_t t) {
  Polyhedron solid;
  for (const auto& face : kTetraFace) {
    Polygon& side = solid.emplace_back();
    for (const int corner : face)
      side.push_back(mesh.nodes[at(mesh.tets[t][static_cast<std::size_t>(corner)])]);
  }
  return solid;
}

}  // namespace

CrackError crackError(const Fragments& f, const Partition& cells) {
  const Embedding& embedding = *cells.embedding;
  const Locator locator(*embedding.tets);
  std::set<std::array<Index, 3>> seen;
  CrackError result;
  for (const Piece& piece : f.pieces)
    for (std::size_t t = 0; t < piece.crack.size(); ++t)
      for (const Index v : piece.crack[t]) {
        const auto [i, j] = std::minmax(piece.cell, f.pieces[at(piece.crackNeighbour[t])].cell);
        if (i == j || !seen.insert({v, i, j}).second) continue;
        const auto [tet, weights] = locator.find(f.positions[at(v)]);
        const double error =
            errorOf(embedded(embedding, tet, weights), i, j, cells.sites) / embedding.diameter;
        result.rms += error * error;
        result.maximum = std::max(result.maximum, error);
        ++result.vertices;
      }
  if (result.vertices > 0) result.rms = std::sqrt(result.rms / static_cast<double>(result.vertices));
  return result;
}

std::vector<double> cellVolumes(const Fragments& f) {
  std::vector<double> volumes(f.sites, 0);
  double sum = 0;
  for (const Piece& piece : f.pieces) {
    volumes[at(piece.cell)] += piece.volume;
    sum += piece.volume;
  }
  for (double& v : volumes) v /= sum;
  return volumes;
}

std::vector<double> convexReference(const Partition& cells, const std::vector<Vec4>& planes) {
  const TetMesh& mesh = *cells.embedding->tets;
  const Eigen::MatrixXd& sites = cells.sites;
  std::vector<double> volumes(cells.siteCount(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Polyhedron inside = solidOf(mesh, t);
    for (const Vec4& plane : planes) inside = clipped(inside, plane.head<3>(), plane[3]);
    if (inside.empty()) continue;
    // ‖p_j‖² − 2 x̄·p_j is affine in the tetrahedron: slope · X + value, per site a column.
    Eigen::Matrix<double, 4, 4> corners;
    Eigen::MatrixXd g(4, sites.cols());
    for (int c = 0; c < 4; ++c) {
      const Index node = mesh.tets[t][static_cast<std::size_t>(c)];
      corners.row(c) << mesh.nodes[at(node)].transpose(), 1;
      g.row(c) = (sites.colwise() - cells.embedding->coordinates.col(node)).colwise().squaredNorm();
    }
    const Eigen::MatrixXd affine = corners.inverse() * g;
    for (Eigen::Index j = 0; j < sites.cols(); ++j) {
      Polyhedron own = inside;
      for (Eigen::Index k = 0; k < sites.cols() && !own.empty(); ++k) {
        if (k == j || (g.col(k) - g.col(j)).minCoeff() > 0) continue;
        const Eigen::Vector4d difference = affine.col(j) - affine.col(k);
        own = clipped(own, difference.head<3>(), -difference[3]);
      }
      volumes[static_cast<std::size_t>(j)] += volumeOf(own);
    }
  }
  const double sum = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  for (double& v : volumes) v /= sum;
  return volumes;
}

SamplePoints pointsWithin(const TriMesh& surface, int cubesPerAxis) {
  constexpr std::uint64_t kStream = 0x766f6c756d65;
  const SurfaceTree tree(surface.positions, surface.triangles);
  const Box box = boxOf(surface.positions);
  const Vec3 cube = (box.high - box.low) / cubesPerAxis;
  const auto n = static_cast<std::size_t>(cubesPerAxis);
  SamplePoints result;
  for (std::size_t set = 0; set < result.sets.size(); ++set) {
    const Rng random(set, kStream);
    std::vector<std::vector<Vec3>> layers(n);
    parallelFor(Exec{}, n, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        for (std::size_t c = 0; c < n * n; ++c) {
          const std::uint64_t number = 3 * (k * n * n + c);
          const Vec3 within(static_cast<double>(c % n) + random.uniformAt(number),
                            static_cast<double>(c / n) + random.uniformAt(number + 1),
                            static_cast<double>(k) + random.uniformAt(number + 2));
          const Vec3 p = box.low + cube.cwiseProduct(within);
          if (tree.contains(p)) layers[k].push_back(p);
        }
    });
    for (const auto& layer : layers)
      result.sets[set].insert(result.sets[set].end(), layer.begin(), layer.end());
  }
  return result;
}

SampledVolumes sampledVolumes(const Partition& cells, const SamplePoints& points) {
  constexpr std::size_t kBlock = 4096;
  const Embedding& embedding = *cells.embedding;
  const Locator locator(*embedding.tets);
  const auto countsOf = [&](const std::vector<Vec3>& set) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(cells.sites.cols());
    return parallelSum(Exec{}, set.size(), kBlock, none, [&](std::size_t begin, std::size_t end) {
      Eigen::VectorXd counts = none;
      for (std::size_t i = begin; i < end; ++i) {
        const auto [tet, weights] = locator.find(set[i]);
        Eigen::Index nearest = 0;
        (cells.sites.colwise() - embedded(embedding, tet, weights))
            .colwise()
            .squaredNorm()
            .minCoeff(&nearest);
        counts[nearest] += 1;
      }
      return counts;
    });
  };
  const Eigen::VectorXd one = countsOf(points.sets[0]), other = countsOf(points.sets[1]);
  const Eigen::VectorXd both = (one + other) / (one + other).sum();
  return {{both.begin(), both.end()},
          0.5 * (one / one.sum() - other / other.sum()).cwiseAbs().maxCoeff(),
          points.sets[0].size() + points.sets[1].size()};
}

double largestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = a.size() == b.size() ? 0 : HUGE_VAL;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace sherd::bench
