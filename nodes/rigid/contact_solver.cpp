#include "rigid/contact_solver.h"

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <deque>
#include <mutex>

namespace sherd {
namespace {

static_assert(sizeof(btScalar) == sizeof(double), "needs bullet-float64");

constexpr double kCompliance = 1e-3;  // in the solver's units, where the body's mass is 1
constexpr int kIterations = 20000;
constexpr double kResidual = 1e-24;  // of squared velocity

btVector3 toBullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 fromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// Bullet compares with absolute speeds, masses and lengths here and there: these units make all of order 1.
struct Units {
  double length, speed, mass;
};

/// A rigid body in Bullet's form: principal axes, about its own centre of mass.
struct BulletBody {
  BulletBody(double mass, const Mat3& inertia, const RigidMotion& motion, const Vec3& origin,
             const Units& units)
      : shape(0.5) {
    const Eigen::SelfAdjointEigenSolver<Mat3> principal(inertia / (units.mass * units.length * units.length));
    Mat3 axes = principal.eigenvectors();
    if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
    btRigidBody::btRigidBodyConstructionInfo info(mass / units.mass, nullptr, &shape,
                                                  toBullet(principal.eigenvalues()));
    const Eigen::Quaterniond q(motion.rotation * Eigen::Quaterniond(axes));
    info.m_startWorldTransform = btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()),
                                             toBullet((motion.position - origin) / units.length));
    body.emplace(info);
    body->setLinearVelocity(toBullet(motion.velocity / units.speed));
    body->setAngularVelocity(toBullet(motion.angularVelocity * units.length / units.speed));
  }
  btSphereShape shape;  // never used: the touches are known
  std::optional<btRigidBody> body;
};

RigidMotion ballMotion(const Ball& ball, double time) {
  RigidMotion motion;
  motion.position = ball.centreAt(time);
  motion.velocity = ball.velocity;
  return motion;
}

btManifoldPoint manifoldPoint(const Vec3& place, const Vec3& normal, const ContactLaw& law) {
  btManifoldPoint point(btVector3(0, 0, 0), btVector3(0, 0, 0), toBullet(normal), 0);
  point.m_positionWorldOnA = point.m_positionWorldOnB = toBullet(place);
  point.m_combinedFriction = law.friction;
  point.m_combinedRestitution = law.restitution;
  return point;
}

btContactSolverInfo solverInfo(std::size_t contacts) {
  btContactSolverInfo info;
  info.m_timeStep = 1;
  info.m_numIterations = kIterations;
  info.m_leastSquaresResidualThreshold = kResidual;
  info.m_restitutionVelocityThreshold = 0;
  info.m_globalCfm = contacts > 1 ? kCompliance : 0;
  info.m_frictionCFM = info.m_globalCfm;
  // Warm starting is what makes Bullet store the impulses; they start at 0 here.
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS;
  return info;
}

Vec3 impulseOf(const btManifoldPoint& point) {
  return fromBullet(point.m_normalWorldOnB * point.m_appliedImpulse +
                    point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                    point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2);
}

/// Velocity of the body's point against that of the obstacle's, m/s.
Vec3 slip(const Flight& flight, const std::optional<Ball>& ball, const Touch& touch) {
  const Vec3 own = flight.velocityAt(flight.toWorld(touch.rest));
  return touch.onBall ? Vec3(own - ball->velocity) : own;
}

std::vector<Vec3> solveInUnits(const Flight& flight, const std::optional<Ball>& ball,
                               std::span<const Touch> touches, const ContactLaw& law, const Units& units) {
  static std::mutex bullet;  // Bullet counts its objects in plain globals
  const std::lock_guard<std::mutex> lock(bullet);
  const RigidBody& body = flight.body();
  const Vec3 origin = flight.motion().position;
  BulletBody moving(body.mass, body.inertia, flight.motion(), origin, units);
  BulletBody floor(0, Mat3::Zero(), {}, Vec3::Zero(), units);
  std::optional<BulletBody> thrown;
  if (ball) {
    const double inertia = 0.4 * ball->mass * ball->radius * ball->radius;
    thrown.emplace(ball->mass, inertia * Mat3::Identity(), ballMotion(*ball, flight.time()), origin, units);
  }
  std::deque<btPersistentManifold> manifolds;  // one each: a manifold holds four points at most
  std::vector<btPersistentManifold*> pointers;
  for (const Touch& touch : touches) {
    btRigidBody& other = touch.onBall ? *thrown->body : *floor.body;
    manifolds.emplace_back(&*moving.body, &other, 0, 1.0, 1.0);
    manifolds.back().addManifoldPoint(
        manifoldPoint((flight.toWorld(touch.rest) - origin) / units.length, touch.normal, law));
    pointers.push_back(&manifolds.back());
  }
  std::vector<btCollisionObject*> bodies{&*moving.body, &*floor.body};
  if (thrown) bodies.push_back(&*thrown->body);
  btSequentialImpulseConstraintSolver solver;
  solver.solveGroup(bodies.data(), static_cast<int>(bodies.size()), pointers.data(),
                    static_cast<int>(pointers.size()), nullptr, 0, solverInfo(touches.size()), nullptr,
                    nullptr);
  std::vector<Vec3> impulses;
  for (const btPersistentManifold* manifold : pointers)
    impulses.push_back(impulseOf(manifold->getContactPoint(0)) * units.mass * units.speed);
  return impulses;
}

}  // namespace

ContactImpulses solveContacts(const Flight& flight, const std::optional<Ball>& ball,
                              std::span<const Touch> touches, const ContactLaw& law) {
  ContactImpulses result;
  double fastest = 0;
  for (const Touch& touch : touches) {
    const Vec3 relative = slip(flight, ball, touch);
    fastest = std::max(fastest, relative.norm());
    result.closingSpeed = std::max(result.closingSpeed, -relative.dot(touch.normal));
  }
  if (!(result.closingSpeed > 0)) {
    result.onBody.assign(touches.size(), Vec3::Zero());
    return result;
  }
  const Units units{flight.body().size, fastest, flight.body().mass};
  result.onBody = solveInUnits(flight, ball, touches, law, units);
  for (std::size_t i = 0; i < touches.size(); ++i)
    if (-slip(flight, ball, touches[i]).dot(touches[i].normal) > 1e-9 * result.closingSpeed)
      result.normalImpulse += result.onBody[i].dot(touches[i].normal);
  return result;
}

}  // namespace sherd
