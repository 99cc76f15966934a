#include "simulate/refined_region.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "geometry/tet_share.h"
#include "simulate/element_rules.h"

namespace sherd {
namespace {

constexpr double kNothingInside = 1e-9;  ///< share of a piece that may be rounding

std::array<Vec3, 4> cornersOf(const TetMesh& mesh, std::size_t t) {
  std::array<Vec3, 4> corners;
  for (std::size_t c = 0; c < 4; ++c) corners[c] = mesh.nodes[at(mesh.tets[t][c])];
  return corners;
}

/// Those of the held triangles that aren't wholly beyond one face of a piece.
std::vector<Index> heldByPiece(const std::array<Vec3, 4>& corners, std::span<const Index> held,
                               const TriMesh& surface) {
  std::vector<Index> near(held.begin(), held.end());
  for (const auto& face : kTetraFace) {
    const Vec3& a = corners[at(face[0])];
    const Vec3 normal = (corners[at(face[1])] - a).cross(corners[at(face[2])] - a);
    std::erase_if(near, [&](Index t) {
      const Triangle& v = surface.triangles[at(t)];
      return std::all_of(v.begin(), v.end(),
                         [&](Index i) { return normal.dot(surface.positions[at(i)] - a) > 0; });
    });
  }
  return near;
}

/// Over the part of a piece inside the surface.
ShareProducts productsOf(const std::array<Vec3, 4>& corners, std::span<const Index> held,
                         const TriMesh& surface, const SurfaceTree& tree) {
  const std::vector<Index> near = heldByPiece(corners, held, surface);
  const TetShare share(corners, surface.positions, surface.triangles);
  const ShareProducts p = share.products(near, false);
  // The last corner was taken to be outside; where it isn't, a whole piece is missing.
  if (p.sum() > kNothingInside) return p;
  const bool missing =
      p.sum() < -kNothingInside || tree.contains(0.25 * (corners[0] + corners[1] + corners[2] + corners[3]));
  return missing ? ShareProducts(p + wholeProducts()) : p;
}

}  // namespace

RefinedRegion::RefinedRegion(const Elements& cage, const DividedTets& divided) : cage_(cage) {
  takePieces(divided);
  findFixed();
  findPlaces();
}

void RefinedRegion::takePieces(const DividedTets& divided) {
  const TetMesh& cage = cage_.mesh();
  std::vector<std::size_t> count(cage.tets.size(), 0);
  for (const Index p : divided.parent) ++count[at(p)];
  std::vector<char> near(cage.nodes.size(), 0);
  for (std::size_t t = 0; t < count.size(); ++t)
    if (count[t] > 1)
      for (const Index n : cage.tets[t]) near[at(n)] = 1;
  begin_.assign(cage.tets.size() + 1, 0);
  for (std::size_t t = 0; t < count.size(); ++t) {
    const Tetra& tet = cage.tets[t];
    const bool covered = std::any_of(tet.begin(), tet.end(), [&](Index n) { return near[at(n)] != 0; });
    begin_[t + 1] = begin_[t] + (covered ? count[t] : 0);
  }

  TetMesh mesh;
  std::vector<Index> number(divided.nodes.size(), -1);
  for (std::size_t i = 0; i < divided.tets.size(); ++i) {
    if (!covers(at(divided.parent[i]))) continue;
    Tetra tet = divided.tets[i];
    for (Index& n : tet) {
      Index& own = number[at(n)];
      if (own < 0) {
        own = static_cast<Index>(mesh.nodes.size());
        mesh.nodes.push_back(divided.nodes[at(n)]);
        cageNode_.push_back(at(n) < cage.nodes.size() ? n : -1);
      }
      n = own;
    }
    mesh.tets.push_back(tet);
    parent_.push_back(divided.parent[i]);
  }
  elements_ = std::make_shared<const Elements>(std::make_shared<const TetMesh>(std::move(mesh)),
                                               ElementOrder::Quadratic);
}

/// Only corners of the cage and middles of its undivided edges can be on tetrahedra that aren't covered.
void RefinedRegion::findFixed() {
  std::vector<char> outside(cage_.nodeCount(), 0);
  for (std::size_t t = 0; t < cage_.mesh().tets.size(); ++t)
    if (!covers(t))
      for (const Index n : cage_.nodesOf(t)) outside[at(n)] = 1;
  fixed_.assign(elements_->nodeCount(), 0);
  for (std::size_t i = 0; i < parent_.size(); ++i) {
    const std::span<const Index> own = elements_->nodesOf(i), parents = cage_.nodesOf(at(parent_[i]));
    const auto cornerOfParent = [&](std::size_t c) {
      const Index node = cageNode_[at(own[c])];
      return node < 0 ? 4 : std::find(parents.begin(), parents.begin() + 4, node) - parents.begin();
    };
    for (std::size_t c = 0; c < 4; ++c)
      if (const auto p = cornerOfParent(c); p < 4) fixed_[at(own[c])] = outside[at(parents[at(Index(p))])];
    for (std::size_t e = 0; e < 6; ++e) {
      const auto a = cornerOfParent(at(kTetraEdge[e][0])), b = cornerOfParent(at(kTetraEdge[e][1]));
      if (a == 4 || b == 4) continue;
      for (std::size_t k = 0; k < 6; ++k)
        if (std::minmax(a, b) == std::minmax<long>(kTetraEdge[k][0], kTetraEdge[k][1]))
          fixed_[at(own[4 + e])] = outside[at(parents[4 + k])];
    }
  }
}

void RefinedRegion::findPlaces() {
  const TetMesh& cage = cage_.mesh();
  const std::vector<Vec3> x = elements_->positions(elements_->mesh().nodes);
  places_.assign(x.size(), Place{-1, {}});
  for (std::size_t i = 0; i < parent_.size(); ++i)
    for (const Index n : elements_->nodesOf(i)) {
      Place& place = places_[at(n)];
      if (place.tet >= 0) continue;
      place = {parent_[i], cage_.shapeValues(barycentricIn(cage, at(parent_[i]), x[at(n)]))};
    }
}

PieceRules pieceRules(const RefinedRegion& region, const TetMesh& cage, std::span<const double> share,
                      const SurfaceTree& surface, const Exec& exec) {
  PieceRules out{std::vector<ElementRule>(region.size(), wholeRule()),
                 std::vector<double>(region.size(), 0.0), std::vector<double>(region.size(), 1.0)};
  parallelFor(exec, cage.tets.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (!region.covers(t)) continue;
      const double inside = cage.insideFraction[t];
      const bool cut = inside > 0 && inside < 1 && productsInside(cage, t).sum() > 0;
      const auto held =
          std::span(cage.held).subspan(at(cage.heldBegin[t]), at(cage.heldBegin[t + 1] - cage.heldBegin[t]));
      const double evenly = std::max(cut ? share[t] - inside : share[t], kLeastPieceShare);
      for (std::size_t i = region.begin(t); i < region.begin(t + 1); ++i) {
        out.share[i] = evenly;
        if (!cut) continue;
        const ShareProducts p =
            productsOf(cornersOf(region.elements().mesh(), i), held, *cage.surface, surface);
        out.inside[i] = std::clamp(p.sum(), 0.0, 1.0);
        out.share[i] += out.inside[i];
        out.rule[i] = ruleOf(p + evenly * wholeProducts());
      }
    }
  });
  return out;
}

}  // namespace sherd
