#include "simulate/statics.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/parallel.h"
#include "geometry/disjoint_sets.h"
#include "simulate/element_response.h"
#include "simulate/nested_dissection.h"
#include "simulate/supernodal_solve.h"

namespace sherd {
namespace {

// The residual at which a solution is good: its share of the load, and the energy that it stands for. The
// second is what makes work and strain energy equal.
constexpr double kResidual = 1e-10, kEnergyResidual = 1e-12;
constexpr int kMostRefinements = 4;

static_assert(sizeof(Vec3) == 3 * sizeof(double));

Result<void> checkTets(const TetMesh& mesh) {
  if (mesh.tets.empty()) return failure("the body has no tetrahedra");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (!(tetVolume(mesh, t) > 0) || !std::isfinite(tetVolume(mesh, t)))
      return failure("tetrahedron " + std::to_string(t) + " is flat or inverted (" +
                         std::to_string(tetVolume(mesh, t)) + " m³)",
                     "every tetrahedron must have a positive volume");
  return {};
}

/// Tetrahedra that share a node but are not joined by faces could turn against each other without any stress.
Result<void> checkHinges(const TetMesh& mesh, std::span<const Index> partOf, Index parts) {
  DisjointSets joined(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index neighbour : mesh.neighbours[t])
      if (neighbour >= 0) joined.join(t, at(neighbour));
  std::vector<std::size_t> first(at(parts), mesh.tets.size());  // per part, the set of its first tetrahedron
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::size_t& expected = first[at(partOf[at(mesh.tets[t][0])])];
    if (expected == mesh.tets.size()) expected = joined.find(t);
    if (joined.find(t) == expected) continue;
    const Vec3& p = mesh.nodes[at(mesh.tets[t][0])];
    return failure("the tetrahedra near (" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " +
                       std::to_string(p.z()) +
                       ") m touch the others by single nodes or edges and can turn freely",
                   "tetrahedra must hang together by faces, or be apart");
  }
  return {};
}

/// Volume inside the surface. A part with none of it (all of it outside) moves as if it
/// weighed what it resists.
std::vector<double> massVolumes(const TetMesh& mesh, std::span<const double> volume,
                                std::span<const double> stiffnessVolume, std::span<const Index> partOf,
                                Index parts) {
  std::vector<double> inside(at(parts), 0.0), mass(volume.size());
  for (std::size_t t = 0; t < volume.size(); ++t) {
    mass[t] = mesh.insideFraction[t] * volume[t];
    inside[at(partOf[at(mesh.tets[t][0])])] += mass[t];
  }
  for (std::size_t t = 0; t < volume.size(); ++t)
    if (!(inside[at(partOf[at(mesh.tets[t][0])])] > 0)) mass[t] = stiffnessVolume[t];
  return mass;
}

/// The part of each element node: that of any element it belongs to.
std::vector<Index> partsOfNodes(const Elements& elements, std::span<const Index> partOfMeshNode) {
  std::vector<Index> partOf(elements.nodeCount(), -1);
  for (std::size_t t = 0; t < elements.mesh().tets.size(); ++t)
    for (const Index n : elements.nodesOf(t)) partOf[at(n)] = partOfMeshNode[at(elements.mesh().tets[t][0])];
  return partOf;
}

/// Springs go to the mesh's own nodes.
void addGauges(BlockMatrix& stiffness, std::span<const Vec3> meshNodes, std::span<const Index> partOf,
               Index parts, Index gaugeNode) {
  std::vector<std::vector<Index>> members(at(parts));
  for (std::size_t n = 0; n < meshNodes.size(); ++n) members[at(partOf[n])].push_back(static_cast<Index>(n));
  for (std::size_t p = 0; p < members.size(); ++p) {
    const bool startsHere = gaugeNode >= 0 && at(partOf[at(gaugeNode)]) == p;
    addGauge(stiffness, meshNodes, members[p], startsHere ? gaugeNode : -1);
  }
}

double dot(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += a[n].dot(b[n]);
  return sum;
}

}  // namespace

Result<Statics> Statics::factor(std::shared_ptr<const TetMesh> mesh, const StaticsParams& params,
                                const Exec& exec) {
  SHERD_CHECK(checkTets(*mesh));
  const Box box = boxOf(mesh->nodes);
  const double size = box.diagonal();
  std::vector<Vec3> nodes;
  for (const Vec3& p : mesh->nodes) nodes.emplace_back((p - box.centre()) / size);
  std::vector<Index> partOf;
  const Index partCount = connectedParts(*mesh, partOf);
  SHERD_CHECK(checkHinges(*mesh, partOf, partCount));

  const auto elements = std::make_shared<const Elements>(mesh, params.elements);
  std::vector<double> share = stiffnessShares(*elements), stiffnessVolume = share, volume;
  ElementRules rules(*elements, share, exec);
  if (exec.cancelled()) return cancelledError();
  for (std::size_t t = 0; t < mesh->tets.size(); ++t) {
    volume.push_back(Element(nodes, mesh->tets[t]).volume);
    stiffnessVolume[t] *= volume[t];
  }
  const Lame lame(params.poissonRatio);
  const VolumetricSplit split(lame, params.largestFull);
  BlockMatrix stiffness = assembleStiffness(*elements, rules, nodes, stiffnessVolume, lame.mu, split);
  addGauges(stiffness, nodes, partOf, partCount, params.gaugeNode);
  if (exec.cancelled()) return cancelledError();
  std::vector<Vec3> positions = elements->positions(nodes);
  const std::vector<Index> order = nestedDissection(positions, stiffness);
  if (exec.cancelled()) return cancelledError();
  SHERD_ASSIGN(SparseCholesky cholesky, SparseCholesky::factor(stiffness, order));

  Statics statics(elements, std::move(rules), std::move(cholesky));
  statics.share_ = std::move(share);
  statics.size_ = size;
  statics.lame_ = lame;
  statics.split_ = split;
  statics.nodes_ = std::move(positions);
  statics.massVolume_ = massVolumes(*mesh, volume, stiffnessVolume, partOf, partCount);
  if (params.elements == ElementOrder::Linear && split.averaged > 0)
    statics.averages_.emplace_back(*mesh, stiffnessVolume);
  statics.stiffnessVolume_ = std::move(stiffnessVolume);
  statics.partOf_ = partsOfNodes(*elements, partOf);
  statics.setMass(partCount);
  return statics;
}

void Statics::setMass(Index partCount) {
  parts_.assign(at(partCount), Part{});
  const TetMesh& mesh = elements_->mesh();
  std::vector<double> mass(at(partCount), 0.0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::size_t part = at(partOf_[at(mesh.tets[t][0])]);
    for (const Index n : mesh.tets[t]) parts_[part].centre += massVolume_[t] / 4 * nodes_[at(n)];
    mass[part] += massVolume_[t];
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p].centre /= mass[p];

  const Eigen::MatrixXd local = elementMass(elements_->order());
  nodeMass_.assign(nodes_.size(), 0.0);
  nodeMoment_.assign(nodes_.size(), Vec3::Zero());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::span<const Index> own = elements_->nodesOf(t);
    const Vec3& centre = parts_[at(partOf_[at(own[0])])].centre;
    for (std::size_t i = 0; i < own.size(); ++i)
      for (std::size_t j = 0; j < own.size(); ++j) {
        const double m = massVolume_[t] * local(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        nodeMass_[at(own[i])] += m;
        nodeMoment_[at(own[i])] += m * (nodes_[at(own[j])] - centre);
      }
  }
  std::vector<Eigen::Matrix<double, 6, 6>> gram(parts_.size());
  for (Eigen::Index mode = 0; mode < 6; ++mode) {
    const std::vector<Wrench> column =
        wrenches(inertialForce(std::vector<Wrench>(parts_.size(), Wrench::Unit(mode))));
    for (std::size_t p = 0; p < parts_.size(); ++p) gram[p].col(mode) = column[p];
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p].inverseGram = gram[p].inverse();
}

/// Rᵀ f per part.
std::vector<Statics::Wrench> Statics::wrenches(std::span<const Vec3> force) const {
  std::vector<Wrench> sum(parts_.size(), Wrench::Zero());
  for (std::size_t n = 0; n < force.size(); ++n) {
    const std::size_t part = at(partOf_[n]);
    sum[part].head<3>() += force[n];
    sum[part].tail<3>() += (nodes_[n] - parts_[part].centre).cross(force[n]);
  }
  return sum;
}

/// M R a.
std::vector<Vec3> Statics::inertialForce(const std::vector<Wrench>& acceleration) const {
  std::vector<Vec3> force(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Wrench& a = acceleration[at(partOf_[n])];
    force[n] = nodeMass_[n] * a.head<3>() + a.tail<3>().cross(nodeMoment_[n]);
  }
  return force;
}

std::vector<Vec3> Statics::balanced(std::span<const Vec3> force) const {
  std::vector<Wrench> acceleration = wrenches(force);
  for (std::size_t p = 0; p < parts_.size(); ++p) acceleration[p] = parts_[p].inverseGram * acceleration[p];
  std::vector<Vec3> load = inertialForce(acceleration);
  for (std::size_t n = 0; n < load.size(); ++n) load[n] = force[n] - load[n];
  return load;
}

/// u −= R (RᵀMR)⁻¹ RᵀM u.
void Statics::removeRigidMotion(std::vector<Vec3>& displacement) const {
  std::vector<Wrench> motion(parts_.size(), Wrench::Zero());
  for (std::size_t n = 0; n < displacement.size(); ++n) {
    Wrench& sum = motion[at(partOf_[n])];
    sum.head<3>() += nodeMass_[n] * displacement[n];
    sum.tail<3>() += nodeMoment_[n].cross(displacement[n]);
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) motion[p] = parts_[p].inverseGram * motion[p];
  for (std::size_t n = 0; n < displacement.size(); ++n) {
    const std::size_t part = at(partOf_[n]);
    displacement[n] -= motion[part].head<3>() + motion[part].tail<3>().cross(nodes_[n] - parts_[part].centre);
  }
}

void Statics::respond(std::size_t width, const double* displacement, double* force, double* energy) const {
  const ElementResponse response(*elements_, rules_, nodes_, stiffnessVolume_, split_, lame_.mu);
  std::vector<double> theta;
  if (!averages_.empty()) {
    theta.assign(width * elements_->mesh().nodes.size(), 0.0);
    response.addDilatation(width, displacement, theta.data());
    for (std::size_t i = 0; i < theta.size(); ++i) theta[i] /= averages_[0].volume[i / width];
  }
  response.add({width, displacement, theta.empty() ? nullptr : theta.data(), force, energy});
}

/// What each of several displacements gives, in walks over the elements that take kSolveWidth of them.
std::vector<Statics::Response> Statics::respond(std::span<const std::vector<Vec3>* const> u) const {
  const std::size_t numbers = 3 * nodes_.size(), tets = stiffnessVolume_.size();
  std::vector<Response> out(u.size());
  for (Response& r : out) {
    r.force.assign(nodes_.size(), Vec3::Zero());
    r.energy.resize(tets);
  }
  if (u.size() < kWorthABlock) {
    for (std::size_t i = 0; i < u.size(); ++i)
      respond(1, u[i]->data()->data(), out[i].force.data()->data(), out[i].energy.data());
    return out;
  }
  std::vector<double> wide(kSolveWidth * numbers, 0.0), force(kSolveWidth * numbers, 0.0),
      energy(kSolveWidth * tets);
  for (std::size_t begin = 0; begin < u.size(); begin += kSolveWidth) {
    const std::size_t count = std::min(kSolveWidth, u.size() - begin);
    for (std::size_t n = 0; n < numbers; ++n)
      for (std::size_t w = 0; w < count; ++w) wide[n * kSolveWidth + w] = (*u[begin + w])[n / 3][n % 3];
    std::fill(force.begin(), force.end(), 0.0);
    respond(kSolveWidth, wide.data(), force.data(), energy.data());
    for (std::size_t n = 0; n < numbers; ++n)
      for (std::size_t w = 0; w < count; ++w) out[begin + w].force[n / 3][n % 3] = force[n * kSolveWidth + w];
    for (std::size_t t = 0; t < tets; ++t)
      for (std::size_t w = 0; w < count; ++w) out[begin + w].energy[t] = energy[t * kSolveWidth + w];
  }
  return out;
}

/// Adds the solved step.
void Statics::takeStep(Progress& p) const {
  if (p.displacement.empty())
    p.displacement = std::move(p.step);
  else
    for (std::size_t n = 0; n < p.step.size(); ++n) p.displacement[n] += p.step[n];
  removeRigidMotion(p.displacement);
}

/// True when what is left of the load is good enough; otherwise `step` becomes that rest.
bool Statics::isSolved(Progress& p) const {
  p.step.resize(p.load.size());
  for (std::size_t n = 0; n < p.step.size(); ++n) p.step[n] = p.load[n] - p.response.force[n];
  const double load = std::sqrt(dot(p.load, p.load)), rest = std::sqrt(dot(p.step, p.step)),
               work = std::abs(dot(p.displacement, p.load)), lost = std::abs(dot(p.displacement, p.step));
  ++p.steps;
  p.residual = load > 0 ? std::max(rest / load, lost / work) : 0;
  if (rest <= kResidual * load && lost <= kEnergyResidual * work) return true;
  p.step = balanced(p.step);
  return false;
}

StaticSolution Statics::finished(Progress p, std::span<const Vec3> force, double youngModulus) const {
  // In units of size and E: K' u' = f / (E size²), u = size u'.
  const double scale = 1 / (youngModulus * size_);
  StaticSolution solution;
  for (Vec3& d : p.displacement) d *= scale;
  solution.work = 0.5 * dot(p.displacement, force);
  for (double& e : p.response.energy) e *= scale;
  solution.tetEnergy = std::move(p.response.energy);
  solution.displacement = std::move(p.displacement);
  solution.residual = p.residual;
  solution.refinements = p.steps - 1;
  return solution;
}

void Statics::solveBlock(std::span<const std::vector<Vec3>> forces, double youngModulus,
                         std::span<StaticSolution> solutions) const {
  std::vector<Progress> all(forces.size());
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    all[i].load = balanced(forces[i]);
    all[i].step = all[i].load;
    open.push_back(i);
  }
  for (int round = 0; round <= kMostRefinements && !open.empty(); ++round) {
    std::vector<std::vector<Vec3>*> steps;
    std::vector<const std::vector<Vec3>*> displacements;
    for (const std::size_t i : open) steps.push_back(&all[i].step);
    cholesky_.solve(steps);
    for (const std::size_t i : open) {
      takeStep(all[i]);
      displacements.push_back(&all[i].displacement);
    }
    std::vector<Response> responses = respond(displacements);
    for (std::size_t k = 0; k < open.size(); ++k) all[open[k]].response = std::move(responses[k]);
    std::erase_if(open, [&](std::size_t i) { return isSolved(all[i]); });
  }
  for (std::size_t i = 0; i < forces.size(); ++i)
    solutions[i] = finished(std::move(all[i]), forces[i], youngModulus);
}

StaticSolution Statics::solve(std::span<const Vec3> force, double youngModulus) const {
  const std::vector<Vec3> one(force.begin(), force.end());
  StaticSolution solution;
  solveBlock({&one, 1}, youngModulus, {&solution, 1});
  return solution;
}

Result<std::vector<StaticSolution>> Statics::solveAll(std::span<const std::vector<Vec3>> forces,
                                                      double youngModulus, const Exec& exec) const {
  std::vector<StaticSolution> solutions(forces.size());
  parallelFor(exec, forces.size(), kSolveWidth, [&](std::size_t begin, std::size_t end) {
    solveBlock(forces.subspan(begin, end - begin), youngModulus,
               std::span(solutions).subspan(begin, end - begin));
  });
  if (exec.cancelled()) return cancelledError();
  return solutions;
}

Statics::Response Statics::respondToOne(std::span<const Vec3> displacement) const {
  const std::vector<Vec3> u(displacement.begin(), displacement.end());
  const std::vector<Vec3>* const one[] = {&u};
  return std::move(respond(one)[0]);
}

std::vector<Vec3> Statics::internalForce(std::span<const Vec3> displacement, double youngModulus) const {
  std::vector<Vec3> force = respondToOne(displacement).force;
  for (Vec3& f : force) f *= youngModulus * size_;
  return force;
}

std::vector<double> Statics::tetEnergies(std::span<const Vec3> displacement, double youngModulus) const {
  std::vector<double> energy = respondToOne(displacement).energy;
  for (double& e : energy) e *= youngModulus * size_;
  return energy;
}

}  // namespace sherd
