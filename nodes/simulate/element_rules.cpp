#include "simulate/element_rules.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "geometry/tet_share.h"

namespace sherd {
namespace {

constexpr double kSameShare = 1e-6;

}  // namespace

Eigen::Matrix4d productsInside(const TetMesh& mesh, std::size_t t) {
  std::array<Vec3, 4> corners;
  for (std::size_t c = 0; c < 4; ++c) corners[c] = mesh.nodes[at(mesh.tets[t][c])];
  const std::size_t first = at(mesh.heldBegin[t]), last = at(mesh.heldBegin[t + 1]);
  const TetShare share(corners, mesh.surface->positions, mesh.surface->triangles);
  const ShareProducts p = share.products(std::span(mesh.held).subspan(first, last - first), false);
  // The last corner was taken to be outside; where it isn't, a whole tetrahedron is missing.
  const double missing = mesh.insideFraction[t] - p.sum();
  if (std::abs(missing) < kSameShare) return p;
  if (std::abs(missing - 1) < kSameShare) return p + wholeProducts();
  return ShareProducts::Zero();
}

ElementRules::ElementRules(const Elements& elements, std::span<const double> share, const Exec& exec)
    : mesh_(&elements.mesh()), order_(elements.order()) {
  if (order_ == ElementOrder::Linear) return;
  std::vector<Index> cut;
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t)
    if (mesh_->insideFraction[t] > 0 && mesh_->insideFraction[t] < 1) cut.push_back(static_cast<Index>(t));
  ruleOf_.assign(mesh_->tets.size(), 0);
  rules_.resize(1 + cut.size(), wholeRule());
  parallelFor(exec, cut.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t t = at(cut[i]);
      const double inside = mesh_->insideFraction[t];
      const ShareProducts p = productsInside(*mesh_, t);
      if (!(p.sum() > 0)) continue;
      ruleOf_[t] = static_cast<Index>(1 + i);
      rules_[1 + i] = sherd::ruleOf(p + std::max(share[t] - inside, 0.0) * wholeProducts());
    }
  });
}

ElementRules::ElementRules(const Elements& elements, std::vector<ElementRule> rules)
    : mesh_(&elements.mesh()), order_(elements.order()), ruleOf_(rules.size()), rules_(std::move(rules)) {
  std::iota(ruleOf_.begin(), ruleOf_.end(), 0);
}

ElementGradients ElementRules::gradients(std::span<const Vec3> nodes, std::size_t t) const {
  const Element linear(nodes, mesh_->tets[t]);
  return order_ == ElementOrder::Linear ? ElementGradients(linear, order_)
                                        : ElementGradients(linear, rules_[at(ruleOf_[t])]);
}

}  // namespace sherd
