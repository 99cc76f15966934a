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

}  // namespace

std::vector<double> stiffnessShares(const TetMesh& mesh) {
  std::vector<double> inside(mesh.nodes.size(), 0.0), all(mesh.nodes.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index n : mesh.tets[t]) {
      inside[at(n)] += mesh.insideFraction[t] * tetVolume(mesh, t);
      all[at(n)] += tetVolume(mesh, t);
    }
  std::vector<double> share = mesh.insideFraction;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index n : mesh.tets[t])
      if (inside[at(n)] < kLeastSupport * all[at(n)]) share[t] = std::max(share[t], kLeastSupport);
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

BlockMatrix assembleStiffness(std::span<const Vec3> nodes, std::span<const Tetra> tets,
                              std::span<const double> weight, const Lame& lame) {
  std::vector<std::vector<Index>> rows(nodes.size());  // per column, rows ≥ it
  for (std::size_t n = 0; n < nodes.size(); ++n) rows[n].push_back(static_cast<Index>(n));
  for (const Tetra& tet : tets)
    for (const Index column : tet)
      for (const Index row : tet)
        if (row > column) rows[at(column)].push_back(row);
  BlockMatrix k;
  k.begin.push_back(0);
  for (std::vector<Index>& column : rows) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    k.row.insert(k.row.end(), column.begin(), column.end());
    k.begin.push_back(static_cast<Index>(k.row.size()));
  }
  k.block.assign(k.row.size(), Mat3::Zero());
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const Element element(nodes, tets[t]);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        const Index row = tets[t][i], column = tets[t][j];
        if (row < column) continue;
        const auto first = k.row.begin() + k.begin[at(column)],
                   last = k.row.begin() + k.begin[at(column) + 1];
        const auto entry = static_cast<std::size_t>(std::lower_bound(first, last, row) - k.row.begin());
        k.block[entry] += weight[t] * element.stiffness(i, j, lame);
      }
  }
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
