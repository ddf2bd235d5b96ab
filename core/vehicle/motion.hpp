#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "core/base/geo.hpp"
#include "core/base/local_metric.hpp"
#include "core/chart/chart.hpp"
#include "core/ocean/field.hpp"

/// How a glider moves: stints, drifts, steering.
namespace glidehelm::vehicle {

/// One underwater segment of a plan: a heading wanted from the dive to the surfacing, and where that leads.
struct Stint {
  GeoPoint dive, surface;
  double dive_s{}, surface_s{};  ///< epoch seconds
  Heading heading;               ///< through water
  Current dac;                   ///< mean of the current met on the way (time-weighted)
  bool arrives{};                ///< the goal radius is crossed inside this stint or in the drift after it
  Metres steering_error;         ///< surfacing of the held heading − surfacing of the list flown by the glider's law
  friend bool operator==(const Stint&, const Stint&) = default;
};

/// Why a motion did not reach its end.
enum class Lost { aground, left_area, left_forecast, no_data };
std::string_view word(Lost reason);
Lost lost_by(ocean::NoCurrent reason);

/// What a vehicle moves in. The chart must outlive it, and so must the fields behind the ocean.
struct Waters {
  ocean::Ocean ocean;
  const chart::Chart& chart;
  Metres margin;  ///< clearance that the track keeps; a start inside it may only move outwards
  /// The currents with their depths: a dive by the law is then flown along its yo-yo (yo.hpp). None: in `ocean.dive`.
  std::optional<ocean::FieldRef> full{};
};

/// A disc to arrive in.
struct Disc {
  GeoPoint centre;
  Metres radius;
};

/// A position of an integrator. The longitude runs on across the antimeridian.
struct State {
  double lat{}, lon{};  ///< radians
  double t_s{};         ///< epoch seconds
  double margin{};      ///< metres of clearance in force: below the wanted one while the start was inside it
  [[nodiscard]] GeoPoint at() const { return GeoPoint::from_kernel(lat, lon); }
};
/// A state at a position, with the margin that can be kept from there.
State state_at(GeoPoint p, double t_s, const Waters& waters);
/// The margin in force after a step from where `before` was: what clearance there is (less a metre of slack for
/// rounding), up to the wanted margin, never less than before.
double gained_margin(const State& there, double before, const Waters& waters);

/// One motion: a stint of constant heading, or a drift.
struct Motion {
  State end;  ///< where it ended, early when lost
  std::optional<Lost> lost;
  std::optional<double> arrival_s;  ///< first instant inside the disc
  double closest{1e18};             ///< metres, smallest distance to the disc's centre at the steps
  State closest_at;                 ///< where that was
  Current mean;                     ///< of the current met
};

/// Velocity through water, m/s; zero drifts.
struct WaterVelocity {
  double east{}, north{};
  static WaterVelocity of(Heading heading, MetresPerSecond speed) {
    return {speed.si() * heading.east(), speed.si() * heading.north()};
  }
};

/// The unconstrained motion model (Thesis 2.2.2.1, eqs. 2.1–2.4; azimuths clockwise from north, see the errata):
/// dx/dt = velocity through water + current(x, t), for `duration` seconds, in `field`. Zero water velocity is a drift.
///
/// Classical Runge–Kutta steps, each compared with two of half its length, which are the ones that count. The step is
/// halved until they agree within 0.02 m (10 s at least) and doubled when they agree eight times better (20 min at
/// most). The method has order 4, so the two halves are about fifteen times nearer to the truth than the difference
/// says, and a stint of 8 h (24 steps of 20 min) ends within 0.1 m of the exact solution where the field is smooth. At
/// the kinks of a bilinear field the order drops, the step falls until the difference is small again, and the bound is
/// that of the steps that straddle a kink: some 0.02 m each.
///
/// Arrival is the first instant inside the disc: looked for on every step and then located inside it to 0.05 s by
/// bisection on the length of a step from the same beginning, with distances exact to 0.01 % (geodesic beyond 50 km). A
/// track that only grazes the disc within a step is found to an eighth of a step.
///
/// Land: every step's segment keeps the margin in force, shorter steps are tried before the motion is called aground. A
/// start inside the margin keeps what clearance it has and may only gain.
///
/// Ends early with `lost` at the last position that was proven good. About 12 current evaluations per step.
Motion move(const Waters& waters, ocean::FieldRef field, State from, double duration, WaterVelocity through_water,
            const Disc* goal);

/// GoalDistance::near (goal_distance.hpp), for those who ask once.
double distance_near(double lat, double lon, const Disc& disc);

/// Where the straight line between two positions enters a disc, as a fraction of the way: 0 when it begins inside, none
/// when it does not come in. For steps that are short against the Earth.
std::optional<double> entry_into(const Disc& disc, double lat0, double lon0, double lat1, double lon1);
/// The same of a way in metres whose ends are `before` and `after` metres from the centre, as GoalDistance::near tells them: where it tells too
/// little of both, a way is looked at for nothing.
std::optional<double> entry_into(Metres disc_radius, double before, double after, const Offset& way);

/// Length in seconds of the Runge–Kutta step with which lanes may be flown: a whole fraction of `stint`, the longest of
/// stint/⌈stint/1 h⌉, halved until it is good enough, 5 min at least.
///
/// Good enough: probes on four headings from nine places between `from` and `to`, each at the time when a glider in still
/// water would be there, end within `tolerance` of their way from where half the step ends them. The default, one
/// thousandth of the way per stint, is a tenth of what merging in cells costs. One hour gives 32 evaluations for a stint of 8 h.
/// Deterministic; some 3500 evaluations.
double lane_step(const ocean::Ocean& ocean, GeoPoint from, GeoPoint to, double t_s, double stint, MetresPerSecond speed,
                 double tolerance = 1e-3);

}  // namespace glidehelm::vehicle
