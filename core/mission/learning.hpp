#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/current.hpp"
#include "core/base/geo.hpp"
#include "core/mission/error_filter.hpp"
#include "core/mission/estimate.hpp"
#include "core/mission/mission.hpp"
#include "core/mission/source_errors.hpp"
#include "core/model/surfacing.hpp"
#include "core/ocean/corrected.hpp"

namespace glidehelm::mission {

/// Angle of the glider's local frame: its y axis points this far clockwise from true north (slocum.md 4.2).
struct FrameRotation {
  Radians clockwise;
  enum class From { configured, magnetic_variation, assumed_zero, waypoint_lines } from{From::assumed_zero};
  Radians spread;  ///< standard deviation
  friend bool operator==(const FrameRotation&, const FrameRotation&) = default;
};
/// "as configured", "from m_gps_mag_var", "from the Waypoint: lines", "assumed".
std::string_view word(FrameRotation::From from);

/// UTM grid convergence at a position: the angle from true north to grid north, clockwise positive; 0 on the central
/// meridian of the position's zone. γ = atan(tan(λ − λ_zone)·sin φ). The zone is the standard 6° one.
Radians utm_convergence(GeoPoint p);

/// What one `Waypoint:` line says of the rotation: true bearing from the fix to the waypoint less (printed + 0.5)°, for
/// the glider prints the floor of the bearing in its own frame. None within a kilometre, where the drift since the fix
/// turns the bearing by degrees. Error: ±0.5° of the floor, and 60 m of drift at 2 km, 1.7°.
std::optional<Radians> rotation_by(GeoPoint fix, const model::AimLine& aim);

/// The rotation in order of trust (slocum.md 4.2): as configured; from `m_gps_mag_var` (positive west) and the
/// convergence at `origin`, r = −variation + γ, unless at least three `Waypoint:` lines disagree with it by more than 3°;
/// the median of the `Waypoint:` lines; zero. `origin` is the position of the mission's local frame, `by_waypoints` what
/// `rotation_by` gave during one mission of the glider.
///
/// Spread: 0.5° as configured; 1° by the variation (the receiver's table is years old: 9.43–9.49° where 9.2° is true);
/// of the lines' median, at least the 0.29° of the floor over the root of their number; 15° when assumed.
FrameRotation frame_rotation(std::optional<Radians> configured, std::optional<Radians> magnetic_variation,
                             GeoPoint origin, std::span<const Radians> by_waypoints = {});

/// A velocity of the local frame in true east and north: the only place where a `LocalVelocity` becomes a `Current`.
/// east = x·cos r + y·sin r, north = −x·sin r + y·cos r (slocum.md 4.2).
Current true_current(model::LocalVelocity local, Radians rotation);
/// The inverse: what a glider with that rotation prints for a true current.
model::LocalVelocity local_velocity(Current current, Radians rotation);

/// A depth-averaged current as the glider measured it, in true east and north, and how far it is known.
struct MeasuredCurrent {
  Current current;
  MetresPerSecond spread;  ///< standard deviation of each component
  bool final_value{};      ///< after the surface drift was known; else the initial value (slocum.md 4.3)
  friend bool operator==(const MeasuredCurrent&, const MeasuredCurrent&) = default;
};
/// The printed current with its uncertainty: 0.01 m/s of the final value (a fix's 30 m and the drift before it, over a
/// dive of hours), 0.05 m/s of an initial one, and the rotation's spread times the speed. None when it was not printed,
/// is not finite, or is faster than the firmware lets through (2.8 m/s, slocum.md S7).
std::optional<MeasuredCurrent> measured_current(const model::Surfacing& surfacing, const FrameRotation& rotation);

/// The depth-averaged current that the glider itself believes in its next stint, in the true frame: what it printed last.
/// Also nonsense counts here (the first value after a deployment), because the glider will steer by it.
std::optional<Current> believed_current(const model::Surfacing& surfacing, Radians rotation);

/// A dive under way or just flown, as far as the shore knows it.
struct Dive {
  GeoPoint from;       ///< where it began: the fix before and the drift that the plan predicted
  double from_s{};     ///< epoch second
  bool drift_known{};  ///< false: no plan said how it drifts, `from` is the fix before
  friend bool operator==(const Dive&, const Dive&) = default;
};

/// All that is known of one surfacing so far; later blocks add to it.
struct SurfacingSeen {
  model::Surfacing at;               ///< newest block; values that only an earlier block had are kept
  std::vector<model::AimLine> aims;  ///< of its `Waypoint:` lines, each waypoint once, with …
  std::vector<GeoPoint> aims_from;   ///< … the fix of the block that had it
  std::optional<Current> forecast;   ///< uncorrected forecast, mean along `dive`; none: not known
  std::vector<SourceShare> shares;   ///< of its sources at the middle of the dive
  bool extrapolated{};               ///< a value was borrowed there
  // the time before it
  std::optional<model::Surfacing> before;  ///< the last surfacing
  std::optional<Instant> dive_said;        ///< when the dialog said that the glider goes under
  std::optional<Dive> dive;
};

/// What plan, watch and margins use, each with its standard deviation.
struct Learned {
  MetresPerSecond speed, speed_spread;        ///< U, horizontal through water
  MetresPerSecond believed_speed;             ///< Û where the dialog does not print m_avg_speed
  Radians heading_bias, heading_bias_spread;  ///< true heading less the glider's, clockwise
  Seconds stint{}, stint_spread{};
  Seconds surface{}, surface_spread{};  ///< from the printed fix to the dive
  FrameRotation rotation;
  std::optional<MeasuredCurrent> water;  ///< of the dive just flown, none that is not trusted
  std::optional<ocean::LocalCorrection> correction;
  SourceErrors source_errors;             ///< how far off each source of currents is
  MetresPerSecond forecast_spread{0.10};  ///< of the uncorrected forecast where the glider is, per component
  friend bool operator==(const Learned&, const Learned&) = default;
};

/// What surfacings teach (product.md 4.3). A value: two that saw the same are equal, and a journal's events give the same
/// numbers again.
///
///  - **Times.** The dialog says when the glider resumes its mission; it waits up to a minute for a fix after that
///    (slocum.md 4.6), and its fix is taken about a minute after it came up. So surface = resumed + 60 s − fix,
///    stint = next fix − 60 s − dive, both exact to about a minute, 1 % of a stint of two hours. `Estimate` keeps them.
///    A dive whose begin nobody heard has the learned surface interval before it. Surfacings with a segment missed in
///    between teach no times.
///  - **Speed and heading bias**, and the **error of the forecast**. Over ground a glider moves with v = Û·ĥ + DAC: that
///    is how it makes its DAC, so v − DAC is where it believes to have headed. Then v − forecast − U0·ĥ is what
///    `ErrorFilter` takes apart.
///  - **How far off each source is**: measured less forecast, with the shares of the sources (`SourceErrors`).
///  - **Believed speed**: the length of v − DAC, where the dialog does not print it.
///  - **Rotation**: `frame_rotation` over one mission of the glider.
///
/// A new mission of the glider (another number, or another file) has another local frame, so the rotation is learned
/// anew, and its first DAC is not used for learning: it may be nonsense of a deployment (slocum.md 4.3). An initial DAC
/// counts with its larger spread until the final one is printed; one that is equal to the last surfacing's to the bit was
/// not measured anew.
class Learning {
 public:
  Learning() = default;

  /// First guesses and switches of a mission; what was learned stays where they are the same.
  void configure(const Mission& mission);
  /// The same mission in other water: its first guesses of speed and stint move, and what surfacings have shown stays.
  void follow_water(const Mission& mission);
  /// A surfacing. To take more of the same surfacing, take it again with a copy from before it.
  void see(const SurfacingSeen& seen);
  [[nodiscard]] Learned learned() const;
  /// `Waypoint:` lines that disagree with the configured rotation by more than 3°: what they say.
  [[nodiscard]] std::optional<Radians> contradicted() const;
  friend bool operator==(const Learning&, const Learning&) = default;

 private:
  /// What configuration says.
  struct Guesses {
    double speed{}, stint{}, surface{};
    std::optional<Radians> rotation;
    bool correct{true};
    double length{}, time{};
    friend bool operator==(const Guesses&, const Guesses&) = default;
  };
  static Guesses guesses_of(const Mission& mission);
  void begin_mission(const model::Surfacing& s);
  void see_rotation(const SurfacingSeen& seen);
  [[nodiscard]] std::optional<double> see_times(const SurfacingSeen& seen);
  void see_dive(const SurfacingSeen& seen, double dive_time);

  Guesses guesses_;
  Estimate stint_, surface_, believed_;
  ErrorFilter errors_;
  SourceErrors sources_;
  std::vector<SourceShare> shares_;  ///< of the last dive
  bool extrapolated_{};
  // of one mission of the glider
  std::string mission_, number_;
  std::optional<GeoPoint> origin_;
  std::vector<Radians> by_waypoints_;
  std::optional<Radians> variation_;
  FrameRotation rotation_;
  std::optional<MeasuredCurrent> water_;
  bool first_{true};  ///< no surfacing of this mission was seen before the last one
};

}  // namespace glidehelm::mission
