#include "rigid/rigid.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

#include "geometry/solid.h"
#include "rigid/contact_solver.h"
#include "rigid/flight.h"
#include "rigid/hertz.h"
#include "rigid/time_of_impact.h"

namespace sherd {
namespace {

constexpr double kFastestSpin = 1e4;  // rad/s

Error outside(const char* parameter, double value, const char* range) {
  return Error{std::string(parameter) + " is " + std::to_string(value), std::string("must be ") + range,
               parameter, Error::Kind::Input};
}

/// Written so that NaN fails every test.
Result<void> checkParams(const RigidParams& p) {
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  const auto notNegative = [](double v) { return v >= 0 && std::isfinite(v); };
  const auto poisson = [](double v) { return v > -1 && v < 0.5; };
  if (!positive(p.body.density)) return outside("density", p.body.density, "above 0");
  if (!positive(p.body.youngModulus)) return outside("young", p.body.youngModulus, "above 0");
  if (!poisson(p.body.poissonRatio)) return outside("poisson", p.body.poissonRatio, "between -1 and 0.5");
  if (!positive(p.obstacleYoung)) return outside("obstacle_young", p.obstacleYoung, "above 0");
  if (!poisson(p.obstaclePoisson))
    return outside("obstacle_poisson", p.obstaclePoisson, "between -1 and 0.5");
  if (!notNegative(p.gravity)) return outside("gravity", p.gravity, "0 or above");
  if (!notNegative(p.dropHeight)) return outside("drop_height", p.dropHeight, "0 or above");
  if (!(p.restitution >= 0 && p.restitution <= 1))
    return outside("restitution", p.restitution, "from 0 to 1");
  if (!notNegative(p.friction)) return outside("friction", p.friction, "0 or above");
  if (!notNegative(p.contactDuration)) return outside("contact_duration", p.contactDuration, "0 or above");
  if (!notNegative(p.contactRadius)) return outside("contact_radius", p.contactRadius, "0 or above");
  if (!positive(p.timeStep)) return outside("time_step", p.timeStep, "above 0");
  if (!positive(p.maxTime)) return outside("max_time", p.maxTime, "above 0");
  if (!p.orientation.allFinite()) return outside("orientation", NAN, "finite");
  if (!p.velocity.allFinite()) return outside("velocity", NAN, "finite");
  if (!(p.angularVelocity.norm() <= kFastestSpin))
    return outside("angular_velocity", p.angularVelocity.norm(), "at most 10000 rad/s long");
  return {};
}

Result<void> checkBall(const RigidParams& p) {
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  if (!positive(p.ballRadius)) return outside("ball_radius", p.ballRadius, "above 0");
  if (!positive(p.ballDensity)) return outside("ball_density", p.ballDensity, "above 0");
  if (!positive(p.ballSpeed)) return outside("ball_speed", p.ballSpeed, "above 0");
  if (!p.ballDirection.allFinite() || !(p.ballDirection.norm() > 0))
    return outside("ball_direction", p.ballDirection.norm(), "a vector of some length");
  if (!p.ballTarget.allFinite()) return outside("ball_target", NAN, "finite");
  if (p.standing && !(p.velocity.isZero(0) && p.angularVelocity.isZero(0)))
    return Error{"the body is to stand on the floor, but moves",
                 "set velocity and angular_velocity to 0, or standing to false", "standing",
                 Error::Kind::Input};
  return {};
}

Result<RigidBody> rigidBody(const TetMesh& mesh, const SolidIntegrals& solid, double density) {
  if (mesh.surface->triangles.empty()) return failure("the body's surface has no triangles");
  RigidBody body;
  const std::vector<Vec3>& vertices = mesh.surface->positions;
  const double tiny = 1e-12 * std::pow(boxOf(vertices).diagonal(), 3);
  if (!(solid.volume > tiny) || !std::isfinite(solid.volume))
    return failure("the body's surface encloses no volume (" + std::to_string(solid.volume) + " m³)",
                   "it must be closed and its triangles face outwards");
  body.mass = density * solid.volume;
  body.inertia = solid.inertia(density);
  body.centreOfMass = solid.centroid;
  for (const Vec3& v : vertices)
    if (!v.allFinite()) return failure("the body's surface has vertices that are not finite numbers");
  body.radius = 0;
  for (const Vec3& v : vertices) body.radius = std::max(body.radius, (v - body.centreOfMass).norm());
  body.size = 2 * body.radius;
  body.radius *= 1 + 1e-12;  // it bounds what rounding makes of the vertices, too
  return body;
}

Eigen::Quaterniond eulerRotation(const Vec3& degrees) {
  const Vec3 angle = degrees * (M_PI / 180);
  return (Eigen::AngleAxisd(angle.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angle.y(), Vec3::UnitY()) *
          Eigen::AngleAxisd(angle.x(), Vec3::UnitX()))
      .normalized();
}

Box turnedBox(const TetMesh& mesh, const RigidBody& body, const RigidMotion& motion) {
  Box box;
  for (const Vec3& v : mesh.surface->positions)
    box.add(motion.rotation * (v - body.centreOfMass) + motion.position);
  return box;
}

/// In the ball scene a floating body stays where its mesh is; otherwise its lowest point is put at a height.
RigidMotion release(const TetMesh& mesh, const RigidBody& body, const RigidParams& params) {
  RigidMotion motion;
  motion.position = body.centreOfMass;
  motion.rotation = eulerRotation(params.orientation);
  motion.velocity = params.velocity;
  motion.angularVelocity = params.angularVelocity;
  const bool floor = params.scene == RigidScene::Floor;
  if (floor || params.standing) {
    // Lowest point relative to the centre of mass: a mesh far from the origin keeps its digits.
    motion.position.y() = 0;
    const double low = turnedBox(mesh, body, motion).low.y();
    motion.position.y() = (floor ? params.dropHeight : 0.0) - low;
  }
  return motion;
}

Ball thrownBall(const Box& target, const RigidBody& body, const RigidMotion& motion,
                const RigidParams& params) {
  Ball ball;
  ball.radius = params.ballRadius;
  ball.mass = params.ballDensity * 4.0 / 3.0 * M_PI * std::pow(params.ballRadius, 3);
  const Vec3 direction = params.ballDirection.normalized();
  ball.velocity = params.ballSpeed * direction;
  const Vec3 aim = target.low + (target.high - target.low).cwiseProduct(params.ballTarget);
  // Just outside of the body's sphere, so that no time goes by on empty flight.
  const double back = body.radius + ball.radius + (aim - motion.position).norm();
  ball.start = aim - 1.01 * back * direction;
  return ball;
}

RigidMotion afterImpulses(const Flight& flight, const std::vector<Touch>& touches,
                          const std::vector<Vec3>& impulses) {
  RigidMotion after = flight.motion();
  Vec3 angular = Vec3::Zero();
  for (std::size_t i = 0; i < touches.size(); ++i) {
    after.velocity += impulses[i] / flight.body().mass;
    angular += (flight.toWorld(touches[i].rest) - after.position).cross(impulses[i]);
  }
  after.angularVelocity += worldInverseInertia(flight.body(), after.rotation) * angular;
  return after;
}

/// Contact duration and patch radius: the given ones, or Hertz's.
void setPatch(Impact& impact, const ContactImpulses& solved, const RigidBody& body, double volume,
              const RigidParams& params) {
  double curvature = std::cbrt(4.0 / 3.0 * M_PI / volume);
  if (params.scene == RigidScene::Ball) curvature += 1 / params.ballRadius;
  const double mass = solved.normalImpulse / ((1 + params.restitution) * solved.closingSpeed);
  const HertzImpact hertz =
      hertzImpact(mass, solved.closingSpeed, 1 / curvature,
                  contactModulus(params.body, params.obstacleYoung, params.obstaclePoisson));
  for (Contact& contact : impact.contacts) {
    contact.duration = params.contactDuration > 0 ? params.contactDuration : hertz.duration;
    contact.radius =
        params.contactRadius > 0 ? params.contactRadius : std::max(hertz.radius, kSmallestPatch * body.size);
  }
}

/// Flies on to the impact; true where there is one, with the places that touch.
bool fly(Flight& flight, const std::optional<Ball>& ball, const TriMesh& surface, const RigidParams& params,
         const Exec& exec, std::vector<Touch>& touches) {
  const std::vector<Vec3>& vertices = surface.positions;
  if (!ball) {
    if (!flyToFloor(flight, vertices, params.maxTime, exec)) return false;
    touches = touchesOnFloor(flight, vertices);
    return true;
  }
  const SurfaceTree tree(vertices, surface.triangles);
  if (!flyToBall(flight, *ball, tree, params.maxTime, exec)) return false;
  touches = touchesOnBall(flight, *ball, vertices, surface.triangles);
  if (params.standing)
    for (const Touch& foot : touchesOnFloor(flight, vertices)) touches.push_back(foot);
  return true;
}

Result<Impact> firstImpact(const TetMesh& mesh, const RigidParams& params, const Exec& exec) {
  const SolidIntegrals solid = integrateSolid(mesh.surface->positions, mesh.surface->triangles);
  SHERD_ASSIGN(const RigidBody body, rigidBody(mesh, solid, params.body.density));
  const RigidMotion start = release(mesh, body, params);
  const bool thrown = params.scene == RigidScene::Ball;
  std::optional<Ball> ball;
  if (thrown) ball = thrownBall(turnedBox(mesh, body, start), body, start, params);
  Flight flight(body, start, thrown ? 0.0 : params.gravity, params.timeStep);

  Impact impact;
  std::vector<Touch> touches;
  impact.hit = fly(flight, ball, *mesh.surface, params, exec, touches);
  if (exec.cancelled()) return cancelledError();
  impact.centreOfMass = body.centreOfMass;
  impact.time = flight.time();
  impact.before = impact.after = flight.motion();
  if (!impact.hit) return impact;
  const ContactImpulses solved = solveContacts(flight, ball, touches, {params.restitution, params.friction});
  impact.after = afterImpulses(flight, touches, solved.onBody);
  const Eigen::Quaterniond toRest = flight.motion().rotation.conjugate();
  for (std::size_t i = 0; i < touches.size(); ++i)
    if (!solved.onBody[i].isZero(0))
      impact.contacts.push_back({touches[i].rest, toRest * solved.onBody[i], 0, 0});
  setPatch(impact, solved, body, solid.volume, params);
  return impact;
}

}  // namespace

Result<Impact> dropUntilImpact(const TetMesh& body, const RigidParams& params, const Exec& exec) {
  SHERD_CHECK(checkParams(params));
  if (params.scene == RigidScene::Ball) SHERD_CHECK(checkBall(params));
  if (body.surface == nullptr) return failure("the body has no surface");
  try {
    return firstImpact(body, params, exec);
  } catch (const std::exception& error) {
    return failure(std::string("moving the body failed: ") + error.what());
  }
}

}  // namespace sherd
