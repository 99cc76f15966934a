// Free flight of a rigid body: a parabola and torque-free rotation.
#pragma once

#include "types/fields.h"
#include "types/vec.h"

namespace sherd {

/// A rigid body's constants.
struct RigidBody {
  double mass = 1;                   ///< kg
  Mat3 inertia = Mat3::Identity();   ///< kg·m², about the centre of mass, rest space
  Vec3 centreOfMass = Vec3::Zero();  ///< m, rest space
  double radius = 1;                 ///< m, of the sphere about the centre of mass that holds the body
  double size = 1;                   ///< m, diameter of that sphere: what tolerances are relative to
};

/// The motion at a moment. Moves forward only; copies are independent.
class Flight {
 public:
  /// `gravity` m/s² along −y; `maxStep` s bounds the rotation's steps, which are also kept below 1/50 rad.
  Flight(const RigidBody& body, const RigidMotion& start, double gravity, double maxStep);

  void advance(double dt);
  double time() const { return time_; }
  const RigidMotion& motion() const { return motion_; }
  const RigidBody& body() const { return *body_; }
  double gravity() const { return gravity_; }
  /// No angular velocity of this flight is ever above this, rad/s; 0 where the body doesn't turn.
  double spinBound() const { return spinBound_; }

  Vec3 toWorld(const Vec3& rest) const {
    return motion_.rotation * (rest - body_->centreOfMass) + motion_.position;
  }
  Vec3 toRest(const Vec3& world) const {
    return motion_.rotation.conjugate() * (world - motion_.position) + body_->centreOfMass;
  }
  /// Velocity of a point of the body at world position x, m/s.
  Vec3 velocityAt(const Vec3& x) const {
    return motion_.velocity + motion_.angularVelocity.cross(x - motion_.position);
  }

 private:
  Vec3 spinAt(const Eigen::Quaterniond& rotation) const;
  void turn(double dt);

  const RigidBody* body_;
  RigidMotion start_, motion_;
  double gravity_, maxStep_, time_ = 0, spinBound_ = 0;
  Mat3 inverseInertia_;
  Vec3 angularMomentum_;  ///< kg·m²/s, world space: constant in free flight
};

/// I⁻¹ of the body in world axes, 1/(kg·m²).
Mat3 worldInverseInertia(const RigidBody& body, const Eigen::Quaterniond& rotation);

}  // namespace sherd
