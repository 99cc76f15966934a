#include "rigid/miss.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sherd {
namespace {

constexpr double kRounding = 1e-6;  // relative: so close to max_time an impact may count as too late
constexpr int kLooks = 512;         // along the ball's way past the body

Error parameter(const char* name, std::string what, std::string remedy) {
  return Error{std::move(what), std::move(remedy), name, Error::Kind::Input};
}

/// Three digits, never less than the number.
std::string roundedUp(double number) {
  const double unit = std::pow(10, std::floor(std::log10(number)) - 2);
  return fmt::format("{:.3g}", std::ceil(number / unit) * unit);
}

/// s until a point at `height` (m) with the speed `up` (m/s) is at 0; infinite where it never is.
double fallTime(double height, double up, double gravity) {
  if (height <= 0 && up <= 0) return 0;
  if (gravity == 0) return up < 0 ? height / -up : std::numeric_limits<double>::infinity();
  const double root = std::sqrt(up * up + 2 * gravity * height);
  return up > 0 ? (up + root) / gravity : 2 * height / (root - up);
}

/// m: the least distance between the ball's centre and the surface around the moment `closest` (s) of the
/// centres, `around` s to either side: looked for at even steps, then by golden sections.
double leastDistance(const Flight& release, const Ball& ball, const SurfaceTree& surface, double closest,
                     double around) {
  const auto distance = [&](const Flight& f) {
    return surface.closest(f.toRest(ball.centreAt(f.time()))).distance;
  };
  Flight flight = release;
  flight.advance(std::max(0.0, closest - around));
  const double step = (closest + around - flight.time()) / kLooks;
  Flight from = flight;  // the look before the best one
  double least = distance(flight);
  for (int i = 0; i < kLooks; ++i) {
    const Flight last = flight;
    flight.advance(step);
    const double now = distance(flight);
    if (now < least) {
      least = now;
      from = last;
    }
  }
  const auto after = [&](double dt) {
    Flight there = from;
    there.advance(dt);
    return distance(there);
  };
  constexpr double kGolden = 0.6180339887498949;
  double low = 0, high = 2 * step;
  for (int i = 0; i < 60; ++i) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    const double atA = after(a), atB = after(b);
    least = std::min({least, atA, atB});
    (atA < atB ? high : low) = atA < atB ? b : a;
  }
  return least;
}

Error passes(double gap, const Flight& release, const RigidParams& params) {
  const Vec3& aim = params.ballTarget;
  const bool within = (aim.array() >= 0).all() && (aim.array() <= 1).all();
  std::string remedy = within
                           ? "aim ball_target at the body itself within its bounding box (0.5 0.5 0.5 is the "
                             "box's middle), or raise ball_radius by more than that"
                           : "aim ball_target within [0, 1]";
  if (!release.motion().velocity.isZero(0))
    remedy += "; the body's own velocity moves it out of the way, too";
  if (gap <= 1e-9 * release.body().size)
    return parameter("ball_target", "the ball only grazes the body", std::move(remedy));
  return parameter("ball_target", fmt::format("the ball passes the body by {:.3g} m", gap),
                   std::move(remedy));
}

}  // namespace

Error whyNotOnFloor(const Flight& release, const RigidParams& params) {
  const double up = params.velocity.y(), gravity = params.gravity;
  const bool spins = release.spinBound() != 0;
  if (gravity == 0 && !(up < 0))
    return parameter("gravity", "gravity is 0 and the body isn't thrown down: it never reaches the floor",
                     "raise gravity (9.81 on earth), or give velocity a negative y");
  const double needs =
      fallTime(spins ? std::max(0.0, release.motion().position.y()) : params.dropHeight, up, gravity);
  if (!(needs <= kLongestWait)) {
    const bool thrownHigh = up > 0 && up * up > 2 * gravity * params.dropHeight;
    return parameter(
        thrownHigh ? "velocity" : "drop_height",
        fmt::format("the body needs {:.3g} s to fall, and max_time ends at {:.0f} s", needs, kLongestWait),
        thrownHigh ? "throw it up less fast, or raise gravity"
                   : "lower drop_height, raise gravity, or give velocity a more negative y");
  }
  if (needs > params.maxTime * (1 - kRounding))
    return parameter("max_time",
                     fmt::format("the body is still in the air after {:.4g} s; it needs {}{} s to fall",
                                 params.maxTime, spins ? "up to " : "", roundedUp(needs)),
                     "raise max_time above that");
  return parameter("drop_height", "the body lies on the floor from the start and isn't moving towards it",
                   "raise drop_height above 0, or give velocity a negative y");
}

Error whyNotByBall(const Flight& release, const Ball& ball, const SurfaceTree& surface,
                   const RigidParams& params) {
  const RigidBody& body = release.body();
  const Vec3 offset = ball.start - release.motion().position;
  const Vec3 approach = ball.velocity - release.motion().velocity;
  const double speed = approach.norm();
  if (!(offset.dot(approach) < 0))
    return parameter("ball_speed", "the body flies off at least as fast as the ball follows",
                     "raise ball_speed above the body's own speed along ball_direction, or lower velocity");
  const double closest = -offset.dot(approach) / (speed * speed);  // s, of the centres
  const double distance = (offset + closest * approach).norm(), reach = body.radius + ball.radius;
  const double inside = distance < reach ? std::sqrt(reach * reach - distance * distance) / speed : 0;
  if (closest + inside > params.maxTime * (1 - kRounding))
    return parameter("max_time",
                     fmt::format("the ball is still on its way after {:.4g} s; it needs up to {} s",
                                 params.maxTime, roundedUp(closest + inside)),
                     "raise max_time above that, or raise ball_speed");
  // Farther away on its line the centre is farther from all of the body than it is at its closest.
  const double around = 2 * std::sqrt(body.radius * (distance + body.radius)) / speed;
  return passes(leastDistance(release, ball, surface, closest, around) - ball.radius, release, params);
}

}  // namespace sherd
