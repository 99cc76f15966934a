#include "simulate/patch_load.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "geometry/point_triangle.h"

namespace sherd {
namespace {

double longestEdge(const std::array<Vec3, 3>& t, std::size_t& from) {
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = (t[(i + 1) % 3] - t[i]).norm();
    if (length > longest) {
      longest = length;
      from = i;
    }
  }
  return longest;
}

Vec3 areaVector(const std::array<Vec3, 3>& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]); }

}  // namespace

PatchLoader::PatchLoader(std::shared_ptr<const Elements> elements, double piece)
    : elements_(std::move(elements)), mesh_(&elements_->mesh()), piece_(piece) {
  tetBegin_.assign(mesh_->surface->triangles.size() + 1, 0);
  for (const Index triangle : mesh_->held) ++tetBegin_[at(triangle) + 1];
  for (std::size_t i = 1; i < tetBegin_.size(); ++i) tetBegin_[i] += tetBegin_[i - 1];
  std::vector<Index> next(tetBegin_.begin(), tetBegin_.end() - 1);
  tetHolding_.resize(mesh_->held.size());
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t)
    for (std::size_t h = at(mesh_->heldBegin[t]); h < at(mesh_->heldBegin[t + 1]); ++h)
      tetHolding_[at(next[at(mesh_->held[h])]++)] = static_cast<Index>(t);
}

std::array<Vec3, 3> PatchLoader::corners(Index triangle) const {
  const Triangle& t = mesh_->surface->triangles[at(triangle)];
  const std::vector<Vec3>& p = mesh_->surface->positions;
  return {p[at(t[0])], p[at(t[1])], p[at(t[2])]};
}

double PatchLoader::distanceTo(Index triangle, const Vec3& point) const {
  const auto c = corners(triangle);
  return (closestOnTriangle(point, c[0], c[1], c[2]) - point).norm();
}

/// Those of `triangles` that hang together with `seed` by shared vertices.
std::vector<Index> PatchLoader::connectedTo(Index seed, const std::vector<Index>& triangles) const {
  std::map<Index, std::vector<Index>> around;  // vertex → triangles
  for (const Index t : triangles)
    for (const Index v : mesh_->surface->triangles[at(t)]) around[v].push_back(t);
  std::vector<Index> found{seed};
  std::map<Index, bool> seen{{seed, true}};
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const Index v : mesh_->surface->triangles[at(found[i])])
      for (const Index t : around[v])
        if (seen.try_emplace(t, true).second) found.push_back(t);
  std::sort(found.begin(), found.end());
  return found;
}

PatchLoader::Patch PatchLoader::patch(const Vec3& point, const Vec3& force, double radius) const {
  struct Near {
    Index triangle;
    double distance;
    bool faces;
  };
  std::vector<Near> near;  // nearer than the radius, or nearest so far
  double closest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh_->surface->triangles.size(); ++t) {
    const auto c = corners(static_cast<Index>(t));
    const Vec3 low = c[0].cwiseMin(c[1]).cwiseMin(c[2]), high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    const double boxDistance = (low - point).cwiseMax(point - high).cwiseMax(0.0).norm();
    if (boxDistance > std::max(radius, closest)) continue;
    const double distance = distanceTo(static_cast<Index>(t), point);
    if (distance >= std::max(radius, closest)) continue;
    near.push_back({static_cast<Index>(t), distance, areaVector(c).dot(force) < 0});
    closest = std::min(closest, distance);
  }
  Near seed{-1, 0, false};
  for (const Near& n : near)
    if (n.distance <= closest + 1e-6 * radius && (seed.triangle < 0 || (n.faces && !seed.faces))) seed = n;
  std::vector<Index> candidates;
  for (const Near& n : near)
    if (n.triangle == seed.triangle || (n.distance < radius && (n.faces || !seed.faces)))
      candidates.push_back(n.triangle);
  return {seed.triangle, connectedTo(seed.triangle, candidates)};
}

/// Splits a piece at the middle of its longest edge until it is small, and weighs its centroid.
void PatchLoader::samplePiece(const Vec3& point, double radius, Index triangle,
                              const std::array<Vec3, 3>& piece, std::vector<Sample>& samples) const {
  if ((closestOnTriangle(point, piece[0], piece[1], piece[2]) - point).norm() >= radius) return;
  std::size_t from = 0;
  if (longestEdge(piece, from) > piece_ * radius) {
    const Vec3 middle = 0.5 * (piece[from] + piece[(from + 1) % 3]), &apex = piece[(from + 2) % 3];
    samplePiece(point, radius, triangle, {piece[from], middle, apex}, samples);
    samplePiece(point, radius, triangle, {middle, piece[(from + 1) % 3], apex}, samples);
    return;
  }
  const Vec3 centroid = (piece[0] + piece[1] + piece[2]) / 3;
  const double r = (centroid - point).norm() / radius;
  const double area = areaVector(piece).norm();
  if (r < 1 && area > 0) samples.push_back({centroid, area * std::sqrt(1 - r * r), triangle});
}

std::vector<PatchLoader::Sample> PatchLoader::quadrature(const Vec3& point, double radius,
                                                         const std::vector<Index>& triangles) const {
  std::vector<Sample> samples;
  for (const Index t : triangles) samplePiece(point, radius, t, corners(t), samples);
  double sum = 0;
  for (const Sample& s : samples) sum += s.weight;
  for (Sample& s : samples) s.weight /= sum;
  return samples;
}

/// The tetrahedron that holds the sample.
Result<PointLoad> PatchLoader::located(const Sample& sample, const Vec3& force) const {
  Index best = -1;
  Vec4 share = Vec4::Constant(-std::numeric_limits<double>::infinity());
  for (std::size_t i = at(tetBegin_[at(sample.triangle)]); i < at(tetBegin_[at(sample.triangle) + 1]); ++i) {
    const Vec4 b = barycentricIn(*mesh_, tetHolding_[i], sample.position);
    if (b.minCoeff() > share.minCoeff()) {
      share = b;
      best = tetHolding_[i];
    }
    if (share.minCoeff() >= 0) break;
  }
  if (best < 0 || share.minCoeff() < -1e-6)
    return failure("no tetrahedron holds the surface at (" + std::to_string(sample.position.x()) + ", " +
                       std::to_string(sample.position.y()) + ", " + std::to_string(sample.position.z()) +
                       ") m",
                   "the tetrahedra must enclose the surface");
  return PointLoad{best, share, force};
}

void PatchLoader::hand(std::span<const PointLoad> loads, std::vector<Vec3>& nodeForce) const {
  for (const PointLoad& load : loads) {
    const auto value = elements_->shapeValues(load.barycentric);
    const std::span<const Index> nodes = elements_->nodesOf(at(load.tet));
    for (std::size_t i = 0; i < nodes.size(); ++i) nodeForce[at(nodes[i])] += value[i] * load.force;
  }
}

std::size_t PatchLoader::pointCount(const Vec3& point, const Vec3& force, double radius) const {
  return quadrature(point, radius, patch(point, force, radius).triangles).size();
}

Result<std::vector<PointLoad>> PatchLoader::pointLoads(const Vec3& point, const Vec3& force,
                                                       double radius) const {
  const Patch found = patch(point, force, radius);
  const std::vector<Sample> samples = quadrature(point, radius, found.triangles);
  Vec3 centre = Vec3::Zero();
  Mat3 moment = Mat3::Zero();  // Σ w (x² I − x xᵀ) about the centre, in units of radius²
  for (const Sample& s : samples) centre += s.weight * (s.position - point);
  for (const Sample& s : samples) {
    const Vec3 x = (s.position - point - centre) / radius;
    moment += s.weight * (x.squaredNorm() * Mat3::Identity() - x * x.transpose());
  }
  // f_q = w_q (F + θ × x_q) with Σ w x × (θ × x) = −centre × F.
  const Vec3 torque = -centre.cross(force) / radius;
  const Vec3 theta =
      samples.empty() ? Vec3::Zero() : Vec3(moment.completeOrthogonalDecomposition().solve(torque));
  // A patch along a line cannot carry a moment about it, and one of no area nothing: the
  // point itself then must.
  std::vector<PointLoad> loads;
  if (samples.empty() || !((moment * theta - torque).norm() <= 1e-9 * force.norm()) ||
      !(theta.norm() <= 10 * force.norm())) {
    SHERD_ASSIGN(const PointLoad load, located({point, 1, found.seed}, force));
    loads.push_back(load);
    return loads;
  }
  for (const Sample& s : samples) {
    const Vec3 x = (s.position - point - centre) / radius;
    SHERD_ASSIGN(const PointLoad load, located(s, s.weight * (force + theta.cross(x))));
    loads.push_back(load);
  }
  return loads;
}

Result<void> PatchLoader::add(const Vec3& point, const Vec3& force, double radius,
                              std::vector<Vec3>& nodeForce) const {
  SHERD_ASSIGN(const std::vector<PointLoad> loads, pointLoads(point, force, radius));
  hand(loads, nodeForce);
  return {};
}

}  // namespace sherd
