#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/model/dive_schedule.hpp"
#include "core/model/glider.hpp"
#include "core/model/waypoint_list.hpp"
#include "core/vehicle/motion.hpp"

/// Headings to waypoints and back (product.md 6, "From headings to waypoints"; slocum.md 4.4–4.5).
///
/// The glider does not fly headings. It dead-reckons from its dive point with the speed Û and the current ĉ that it
/// believes, and steers to the current waypoint by heading = bearing − asin(cross/Û) until the dead-reckoned distance is
/// below the list's radius r. So a heading h is flown by aiming along g = Û·h + ĉ:
///
///     w = d + sign(h·g) · g/|g| · ((1 − m)·|g|·t + r)
///
/// Its ring is crossed at (1 − m)·t of the stint; the rest is flown towards the next waypoint.
namespace glidehelm::vehicle {

/// What is known of the flight that a list is for.
struct Flight {
  model::Glider glider;
  model::DiveSchedule schedule;
  GeoPoint fix;
  double fix_s{};  ///< epoch second of the fix
  std::optional<Current>
      believed_current;  ///< ĉ of the first stint with correction 1: the measured DAC; none: still water
  Disc goal;
  double horizon_s{};  ///< epoch second beyond which nothing is flown
};

/// The unflown share m of a stint at whose beginning the ring is crossed early: 1 % with correction 1, 5 % with 0.
double early_share(int current_correction);

/// An aim point and what it means for the list.
struct Aim {
  GeoPoint at;
  double length{};   ///< metres from the dive point
  bool ends_list{};  ///< never hit (believed current against h stronger than Û), or lengthened: nothing may follow
};
/// w for a heading wanted from `dive` for `seconds`. A leg shorter than max(2r, 500 m) is lengthened to that and ends the
/// list; so does sign −1, for which the law holds h only towards a waypoint up-current.
Aim aim_point(GeoPoint dive, Heading wanted, const model::Glider& glider, Current believed, double seconds,
              Metres radius);

struct ListOptions {
  int max_waypoints{8};
  std::optional<Metres> radius;  ///< none: 10 % of the median leg, at least 100 m and twice the expected drift
  model::AtEnd at_end{model::AtEnd::loop};
};

/// The list for a plan's headings, for the case that no further file reaches the glider: with correction 1 aim points,
/// then the goal; with correction 0 the first aim point, then only as many points of the way as the straight way to the
/// goal needs around land and areas, then the goal (an aim point that is not hit in time would turn the next dive back).
/// `stints` are those of a plan in order; the list is the goal alone when the first of them arrives by steering there, or when
/// there are none.
model::WaypointList list_for(std::span<const Stint> stints, const Flight& flight, const Waters& waters,
                             const ListOptions& options);

/// A list flown by the law to its end, or to the goal, the horizon, 200 stints, or until it is lost.
struct FlownList {
  std::vector<Stint> stints;        ///< `heading` is the one at the dive
  std::optional<double> arrival_s;  ///< first entry into the goal's disc
  std::optional<Lost> lost;
};
/// Refixes at each surfacing and drifts there; with correction 1 believes the DAC met in the stint before. The
/// integrator is the midpoint rule with steps of at most 120 s: positions agree with the verifier's own to a few metres per stint.
FlownList fly_list(const model::WaypointList& list, const Flight& flight, const Waters& waters);

/// What happens when every surfacing brings a new list: stint k flown towards its own aim point from its own dive
/// point, then towards the next. This is what a plan promises for its stints.
///
/// `wanted` are headings by stint. After the last of them, and in a stint that comes to the goal by steering straight to
/// it, the aim is the goal itself. Ends at the arrival (that stint is flown to its end), the horizon, or when lost.
FlownList fly_headings(std::span<const Heading> wanted, const Flight& flight, const Waters& waters);

/// The heading for stint k from a dive point; none ends the flight.
using Helm = std::function<std::optional<Heading>(int k, GeoPoint dive, double dive_s)>;
/// The same with headings asked for at each dive (`direct` steers so).
FlownList fly_helm(const Helm& helm, const Flight& flight, const Waters& waters);

}  // namespace glidehelm::vehicle
