#include "simulate/statics.h"

#include <cmath>
#include <string>

#include "geometry/disjoint_sets.h"
#include "simulate/assembly.h"
#include "simulate/nested_dissection.h"

namespace sherd {
namespace {

/// M x for the consistent mass matrix of tetrahedra that weigh `mass`: m/20 (1 + δ_ij).
std::vector<Vec3> massTimes(std::span<const Tetra> tets, std::span<const double> mass,
                            std::span<const Vec3> x) {
  std::vector<Vec3> y(x.size(), Vec3::Zero());
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const Tetra& tet = tets[t];
    const Vec3 sum = x[at(tet[0])] + x[at(tet[1])] + x[at(tet[2])] + x[at(tet[3])];
    for (const Index n : tet) y[at(n)] += mass[t] / 20 * (x[at(n)] + sum);
  }
  return y;
}

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

}  // namespace

Result<Statics> Statics::factor(std::shared_ptr<const TetMesh> mesh, double poissonRatio, const Exec& exec,
                                Index gaugeNode) {
  SHERD_CHECK(checkTets(*mesh));
  const Box box = boxOf(mesh->nodes);
  const double size = box.diagonal();
  std::vector<Vec3> nodes;
  for (const Vec3& p : mesh->nodes) nodes.emplace_back((p - box.centre()) / size);
  std::vector<Index> partOf;
  const Index partCount = connectedParts(*mesh, partOf);
  SHERD_CHECK(checkHinges(*mesh, partOf, partCount));

  std::vector<double> stiffnessVolume = stiffnessShares(*mesh), volume;
  for (std::size_t t = 0; t < mesh->tets.size(); ++t) {
    volume.push_back(Element(nodes, mesh->tets[t]).volume);
    stiffnessVolume[t] *= volume[t];
  }
  BlockMatrix stiffness = assembleStiffness(nodes, mesh->tets, stiffnessVolume, Lame(poissonRatio));
  std::vector<std::vector<Index>> members(at(partCount));
  for (std::size_t n = 0; n < nodes.size(); ++n) members[at(partOf[n])].push_back(static_cast<Index>(n));
  for (std::size_t p = 0; p < members.size(); ++p) {
    const bool startsHere = gaugeNode >= 0 && at(partOf[at(gaugeNode)]) == p;
    addGauge(stiffness, nodes, members[p], startsHere ? gaugeNode : -1);
  }
  if (exec.cancelled()) return cancelledError();
  const std::vector<Index> order = nestedDissection(nodes, stiffness);
  if (exec.cancelled()) return cancelledError();
  SHERD_ASSIGN(SparseCholesky cholesky, SparseCholesky::factor(stiffness, order));

  Statics statics(mesh, std::move(cholesky));
  statics.size_ = size;
  statics.poisson_ = poissonRatio;
  statics.nodes_ = std::move(nodes);
  statics.massVolume_ = massVolumes(*mesh, volume, stiffnessVolume, partOf, partCount);
  statics.stiffnessVolume_ = std::move(stiffnessVolume);
  statics.partOf_ = std::move(partOf);
  statics.setParts(partCount);
  return statics;
}

void Statics::setParts(Index count) {
  parts_.assign(at(count), Part{});
  std::vector<double> mass(at(count), 0.0);
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    const Tetra& tet = mesh_->tets[t];
    const std::size_t part = at(partOf_[at(tet[0])]);
    for (const Index n : tet) parts_[part].centre += massVolume_[t] / 4 * nodes_[at(n)];
    mass[part] += massVolume_[t];
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p].centre /= mass[p];
  std::vector<Eigen::Matrix<double, 6, 6>> gram(at(count));
  for (Eigen::Index mode = 0; mode < 6; ++mode) {
    const std::vector<Vec3> field = rigidField(std::vector<Wrench>(at(count), Wrench::Unit(mode)));
    const std::vector<Wrench> column = wrenches(massTimes(mesh_->tets, massVolume_, field));
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

/// R a.
std::vector<Vec3> Statics::rigidField(const std::vector<Wrench>& motion) const {
  std::vector<Vec3> field(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::size_t part = at(partOf_[n]);
    field[n] = motion[part].head<3>() + motion[part].tail<3>().cross(nodes_[n] - parts_[part].centre);
  }
  return field;
}

std::vector<Vec3> Statics::balanced(std::span<const Vec3> force) const {
  std::vector<Wrench> acceleration = wrenches(force);
  for (std::size_t p = 0; p < parts_.size(); ++p) acceleration[p] = parts_[p].inverseGram * acceleration[p];
  std::vector<Vec3> load = massTimes(mesh_->tets, massVolume_, rigidField(acceleration));
  for (std::size_t n = 0; n < load.size(); ++n) load[n] = force[n] - load[n];
  return load;
}

void Statics::removeRigidMotion(std::vector<Vec3>& displacement) const {
  std::vector<Wrench> motion = wrenches(massTimes(mesh_->tets, massVolume_, displacement));
  for (std::size_t p = 0; p < parts_.size(); ++p) motion[p] = parts_[p].inverseGram * motion[p];
  const std::vector<Vec3> rigid = rigidField(motion);
  for (std::size_t n = 0; n < displacement.size(); ++n) displacement[n] -= rigid[n];
}

StaticSolution Statics::solve(std::span<const Vec3> force, double youngModulus) const {
  const std::vector<Vec3> load = balanced(force);
  StaticSolution solution;
  // In units of size and E: K' u' = f / (E size²), u = size u'.
  std::vector<Vec3> u = load;
  cholesky_.solve(u);
  removeRigidMotion(u);
  // One step of refinement: slivers and soft nodes cost digits.
  std::vector<Vec3> rest = internalForce(u, 1 / size_);
  for (std::size_t n = 0; n < u.size(); ++n) rest[n] = load[n] - rest[n];
  rest = balanced(rest);
  cholesky_.solve(rest);
  for (std::size_t n = 0; n < u.size(); ++n) u[n] += rest[n];
  removeRigidMotion(u);
  for (Vec3& d : u) d /= youngModulus * size_;
  for (std::size_t n = 0; n < u.size(); ++n) solution.work += 0.5 * u[n].dot(force[n]);
  solution.tetEnergy = tetEnergies(u, youngModulus);
  solution.displacement = std::move(u);
  return solution;
}

std::vector<Vec3> Statics::internalForce(std::span<const Vec3> displacement, double youngModulus) const {
  std::vector<Vec3> force(nodes_.size(), Vec3::Zero());
  const Lame lame(poisson_);
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    const Tetra& tet = mesh_->tets[t];
    const Element element(nodes_, tet);
    const Mat3 stress = Element::stress(element.strain(displacement, tet), lame);
    for (std::size_t i = 0; i < 4; ++i)
      force[at(tet[i])] += youngModulus * size_ * stiffnessVolume_[t] * (stress * element.gradient[i]);
  }
  return force;
}

std::vector<double> Statics::tetEnergies(std::span<const Vec3> displacement, double youngModulus) const {
  std::vector<double> energy(mesh_->tets.size());
  const Lame lame(poisson_);
  for (std::size_t t = 0; t < energy.size(); ++t) {
    const Tetra& tet = mesh_->tets[t];
    const Mat3 strain = Element(nodes_, tet).strain(displacement, tet);
    energy[t] = youngModulus * size_ * stiffnessVolume_[t] * Element::energyDensity(strain, lame);
  }
  return energy;
}

}  // namespace sherd
