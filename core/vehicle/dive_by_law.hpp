#pragma once

#include <span>

#include "core/base/local_metric.hpp"
#include "core/vehicle/steering.hpp"

/// One dive as the glider flies it: by dead reckoning towards waypoints. The inside of steering.hpp.
namespace glidehelm::vehicle {

/// What a dive did.
struct DiveFlown {
  Motion motion;
  Heading first_heading;  ///< at the dive, the true one
};

/// Heading = bearing − asin(cross/Û), where cross is the part of the believed current to the right of the bearing.
/// |cross| ≥ Û steers square to the bearing, as far up-current as it goes. Sines and cosines in and out: they are what each step of a dive
/// needs of both angles, and sin(asin x) is x.
SineCosine steered_heading(SineCosine bearing, Current believed, MetresPerSecond believed_speed);

/// Flies from `from` for `seconds` by the law of product.md 6 (slocum.md 4.4).
///
/// The dead-reckoned position starts at the true dive point and moves with Û·h + ĉ, the true one with U·h' + c, where h'
/// is h turned by the glider's heading bias. Each step
/// takes its heading from the dead-reckoned bearing to `points[target]`; when the dead-reckoned distance is below
/// `radius` the next point is the target (the first one after the last if `loops`; else, and with a single point, the
/// glider keeps steering to the one it has). A step that would come into the ring ends a hundredth of a second inside.
///
/// With `waters.full` the true current is that at the depth of the yo-yo, in steps of a minute, which are 9 m of a usual
/// glider's depth; else `waters.ocean.dive`.
///
/// Steps of at most 5 min by the midpoint rule: with a current that changes by 3e-5 1/s along the way (1 m/s over 30 km)
/// the error of the rule is (5 min · 3e-5)²/6 = 1.4e-5 of the way, decimetres per stint. The bearing is that of the
/// geodesic to 1e-4 rad; it is the geodesic's own beyond 50 km.
///
/// Within the ring of a point that stays the target steps are a minute. The arrival is where the straight step enters the goal's disc; `closest` is
/// looked for at the ends of steps. Ends early when it is lost. `target` is left where the
/// dive left it. Precondition: at least one point, 0 ≤ target < points.
DiveFlown dive_by_law(const Flight& flight, const Waters& waters, const State& from, double seconds,
                      std::span<const GeoPoint> points, std::size_t& target, Metres radius, bool loops,
                      Current believed);

}  // namespace glidehelm::vehicle
