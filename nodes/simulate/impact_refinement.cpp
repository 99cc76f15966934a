#include "simulate/impact_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "geometry/surface_tree.h"
#include "simulate/local_refinement.h"

namespace sherd {
namespace {

/// Per tetrahedron, the longest edge that its energy allows.
std::vector<double> edgesForEnergy(const TetMesh& mesh, std::span<const double> energy, double largestShare) {
  const double least = std::max(largestShare, kLargestMultiple / static_cast<double>(energy.size()));
  const double largest = least * std::accumulate(energy.begin(), energy.end(), 0.0);
  std::vector<double> wanted(energy.size(), std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < energy.size(); ++t) {
    if (!(energy[t] > largest)) continue;
    double longest = 0;
    for (const auto& e : kTetraEdge)
      longest = std::max(
          longest, (mesh.nodes[at(mesh.tets[t][at(e[0])])] - mesh.nodes[at(mesh.tets[t][at(e[1])])]).norm());
    wanted[t] = longest * std::max(std::cbrt(largest / energy[t]), kShortestShare);
  }
  return wanted;
}

double edgeForContacts(const Impact& impact, const Vec3& place, double patchEdges) {
  double wanted = std::numeric_limits<double>::infinity();
  for (const Contact& c : impact.contacts)
    wanted = std::min(wanted, patchEdges * c.radius + std::max((place - c.point).norm() - c.radius, 0.0));
  return wanted;
}

}  // namespace

struct ImpactRefinement::Impl {
  const Statics& statics;
  RefinementParams params;
  SurfaceTree surface;
};

ImpactRefinement::ImpactRefinement(const Statics& statics, const RefinementParams& params)
    : impl_(new Impl{statics, params,
                     SurfaceTree(statics.elements()->mesh().surface->positions,
                                 statics.elements()->mesh().surface->triangles)}) {}
ImpactRefinement::~ImpactRefinement() = default;

Result<std::size_t> ImpactRefinement::refine(const Impact& impact, std::span<const Vec3> force,
                                             std::span<const PointLoad> loads, double youngModulus,
                                             StaticSolution& solution, const Exec& exec) const {
  const TetMesh& mesh = impl_->statics.elements()->mesh();
  const std::vector<double> forEnergy = edgesForEnergy(mesh, solution.tetEnergy, impl_->params.largestShare);
  const DividedTets divided = divideTets(mesh.nodes, mesh.tets, [&](const Vec3& place, Index t) {
    return std::min(forEnergy[at(t)], edgeForContacts(impact, place, impl_->params.patchEdges));
  });
  if (divided.tets.size() == mesh.tets.size()) return std::size_t{0};
  if (exec.cancelled()) return cancelledError();
  const auto leaveIt = [&](const std::string& why) {
    exec.warn("the energy is that of unrefined tetrahedra, which may be too low: " + why);
    return std::size_t{0};
  };
  const auto refinement = LocalRefinement::make(impl_->statics, divided, impl_->surface, exec);
  if (exec.cancelled()) return cancelledError();
  if (!refinement.ok()) return leaveIt(refinement.error().what);
  SHERD_ASSIGN(StaticSolution refined, refinement->solve(force, loads, youngModulus, exec));
  if (!(refined.residual <= kWorstResidual))
    return leaveIt("the body is too flat for smaller ones, or hangs together by next to nothing");
  solution = std::move(refined);
  return refinement->pieces();
}

}  // namespace sherd
