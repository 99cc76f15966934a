#include <gtest/gtest.h>

#include <cmath>

#include "bodies.h"
#include "rigid/flight.h"
#include "rigid/hertz.h"
#include "rigid/rigid.h"

using namespace sherd;
using namespace sherd::rigid_test;

namespace {

Impact drop(const TetMesh& body, const RigidParams& params) {
  const Result<Impact> impact = dropUntilImpact(body, params, {});
  EXPECT_TRUE(impact.ok()) << (impact.ok() ? "" : impact.error().text());
  return impact.ok() ? *impact : Impact{};
}

std::string errorOf(const TetMesh& body, const RigidParams& params) {
  const Result<Impact> impact = dropUntilImpact(body, params, {});
  return impact.ok() ? "no error" : impact.error().text();
}

TEST(DropOnFloor, BodyWithoutVolumeIsRefused) {
  EXPECT_NE(errorOf(bodyOf({}, {}), {}).find("no triangles"), std::string::npos);
  TetMesh insideOut = sphere(1, 1);
  auto surface = std::make_shared<TriMesh>(*insideOut.surface);
  for (Triangle& t : surface->triangles) std::swap(t[0], t[1]);
  insideOut.surface = surface;
  EXPECT_NE(errorOf(insideOut, {}).find("encloses no volume"), std::string::npos);
}

TEST(DropOnFloor, ParametersOutOfRangeAreNamed) {
  const TetMesh body = sphere(1, 1);
  RigidParams params;
  params.gravity = -1;
  EXPECT_NE(errorOf(body, params).find("gravity"), std::string::npos);
  params = {};
  params.dropHeight = NAN;
  EXPECT_NE(errorOf(body, params).find("drop_height"), std::string::npos);
  params = {};
  params.restitution = 1.5;
  EXPECT_NE(errorOf(body, params).find("restitution"), std::string::npos);
  params = {};
  params.angularVelocity = Vec3(0, 0, 2e4);
  EXPECT_NE(errorOf(body, params).find("angular_velocity"), std::string::npos);
}

TEST(DropOnFloor, VectorsOutOfRangeArePrinted) {
  const TetMesh body = sphere(1, 1);
  RigidParams params;
  params.orientation = Vec3(1, NAN, 2.5);
  EXPECT_EQ(errorOf(body, params), "orientation is (1, nan, 2.5); must be finite");
  params = {};
  params.velocity = Vec3(INFINITY, 0, 0);
  EXPECT_EQ(errorOf(body, params), "velocity is (inf, 0, 0); must be finite");
  params = {};
  params.angularVelocity = Vec3(0, 0, 2e4);
  EXPECT_NE(errorOf(body, params).find("(0, 0, 20000)"), std::string::npos);
  params = {};
  params.body.density = -1e-9;
  EXPECT_EQ(errorOf(body, params), "density is -1e-09; must be above 0");
}

TEST(DropOnFloor, WeightlessAndEndlesslySoftAreNamed) {
  const auto portOf = [](const RigidParams& params) {
    const Result<Impact> impact = dropUntilImpact(sphere(0.1, 2), params, {});
    return impact.ok() ? std::string("ok") : impact.error().port;
  };
  EXPECT_EQ(portOf({}), "ok");
  RigidParams params;
  params.body.density = 1e-300;
  EXPECT_EQ(portOf(params), "density");
  params.body.density = 1e300;
  EXPECT_EQ(portOf(params), "density");
  params = {};
  params.body.youngModulus = 5e-324;
  EXPECT_EQ(portOf(params), "young");
  params.contactDuration = 1e-3;
  params.contactRadius = 0.01;
  EXPECT_EQ(portOf(params), "ok");  // nothing is Hertz's
  params = {};
  params.obstacleYoung = 5e-324;
  EXPECT_EQ(portOf(params), "obstacle_young");
}

TEST(DropOnFloor, APatchIsNoLargerThanTheBody) {
  std::vector<std::string> warnings;
  Exec exec;
  exec.onMessage = [&](LogLevel, const std::string& line) { warnings.push_back(line); };
  RigidParams params;
  const auto radius = [&] {
    const Result<Impact> impact = dropUntilImpact(sphere(0.1, 2), params, exec);
    return impact.ok() ? impact->contacts.at(0).radius : -1;
  };
  EXPECT_LT(radius(), 0.1);
  EXPECT_TRUE(warnings.empty());
  params.contactRadius = 3;
  EXPECT_NEAR(radius(), 0.2, 1e-12);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("lower contact_radius"), std::string::npos) << warnings[0];
  params.contactRadius = 0;
  params.body.youngModulus = 1e-300;
  EXPECT_NEAR(radius(), 0.2, 1e-12);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[1].find("check young"), std::string::npos) << warnings[1];
}

/// The reason is right: what it tells to change, changed so, gives an impact.
TEST(DropOnFloor, SaysWhyNothingWasHit) {
  const TetMesh body = sphere(0.1, 2);
  const auto why = [&](const RigidParams& params) {
    EXPECT_FALSE(drop(body, params).hit);
    return whyNoImpact(body, params);
  };
  RigidParams params;
  params.dropHeight = 1000;
  EXPECT_EQ(why(params).port, "max_time");
  EXPECT_EQ(why(params).text(),
            "the body is still in the air after 10 s; it needs 14.3 s to fall; raise max_time above that");
  params.maxTime = 14.3;
  EXPECT_TRUE(drop(body, params).hit);
  params.maxTime = 10;
  params.velocity = Vec3(0, -200, 0);
  EXPECT_TRUE(drop(body, params).hit);
  params.velocity = Vec3(0, -90, 0);
  params.gravity = 0;
  EXPECT_NE(why(params).text().find("11.2 s"), std::string::npos) << why(params).text();
  params = {};
  params.velocity = Vec3(0, 60, 0);  // 2 · 60 / 9.81 s and a little
  EXPECT_NE(why(params).text().find("12.3 s"), std::string::npos) << why(params).text();
  params.angularVelocity = Vec3(1, 0, 0);
  EXPECT_NE(why(params).text().find("up to 12.3 s"), std::string::npos) << why(params).text();
  params = {};
  params.gravity = 0;
  EXPECT_EQ(why(params).port, "gravity");
  params.velocity = Vec3(0, 1, 0);
  EXPECT_EQ(why(params).port, "gravity");
  params = {};
  params.gravity = 1e-9;
  EXPECT_EQ(why(params).port, "drop_height");
  params.velocity = Vec3(0, 3, 0);
  EXPECT_EQ(why(params).port, "velocity");
  params = {};
  params.dropHeight = 0;
  EXPECT_NE(why(params).text().find("lies on the floor"), std::string::npos) << why(params).text();
  params.gravity = -1;
  EXPECT_EQ(whyNoImpact(body, params).port, "gravity");
}

TEST(DropOnFloor, WithoutGravityNothingIsHit) {
  RigidParams params;
  params.gravity = 0;
  params.velocity = Vec3(3, 0, 0);
  const Impact impact = drop(sphere(1, 1), params);
  EXPECT_FALSE(impact.hit);
  EXPECT_TRUE(impact.contacts.empty());
  params.angularVelocity = Vec3(0, 0, 4);
  EXPECT_FALSE(drop(sphere(1, 1), params).hit);
}

TEST(DropOnFloor, LyingOnTheFloorIsNoImpact) {
  RigidParams params;
  params.dropHeight = 0;
  EXPECT_FALSE(drop(families::box(1, 1, 1, Vec3(1, 2, 3)), params).hit);
  params.velocity = Vec3(0, -2, 0);
  const Impact pushed = drop(families::box(1, 1, 1, Vec3(1, 2, 3)), params);
  EXPECT_TRUE(pushed.hit);
  EXPECT_EQ(pushed.time, 0);
}

TEST(DropOnFloor, TooLateIsNoImpact) {
  RigidParams params;
  params.maxTime = 0.1;
  EXPECT_FALSE(drop(sphere(0.1, 1), params).hit);
}

TEST(DropOnFloor, FreeFallSpeedAndTimeAreExact) {
  for (const double height : {1e-3, 1.0, 400.0}) {
    RigidParams params;
    params.dropHeight = height;
    const Impact impact = drop(sphere(0.1, 2), params);
    ASSERT_TRUE(impact.hit);
    const double speed = std::sqrt(2 * params.gravity * height);
    EXPECT_NEAR(-impact.before.velocity.y(), speed, 1e-9 * speed);
    EXPECT_NEAR(impact.time, speed / params.gravity, 1e-9 * speed);
  }
}

TEST(DropOnFloor, ThrownUpFromTheFloorItComesBack) {
  RigidParams params;
  params.dropHeight = 0;
  params.velocity = Vec3(0, 5, 0);
  const Impact impact = drop(sphere(0.1, 2), params);
  ASSERT_TRUE(impact.hit);
  EXPECT_NEAR(impact.before.velocity.y(), -5, 1e-8);
}

TEST(DropOnFloor, CentralHitGivesTheTextbookImpulse) {
  const TetMesh body = sphere(0.1, 2);
  for (const double e : {0.0, 0.3, 1.0}) {
    RigidParams params;
    params.restitution = e;
    const Impact impact = drop(body, params);
    ASSERT_EQ(impact.contacts.size(), 1U);
    const double expected = (1 + e) * massOf(body, params.body.density) * std::sqrt(2 * params.gravity);
    EXPECT_NEAR(impact.contacts[0].impulse.y(), expected, 1e-9 * expected);
    EXPECT_LT((impact.contacts[0].point - Vec3(0, -0.1, 0)).norm(), 1e-15);
    EXPECT_NEAR(impact.after.velocity.y(), -e * impact.before.velocity.y(), 1e-8);
  }
}

/// A frictionless box on its edge or corner: J = (1 + e) v / (1/m + n·(I⁻¹(r×n))×r).
TEST(DropOnFloor, EccentricHitGivesTheTextbookImpulse) {
  const TetMesh body = families::box(1, 1, 1, Vec3(0.2, 0.1, 0.3));
  RigidParams params;
  params.orientation = Vec3(20, 10, 30);
  params.friction = 0;
  params.restitution = 0.4;
  const Impact impact = drop(body, params);
  ASSERT_EQ(impact.contacts.size(), 1U);
  const double mass = massOf(body, params.body.density);
  const Mat3 inertia =
      integrateSolid(body.surface->positions, body.surface->triangles).inertia(params.body.density);
  const Vec3 n = impact.before.rotation.conjugate() * Vec3::UnitY();
  const Vec3 arm = (impact.contacts[0].point - impact.centreOfMass).cross(n);
  const double expected = 1.4 * std::sqrt(2 * 9.81) / (1 / mass + arm.dot(inertia.inverse() * arm));
  EXPECT_LT((impact.contacts[0].impulse - expected * n).norm(), 1e-9 * expected);
}

TEST(DropOnFloor, RotationTurnsAboutXThenYThenZ) {
  RigidParams params;
  params.orientation = Vec3(90, 90, 0);
  const Impact impact = drop(families::box(1, 1, 1, Vec3(1, 2, 3)), params);
  // y → z under the turn about x, z → x under the one about y.
  EXPECT_LT((impact.before.rotation * Vec3::UnitY() - Vec3::UnitX()).norm(), 1e-9);
}

TEST(DropOnFloor, FlatBoxSplitsItsImpulseEvenly) {
  const TetMesh body = families::box(1, 1, 1, Vec3(0.2, 0.2, 0.2));
  const Impact impact = drop(body, {});
  ASSERT_EQ(impact.contacts.size(), 4U);
  const double total = 1.1 * massOf(body, 2400) * std::sqrt(2 * 9.81);
  EXPECT_NEAR(totalImpulse(impact).y(), total, 2e-3 * total);
  for (const Contact& contact : impact.contacts) EXPECT_NEAR(contact.impulse.y(), total / 4, 1e-3 * total);
}

TEST(DropOnFloor, ManyTouchingVerticesStayFew) {
  const TetMesh body = families::box(20, 20, 2, Vec3(1, 1, 0.1));
  RigidParams params;
  params.orientation = Vec3(90, 0, 0);
  const Impact impact = drop(body, params);
  ASSERT_TRUE(impact.hit);
  EXPECT_LE(impact.contacts.size(), 32U);
  EXPECT_GE(impact.contacts.size(), 4U);
  EXPECT_LT(impact.after.angularVelocity.norm(), 1e-2);
}

TEST(DropOnFloor, FrictionStaysInCoulombsCone) {
  RigidParams params;
  params.friction = 0.2;
  params.velocity = Vec3(8, 0, 3);
  const Impact impact = drop(sphere(0.1, 2), params);
  ASSERT_EQ(impact.contacts.size(), 1U);
  const Vec3 j = impact.contacts[0].impulse;
  EXPECT_NEAR(std::hypot(j.x(), j.z()), 0.2 * j.y(), 1e-6 * j.y());
  EXPECT_LT(j.x(), 0);
}

TEST(DropOnFloor, TheTimeStepDoesNotMatter) {
  const TetMesh body = families::uShape(1, 2, 4, 1, 0.05);
  RigidParams params;
  params.orientation = Vec3(13, 41, 77);
  params.angularVelocity = Vec3(9, -4, 17);
  params.dropHeight = 2;
  const Impact coarse = drop(body, params);
  for (const double step : {1e-2, 1.0 / 480, 1e-4}) {
    params.timeStep = step;
    const Impact fine = drop(body, params);
    ASSERT_EQ(fine.contacts.size(), coarse.contacts.size());
    EXPECT_NEAR(fine.time, coarse.time, 1e-7);
    EXPECT_LT((totalImpulse(fine) - totalImpulse(coarse)).norm(), 1e-5 * totalImpulse(coarse).norm());
  }
}

TEST(DropOnFloor, UnitsFromMillimetresToKilometres) {
  RigidParams params;
  params.orientation = Vec3(20, 10, 30);
  const RigidParams unitParams = params;
  for (const double size : {1e-3, 1.0, 1e3}) {
    const TetMesh body = families::box(1, 1, 1, size * Vec3(2, 1, 3));
    params.dropHeight = size;
    params.maxTime = 100;
    const Impact impact = drop(body, params);
    ASSERT_EQ(impact.contacts.size(), 1U) << size;
    // Impulse grows as m v = L³ √L.
    const double scaled = impact.contacts[0].impulse.norm() / std::pow(size, 3.5);
    const double unit = drop(families::box(1, 1, 1, Vec3(2, 1, 3)), unitParams).contacts[0].impulse.norm();
    EXPECT_NEAR(scaled, unit, 1e-6 * unit) << size;
    EXPECT_TRUE(impact.contacts[0].duration > 0 && impact.contacts[0].radius >= kSmallestPatch * size);
  }
}

TEST(DropOnFloor, GivenPatchAndDurationAreUsed) {
  RigidParams params;
  params.contactDuration = 3e-4;
  params.contactRadius = 0.02;
  const Impact impact = drop(sphere(0.1, 2), params);
  ASSERT_EQ(impact.contacts.size(), 1U);
  EXPECT_EQ(impact.contacts[0].duration, 3e-4);
  EXPECT_EQ(impact.contacts[0].radius, 0.02);
}

TEST(DropOnFloor, CancellingIsAnError) {
  CancelToken token;
  token.cancel();
  Exec exec;
  exec.cancel = &token;
  const Result<Impact> impact = dropUntilImpact(sphere(1, 1), {}, exec);
  ASSERT_FALSE(impact.ok());
  EXPECT_EQ(impact.error().kind, Error::Kind::Cancelled);
}

/// Energy and angular momentum of a torque-free body stay what they were.
TEST(Flight, KeepsEnergyAndAngularMomentum) {
  RigidBody body;
  body.inertia = Vec3(1, 2, 3.5).asDiagonal();
  RigidMotion start;
  start.angularVelocity = Vec3(0.3, 8, -0.2);  // about the unstable axis
  Flight flight(body, start, 9.81, 1.0 / 240);
  flight.advance(3);
  const Mat3 r = flight.motion().rotation.toRotationMatrix();
  const Vec3 momentum = r * body.inertia * r.transpose() * flight.motion().angularVelocity;
  const Vec3 before = body.inertia * start.angularVelocity;
  EXPECT_LT((momentum - before).norm(), 1e-12 * before.norm());
  EXPECT_NEAR(flight.motion().angularVelocity.dot(momentum), start.angularVelocity.dot(before),
              1e-6 * start.angularVelocity.dot(before));
}

/// Energy stored at the deepest approach, 8/15 E* √R δ^(5/2), is the energy of the approach.
TEST(Hertz, StoresTheEnergyOfTheApproach) {
  const HertzImpact impact = hertzImpact(0.5, 3, 0.02, 2e10);
  EXPECT_NEAR(8.0 / 15 * 2e10 * std::sqrt(0.02) * std::pow(impact.indentation, 2.5), 0.5 * 0.5 * 9, 1e-12);
  const double peak = 4.0 / 3 * 2e10 * std::sqrt(0.02) * std::pow(impact.indentation, 1.5);
  EXPECT_NEAR(peak / (2 * 0.5 * 3 / impact.duration), kHertzPeak, 0.005);
}

}  // namespace
