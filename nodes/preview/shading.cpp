#include "preview/shading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "base/rng.h"
#include "preview/sampler.h"

namespace sherd {
namespace {

constexpr float kKey = 0.78f;          // irradiance of the key light over π
constexpr float kLightRadius = 0.12f;  // of the key light as seen from the body, radians
constexpr float kReach = 3.0f;         // how far occluders count, in body sizes
constexpr float kOffset = 2e-4f;       // of secondary rays' origins from the surface, in body sizes
enum Use : std::size_t { kPixel, kLight, kSky };

/// Light from above, darker and warmer from the ground.
Colour sky(const Vec3f& direction) {
  const float t = 0.5f + 0.5f * direction.y();
  return (1 - t) * Colour(0.20f, 0.19f, 0.18f) + t * Colour(0.52f, 0.55f, 0.60f);
}

/// Two axes perpendicular to a unit vector (Duff et al. 2017).
std::pair<Vec3f, Vec3f> axes(const Vec3f& n) {
  const float sign = std::copysign(1.f, n.z()), a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
  return {{1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()}, {b, sign + n.y() * n.y() * a, -n.y()}};
}

/// A disc of this radius about the tip of a unit vector.
Vec3f around(const Vec3f& n, float radius, const Eigen::Vector2f& point) {
  const auto [s, t] = axes(n);
  const float r = radius * std::sqrt(point.x()), angle = 2 * std::numbers::pi_v<float> * point.y();
  return (n + r * std::cos(angle) * s + r * std::sin(angle) * t).normalized();
}

Vec3f cosineWeighted(const Vec3f& n, const Eigen::Vector2f& point) {
  const auto [s, t] = axes(n);
  const float r = std::sqrt(point.x()), angle = 2 * std::numbers::pi_v<float> * point.y();
  return (std::sqrt(std::max(0.f, 1 - point.x())) * n + r * std::cos(angle) * s + r * std::sin(angle) * t)
      .normalized();
}

class Painter {
 public:
  Painter(const Scene& scene, const Camera& camera) : scene_(scene), camera_(camera) {
    ground_ = std::numeric_limits<float>::infinity();
    for (const Vec3f& p : scene.soup().corners) ground_ = std::min(ground_, p.y());
    light_ = (-0.55f * camera.right + 0.95f * Vec3f::UnitY() - 0.45f * camera.ahead).normalized();
  }

  /// Light along one ray of a pixel; (x, y) in [−1, 1]².
  Colour sample(float x, float y, const Sampler& sampler, std::uint32_t index) const {
    const Vec3f direction = camera_.ray(x, y);
    const Colour behind = backdrop(0.5f - 0.5f * y);
    Hit hit;
    if (scene_.firstHit(camera_.eye, direction, hit)) return body(hit, direction, sampler, index);
    if (direction.y() >= 0) return behind;
    const float distance = (ground_ - camera_.eye.y()) / direction.y();
    if (!(distance > 0)) return behind;
    // Shadows fade towards the panel's sides, where the next panel begins.
    const float fade = std::clamp((1 - std::abs(x)) / 0.25f, 0.f, 1.f);
    const float light = lightOn(camera_.eye + distance * direction, sampler, index);
    return (1 - 0.65f * fade * (1 - light)) * behind;
  }

 private:
  Colour body(const Hit& hit, const Vec3f& direction, const Sampler& sampler, std::uint32_t index) const {
    const Vec3f origin = camera_.eye + hit.distance * direction + kOffset * hit.geometricNormal;
    const Vec3f toLight = around(light_, kLightRadius, sampler.point(index, kLight));
    const float facing = hit.normal.dot(toLight);
    float key = 0, gloss = 0;
    if (facing > 0 && hit.geometricNormal.dot(toLight) > 0 && !scene_.occluded(origin, toLight, kReach)) {
      key = kKey * facing;
      gloss = 0.10f * std::pow(std::max(0.f, hit.normal.dot((toLight - direction).normalized())), 40.f);
    }
    const Vec3f outwards = cosineWeighted(hit.normal, sampler.point(index, kSky));
    // What is hidden from the sky sees the body itself, lit about half as well.
    const Colour ambient = hit.geometricNormal.dot(outwards) > 0 && !scene_.occluded(origin, outwards, kReach)
                               ? sky(outwards)
                               : Colour(0.22f * hit.colour);
    return (hit.colour.array() * (Colour::Constant(key) + ambient).array()).matrix() +
           Colour::Constant(gloss);
  }

  /// The share of its light that reaches a point of the ground past the body.
  float lightOn(const Vec3f& point, const Sampler& sampler, std::uint32_t index) const {
    const Vec3f up = Vec3f::UnitY(), origin = point + kOffset * up;
    const Vec3f toLight = around(light_, kLightRadius, sampler.point(index, kLight));
    const Vec3f outwards = cosineWeighted(up, sampler.point(index, kSky));
    const float key = kKey * toLight.y(), open = 0.55f;
    const float seen = (scene_.occluded(origin, toLight, kReach) ? 0 : key) +
                       (scene_.occluded(origin, outwards, kReach) ? 0 : open);
    return seen / (key + open);
  }

  const Scene& scene_;
  const Camera& camera_;
  float ground_;
  Vec3f light_;
};

}  // namespace

Colour backdrop(float v) { return (1 - v) * Colour(0.83f, 0.85f, 0.88f) + v * Colour(0.60f, 0.62f, 0.66f); }

void drawPanel(const Scene& scene, const Camera& camera, const PanelFrame& frame, int samples,
               PixelBuffer& canvas, const Exec& exec) {
  constexpr int kTile = 16;
  const Painter painter(scene, camera);
  const Rng seeds(0x70697865, static_cast<std::uint64_t>(frame.left));
  const int across = (frame.width + kTile - 1) / kTile, down = (frame.height + kTile - 1) / kTile;
  const auto pixel = [&](int x, int y) {
    const auto number = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(frame.width) +
                        static_cast<std::uint64_t>(x);
    const Sampler sampler(seeds, number);
    Colour sum = Colour::Zero();
    for (int s = 0; s < samples; ++s) {
      const auto index = static_cast<std::uint32_t>(s);
      const Eigen::Vector2f jitter = sampler.point(index, kPixel);
      const float u = (static_cast<float>(x) + jitter.x()) / static_cast<float>(frame.width);
      const float v = (static_cast<float>(y) + jitter.y()) / static_cast<float>(frame.height);
      sum += painter.sample(2 * u - 1, 1 - 2 * v, sampler, index).cwiseMin(1.f);
    }
    canvas.at(frame.left + x, frame.top + y) = sum / static_cast<float>(samples);
  };
  parallelFor(exec, static_cast<std::size_t>(across * down), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t tile = begin; tile < end; ++tile) {
      const int left = static_cast<int>(tile) % across * kTile, top = static_cast<int>(tile) / across * kTile;
      for (int y = top; y < std::min(top + kTile, frame.height); ++y)
        for (int x = left; x < std::min(left + kTile, frame.width); ++x) pixel(x, y);
    }
  });
}

}  // namespace sherd
