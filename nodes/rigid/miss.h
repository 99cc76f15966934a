// Why a body was not hit, and what would change that.
#pragma once

#include <span>

#include "base/result.h"
#include "geometry/surface_tree.h"
#include "rigid/flight.h"
#include "rigid/rigid.h"
#include "rigid/time_of_impact.h"

namespace sherd {

/// For a flight at its release that flyToFloor found no impact of. Names max_time with the time that the fall
/// takes (exact without spin, else a bound: by then the centre of mass would be at the floor), gravity,
/// velocity or drop_height. O(1).
Error whyNotOnFloor(const Flight& release, const RigidParams& params);

/// For a flight at its release that flyToBall found no impact of. Names ball_target with the distance by
/// which the ball passes the body, ball_speed or max_time. Cost: some hundred closest points.
Error whyNotByBall(const Flight& release, const Ball& ball, const SurfaceTree& surface,
                   const RigidParams& params);

}  // namespace sherd
