#include "preview/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sherd {
namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180;
constexpr float kFieldOfView = 26 * kDegree;  // of the picture's shorter side
constexpr float kAzimuth = 32 * kDegree, kElevation = 20 * kDegree;

/// The largest of (along − depth·slope) and of (−along − depth·slope): where the two sides of the view touch
/// the points.
struct Sides {
  float positive = -std::numeric_limits<float>::infinity(), negative = positive;
  void add(float along, float depth, float slope) {
    positive = std::max(positive, along - depth * slope);
    negative = std::max(negative, -along - depth * slope);
  }
  float centre() const { return 0.5f * (positive - negative); }
  float depth(float slope) const { return -0.5f * (positive + negative) / slope; }
};

}  // namespace

Camera threeQuarterView(const std::vector<Vec3f>& points, float aspect, float share) {
  Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
  for (const Vec3f& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const bool widerInX = high.x() - low.x() >= high.z() - low.z();
  const float azimuth = widerInX ? kAzimuth : 90 * kDegree - kAzimuth;

  Camera camera;
  const Vec3f towards(std::sin(azimuth) * std::cos(kElevation), std::sin(kElevation),
                      std::cos(azimuth) * std::cos(kElevation));
  camera.ahead = -towards;
  camera.right = Vec3f::UnitY().cross(towards).normalized();
  camera.up = towards.cross(camera.right);
  const float shorter = std::tan(kFieldOfView / 2);
  camera.tanX = aspect >= 1 ? shorter * aspect : shorter;
  camera.tanY = camera.tanX / aspect;

  // Each pair of opposite sides of the view, moved until both touch the points, gives one coordinate of the
  // eye and a depth; the eye goes to the farther depth.
  Sides sideways, upright;
  const float slopeX = share * camera.tanX, slopeY = share * camera.tanY;
  for (const Vec3f& p : points) {
    sideways.add(p.dot(camera.right), p.dot(camera.ahead), slopeX);
    upright.add(p.dot(camera.up), p.dot(camera.ahead), slopeY);
  }
  if (points.empty()) return camera;
  const float depth = std::min(sideways.depth(slopeX), upright.depth(slopeY));
  camera.eye = sideways.centre() * camera.right + upright.centre() * camera.up + depth * camera.ahead;
  return camera;
}

}  // namespace sherd
