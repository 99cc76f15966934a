#include <gtest/gtest.h>

#include <cmath>

#include "bodies.h"
#include "rigid/rigid.h"

using namespace sherd;
using namespace sherd::rigid_test;

namespace {

RigidParams throwAlong(const Vec3& direction, const Vec3& target) {
  RigidParams params;
  params.scene = RigidScene::Ball;
  params.ballDirection = direction;
  params.ballTarget = target;
  return params;
}

Impact hitBy(const TetMesh& body, const RigidParams& params) {
  const Result<Impact> impact = dropUntilImpact(body, params, {});
  EXPECT_TRUE(impact.ok()) << (impact.ok() ? "" : impact.error().text());
  return impact.ok() ? *impact : Impact{};
}

double ballMass(const RigidParams& p) { return p.ballDensity * 4 / 3 * M_PI * std::pow(p.ballRadius, 3); }

TEST(BallAtBody, BadBallsAreNamed) {
  const auto errorOf = [](const RigidParams& params) {
    const Result<Impact> impact = dropUntilImpact(sphere(1, 1), params, {});
    return impact.ok() ? std::string() : impact.error().text();
  };
  RigidParams params = throwAlong(Vec3::Zero(), Vec3::Constant(0.5));
  EXPECT_NE(errorOf(params).find("ball_direction"), std::string::npos);
  params = throwAlong(Vec3::UnitX(), Vec3::Constant(0.5));
  params.ballRadius = 0;
  EXPECT_NE(errorOf(params).find("ball_radius"), std::string::npos);
  params = throwAlong(Vec3::UnitX(), Vec3::Constant(0.5));
  params.standing = true;
  params.velocity = Vec3(1, 0, 0);
  EXPECT_NE(errorOf(params).find("stand"), std::string::npos);
}

TEST(BallAtBody, AimedPastItMisses) {
  EXPECT_FALSE(hitBy(sphere(0.3, 3), throwAlong(Vec3::UnitX(), Vec3(0.5, 1.2, 0.5))).hit);
  EXPECT_FALSE(hitBy(sphere(0.3, 3), throwAlong(Vec3::UnitX(), Vec3(0.5, 1.084, 0.5))).hit);
  EXPECT_TRUE(hitBy(sphere(0.3, 3), throwAlong(Vec3::UnitX(), Vec3(0.5, 1.082, 0.5))).hit);
}

TEST(BallAtBody, CentralHitIsTheTextbooks) {
  const TetMesh body = families::box(2, 2, 2, Vec3(0.4, 0.4, 0.4));
  RigidParams params = throwAlong(Vec3::UnitX(), Vec3::Constant(0.5));
  params.restitution = 0.5;
  const Impact impact = hitBy(body, params);
  ASSERT_EQ(impact.contacts.size(), 1U);
  EXPECT_LT((impact.contacts[0].point - Vec3(0, 0.2, 0.2)).norm(), 1e-9);
  const double m = massOf(body, params.body.density), b = ballMass(params);
  const double expected = 1.5 * params.ballSpeed * m * b / (m + b);
  EXPECT_LT((impact.contacts[0].impulse - Vec3(expected, 0, 0)).norm(), 1e-9 * expected);
  // Total momentum: the ball loses what the body gets.
  const double ballAfter = params.ballSpeed - impact.contacts[0].impulse.x() / b;
  EXPECT_NEAR(m * impact.after.velocity.x() + b * ballAfter, b * params.ballSpeed,
              1e-9 * b * params.ballSpeed);
  EXPECT_NEAR(impact.after.velocity.x() - ballAfter, 0.5 * params.ballSpeed, 1e-8);
}

/// Momentum and angular momentum about the body's centre pass over whole; energy is not gained.
TEST(BallAtBody, ObliqueHitConserves) {
  const TetMesh body = families::box(2, 2, 2, Vec3(0.4, 0.2, 0.6));
  RigidParams params = throwAlong(Vec3(1, 0.2, -0.3), Vec3(0.5, 0.7, 0.7));
  params.orientation = Vec3(15, 70, -20);
  params.velocity = Vec3(0.3, 0, 0.2);
  params.angularVelocity = Vec3(0, 3, 1);
  const Impact impact = hitBy(body, params);
  ASSERT_TRUE(impact.hit);
  const double m = massOf(body, params.body.density);
  const Mat3 inertia =
      integrateSolid(body.surface->positions, body.surface->triangles).inertia(params.body.density);
  const Vec3 change = impact.before.rotation * totalImpulse(impact);
  EXPECT_LT((m * (impact.after.velocity - impact.before.velocity) - change).norm(), 1e-9 * change.norm());
  Vec3 moment = Vec3::Zero();
  for (const Contact& c : impact.contacts) moment += (c.point - impact.centreOfMass).cross(c.impulse);
  const Vec3 spin =
      impact.before.rotation.conjugate() * (impact.after.angularVelocity - impact.before.angularVelocity);
  EXPECT_LT((inertia * spin - moment).norm(), 1e-9 * moment.norm());
  const auto energy = [&](const RigidMotion& motion, double ballSpeed) {
    const Vec3 w = motion.rotation.conjugate() * motion.angularVelocity;
    return 0.5 * (m * motion.velocity.squaredNorm() + w.dot(inertia * w) +
                  ballMass(params) * ballSpeed * ballSpeed);
  };
  const double spinless =
      (params.ballSpeed * params.ballDirection.normalized() - change / ballMass(params)).norm();
  EXPECT_LT(energy(impact.after, spinless), energy(impact.before, params.ballSpeed));
}

/// Into the gap of a U from above: the ball gets to the bottom of the gap, far inside the hull.
TEST(BallAtBody, FliesIntoTheGapOfAU) {
  const TetMesh body = families::uShape(1, 2, 5, 2, 0.1);  // gap 0.2 wide, its bottom at y = 0.1
  RigidParams params = throwAlong(-Vec3::UnitY(), Vec3::Constant(0.5));
  params.ballRadius = 0.08;
  const Impact impact = hitBy(body, params);
  ASSERT_EQ(impact.contacts.size(), 1U);
  EXPECT_LT((impact.contacts[0].point - Vec3(0.2, 0.1, 0.1)).norm(), 1e-8);
  // Through the gap from the side, past everything, there is nothing to hit.
  params = throwAlong(Vec3::UnitZ(), Vec3(0.5, 0.7, 0.5));
  params.ballRadius = 0.08;
  EXPECT_FALSE(hitBy(body, params).hit);
  // A ball as wide as the gap touches both arms' inner corners from above.
  params = throwAlong(-Vec3::UnitY(), Vec3::Constant(0.5));
  params.ballRadius = 0.15;
  const Impact wedged = hitBy(body, params);
  ASSERT_EQ(wedged.contacts.size(), 2U);
  EXPECT_NEAR(wedged.contacts[0].point.y(), 0.5, 1e-9);
  EXPECT_NEAR(wedged.contacts[0].impulse.norm(), wedged.contacts[1].impulse.norm(),
              1e-3 * wedged.contacts[0].impulse.norm());
}

TEST(BallAtBody, TheFloorHoldsAStandingBody) {
  const TetMesh wall = families::box(4, 4, 1, Vec3(1, 1, 0.1));
  RigidParams params = throwAlong(Vec3(0, -1, -1), Vec3(0.5, 0.9, 0.5));
  params.standing = true;
  const Impact impact = hitBy(wall, params);
  ASSERT_TRUE(impact.hit);
  EXPECT_GT(impact.contacts.size(), 1U);
  bool atFloor = false;
  for (const Contact& c : impact.contacts) atFloor = atFloor || c.point.y() == 0;
  EXPECT_TRUE(atFloor);
  params.standing = false;
  EXPECT_EQ(hitBy(wall, params).contacts.size(), 1U);
}

TEST(BallAtBody, TimeStepDoesNotMatter) {
  const TetMesh body = families::uShape(1, 2, 4, 1, 0.1);
  RigidParams params = throwAlong(Vec3(1, -0.3, 0.1), Vec3(0.4, 0.6, 0.5));
  params.ballRadius = 0.03;
  params.angularVelocity = Vec3(2, 5, -30);
  const Impact a = hitBy(body, params);
  params.timeStep = 1e-4;
  const Impact b = hitBy(body, params);
  ASSERT_TRUE(a.hit && b.hit);
  EXPECT_LT((totalImpulse(a) - totalImpulse(b)).norm(), 1e-6 * totalImpulse(a).norm());
}

}  // namespace
