#include "simulate/elements.h"

#include <algorithm>
#include <cmath>

#include "geometry/tet_edges.h"

namespace sherd {
namespace {

/// The points of the rule of degree 2: one coordinate is kNear, the other three kFar.
constexpr double kNear = 0.58541019662496845446, kFar = 0.13819660112501051518;

std::size_t corner(std::size_t edge, std::size_t end) {
  return static_cast<std::size_t>(kTetraEdge[edge][end]);
}

/// Corners that two edges share.
int sharedCorners(std::size_t a, std::size_t b) {
  int count = 0;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) count += corner(a, i) == corner(b, j) ? 1 : 0;
  return count;
}

}  // namespace

Elements::Elements(std::shared_ptr<const TetMesh> mesh, ElementOrder order)
    : mesh_(std::move(mesh)), order_(order), nodeCount_(mesh_->nodes.size()) {
  if (order_ == ElementOrder::Quadratic) edges_ = tetEdges(mesh_->tets);
  nodeCount_ += edges_.size();
  nodes_.reserve(perTet() * mesh_->tets.size());
  for (const Tetra& tet : mesh_->tets) {
    nodes_.insert(nodes_.end(), tet.begin(), tet.end());
    if (order_ == ElementOrder::Linear) continue;
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [low, high] = std::minmax(tet[corner(e, 0)], tet[corner(e, 1)]);
      const auto found = std::lower_bound(edges_.begin(), edges_.end(), Edge{low, high});
      nodes_.push_back(static_cast<Index>(mesh_->nodes.size()) + static_cast<Index>(found - edges_.begin()));
    }
  }
}

std::vector<Vec3> Elements::positions(std::span<const Vec3> meshNodes) const {
  std::vector<Vec3> all(meshNodes.begin(), meshNodes.end());
  all.reserve(nodeCount_);
  for (const auto& [a, b] : edges_) all.emplace_back(0.5 * (meshNodes[at(a)] + meshNodes[at(b)]));
  return all;
}

std::array<double, kMostElementNodes> Elements::shapeValues(const Vec4& barycentric) const {
  std::array<double, kMostElementNodes> values{};
  const auto xi = [&](std::size_t i) { return barycentric[static_cast<Eigen::Index>(i)]; };
  for (std::size_t i = 0; i < 4; ++i)
    values[i] = order_ == ElementOrder::Linear ? xi(i) : xi(i) * (2 * xi(i) - 1);
  if (order_ == ElementOrder::Quadratic)
    for (std::size_t e = 0; e < 6; ++e) values[4 + e] = 4 * xi(corner(e, 0)) * xi(corner(e, 1));
  return values;
}

Vec4 barycentricIn(const TetMesh& mesh, Index t, const Vec3& p) {
  const Tetra& tet = mesh.tets[at(t)];
  const Vec3& a = mesh.nodes[at(tet[0])];
  const Vec3 ab = mesh.nodes[at(tet[1])] - a, ac = mesh.nodes[at(tet[2])] - a,
             ad = mesh.nodes[at(tet[3])] - a, ap = p - a;
  const double det = ab.dot(ac.cross(ad));
  const double b = ap.dot(ac.cross(ad)) / det, c = ab.dot(ap.cross(ad)) / det, d = ab.dot(ac.cross(ap)) / det;
  return {1 - b - c - d, b, c, d};
}

Eigen::MatrixXd elementMass(ElementOrder order) {
  if (order == ElementOrder::Linear)
    return (Eigen::MatrixXd::Ones(4, 4) + Eigen::MatrixXd::Identity(4, 4)) / 20;
  Eigen::MatrixXd mass(10, 10);
  mass.topLeftCorner(4, 4) = Eigen::MatrixXd::Ones(4, 4) + 5 * Eigen::MatrixXd::Identity(4, 4);
  for (std::size_t e = 0; e < 6; ++e) {
    const auto row = static_cast<Eigen::Index>(4 + e);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      mass(row, column) = mass(column, row) = i == corner(e, 0) || i == corner(e, 1) ? -4 : -6;
    }
    for (std::size_t f = 0; f < 6; ++f)
      mass(row, static_cast<Eigen::Index>(4 + f)) = 8 << sharedCorners(e, f);  // 8, 16, 32
  }
  return mass / 420;
}

ElementRule wholeRule() {
  ElementRule rule;
  for (std::size_t q = 0; q < 4; ++q) {
    rule[q].setConstant(kFar);
    rule[q][static_cast<Eigen::Index>(q)] = kNear;
  }
  return rule;
}

ElementRule ruleOf(const Eigen::Matrix4d& products) {
  // P Pᵀ / 4 = products, by Cholesky's factorization with pivots: parts that are hardly more than a point
  // have products of lower rank.
  constexpr double kNothing = 1e-14;
  Eigen::Matrix4d rest = products * (4 / products.sum());
  ElementRule rule;
  for (Vec4& column : rule) {
    Eigen::Index pivot = 0;
    const double largest = rest.diagonal().maxCoeff(&pivot);
    column = largest > kNothing ? Vec4(rest.col(pivot) / std::sqrt(largest)) : Vec4::Zero();
    rest -= column * column.transpose();
  }
  return rule;
}

ElementGradients::ElementGradients(const Element& linear, ElementOrder order)
    : points_(order == ElementOrder::Linear ? 1 : 4), nodes_(order == ElementOrder::Linear ? 4 : 10) {
  if (order == ElementOrder::Quadratic) {
    *this = ElementGradients(linear, wholeRule());
    return;
  }
  std::copy(linear.gradient.begin(), linear.gradient.end(), gradient_[0].begin());
  std::copy(linear.gradient.begin(), linear.gradient.end(), mean_.begin());
}

ElementGradients::ElementGradients(const Element& linear, const ElementRule& rule) : points_(4), nodes_(10) {
  const std::array<Vec3, 4>& g = linear.gradient;
  std::fill(mean_.begin(), mean_.end(), Vec3::Zero());
  for (std::size_t q = 0; q < 4; ++q) {
    const double one = rule[q].sum();
    const auto xi = [&](std::size_t i) { return rule[q][static_cast<Eigen::Index>(i)]; };
    for (std::size_t i = 0; i < 4; ++i) gradient_[q][i] = (4 * xi(i) - one) * g[i];
    for (std::size_t e = 0; e < 6; ++e) {
      const std::size_t a = corner(e, 0), b = corner(e, 1);
      gradient_[q][4 + e] = 4 * (xi(a) * g[b] + xi(b) * g[a]);
    }
    for (std::size_t i = 0; i < 10; ++i) mean_[i] += weight() * one * gradient_[q][i];
  }
}

}  // namespace sherd
