#include "rigid/rigid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <string>

#include "geometry/solid.h"
#include "rigid/contact_solver.h"
#include "rigid/flight.h"
#include "rigid/hertz.h"
#include "rigid/miss.h"
#include "rigid/time_of_impact.h"

namespace sherd {
namespace {

constexpr double kFastestSpin = 1e4;        // rad/s
constexpr double kLargestMassRatio = 1e18;  // beyond, the lighter one changes no digit of the other's motion

Error outside(const char* parameter, const std::string& value, const char* range) {
  return Error{std::string(parameter) + " is " + value, std::string("must be ") + range, parameter,
               Error::Kind::Input};
}

Error outside(const char* parameter, double value, const char* range) {
  return outside(parameter, fmt::format("{:.6g}", value), range);
}

Error outside(const char* parameter, const Vec3& value, const char* range) {
  return outside(parameter, fmt::format("({:.6g}, {:.6g}, {:.6g})", value.x(), value.y(), value.z()), range);
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
  if (!p.orientation.allFinite()) return outside("orientation", p.orientation, "finite");
  if (!p.velocity.allFinite()) return outside("velocity", p.velocity, "finite");
  if (!(p.angularVelocity.norm() <= kFastestSpin))
    return outside("angular_velocity", p.angularVelocity, "at most 10000 rad/s long");
  return {};
}

Result<void> checkBall(const RigidParams& p) {
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  if (!positive(p.ballRadius)) return outside("ball_radius", p.ballRadius, "above 0");
  if (!positive(p.ballDensity)) return outside("ball_density", p.ballDensity, "above 0");
  if (!positive(p.ballSpeed)) return outside("ball_speed", p.ballSpeed, "above 0");
  if (!p.ballDirection.allFinite() || !(p.ballDirection.norm() > 0))
    return outside("ball_direction", p.ballDirection, "a finite vector of some length");
  if (!p.ballTarget.allFinite()) return outside("ball_target", p.ballTarget, "finite");
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
    return failure("the body's surface encloses no volume (" + fmt::format("{:.3g}", solid.volume) + " m³)",
                   "it must be closed and its triangles face outwards");
  body.mass = density * solid.volume;
  body.inertia = solid.inertia(density);
  const double determinant = body.inertia.determinant();  // its inverse is what moves the body
  if (!std::isnormal(determinant))
    return Error{fmt::format("the body's mass, {:.3g} kg, is too {} to compute with", body.mass,
                             body.mass < 1 ? "small" : "large"),
                 "give its density in kg/m³ (2400 is concrete, 2500 glass)", "density", Error::Kind::Input};
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
  // Just outside of the body's sphere, so that no time goes by on empty flight, however large the ball is.
  const double back = body.radius + ball.radius + (aim - motion.position).norm();
  ball.start = aim - (back + 0.01 * body.radius) * direction;
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

/// Is there anything to deform the body with?
Result<void> checkImpulses(const Impact& impact, const RigidBody& body, const std::optional<Ball>& ball) {
  double sum = 0;
  for (const Contact& contact : impact.contacts) sum += contact.impulse.norm();
  if (std::isnormal(sum)) return {};
  if (!ball)
    return Error{
        fmt::format("the floor hits the body ({:.3g} kg) without an impulse ({:.3g} N·s)", body.mass, sum),
        "give its density in kg/m³, and a fall of some height", "density", Error::Kind::Input};
  const bool light = ball->mass < body.mass;
  return Error{fmt::format("the ball ({:.3g} kg) hits the body ({:.3g} kg) without an impulse ({:.3g} N·s)",
                           ball->mass, body.mass, sum),
               light ? "raise ball_density or ball_radius" : "raise the body's density",
               light ? "ball_density" : "density", Error::Kind::Input};
}

/// Contact duration and patch radius: the given ones, or Hertz's.
Result<void> setPatch(Impact& impact, const ContactImpulses& solved, const RigidBody& body, double volume,
                      const RigidParams& params, const Exec& exec) {
  double curvature = std::cbrt(4.0 / 3.0 * M_PI / volume);
  if (params.scene == RigidScene::Ball) curvature += 1 / params.ballRadius;
  const double mass = solved.normalImpulse / ((1 + params.restitution) * solved.closingSpeed);
  const HertzImpact hertz =
      hertzImpact(mass, solved.closingSpeed, 1 / curvature,
                  contactModulus(params.body, params.obstacleYoung, params.obstaclePoisson));
  const bool givenRadius = params.contactRadius > 0;
  const double duration = params.contactDuration > 0 ? params.contactDuration : hertz.duration;
  double radius = givenRadius ? params.contactRadius : std::max(hertz.radius, kSmallestPatch * body.size);
  const char* softer = params.body.youngModulus <= params.obstacleYoung ? "young" : "obstacle_young";
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  if (!positive(duration) || !positive(radius))
    return Error{fmt::format("Hertz's contact would last {:.3g} s and have a radius of {:.3g} m",
                             hertz.duration, hertz.radius),
                 "check young, obstacle_young and density, or give contact_duration and contact_radius",
                 softer, Error::Kind::Input};
  if (radius > body.size) {
    exec.warn(fmt::format(
        "the contact's radius, {:.3g} m, is larger than the body, whose size of {:.3g} m is taken; {}",
        radius, body.size,
        givenRadius
            ? "lower contact_radius"
            : "check young, obstacle_young and density, or give contact_duration and contact_radius"));
    radius = body.size;
  }
  for (Contact& contact : impact.contacts) {
    contact.duration = duration;
    contact.radius = radius;
  }
  return {};
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

/// Everything at the release.
struct Scene {
  RigidBody body;
  double volume = 0;  ///< m³
  RigidMotion start;
  double gravity = 0;
  std::optional<Ball> ball;
};

Result<Scene> setUp(const TetMesh& mesh, const RigidParams& params) {
  SHERD_CHECK(checkParams(params));
  if (params.scene == RigidScene::Ball) SHERD_CHECK(checkBall(params));
  if (mesh.surface == nullptr) return failure("the body has no surface");
  const SolidIntegrals solid = integrateSolid(mesh.surface->positions, mesh.surface->triangles);
  Scene scene;
  scene.volume = solid.volume;
  SHERD_ASSIGN(scene.body, rigidBody(mesh, solid, params.body.density));
  scene.start = release(mesh, scene.body, params);
  if (params.scene == RigidScene::Floor) {
    scene.gravity = params.gravity;
    return scene;
  }
  if (!(params.ballRadius >= kSmallestBall * scene.body.size))
    return Error{
        fmt::format("the ball is too small for the body: its radius is {:.3g} m, the body's size {:.3g} m",
                    params.ballRadius, scene.body.size),
        fmt::format("raise ball_radius to {:.3g} m at least", kSmallestBall * scene.body.size), "ball_radius",
        Error::Kind::Input};
  scene.ball = thrownBall(turnedBox(mesh, scene.body, scene.start), scene.body, scene.start, params);
  const double share = scene.ball->mass / scene.body.mass;
  if (!(share >= 1 / kLargestMassRatio && share <= kLargestMassRatio))
    return Error{fmt::format("the ball's mass, {:.3g} kg, is too {} for the body's, {:.3g} kg",
                             scene.ball->mass, share < 1 ? "small" : "large", scene.body.mass),
                 "give the density of both in kg/m³ (steel is 7800, concrete 2400), or change ball_radius",
                 "ball_density", Error::Kind::Input};
  return scene;
}

Result<Impact> firstImpact(const TetMesh& mesh, const RigidParams& params, const Exec& exec) {
  SHERD_ASSIGN(const Scene scene, setUp(mesh, params));
  const RigidBody& body = scene.body;
  const std::optional<Ball>& ball = scene.ball;
  Flight flight(body, scene.start, scene.gravity, params.timeStep);

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
  SHERD_CHECK(checkImpulses(impact, body, ball));
  SHERD_CHECK(setPatch(impact, solved, body, scene.volume, params, exec));
  return impact;
}

}  // namespace

Result<Impact> dropUntilImpact(const TetMesh& body, const RigidParams& params, const Exec& exec) {
  try {
    return firstImpact(body, params, exec);
  } catch (const std::exception& error) {
    return failure(std::string("moving the body failed: ") + error.what());
  }
}

Error whyNoImpact(const TetMesh& body, const RigidParams& params) {
  try {
    const Result<Scene> scene = setUp(body, params);
    if (!scene.ok()) return scene.error();
    const Flight flight(scene->body, scene->start, scene->gravity, params.timeStep);
    if (!scene->ball) return whyNotOnFloor(flight, params);
    const SurfaceTree tree(body.surface->positions, body.surface->triangles);
    return whyNotByBall(flight, *scene->ball, tree, params);
  } catch (const std::exception& error) {
    return failure(std::string("moving the body failed: ") + error.what());
  }
}

}  // namespace sherd
