#include "rigid/time_of_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/point_triangle.h"

namespace sherd {
namespace {

constexpr double kTouching = 1e-10;  // of the body's size: the gap at which conservative advancement ends
constexpr std::size_t kMostTouches = 32;  // that represent a flat contact

struct Gap {
  double gap = 0;      ///< m, never above the true distance
  bool exact = false;  ///< it is the true distance
};

/// Conservative advancement. gapAt(flight) → Gap, closingAt(flight) → m/s (asked for at exact gaps
/// of about 0), safeStep(flight, gap) → s in which `gap` metres cannot be closed, passed(flight) →
/// no impact can follow.
template <class GapAt, class ClosingAt, class SafeStep, class Passed>
bool advanceToImpact(Flight& flight, double maxTime, const Exec& exec, const GapAt& gapAt,
                     const ClosingAt& closingAt, const SafeStep& safeStep, const Passed& passed) {
  const double touching = kTouching * flight.body().size;
  while (flight.time() <= maxTime && !exec.cancelled() && !passed(flight)) {
    const Gap now = gapAt(flight);
    double step = safeStep(flight, now.gap);
    if (now.exact && now.gap <= touching) {
      if (closingAt(flight) > 0) return true;
      step = std::max(step, 1e-4 * maxTime);  // sliding or rolling on: look again later
    }
    // A step that vanishes in the time's last digits would stand still; it is far below the touching gap.
    flight.advance(std::max(step, 4e-16 * std::max(flight.time(), maxTime * 1e-3)));
  }
  return false;
}

double lowest(const Flight& flight, std::span<const Vec3> vertices) {
  const Vec3 up = flight.motion().rotation.conjugate() * Vec3::UnitY();  // in rest space
  double low = std::numeric_limits<double>::infinity();
  for (const Vec3& v : vertices) low = std::min(low, up.dot(v - flight.body().centreOfMass));
  return flight.motion().position.y() + low;
}

/// The speed below which a touch counts as rest: rounding of what the flight's velocities are made of.
double restSpeed(const Flight& flight) {
  return 1e-9 * (flight.motion().velocity.norm() + flight.spinBound() * flight.body().radius +
                 std::sqrt(flight.gravity() * flight.body().size));
}

/// Keeps points that span the set: the one farthest from the mean, then again and again the one farthest from
/// those kept (ties: the lowest index), until all lie within `covered` of a kept one or there are enough.
std::vector<Vec3> spanningSubset(const std::vector<Vec3>& points, double covered) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  std::vector<double> distance(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) distance[i] = (points[i] - mean).norm();
  std::vector<Vec3> kept;
  while (kept.size() < kMostTouches) {
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (!kept.empty() && *farthest <= covered) break;
    kept.push_back(points[static_cast<std::size_t>(farthest - distance.begin())]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double toLast = (points[i] - kept.back()).norm();
      distance[i] = kept.size() == 1 ? toLast : std::min(distance[i], toLast);
    }
  }
  return kept;
}

}  // namespace

bool flyToFloor(Flight& flight, std::span<const Vec3> vertices, double maxTime, const Exec& exec) {
  const auto gapAt = [&](const Flight& f) {
    const double sphere = f.motion().position.y() - f.body().radius;
    return sphere > f.body().size ? Gap{sphere, false} : Gap{lowest(f, vertices), true};
  };
  const auto closingAt = [&](const Flight& f) {
    double fastest = 0;
    const double low = lowest(f, vertices);
    for (const Vec3& v : vertices) {
      const Vec3 x = f.toWorld(v);
      if (x.y() <= low + kSimultaneous * f.body().size) fastest = std::max(fastest, -f.velocityAt(x).y());
    }
    return fastest > restSpeed(f) ? fastest : 0.0;
  };
  // The gap closes by at most c dt + ½ g dt², c = −v_y + |ω| r.
  const auto safeStep = [&](const Flight& f, double gap) {
    const double c = -f.motion().velocity.y() + f.spinBound() * f.body().radius, g = f.gravity();
    gap = std::max(gap, 0.0);
    if (g == 0) return c > 0 ? gap / c : maxTime;
    const double root = std::sqrt(c * c + 2 * g * gap);
    if (c <= 0) return (root - c) / g;
    return 2 * gap / (c + root);
  };
  // Flying off without gravity, or lying on the floor.
  const auto passed = [&](const Flight& f) {
    const bool spins = f.spinBound() != 0, sinks = f.motion().velocity.y() < 0;
    if (f.gravity() == 0 && !sinks && (!spins || f.motion().position.y() > f.body().radius)) return true;
    return !spins && std::abs(f.motion().velocity.y()) <= restSpeed(f) &&
           lowest(f, vertices) <= kTouching * f.body().size;
  };
  return advanceToImpact(flight, maxTime, exec, gapAt, closingAt, safeStep, passed);
}

std::vector<Touch> touchesOnFloor(const Flight& flight, std::span<const Vec3> vertices) {
  const double size = flight.body().size, low = lowest(flight, vertices);
  std::vector<Vec3> touching;
  for (const Vec3& v : vertices)
    if (flight.toWorld(v).y() <= low + kSimultaneous * size) touching.push_back(v);
  std::vector<Touch> touches;
  for (const Vec3& rest : spanningSubset(touching, 10 * kSimultaneous * size))
    touches.push_back({rest, Vec3::UnitY(), false});
  return touches;
}

bool flyToBall(Flight& flight, const Ball& ball, const SurfaceTree& surface, double maxTime,
               const Exec& exec) {
  const auto offset = [&](const Flight& f) { return Vec3(ball.centreAt(f.time()) - f.motion().position); };
  const Vec3 approach = ball.velocity - flight.motion().velocity;
  const double reach = flight.body().radius + ball.radius;
  const auto gapAt = [&](const Flight& f) {
    const double spheres = offset(f).norm() - reach;
    if (spheres > 0.01 * f.body().size) return Gap{spheres, false};
    return Gap{surface.closest(f.toRest(ball.centreAt(f.time()))).distance - ball.radius, true};
  };
  const auto closingAt = [&](const Flight& f) {
    const Vec3 centre = ball.centreAt(f.time());
    const Vec3 touch = f.toWorld(surface.closest(f.toRest(centre)).point);
    return (touch - centre).normalized().dot(ball.velocity - f.velocityAt(touch)) - restSpeed(f);
  };
  // Seen from the body, the ball's centre moves at |v| + |ω| r at most, and r grows by no more than the gap.
  const auto safeStep = [&](const Flight& f, double gap) {
    gap = std::max(gap, 0.0);
    return gap / (approach.norm() + f.spinBound() * (offset(f).norm() + gap));
  };
  const auto passed = [&](const Flight& f) {
    return offset(f).dot(approach) >= 0 && offset(f).norm() > reach * (1 + 1e-9);
  };
  return advanceToImpact(flight, maxTime, exec, gapAt, closingAt, safeStep, passed);
}

std::vector<Touch> touchesOnBall(const Flight& flight, const Ball& ball, std::span<const Vec3> vertices,
                                 std::span<const Triangle> triangles) {
  struct Near {
    double distance;
    Vec3 rest;
  };
  const Vec3 centre = ball.centreAt(flight.time()), centreRest = flight.toRest(centre);
  const double reach = ball.radius + kSimultaneous * std::min(flight.body().size, ball.radius);
  std::vector<Near> near;
  for (const Triangle& t : triangles) {
    const Vec3 p = closestOnTriangle(centreRest, vertices[at(t[0])], vertices[at(t[1])], vertices[at(t[2])]);
    const double distance = (p - centreRest).norm();
    if (distance <= reach) near.push_back({distance, p});
  }
  std::stable_sort(near.begin(), near.end(),
                   [](const Near& a, const Near& b) { return a.distance < b.distance; });
  const double sameDirection = std::cos(20 * M_PI / 180);
  std::vector<Touch> touches;
  for (const Near& n : near) {
    const Vec3 normal = (flight.toWorld(n.rest) - centre).normalized();
    const bool seen = std::any_of(touches.begin(), touches.end(),
                                  [&](const Touch& t) { return t.normal.dot(normal) > sameDirection; });
    if (!seen && touches.size() < kMostTouches) touches.push_back({n.rest, normal, true});
  }
  return touches;
}

}  // namespace sherd
