// When and where a flying body first touches the floor or a ball.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/exec.h"
#include "geometry/surface_tree.h"
#include "rigid/flight.h"

namespace sherd {

/// A place where the body touches an obstacle.
struct Touch {
  Vec3 rest;            ///< m, on the body's surface, rest space
  Vec3 normal;          ///< unit, world space, out of the obstacle towards the body
  bool onBall = false;  ///< else on the floor
};

/// A ball in straight flight.
struct Ball {
  double mass = 0;                                     ///< kg
  double radius = 0;                                   ///< m
  Vec3 start = Vec3::Zero(), velocity = Vec3::Zero();  ///< m and m/s, world space, at time 0
  Vec3 centreAt(double time) const { return start + time * velocity; }
};

/// Contacts closer than this share of the body's size when the first one touches are simultaneous with it.
inline constexpr double kSimultaneous = 1e-4;

/// Advances `flight` to its first impact on the plane y = 0 and returns true, or past `maxTime` and returns
/// false. `vertices` (m, rest space) are all those that may touch. An impact is a touch with closing speed.
bool flyToFloor(Flight& flight, std::span<const Vec3> vertices, double maxTime, const Exec& exec);
/// The vertices that touch the floor, at most 32 of them, chosen to span all.
std::vector<Touch> touchesOnFloor(const Flight& flight, std::span<const Vec3> vertices);

/// The same for a ball that starts outside of the body. False also as soon as the ball has passed.
bool flyToBall(Flight& flight, const Ball& ball, const SurfaceTree& surface, double maxTime,
               const Exec& exec);
/// Where the ball touches the surface: its closest points, those within 20° of a closer one (seen from the
/// ball's centre) left out. Cost O(triangles).
std::vector<Touch> touchesOnBall(const Flight& flight, const Ball& ball, std::span<const Vec3> vertices,
                                 std::span<const Triangle> triangles);

}  // namespace sherd
