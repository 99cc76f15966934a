// The rigid part of line 8 of Algorithm 1 (Schvartzman and Otaduy 2014): one body moves until
// it is first hit.
//
// Two scenes. `Floor`: the body is let go above the plane y = 0 and falls. `Ball`: a ball flies along a
// straight line at the body, which floats or stands on the floor; gravity is left out for that short flight.
//
// What decides the moment of impact is the surface itself, so a concave body needs neither a hull nor convex
// parts: against the floor its lowest vertices, against the ball its closest point. Free flight is exact
// (parabola; torque-free rotation by a fourth-order scheme) and the moment is found by conservative
// advancement (Mirtich 1996, "Impulse-based dynamic simulation", section 2.3), which jumps over empty flight
// and never passes through anything. Neither the moment nor the velocities at it depend on the time step,
// then, except by the rotation's error of at most 1e-7 rad per turn.
//
// The impulses at that moment are Bullet's: its sequential-impulse solver with restitution and
// Coulomb friction on all simultaneous contacts, in units in which the body's size, mass and fastest
// contact speed are 1.
#pragma once

#include "base/exec.h"
#include "base/result.h"
#include "types/fields.h"
#include "types/material.h"
#include "types/tet_mesh.h"

namespace sherd {

enum class RigidScene { Floor, Ball };

/// World space is metres with y up; angles are degrees where a comment says so.
struct RigidParams {
  RigidScene scene = RigidScene::Floor;
  Material body;  ///< of the moving body
  /// Degrees. The body is turned about its centre of mass, first about the world's x axis, then y, then z.
  Vec3 orientation = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();         ///< m/s, of the centre of mass at the release
  Vec3 angularVelocity = Vec3::Zero();  ///< rad/s, world space, at the release; at most 1e4 long
  double gravity = 9.81;                ///< m/s² along −y, ≥ 0; plays no part in the ball scene

  double dropHeight = 1;  ///< m, ≥ 0, from the floor to the body's lowest point at the release; floor scene

  double ballRadius = 0.05;            ///< m, > 0
  double ballDensity = 7800;           ///< kg/m³, > 0
  double ballSpeed = 10;               ///< m/s, > 0
  Vec3 ballDirection = Vec3(1, 0, 0);  ///< world space, any length but 0
  /// Where the ball's path leads: a point of the turned body's bounding box, from (0, 0, 0), its low corner,
  /// to (1, 1, 1), its high one. Components outside of [0, 1] aim past the body.
  Vec3 ballTarget = Vec3::Constant(0.5);
  bool standing =
      false;  ///< ball scene: the body stands still on the floor, which then holds against the hit

  double restitution = 0.1;      ///< in [0, 1]
  double friction = 0.5;         ///< Coulomb's, ≥ 0
  double obstacleYoung = 3e10;   ///< Pa, > 0: of the floor (concrete) or the ball
  double obstaclePoisson = 0.2;  ///< in (−1, 0.5)

  double contactDuration = 0;  ///< s; 0: Hertz's
  double contactRadius = 0;    ///< m; 0: Hertz's, but at least kSmallestPatch of the body's size

  double timeStep = 1.0 / 240;  ///< s, > 0: the longest step of the rotation's integration
  double maxTime = 10;          ///< s, > 0: how long to wait for an impact
};

/// Share of the body's size (diameter of the sphere about its centre of mass that holds it) below which a
/// contact patch would be a point load, whose energy grows without bound as the mesh gets finer.
inline constexpr double kSmallestPatch = 0.03;

/// Share of the body's size below which a ball's radius drowns in the precision with which a touch is found.
inline constexpr double kSmallestBall = 1e-6;

/// s: the most that waiting for an impact is worth; a node's max_time ends there.
inline constexpr double kLongestWait = 1e4;

/// Peak force over mean force, J / T, of Hertz's impact: F_max T / (2 m v) with F_max = 5/4 m v²/δ,
/// T = 2.94 δ/v.
inline constexpr double kHertzPeak = 1.84;

/// Releases the body and returns its first impact; `hit` is false where there was none within maxTime, and
/// then `before` and `after` are the motion at the end of the search.
///
/// body.surface (m, rest space) must enclose a volume; its mass, centre and inertia are the surface's, with
/// params.body.density. Contacts that come within 1e-4 of the body's size of touching together count as
/// simultaneous; many of them are represented by at most 32 of the touching points. Contact::point lies on
/// the surface, Contact::impulse acts on the body, both in rest space. All contacts share one duration.
///
/// Duration and patch follow Hertz (Johnson, "Contact Mechanics", 1985, section 11.4.1) for two spheres of
/// the material pair, the body as the sphere of its volume (the curvature of a triangle mesh at a vertex is a
/// property of the meshing): with m* = ΣJ_n / ((1 + e) v) the mass behind the contacts,
///   δ = (15 m* v² / (16 √R E*))^(2/5),   a = √(R δ),   T = 2.94 δ / v.
/// A patch, given or Hertz's, is no larger than the body's size: a larger one is cut to that, with a warning.
///
/// Errors: a parameter outside its range; a surface without volume; a mass, impulse, duration or radius that
/// is no positive finite number, by the name of the parameter it comes from; a ball too small or too light;
/// cancelled.
/// Cost O(vertices) per step near the floor, O(log triangles) per step near the ball: some tens of steps.
Result<Impact> dropUntilImpact(const TetMesh& body, const RigidParams& params, const Exec& exec);

/// What keeps the body from being hit where dropUntilImpact returns hit = false for the same arguments: by
/// the name of the parameter to change, and with how far or how long it falls short (rigid/miss.h).
Error whyNoImpact(const TetMesh& body, const RigidParams& params);

}  // namespace sherd
