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

/// What a vehicle moves in. References must outlive it.
struct Waters {
  ocean::Ocean ocean;
  const chart::Chart& chart;
  Metres margin;  ///< clearance that the track keeps; a start inside it may only move outwards
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

/// One motion: a stint of constant heading, or a drift.
struct Motion {
  State end;  ///< where it ended, early when lost
  std::optional<Lost> lost;
  std::optional<double> arrival_s;  ///< first instant inside the disc
  double closest{1e18};             ///< metres, smallest distance to the disc's centre at the steps
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
/// dx/dt = velocity through water + current(x, t), for `duration` seconds, in `field`.
///
/// Classical Runge–Kutta steps, each compared with two of half its length; the step is halved until they agree within
/// 0.02 m (10 s at least) and doubled when they agree eight times better (20 min at most). So a stint of 8 h keeps within about
/// 1 m of the exact solution where the field is smooth; at the kinks of a bilinear field the small steps bound the error likewise.
/// The crossing of the disc is found inside its step to 0.1 s by flying shorter steps from the step's beginning; a track that
/// only touches the disc for less than a step is found too. Land: every step's segment keeps the margin in force.
Motion move(const Waters& waters, ocean::FieldRef field, State from, double duration, WaterVelocity through_water,
            const Disc* goal);

/// Distance in metres from a position to the centre of a disc: the local metric where that is exact to 1e-4 (50 km), a
/// lower bound beyond. For inner loops.
double distance_near(double lat, double lon, const Disc& disc);

/// Length of a Runge–Kutta step (seconds, a whole fraction of `stint`) with which lanes may be flown: the longest of
/// stint/⌈stint/1 h⌉, halved until probes from nine places between `from` and `to`, on four headings, end within `tolerance` of their
/// way from where half the step ends them. 1 h gives 32 evaluations for a stint of 8 h. Deterministic.
double lane_step(const ocean::Ocean& ocean, GeoPoint from, GeoPoint to, double t_s, double stint, MetresPerSecond speed,
                 double tolerance = 1e-3);

}  // namespace glidehelm::vehicle
