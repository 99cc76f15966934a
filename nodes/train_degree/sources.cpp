#include "train_degree/sources.h"

#include <fmt/format.h>

#include <cmath>

#include "geometry/solid.h"
#include "train_degree/rotations.h"

namespace sherd {
namespace {

/// Of the body's size: as far as centres of mass of one body, computed twice, may be apart.
constexpr double kSameCentre = 1e-6;

Error outside(const char* parameter, const std::string& value, const char* range) {
  return Error{fmt::format("{} is {}", parameter, value), std::string("must be ") + range, parameter,
               Error::Kind::Input};
}

Result<void> checkAmounts(const std::vector<double>& values, const char* parameter, const char* unit) {
  for (const double v : values)
    if (!(v > 0) || !std::isfinite(v))
      return outside(parameter, fmt::format("{:.6g} {}", v, unit), "above 0");
  return {};
}

Result<void> checkImpact(const Impact& impact, const Vec3& centre, double size) {
  for (const Contact& c : impact.contacts) {
    const bool isSound = c.point.allFinite() && c.impulse.allFinite() && c.duration > 0 && c.radius > 0 &&
                         std::isfinite(c.duration) && std::isfinite(c.radius);
    if (!isSound) return failure("has a contact that is not finite, or without duration or radius");
  }
  const double apart = (impact.centreOfMass - centre).norm();
  if (impact.hit && !(apart <= kSameCentre * size))
    return failure(fmt::format("is of another body: its centre of mass is {:.3g} m from this one's", apart),
                   "wire the impacts of a Simulate with the same body");
  return {};
}

Result<void> checkImpacts(const TetMesh& tets, const std::vector<Impact>& impacts) {
  if (impacts.empty() || tets.surface == nullptr) return {};
  const Vec3 centre = integrateSolid(tets.surface->positions, tets.surface->triangles).centroid;
  for (std::size_t i = 0; i < impacts.size(); ++i)
    if (const auto good = checkImpact(impacts[i], centre, sizeOf(tets)); !good.ok())
      return Error{fmt::format("impact {} {}", i + 1, good.error().what), good.error().remedy, "impacts",
                   Error::Kind::Input};
  return {};
}

const std::vector<double>& listOr(const std::vector<double>& list, const std::vector<double>& otherwise) {
  return list.empty() ? otherwise : list;
}

void addDrops(const TrainDegreeParams& params, int& group, std::vector<DropExample>& out) {
  for (const Vec3& orientation : uniformOrientations(params.orientations, params.seed)) {
    for (const double height : listOr(params.heights, kDropHeights)) {
      DropExample& drop = out.emplace_back();
      drop.orientation = orientation;
      drop.height = height;
      drop.example.group = group;
    }
    ++group;
  }
}

void addBalls(const TetMesh& tets, const TrainDegreeParams& params, int& group,
              std::vector<DropExample>& out) {
  std::vector<BallHit> hits = params.ballHits;
  if (params.balls > 0 && tets.surface != nullptr)
    for (const BallHit& hit : spreadBallHits(*tets.surface, params.balls, params.drop.standing, params.seed))
      hits.push_back(hit);
  for (const BallHit& hit : hits) {
    for (const double speed : listOr(params.ballSpeeds, kBallSpeeds)) {
      DropExample& thrown = out.emplace_back();
      thrown.source = ExampleSource::Ball;
      thrown.hit = hit;
      thrown.speed = speed;
      thrown.example.group = group;
    }
    ++group;
  }
}

}  // namespace

double sizeOf(const TetMesh& tets) {
  if (tets.surface == nullptr || tets.surface->positions.empty()) return 1;
  Vec3 low = tets.surface->positions[0], high = low;
  for (const Vec3& p : tets.surface->positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double size = (high - low).norm();
  return size > 0 && std::isfinite(size) ? size : 1;
}

Result<void> checkSources(const TetMesh& tets, const TrainDegreeParams& p) {
  if (p.orientations < 0) return outside("orientations", std::to_string(p.orientations), "at least 0");
  if (p.balls < 0) return outside("balls", std::to_string(p.balls), "at least 0");
  if (p.repeats < 1) return outside("repeats", std::to_string(p.repeats), "at least 1");
  if (p.maxDegree < 1) return outside("max_degree", std::to_string(p.maxDegree), "at least 1");
  if (!(p.gamma > 0) || !std::isfinite(p.gamma))
    return outside("gamma", fmt::format("{:.6g}", p.gamma), "above 0");
  SHERD_CHECK(checkAmounts(p.heights, "heights", "m"));
  SHERD_CHECK(checkAmounts(p.ballSpeeds, "ball_speeds", "m/s"));
  return checkImpacts(tets, p.impacts);
}

Result<std::vector<DropExample>> examplesOf(const TetMesh& tets, const TrainDegreeParams& params) {
  std::vector<DropExample> out;
  int group = 0;
  addDrops(params, group, out);
  addBalls(tets, params, group, out);
  for (std::size_t i = 0; i < params.impacts.size(); ++i) {
    if (!params.impacts[i].hit || params.impacts[i].contacts.empty()) continue;
    DropExample& given = out.emplace_back();
    given.source = ExampleSource::Impact;
    given.impact = i;
    given.example.group = group++;
  }
  if (out.empty())
    return Error{"there is nothing to learn from: no drop, no ball, and no impact that hits the body",
                 "ask for at least one orientation or ball, or wire impacts", "orientations",
                 Error::Kind::Input};
  return out;
}

RigidParams sceneOf(const DropExample& example, const TrainDegreeParams& params) {
  RigidParams scene = params.drop;
  scene.orientation = example.orientation;
  scene.velocity = scene.angularVelocity = Vec3::Zero();
  if (example.source == ExampleSource::Drop) {
    scene.scene = RigidScene::Floor;
    scene.dropHeight = example.height;
    // What plays no part is always the same, so that it changes no key.
    const RigidParams none;
    scene.ballRadius = none.ballRadius;
    scene.ballDensity = none.ballDensity;
    scene.standing = none.standing;
    return scene;
  }
  scene.scene = RigidScene::Ball;
  scene.ballTarget = example.hit.target;
  scene.ballDirection = example.hit.direction;
  scene.ballSpeed = example.speed;
  scene.dropHeight = 1;
  return scene;
}

}  // namespace sherd
