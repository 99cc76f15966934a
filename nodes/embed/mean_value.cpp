// Mean value coordinates (extension.h).
//
// Seen from the point x, triangle (p_0, p_1, p_2) covers a spherical triangle whose mean vector is
//   m = ½ Σ_i θ_i n_i,   θ_i the angle between p_i+1 − x and p_i−1 − x, n_i the normal of their plane,
// and m = Σ_i w_i (p_i − x) gives w_i = (n_i·m) / (n_i·(p_i − x)). The mean vectors of a closed surface add
// up to zero, which makes x = Σ w_i p_i / Σ w_i.
#include <Eigen/Dense>
#include <cmath>

#include "embed/extension.h"

namespace sherd {
namespace {

/// Sine of the elevation of x over a triangle's plane below which the triangle is seen edge-on. Its weights
/// go to zero with it, and rounding in them grows with its inverse: both are 1e-8 here, and projected out
/// below.
constexpr double kEdgeOn = 1e-8;
/// Length of the mean vector from which on a triangle in such a plane is not seen edge-on: x is right above
/// it.
constexpr double kCovers = 1e-3;
constexpr double kOnSurface = 1e-12;

enum class Seen { Added, EdgeOn, OnFace };

/// Barycentric coordinates of a point on the triangle, up to a factor.
Seen onFace(const double (&angle)[3], const double (&distance)[3], double (&weight)[3]) {
  for (int i = 0; i < 3; ++i) weight[i] = std::sin(angle[i]) * distance[(i + 1) % 3] * distance[(i + 2) % 3];
  return Seen::OnFace;
}

/// One triangle's weights.
Seen addTriangle(const Vec3 (&p)[3], double (&weight)[3]) {
  Vec3 u[3], n[3];
  double distance[3], angle[3];
  for (int i = 0; i < 3; ++i) {
    distance[i] = p[i].norm();
    u[i] = p[i] / distance[i];
  }
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = u[(i + 1) % 3], &b = u[(i + 2) % 3];
    n[i] = a.cross(b);
    const double sine = n[i].norm();
    angle[i] = std::atan2(sine, a.dot(b));
    if (sine > 0) n[i] /= sine;
  }
  const Vec3 mean = 0.5 * (angle[0] * n[0] + angle[1] * n[1] + angle[2] * n[2]);
  const bool covers = mean.norm() > kCovers;
  for (int i = 0; i < 3; ++i) {
    const double elevation = n[i].dot(u[i]);
    if (std::abs(elevation) < kOnSurface && covers) return onFace(angle, distance, weight);
    if (std::abs(elevation) < kEdgeOn && !covers) return Seen::EdgeOn;
    weight[i] = n[i].dot(mean) / (elevation * distance[i]);
  }
  return Seen::Added;
}

/// The smallest change, relative to the weights' sizes, that makes Σ λ = 1 and Σ λ (p − x) = 0 exact.
void project(Eigen::VectorXd& lambda, const Eigen::Matrix4Xd& constraints) {
  const Eigen::VectorXd size = lambda.cwiseAbs();
  const Eigen::Matrix4d normal = constraints * size.asDiagonal() * constraints.transpose();
  const Eigen::FullPivLU<Eigen::Matrix4d> solver(normal);
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::Vector4d residual = Eigen::Vector4d(0, 0, 0, 1) - constraints * lambda;
    const Eigen::VectorXd change = size.cwiseProduct(constraints.transpose() * solver.solve(residual));
    if (change.allFinite()) lambda += change;
  }
}

}  // namespace

Eigen::VectorXd meanValueCoordinates(const Vec3& point, std::span<const Vec3> positions,
                                     std::span<const Triangle> triangles) {
  const auto count = static_cast<Eigen::Index>(positions.size());
  Eigen::Matrix4Xd relative(4, count);  // p − x in units of the largest, and a row of ones
  for (Eigen::Index i = 0; i < count; ++i)
    relative.col(i) << positions[static_cast<std::size_t>(i)] - point, 1.0;
  const double size = relative.topRows<3>().colwise().norm().maxCoeff();
  relative.topRows<3>() /= size;

  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i)
    if (relative.col(i).head<3>().norm() < kOnSurface) {
      lambda[i] = 1;
      return lambda;
    }
  for (const Triangle& triangle : triangles) {
    const Vec3 p[3] = {relative.col(triangle[0]).head<3>(), relative.col(triangle[1]).head<3>(),
                       relative.col(triangle[2]).head<3>()};
    double weight[3];
    const Seen seen = addTriangle(p, weight);
    if (seen == Seen::EdgeOn) continue;
    if (seen == Seen::OnFace) lambda.setZero();
    for (std::size_t c = 0; c < 3; ++c) lambda[triangle[c]] += weight[c];
    if (seen == Seen::OnFace) break;
  }
  const double sum = lambda.sum();
  if (!(std::abs(sum) > 1e-12 * lambda.cwiseAbs().sum()))
    return Eigen::VectorXd::Constant(count, std::numeric_limits<double>::quiet_NaN());
  lambda /= sum;
  project(lambda, relative);
  return lambda;
}

}  // namespace sherd
