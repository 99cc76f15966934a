#include "simulate/local_refinement.h"

#include <algorithm>
#include <cmath>

#include "simulate/element_response.h"
#include "simulate/nested_dissection.h"

namespace sherd {
namespace {

constexpr double kResidual = 1e-10;  // share of the energy that may be missing
constexpr int kMostSteps = 40;       // some four are usual: more is what rounding leaves of flat bodies

double dot(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += a[n].dot(b[n]);
  return sum;
}

/// The rows and columns of `nodes` (ascending).
BlockMatrix partOf(const BlockMatrix& matrix, std::span<const Index> nodes) {
  std::vector<Index> number(matrix.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) number[at(nodes[i])] = static_cast<Index>(i);
  BlockMatrix part;
  part.begin.push_back(0);
  for (const Index n : nodes) {
    for (std::size_t e = at(matrix.begin[at(n)]); e < at(matrix.begin[at(n) + 1]); ++e) {
      if (number[at(matrix.row[e])] < 0) continue;
      part.row.push_back(number[at(matrix.row[e])]);
      part.block.push_back(matrix.block[e]);
    }
    part.begin.push_back(static_cast<Index>(part.row.size()));
  }
  return part;
}

}  // namespace

Result<LocalRefinement> LocalRefinement::make(const Statics& statics, const DividedTets& divided,
                                              const SurfaceTree& surface, const Exec& exec) {
  LocalRefinement r(statics);
  const TetMesh& cage = statics.elements_->mesh();
  r.region_ = std::make_unique<const RefinedRegion>(*statics.elements_, divided);
  const Elements& elements = r.region_->elements();
  const PieceRules rules = pieceRules(*r.region_, cage, statics.share_, surface, exec);
  if (exec.cancelled()) return cancelledError();
  r.rules_ = std::make_unique<const ElementRules>(elements, rules.rule);
  const Vec3 centre = boxOf(cage.nodes).centre();
  for (const Vec3& p : elements.mesh().nodes) r.nodes_.emplace_back((p - centre) / statics.size_);
  for (std::size_t i = 0; i < r.pieces(); ++i)
    r.weight_.push_back(rules.share[i] * Element(r.nodes_, elements.mesh().tets[i]).volume);
  r.outsideVolume_ = statics.stiffnessVolume_;
  for (std::size_t t = 0; t < cage.tets.size(); ++t)
    if (r.region_->covers(t)) r.outsideVolume_[t] = 0;
  for (std::size_t n = 0; n < elements.nodeCount(); ++n)
    if (r.region_->fixed()[n] == 0) r.free_.push_back(static_cast<Index>(n));
  r.setMass(rules);
  r.setInertia();
  if (exec.cancelled()) return cancelledError();
  SHERD_CHECK(r.factorPieces());
  return r;
}

Result<void> LocalRefinement::factorPieces() {
  const Elements& elements = region_->elements();
  stiffness_ = assembleStiffness(elements, *rules_, nodes_, weight_, statics_->lame_.mu, statics_->split_);
  BlockMatrix free = partOf(stiffness_, free_);
  const std::vector<Vec3> all = elements.positions(nodes_);
  std::vector<Vec3> positions;
  for (const Index n : free_) positions.push_back(all[at(n)]);
  holdWholeParts(free, positions);
  SHERD_ASSIGN(SparseCholesky cholesky, SparseCholesky::factor(free, nestedDissection(positions, free)));
  cholesky_.push_back(std::move(cholesky));
  return {};
}

/// A connected part that is covered wholly has nothing fixed: springs hold it, as the cage's do.
void LocalRefinement::holdWholeParts(BlockMatrix& free, std::span<const Vec3> positions) const {
  std::vector<char> held(statics_->parts_.size(), 0);
  std::vector<std::vector<Index>> members(held.size());
  for (std::size_t n = 0; n < region_->fixed().size(); ++n)
    if (region_->fixed()[n] != 0) held[partOfNode(n)] = 1;
  for (std::size_t i = 0; i < free_.size(); ++i)
    members[partOfNode(at(free_[i]))].push_back(static_cast<Index>(i));
  for (std::size_t p = 0; p < held.size(); ++p)
    if (held[p] == 0 && !members[p].empty()) addGauge(free, positions, members[p], -1);
}

std::size_t LocalRefinement::partOfNode(std::size_t node) const {
  return partOfTet(at(region_->places()[node].tet));
}
std::size_t LocalRefinement::partOfTet(std::size_t tet) const {
  return at(statics_->partOf_[at(statics_->elements_->nodesOf(tet)[0])]);
}

void LocalRefinement::Inertia::addElement(std::span<const Index> nodes, const Vec3& centre,
                                          std::span<const Vec3> positions, double volume) {
  static const Eigen::MatrixXd local = elementMass(ElementOrder::Quadratic);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const double m = volume * local(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      mass[at(nodes[i])] += m;
      moment[at(nodes[i])] += m * (positions[at(nodes[j])] - centre);
    }
}

void LocalRefinement::setMass(const PieceRules& rules) {
  const Elements &cage = *statics_->elements_, &elements = region_->elements();
  const std::vector<Vec3> positions = elements.positions(nodes_);
  inertia_ = {Inertia(cage.nodeCount()), Inertia(elements.nodeCount())};
  for (std::size_t t = 0; t < cage.mesh().tets.size(); ++t) {
    const Vec3& centre = statics_->parts_[partOfTet(t)].centre;
    if (!region_->covers(t)) {
      inertia_[0].addElement(cage.nodesOf(t), centre, statics_->nodes_, statics_->massVolume_[t]);
      continue;
    }
    double inside = 0;
    std::vector<double> held;
    for (std::size_t i = region_->begin(t); i < region_->begin(t + 1); ++i) {
      held.push_back(rules.inside[i] * Element(nodes_, elements.mesh().tets[i]).volume);
      inside += held.back();
    }
    for (std::size_t i = 0; i < held.size() && inside > 0; ++i)
      inertia_[1].addElement(elements.nodesOf(region_->begin(t) + i), centre, positions,
                             statics_->massVolume_[t] * held[i] / inside);
  }
  Field mass(elements.nodeCount()), onCage(cage.nodeCount(), Vec3::Zero());
  for (std::size_t n = 0; n < mass.size(); ++n) mass[n] = Vec3(inertia_[1].mass[n], 0, 0);
  addRestricted(mass, onCage);
  for (std::size_t n = 0; n < onCage.size(); ++n) inertia_[0].mass[n] += onCage[n].x();
  addRestricted(inertia_[1].moment, inertia_[0].moment);
}

/// M R a, of the cage's nodes or the pieces'.
LocalRefinement::Field LocalRefinement::inertialForce(const Wrenches& acceleration, bool ofPieces) const {
  const Inertia& inertia = inertia_[ofPieces ? 1 : 0];
  Field force(inertia.mass.size());
  for (std::size_t n = 0; n < force.size(); ++n) {
    const auto& a = acceleration[ofPieces ? partOfNode(n) : at(statics_->partOf_[n])];
    force[n] = inertia.mass[n] * a.head<3>() + a.tail<3>().cross(inertia.moment[n]);
  }
  return force;
}

void LocalRefinement::setInertia() {
  const std::size_t parts = statics_->parts_.size();
  inverseGram_.resize(parts);
  for (Eigen::Index mode = 0; mode < 6; ++mode) {
    const Wrenches column =
        statics_->wrenches(inertialForce(Wrenches(parts, Statics::Wrench::Unit(mode)), false));
    for (std::size_t p = 0; p < parts; ++p) inverseGram_[p].col(mode) = column[p];
  }
  for (auto& gram : inverseGram_) gram = gram.inverse().eval();
}

/// P u.
LocalRefinement::Field LocalRefinement::interpolated(const Field& cage) const {
  Field pieces;
  pieces.reserve(region_->places().size());
  for (const RefinedRegion::Place& place : region_->places()) {
    const std::span<const Index> own = statics_->elements_->nodesOf(at(place.tet));
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < own.size(); ++i) sum += place.value[i] * cage[at(own[i])];
    pieces.push_back(sum);
  }
  return pieces;
}

/// cage += Pᵀ pieces.
void LocalRefinement::addRestricted(const Field& pieces, Field& cage) const {
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const RefinedRegion::Place& place = region_->places()[n];
    const std::span<const Index> own = statics_->elements_->nodesOf(at(place.tet));
    for (std::size_t i = 0; i < own.size(); ++i) cage[at(own[i])] += place.value[i] * pieces[n];
  }
}

/// K u.
LocalRefinement::Field LocalRefinement::timesPieces(const Field& pieces) const {
  Field force(pieces.size(), Vec3::Zero());
  for (std::size_t column = 0; column < pieces.size(); ++column)
    for (std::size_t e = at(stiffness_.begin[column]); e < at(stiffness_.begin[column + 1]); ++e) {
      const std::size_t row = at(stiffness_.row[e]);
      force[row] += stiffness_.block[e] * pieces[column];
      if (row != column) force[column] += stiffness_.block[e].transpose() * pieces[row];
    }
  return force;
}

/// K_hh⁻¹ f_h, zero at fixed nodes.
LocalRefinement::Field LocalRefinement::solvedPieces(const Field& force) const {
  Field some, all(force.size(), Vec3::Zero());
  for (const Index n : free_) some.push_back(force[at(n)]);
  cholesky_[0].solve(some);
  for (std::size_t i = 0; i < free_.size(); ++i) all[at(free_[i])] = some[i];
  return all;
}

/// What tetrahedra that are not covered pull with, and their energies.
LocalRefinement::Field LocalRefinement::outsideForce(const Field& cage, std::vector<double>& energy) const {
  Field force(cage.size(), Vec3::Zero());
  energy.resize(outsideVolume_.size());
  const ElementResponse response(*statics_->elements_, statics_->rules_, statics_->nodes_, outsideVolume_,
                                 statics_->split_, statics_->lame_.mu);
  response.add({1, cage.data()->data(), nullptr, force.data()->data(), energy.data()});
  return force;
}

/// S x.
LocalRefinement::Field LocalRefinement::timesSchur(const Field& cage) const {
  std::vector<double> energy;
  Field force = outsideForce(cage, energy), pieces = interpolated(cage);
  const Field correction = solvedPieces(timesPieces(pieces));
  for (std::size_t n = 0; n < pieces.size(); ++n) pieces[n] -= correction[n];
  addRestricted(timesPieces(pieces), force);
  return force;
}

/// A force at a point of the piece that holds it; none where its tetrahedron isn't covered.
void LocalRefinement::addPointLoad(const PointLoad& load, Field& force) const {
  const std::size_t t = at(load.tet);
  const TetMesh &cage = statics_->elements_->mesh(), &pieces = region_->elements().mesh();
  Vec3 point = Vec3::Zero();
  for (std::size_t c = 0; c < 4; ++c)
    point += load.barycentric[static_cast<Eigen::Index>(c)] * cage.nodes[at(cage.tets[t][c])];
  std::size_t best = 0;
  Vec4 share = Vec4::Constant(-std::numeric_limits<double>::infinity());
  for (std::size_t i = region_->begin(t); i < region_->begin(t + 1); ++i) {
    const Vec4 b = barycentricIn(pieces, static_cast<Index>(i), point);
    if (!(b.minCoeff() > share.minCoeff())) continue;
    share = b;
    best = i;
  }
  if (!region_->covers(t)) return;
  const auto value = region_->elements().shapeValues(share);
  const std::span<const Index> own = region_->elements().nodesOf(best);
  for (std::size_t i = 0; i < own.size(); ++i) force[at(own[i])] += value[i] * load.force;
}

/// f_h: the point loads less the forces of inertia.
LocalRefinement::Field LocalRefinement::pieceForce(const Wrenches& acceleration,
                                                   std::span<const PointLoad> loads) const {
  Field sum = inertialForce(acceleration, true);
  for (Vec3& f : sum) f = -f;
  for (const PointLoad& load : loads) addPointLoad(load, sum);
  return sum;
}

Result<LocalRefinement::Solved> LocalRefinement::conjugateGradients(const Field& load, const Field& pieceLoad,
                                                                    const Exec& exec) const {
  Field rest = load;
  Field first = timesPieces(solvedPieces(pieceLoad));
  for (Vec3& f : first) f = -f;
  addRestricted(first, rest);
  Field whole = load;
  statics_->cholesky_.solve(whole);
  const double start = dot(whole, load);
  Solved s{Field(load.size(), Vec3::Zero()), {}, 0, 0};
  Field direction(load.size(), Vec3::Zero());
  double last = 0;
  for (; s.steps < kMostSteps; ++s.steps) {
    Field step = rest;
    statics_->cholesky_.solve(step);
    const double left = dot(step, rest);
    s.residual = start > 0 ? std::max(left, 0.0) / start : 0;
    if (!(s.residual > kResidual)) break;
    for (std::size_t n = 0; n < step.size(); ++n)
      direction[n] = step[n] + (s.steps > 0 ? left / last : 0.0) * direction[n];
    last = left;
    const Field image = timesSchur(direction);
    const double bend = dot(direction, image);
    if (!(bend > 0)) break;
    const double length = left / bend;
    for (std::size_t n = 0; n < step.size(); ++n) {
      s.cage[n] += length * direction[n];
      rest[n] -= length * image[n];
    }
    if (exec.cancelled()) return cancelledError();
  }
  Field pieces = timesPieces(interpolated(s.cage));
  for (std::size_t n = 0; n < pieces.size(); ++n) pieces[n] = pieceLoad[n] - pieces[n];
  s.pieces = solvedPieces(pieces);
  return s;
}

/// u −= R (RᵀMR)⁻¹ RᵀM u, of the mesh's nodes, u being the cage's and the pieces' displacements added.
void LocalRefinement::removeRigidMotion(const Solved& solved, Field& displacement) const {
  Wrenches motion(statics_->parts_.size(), Statics::Wrench::Zero());
  const auto add = [](Statics::Wrench& sum, const Inertia& inertia, const Vec3& u, std::size_t n) {
    sum.head<3>() += inertia.mass[n] * u;
    sum.tail<3>() += inertia.moment[n].cross(u);
  };
  for (std::size_t n = 0; n < solved.cage.size(); ++n)
    add(motion[at(statics_->partOf_[n])], inertia_[0], solved.cage[n], n);
  for (std::size_t n = 0; n < solved.pieces.size(); ++n)
    add(motion[partOfNode(n)], inertia_[1], solved.pieces[n], n);
  for (std::size_t p = 0; p < motion.size(); ++p) motion[p] = inverseGram_[p] * motion[p];
  for (std::size_t n = 0; n < displacement.size(); ++n) {
    const std::size_t part = at(statics_->partOf_[n]);
    displacement[n] -= motion[part].head<3>() +
                       motion[part].tail<3>().cross(statics_->nodes_[n] - statics_->parts_[part].centre);
  }
}

Result<StaticSolution> LocalRefinement::solve(std::span<const Vec3> force, std::span<const PointLoad> loads,
                                              double youngModulus, const Exec& exec) const {
  Wrenches acceleration = statics_->wrenches(force);
  for (std::size_t p = 0; p < acceleration.size(); ++p) acceleration[p] = inverseGram_[p] * acceleration[p];
  Field load = inertialForce(acceleration, false);
  for (std::size_t n = 0; n < load.size(); ++n) load[n] = force[n] - load[n];
  const Field pieceLoad = pieceForce(acceleration, loads);
  SHERD_ASSIGN(const Solved solved, conjugateGradients(load, pieceLoad, exec));
  const double scale = 1 / (youngModulus * statics_->size_);
  StaticSolution out;
  out.work = 0.5 * scale * (dot(load, solved.cage) + dot(pieceLoad, solved.pieces));
  out.residual = solved.residual;
  out.refinements = solved.steps;

  outsideForce(solved.cage, out.tetEnergy);
  Field pieces = interpolated(solved.cage), pull(pieces.size(), Vec3::Zero());
  for (std::size_t n = 0; n < pieces.size(); ++n) pieces[n] += solved.pieces[n];
  std::vector<double> energy(region_->size());
  const ElementResponse response(region_->elements(), *rules_, nodes_, weight_, statics_->split_,
                                 statics_->lame_.mu);
  response.add({1, pieces.data()->data(), nullptr, pull.data()->data(), energy.data()});
  for (std::size_t i = 0; i < energy.size(); ++i) out.tetEnergy[at(region_->parent(i))] += energy[i];
  for (double& e : out.tetEnergy) e *= scale;

  out.displacement = solved.cage;
  out.displacement.resize(statics_->elements_->mesh().nodes.size());
  for (std::size_t n = 0; n < region_->elements().mesh().nodes.size(); ++n)
    if (const Index own = region_->cageNode(n); own >= 0) out.displacement[at(own)] = pieces[n];
  removeRigidMotion(solved, out.displacement);
  for (Vec3& d : out.displacement) d *= scale;
  return out;
}

}  // namespace sherd
