#include "simulate/assembly.h"

#include <algorithm>

#include "geometry/disjoint_sets.h"
#include "simulate/statics.h"

namespace sherd {
namespace {

Index farthest(std::span<const Index> members, const auto& distance) {
  Index best = members.front();
  for (const Index i : members)
    if (distance(i) > distance(best)) best = i;
  return best;
}

/// Any two unit vectors that complete `axis` to a right angle triple.
std::pair<Vec3, Vec3> across(const Vec3& axis) {
  const Vec3 one = axis.unitOrthogonal();
  return {one, axis.normalized().cross(one)};
}

/// Which blocks a matrix has.
class Pattern {
 public:
  explicit Pattern(std::size_t nodes) : rows_(nodes) {
    for (std::size_t n = 0; n < nodes; ++n) rows_[n].push_back(static_cast<Index>(n));
  }
  /// A block for every two of `nodes`.
  void join(std::span<const Index> nodes) {
    for (const Index column : nodes)
      for (const Index row : nodes)
        if (row > column) add(at(column), row);
  }
  BlockMatrix matrix() {
    BlockMatrix k;
    k.begin.push_back(0);
    for (std::vector<Index>& column : rows_) {
      tidy(column);
      k.row.insert(k.row.end(), column.begin(), column.end());
      k.begin.push_back(static_cast<Index>(k.row.size()));
    }
    k.block.assign(k.row.size(), Mat3::Zero());
    return k;
  }

 private:
  void add(std::size_t column, Index row) {
    std::vector<Index>& rows = rows_[column];
    if (rows.size() == rows.capacity()) tidy(rows);  // before it grows: most of it are repeats
    rows.push_back(row);
  }
  static void tidy(std::vector<Index>& rows) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  }
  std::vector<std::vector<Index>> rows_;  // per column, rows ≥ it
};

Mat3& blockAt(BlockMatrix& k, Index row, Index column) {
  const auto first = k.row.begin() + k.begin[at(column)], last = k.row.begin() + k.begin[at(column) + 1];
  return k.block[static_cast<std::size_t>(std::lower_bound(first, last, row) - k.row.begin())];
}

/// ∂²W/∂u_i∂u_j per volume: λ g_i g_jᵀ + μ g_j g_iᵀ + μ (g_i·g_j) I, over the points, and the averaged part
/// of λ.
Mat3 elementBlock(const ElementGradients& g, std::size_t i, std::size_t j, double mu,
                  const VolumetricSplit& lambda) {
  Mat3 sum = Mat3::Zero();
  for (std::size_t q = 0; q < g.points(); ++q) {
    const Vec3 &a = g.at(q, i), &b = g.at(q, j);
    sum += g.weight() * (lambda.full * a * b.transpose() + mu * b * a.transpose());
    sum.diagonal().array() += g.weight() * mu * a.dot(b);
  }
  if (g.nodes() > 4 && lambda.averaged > 0) sum += lambda.averaged * g.mean(i) * g.mean(j).transpose();
  return sum;
}

void addElements(BlockMatrix& k, const Elements& elements, const ElementRules& rules,
                 std::span<const Vec3> nodes, std::span<const double> weight, double mu,
                 const VolumetricSplit& lambda) {
  for (std::size_t t = 0; t < weight.size(); ++t) {
    const ElementGradients g = rules.gradients(nodes, t);
    const std::span<const Index> own = elements.nodesOf(t);
    for (std::size_t i = 0; i < own.size(); ++i)
      for (std::size_t j = 0; j < own.size(); ++j)
        if (own[i] >= own[j]) blockAt(k, own[i], own[j]) += weight[t] * elementBlock(g, i, j, mu, lambda);
  }
}

/// A node and its neighbours, ascending.
std::vector<Index> ringOf(const TetMesh& mesh, const NodalAverages& averages, std::size_t node) {
  std::vector<Index> ring;
  for (std::size_t i = at(averages.begin[node]); i < at(averages.begin[node + 1]); ++i)
    for (const Index n : mesh.tets[at(averages.tet[i])]) ring.push_back(n);
  std::sort(ring.begin(), ring.end());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  return ring;
}

/// Σ_n V_n λ b_n b_nᵀ, where θ_n = b_n · u.
void addNodalAverages(BlockMatrix& k, const TetMesh& mesh, const NodalAverages& averages,
                      std::span<const Vec3> nodes, std::span<const double> weight, double averaged) {
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const std::vector<Index> ring = ringOf(mesh, averages, n);
    std::vector<Vec3> b(ring.size(), Vec3::Zero());
    for (std::size_t i = at(averages.begin[n]); i < at(averages.begin[n + 1]); ++i) {
      const std::size_t t = at(averages.tet[i]);
      const Element element(nodes, mesh.tets[t]);
      for (std::size_t c = 0; c < 4; ++c) {
        const auto found = std::lower_bound(ring.begin(), ring.end(), mesh.tets[t][c]);
        b[static_cast<std::size_t>(found - ring.begin())] +=
            weight[t] / (4 * averages.volume[n]) * element.gradient[c];
      }
    }
    for (std::size_t j = 0; j < ring.size(); ++j)
      for (std::size_t i = j; i < ring.size(); ++i)
        blockAt(k, ring[i], ring[j]) += averages.volume[n] * averaged * b[i] * b[j].transpose();
  }
}

}  // namespace

std::vector<double> stiffnessShares(const Elements& elements) {
  const TetMesh& mesh = elements.mesh();
  std::vector<double> inside(elements.nodeCount(), 0.0), all(elements.nodeCount(), 0.0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index n : elements.nodesOf(t)) {
      inside[at(n)] += mesh.insideFraction[t] * tetVolume(mesh, t);
      all[at(n)] += tetVolume(mesh, t);
    }
  std::vector<double> share = mesh.insideFraction;
  for (double& s : share) s = std::max(s, kLeastShare);
  const double least = elements.order() == ElementOrder::Linear ? kLeastSupport : kLeastQuadraticSupport;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index n : elements.nodesOf(t))
      if (inside[at(n)] < least * all[at(n)]) share[t] = std::max(share[t], least);
  return share;
}

Index connectedParts(const TetMesh& mesh, std::vector<Index>& partOf) {
  DisjointSets sets(mesh.nodes.size());
  for (const Tetra& tet : mesh.tets)
    for (const Index n : tet) sets.join(at(tet[0]), at(n));
  Index count = 0;
  partOf.assign(mesh.nodes.size(), -1);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const std::size_t root = sets.find(n);
    if (partOf[root] < 0) partOf[root] = count++;
    partOf[n] = partOf[root];
  }
  return count;
}

NodalAverages::NodalAverages(const TetMesh& mesh, std::span<const double> weight)
    : begin(mesh.nodes.size() + 1, 0), tet(4 * mesh.tets.size()), volume(mesh.nodes.size(), 0.0) {
  for (const Tetra& t : mesh.tets)
    for (const Index n : t) ++begin[at(n) + 1];
  for (std::size_t n = 1; n < begin.size(); ++n) begin[n] += begin[n - 1];
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index n : mesh.tets[t]) {
      tet[at(next[at(n)]++)] = static_cast<Index>(t);
      volume[at(n)] += weight[t] / 4;
    }
}

BlockMatrix assembleStiffness(const Elements& elements, const ElementRules& rules,
                              std::span<const Vec3> nodes, std::span<const double> weight, double mu,
                              const VolumetricSplit& lambda) {
  const bool nodal = lambda.averaged > 0 && elements.order() == ElementOrder::Linear;
  Pattern pattern(elements.nodeCount());
  for (std::size_t t = 0; t < weight.size(); ++t) pattern.join(elements.nodesOf(t));
  if (!nodal) {
    BlockMatrix k = pattern.matrix();
    addElements(k, elements, rules, nodes, weight, mu, lambda);
    return k;
  }
  const NodalAverages averages(elements.mesh(), weight);
  for (std::size_t n = 0; n < elements.nodeCount(); ++n) pattern.join(ringOf(elements.mesh(), averages, n));
  BlockMatrix k = pattern.matrix();
  addElements(k, elements, rules, nodes, weight, mu, lambda);
  addNodalAverages(k, elements.mesh(), averages, nodes, weight, lambda.averaged);
  return k;
}

void addGauge(BlockMatrix& stiffness, std::span<const Vec3> nodes, std::span<const Index> members,
              Index start) {
  Vec3 centre = Vec3::Zero();
  double spring = 0;
  const auto diagonal = [&](Index n) -> Mat3& { return stiffness.block[at(stiffness.begin[at(n)])]; };
  for (const Index n : members) {
    centre += nodes[at(n)] / static_cast<double>(members.size());
    spring += diagonal(n).trace() / (3 * static_cast<double>(members.size()));
  }
  const auto x = [&](Index n) -> const Vec3& { return nodes[at(n)]; };
  const Index a = start >= 0 ? start : farthest(members, [&](Index n) { return (x(n) - centre).norm(); });
  const Index b = farthest(members, [&](Index n) { return (x(n) - x(a)).norm(); });
  const Vec3 line = x(b) - x(a);
  const Index c = farthest(members, [&](Index n) { return (x(n) - x(a)).cross(line).norm(); });
  const Vec3 normal = (x(c) - x(a)).cross(line).normalized();
  const auto [one, two] = across(line);
  diagonal(a) += spring * Mat3::Identity();
  diagonal(b) += spring * (one * one.transpose() + two * two.transpose());
  diagonal(c) += spring * normal * normal.transpose();
}

}  // namespace sherd
