#pragma once

#include <functional>
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
///
/// Two flights are told apart:
///  - `fly_list`: **the list alone**, if no further file reaches the glider. Its first surfacing and its arrival are what
///    a file promises to the verifier.
///  - `fly_headings`, `fly_helm`: **a new list at each surfacing**, as long as the link holds. Every stint is flown from
///    its own dive point towards its own w_1 and then towards the second point of that list. Its surfacings are what a
///    plan promises.
/// The first stint is the same in both, up to what the few minutes after the ring of w_1 are steered to.
namespace glidehelm::vehicle {

/// What is known of the flight that a list is for. Precondition: current_correction is 0 or 1, speeds and schedule are
/// positive.
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

/// The share m of a stint that is left when the ring of its aim is crossed: 5 % with correction 0, 1 % with 1.
double usual_early_share(int current_correction);
/// The share of one stint: the usual one, or 5 % for a glider that has measured nothing yet (so that it believes in still
/// water) and is expected to meet the current `unmeasured`, stronger than a tenth of Û. A ring that is not crossed
/// because a stint was cut a little short stays the target: where dead reckoning ends far from the place that the glider
/// is really at, the next dive would turn back (docs/decisions/016).
double early_share(const model::Glider& glider, const std::optional<Current>& unmeasured);

/// An aim point and what it means for the list.
struct Aim {
  GeoPoint at;
  double length{};   ///< metres from the dive point
  bool ends_list{};  ///< never hit (believed current against h stronger than Û), or lengthened: nothing may follow
};
/// w for a heading wanted from `dive` for `seconds`. A leg shorter than max(2r, 500 m), plus the metres `drifted` since the
/// surfacing before so that it is as long for a glider that dives at once, is lengthened to that and ends the list; so does sign −1, for which the law holds h only towards a waypoint up-current. The believed current counts with
/// correction 1 only. Where g is null the wanted heading serves as its direction. With a heading bias h is the heading that the
/// glider must mean to steer, the wanted one turned back.
Aim aim_point(GeoPoint dive, Heading wanted, const model::Glider& glider, Current believed, double seconds,
              Metres radius, Metres drifted = Metres{0}, const std::optional<Current>& unmeasured = std::nullopt);

struct ListOptions {
  int max_waypoints{8};          ///< at least 1
  std::optional<Metres> radius;  ///< none: 10 % of the median leg, at least 100 m and twice the expected drift
  model::AtEnd at_end{model::AtEnd::loop};
};

/// The list for a plan's stints (in order), for the case that no further file reaches the glider.
///
///  - Correction 1: w_1 … w_7, then the goal. Correction 0: w_1, then only as many points of the way as the straight way
///    to the goal needs around land and areas (from each the farthest predicted surfacing in sight and reach), then the goal: an aim
///    point that is not hit in time would turn the next dive back. Never more than `max_waypoints`.
///  - No leg is longer than 1.09·(Û + largest current believed or drifted in so far)·t_s, those after the first than 1.00 of
///    it, so that the written file keeps product.md 7.1, and no aim point lies inside the ring of the one before: an aim point too far from the one before is
///    brought nearer to its own dive point; where even that does not do, the goal follows at once. When fix → w_1 would be too long the radius gives way, down to 100 m.
///  - A point whose ring would hold the goal is left out: the goal says the same.
///  - It ends with the first aim that ends it (`Aim::ends_list`).
///  - The goal is left out, and then the last points, as far as the list alone would else run aground or out of the
///    water with data (flown by `fly_list`): a list that goes round and round over its own points is safe for a lost call, a last
///    leg across land is not. When nothing helps the list is as above, for the verifier to refuse.
///  - When the first stint arrives: the goal alone if steering at it is how the stint was predicted, else the heading
///    that arrives, held until it does, and then the goal, with a radius of at most half the goal's, and so small that the
///    goal lies outside the ring before it.
///  - Without stints: the goal alone.
///
/// One radius for all points, in whole metres: 10 % of the median leg, at least 100 m and twice the largest predicted
/// surface drift, at most half of the first leg (a waypoint inside its own ring is hit at once). A list of the goal alone
/// takes a tenth of the way, at most half the goal's radius, so that the glider comes well inside.
model::WaypointList list_for(std::span<const Stint> stints, const Flight& flight, const Waters& waters,
                             const ListOptions& options);

/// What was flown.
struct FlownList {
  std::vector<Stint> stints;        ///< `heading` is the one at the dive
  std::optional<double> arrival_s;  ///< first entry into the goal's disc
  std::optional<Lost> lost;
  GeoPoint
      closest;  ///< the position nearest to the goal's centre, drifts included (at the ends of steps; among positions beyond 50 km: to 1 %)
};

/// Most stints of a plan.
inline constexpr int kMostStints = 2000;

/// Most stints that a list is followed for when no further file comes; no mission leaves a glider alone longer.
inline constexpr int kMostListStints = 60;

/// A list flown by the law to the goal, the horizon, `kMostListStints`, or until it is lost. Refixes at each surfacing and
/// drifts there; with correction 1 believes the mean current met in the stint before. The target outlives a surfacing.
/// The stint that arrives is flown to its end; one that is lost is part of the answer as far as it came.
FlownList fly_list(const model::WaypointList& list, const Flight& flight, const Waters& waters);

/// What happens when every surfacing brings a new list: stint k flown towards its own aim point from its own dive point,
/// then towards the next point of that list: w_2 with correction 1; with correction 0 the first ground point or the goal.
///
/// `wanted` are headings by stint; after the last of them the aim is the goal itself. In a stint that comes to the goal by
/// steering straight at it no later than by its heading, the aim is the goal too, and `Stint::heading` is the heading that
/// results. `steering_error` is the distance from where holding `Stint::heading` for the whole stint would have come up.
/// Ends at the arrival (that stint is flown to its end), before a stint that would end beyond the horizon without
/// arriving, or when lost; a stint that is lost before it arrives is not part of the answer.
FlownList fly_headings(std::span<const Heading> wanted, const Flight& flight, const Waters& waters);

/// The heading for stint k from a dive point; none: steer at the goal. Deterministic: it is asked more than once.
using Helm = std::function<std::optional<Heading>(int k, GeoPoint dive, double dive_s)>;
/// The same with headings asked for at each dive (`direct` steers so).
FlownList fly_helm(const Helm& helm, const Flight& flight, const Waters& waters);

}  // namespace glidehelm::vehicle
