#include "rigid/flight.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace sherd {
namespace {

constexpr double kLargestTurn = 0.02;  // rad per step: the fourth-order error is then below 1e-10 a step

Eigen::Quaterniond plus(const Eigen::Quaterniond& q, double factor, const Eigen::Quaterniond& rate) {
  Eigen::Quaterniond sum;
  sum.coeffs() = q.coeffs() + factor * rate.coeffs();
  return sum;
}

}  // namespace

Mat3 worldInverseInertia(const RigidBody& body, const Eigen::Quaterniond& rotation) {
  const Mat3 r = rotation.toRotationMatrix();
  return r * body.inertia.inverse() * r.transpose();
}

Flight::Flight(const RigidBody& body, const RigidMotion& start, double gravity, double maxStep)
    : body_(&body),
      start_(start),
      motion_(start),
      gravity_(gravity),
      maxStep_(maxStep),
      inverseInertia_(body.inertia.inverse()) {
  const Mat3 r = start.rotation.toRotationMatrix();
  angularMomentum_ = r * body.inertia * r.transpose() * start.angularVelocity;
  const double smallest =
      Eigen::SelfAdjointEigenSolver<Mat3>(body.inertia, Eigen::EigenvaluesOnly).eigenvalues()[0];
  // Twice the kinetic energy is ω·L ≥ I_min |ω|², and constant.
  if (!start.angularVelocity.isZero(0))
    spinBound_ = std::sqrt(std::max(0.0, start.angularVelocity.dot(angularMomentum_)) / smallest);
}

Vec3 Flight::spinAt(const Eigen::Quaterniond& rotation) const {
  const Mat3 r = rotation.normalized().toRotationMatrix();
  return r * (inverseInertia_ * (r.transpose() * angularMomentum_));
}

/// One classical Runge–Kutta step of q' = ½ ω(q) q with ω(q) = R I⁻¹ Rᵀ L.
void Flight::turn(double dt) {
  const auto rate = [this](const Eigen::Quaterniond& q) {
    const Vec3 half = 0.5 * spinAt(q);
    return Eigen::Quaterniond(0, half.x(), half.y(), half.z()) * q;
  };
  const Eigen::Quaterniond q = motion_.rotation;
  const Eigen::Quaterniond k1 = rate(q), k2 = rate(plus(q, dt / 2, k1)), k3 = rate(plus(q, dt / 2, k2)),
                           k4 = rate(plus(q, dt, k3));
  motion_.rotation.coeffs() =
      q.coeffs() + dt / 6 * (k1.coeffs() + 2 * k2.coeffs() + 2 * k3.coeffs() + k4.coeffs());
  motion_.rotation.normalize();
}

void Flight::advance(double dt) {
  time_ += dt;
  const Vec3 fall(0, -gravity_, 0);
  motion_.position = start_.position + time_ * (start_.velocity + 0.5 * time_ * fall);
  motion_.velocity = start_.velocity + time_ * fall;
  if (spinBound_ == 0) return;
  const double step = std::min(maxStep_, kLargestTurn / spinBound_);
  const double count = std::max(1.0, std::ceil(dt / step));
  for (double i = 0; i < count; ++i) turn(dt / count);
  motion_.angularVelocity = spinAt(motion_.rotation);
}

}  // namespace sherd
