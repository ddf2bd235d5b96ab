#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/geo.hpp"
#include "core/model/dive_schedule.hpp"
#include "core/model/glider.hpp"
#include "core/model/waypoint_list.hpp"
#include "core/ocean/field.hpp"

namespace glidehelm::safety {

/// A list to fly, as the glider would, if no further file reaches it.
struct FlightOrder {
  std::vector<GeoPoint> points;  ///< at least one
  Metres radius;
  model::AtEnd at_end{model::AtEnd::loop};
  model::Glider glider;
  model::DiveSchedule schedule;
  std::optional<Current> believed_current;  ///< of the first stint, with correction 1; none: still water
  GeoPoint fix;
  double fix_s{}, horizon_s{};  ///< epoch seconds
  GeoPoint goal;
  Metres goal_radius;
};

/// One position of the true track. The longitude runs on across the antimeridian.
struct TrackPoint {
  double lat{}, lon{};  ///< radians
  double t_s{};         ///< epoch second
  int stint{};          ///< the stint flown, or the one that the drift leads to
  bool drifting{};      ///< on the surface
  [[nodiscard]] GeoPoint at() const { return GeoPoint::from_kernel(lat, lon); }
};

struct StintFlown {
  GeoPoint dived, surfaced;
  double dived_s{}, surfaced_s{};
  Current believed;  ///< ĉ during the stint
  Current met;       ///< mean of the true current over the stint
  Current drift;     ///< mean surface current of the drift before it
};

/// Why a flight ended.
enum class FlightEnd { horizon, stints, list_finished, land, no_data, outside_area, outside_time, not_finite };
std::string_view word(FlightEnd end);

struct Flight {
  std::vector<TrackPoint> track;   ///< from the fix; neighbours at most 60 s apart
  std::vector<StintFlown> stints;  ///< completed ones
  std::optional<double>
      arrival_s;                ///< first entry into the goal radius, in a stint or a drift; fix_s when inside already
  std::size_t arrival_index{};  ///< first track point at or after the arrival; track.size() without one
  FlightEnd end{FlightEnd::horizon};
  double fastest_current{};  ///< m/s, largest current sampled
  double farthest_target{};  ///< m, largest distance to the waypoint steered to
};

/// Most stints that a list is flown for.
inline constexpr int kMostStints = 60;
/// Longest step of the integrator. On a circle of period P the midpoint rule lags by (2π·dt/P)²/6 of the way: 60 s in an
/// eddy that turns within 6 h, sharper than any forecast holds, cost 5e-5; the yo of a 200 m dive is sampled every 9 m.
/// At 5 m/s, the largest current that is not refused, neighbours are 320 m apart, at 3.5 m/s 228 m: a track point every
/// 250 m wherever the ocean is plausible.
inline constexpr double kStep = 60.0;

/// Flies the list by the law of product.md 6 ("From headings to waypoints"), written here a second time on purpose:
///
///  - Drift on the surface for `drift_before(k)` with the current at depth 0, then dive for `stint_length(k)`.
///  - Under water the true position moves with U·h' + c at the depth of the yo (`yo_depth`), h' being h turned by the
///    heading bias; the dead-reckoned one starts at the true dive point and moves with Û·h + ĉ. Heading h = bearing − asin(cross/Û), where the bearing is the
///    geodesic's at the dead-reckoned position and cross the part of ĉ to the right of it; |cross| ≥ Û steers square.
///  - A waypoint is hit when the dead-reckoned distance falls below `radius`; the next one follows, after the last the
///    first (loop), or the flight ends (wait: heading idle). A list of one point keeps steering to it. The instant is
///    the crossing of the ring by the straight step, so no step jumps over it. The target outlives a surfacing.
///  - ĉ is 0 with correction 0; with correction 1 it is `believed_current`, then the mean current met in the stint
///  before.
///  - A field of two dimensions ignores the depth; below the bottom the deepest value above it counts. Anything else
///    that is no current ends the flight where the step began.
///
/// Positions step with the WGS84 radii at the middle of each step (core/base/local_metric). The flight goes on after
/// the goal: what follows an arrival is for the caller to judge. Two samples and two geodesics per step: about 5 µs.
/// Precondition: all numbers finite, speeds and schedule positive, correction 0 or 1 (rules.hpp checks "0 dossier").
Flight fly(const FlightOrder& order, ocean::FieldRef full);

/// Depth at `since_dive` of a stint of `length`: from the surface down to dive_depth, between climb_to and dive_depth
/// in straight lines, and up again so that the stint ends at the surface. Vertical speed U·tan(glide angle).
double yo_depth(const model::Glider& glider, double since_dive, double length);

/// Heading through water, radians clockwise from north, for a bearing and a believed current.
double steered_heading(double bearing, Current believed, double believed_speed);

}  // namespace glidehelm::safety
