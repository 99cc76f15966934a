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
  EXPECT_NE(errorOf(params).find("ball_direction is (0, 0, 0); must be"), std::string::npos);
  params = throwAlong(Vec3::UnitX(), Vec3(0.5, NAN, 0.5));
  EXPECT_EQ(errorOf(params), "ball_target is (0.5, nan, 0.5); must be finite");
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

TEST(BallAtBody, SaysWhyItMissed) {
  const TetMesh body = families::box(2, 2, 2, Vec3(0.4, 0.4, 0.4));
  const auto why = [&](const RigidParams& params) {
    EXPECT_FALSE(hitBy(body, params).hit);
    return whyNoImpact(body, params);
  };
  RigidParams params = throwAlong(Vec3::UnitX(), Vec3(0.5, 1.5, 0.5));  // 0.2 m above, radius 0.05 m
  EXPECT_EQ(why(params).port, "ball_target");
  EXPECT_EQ(why(params).text(), "the ball passes the body by 0.15 m; aim ball_target within [0, 1]");
  params = throwAlong(Vec3(1, -1, 0), Vec3(1, 1, 0.5) + Vec3(0.25, 0.25, 0));  // over an edge, 0.1 √2 m away
  EXPECT_NE(why(params).what.find("by 0.0914 m"), std::string::npos) << why(params).what;
  params = throwAlong(Vec3::UnitX(), Vec3::Constant(0.5));
  params.velocity = Vec3(0, 40, 0);
  EXPECT_NE(why(params).remedy.find("own velocity"), std::string::npos) << why(params).text();
  EXPECT_EQ(why(params).port, "ball_target");
  params.velocity = Vec3(10, 0, 0);
  EXPECT_EQ(why(params).port, "ball_speed");
  params.velocity = Vec3(9.9, 0, 0);
  EXPECT_TRUE(hitBy(body, params).hit);
  params.maxTime = 1e-3;
  EXPECT_EQ(why(params).port, "max_time");
  const TetMesh hollow = families::uShape(1, 2, 5, 2, 0.1);
  params = throwAlong(Vec3::UnitZ(), Vec3(0.5, 0.7, 0.5));  // between the arms, whose gap is 0.2 m wide
  EXPECT_NE(whyNoImpact(hollow, params).text().find("by 0.05 m"), std::string::npos)
      << whyNoImpact(hollow, params).text();
  EXPECT_NE(whyNoImpact(hollow, params).remedy.find("raise ball_radius"), std::string::npos);
}

TEST(BallAtBody, BallsTooSmallOrTooLightAreNamed) {
  const auto portOf = [](const RigidParams& params) {
    const Result<Impact> impact = dropUntilImpact(families::box(2, 2, 2, Vec3(0.4, 0.4, 0.4)), params, {});
    if (!impact.ok()) return impact.error().port;
    return std::string(totalImpulse(*impact).norm() > 0 ? "ok" : "no impulse");
  };
  const RigidParams usual = throwAlong(Vec3::UnitX(), Vec3::Constant(0.4));
  RigidParams params = usual;
  params.ballRadius = 1e-10;
  EXPECT_EQ(portOf(params), "ball_radius");
  params.ballRadius = 1e-6;
  EXPECT_EQ(portOf(params), "ok");
  params = usual;
  params.ballDensity = 5e-324;
  EXPECT_EQ(portOf(params), "ball_density");
  params.ballDensity = 1e-300;
  EXPECT_EQ(portOf(params), "ball_density");
  params.ballDensity = 1;
  EXPECT_EQ(portOf(params), "ok");
  params = usual;
  params.body.density = 1e-300;
  EXPECT_EQ(portOf(params), "density");
}

TEST(BallAtBody, ALargeBallIsNotLate) {
  const TetMesh body = families::box(2, 2, 2, Vec3(0.4, 0.4, 0.4));
  for (const double radius : {0.01, 1.0, 1000.0}) {
    RigidParams params = throwAlong(Vec3::UnitX(), Vec3::Constant(0.5));
    params.ballRadius = radius;
    const Impact impact = hitBy(body, params);
    ASSERT_TRUE(impact.hit) << radius;
    EXPECT_LT(impact.time, 0.2 / params.ballSpeed) << radius;  // half the body's size
  }
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
