#include "core/mission/learning.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/local_metric.hpp"
#include "core/base/text.hpp"

namespace glidehelm::mission {

namespace {

constexpr double kFastestBelieved = 2.8;  // m/s: u_max_water_speed, the firmware clips here
constexpr double kNearest = 1000.0;       // m: `Waypoint:` lines within it say nothing of the rotation
constexpr double kDisagrees = 3.0;        // degrees
constexpr std::size_t kLinesDecide = 3;   // so many lines overrule the magnetic variation
constexpr std::size_t kMostLines = 31;    // kept; the median of them is good to 0.1°
constexpr double kFinalSpread = 0.01, kInitialSpread = 0.05;  // m/s
constexpr double kForecastSpread = 0.02;          // m/s: a straight line is not the way flown, and a grid has cells
constexpr double kUnknownDrift = 0.03;            // m/s: a quarter of an hour at 0.4 m/s over a dive of four hours
constexpr double kPostFix = 60.0, kToFix = 60.0;  // s: resumed to dive, surfaced to fix
constexpr double kGuessedTimes = 0.10;            // of the stint: spread of a configured length (product.md 4.3)
constexpr double kTimesFloor = 60.0;              // s: what the dialog does not show
constexpr double kSpeedGuess = 0.10;              // of the configured speed
constexpr double kBelievedFloor = 0.005;          // m/s
constexpr double kBiasGuess = 5.0;                // degrees
constexpr double kForecastError = 0.10;           // m/s
constexpr double kShortestDive = 600.0;           // s

/// SSSS of `MMMM.SSSS`.
std::optional<int> segment_number(const std::string& segment) {
  const auto dot = segment.find('.');
  if (dot == std::string::npos) return std::nullopt;
  int number = 0;
  const char* begin = segment.data() + dot + 1;
  const char* end = segment.data() + segment.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

std::string mission_number(const std::string& segment) { return segment.substr(0, segment.find('.')); }

struct Vector {
  double east{}, north{};
  [[nodiscard]] double length() const { return std::hypot(east, north); }
};

}  // namespace

std::string_view word(FrameRotation::From from) {
  switch (from) {
    case FrameRotation::From::configured:
      return "as configured";
    case FrameRotation::From::magnetic_variation:
      return "from m_gps_mag_var";
    case FrameRotation::From::waypoint_lines:
      return "from the Waypoint: lines";
    case FrameRotation::From::assumed_zero:
      break;
  }
  return "assumed";
}

Radians utm_convergence(GeoPoint p) {
  const double zone = std::floor((p.lon.degrees() + 180.0) / 6.0);
  const double central = degrees(zone * 6.0 - 180.0 + 3.0).si();
  return Radians{std::atan(std::tan(p.lon.radians() - central) * std::sin(p.lat.radians()))};
}

std::optional<Radians> rotation_by(GeoPoint fix, const model::AimLine& aim) {
  const auto way = geodesic(fix, aim.at);
  if (way.length.si() <= kNearest || !(aim.range.si() > kNearest) || !std::isfinite(aim.bearing_deg))
    return std::nullopt;
  return wrapped(way.departing.from_north() - degrees(aim.bearing_deg + 0.5));
}

FrameRotation frame_rotation(std::optional<Radians> configured, std::optional<Radians> magnetic_variation,
                             GeoPoint origin, std::span<const Radians> by_waypoints) {
  using From = FrameRotation::From;
  if (configured) return {*configured, From::configured, degrees(0.5)};
  std::optional<FrameRotation> lines;
  if (!by_waypoints.empty()) {
    // Around the first one, so that no rotation lies at the cut of the circle.
    std::vector<double> turned, off;
    for (const auto& r : by_waypoints) turned.push_back(wrapped(r - by_waypoints.front()).si());
    const double middle = median_of(turned);
    for (const double t : turned) off.push_back(std::abs(t - middle));
    const double n = static_cast<double>(by_waypoints.size());
    const double of_one = by_waypoints.size() < kLinesDecide ? degrees(1.5).si() : 1.4826 * median_of(off);
    const double spread = std::max(degrees(0.29).si(), of_one) / std::sqrt(n);
    lines = FrameRotation{wrapped(by_waypoints.front() + Radians{middle}), From::waypoint_lines, Radians{spread}};
  }
  if (magnetic_variation && std::isfinite(magnetic_variation->si())) {
    const Radians r = wrapped(utm_convergence(origin) - *magnetic_variation);
    const bool disagree = lines && by_waypoints.size() >= kLinesDecide &&
                          std::abs(in_degrees(wrapped(lines->clockwise - r))) > kDisagrees;
    if (!disagree) return {r, From::magnetic_variation, degrees(1.0)};
  }
  return lines.value_or(FrameRotation{Radians{0.0}, From::assumed_zero, degrees(15.0)});
}

Current true_current(model::LocalVelocity local, Radians rotation) {
  const double c = std::cos(rotation.si()), s = std::sin(rotation.si());
  return {MetresPerSecond{local.x.si() * c + local.y.si() * s}, MetresPerSecond{-local.x.si() * s + local.y.si() * c}};
}

model::LocalVelocity local_velocity(Current current, Radians rotation) {
  const double c = std::cos(rotation.si()), s = std::sin(rotation.si());
  return {MetresPerSecond{current.east.si() * c - current.north.si() * s},
          MetresPerSecond{current.east.si() * s + current.north.si() * c}};
}

std::optional<MeasuredCurrent> measured_current(const model::Surfacing& surfacing, const FrameRotation& rotation) {
  const auto current = believed_current(surfacing, rotation.clockwise);
  if (!current) return std::nullopt;
  const double own = surfacing.water_is_final ? kFinalSpread : kInitialSpread;
  return MeasuredCurrent{*current, MetresPerSecond{std::hypot(own, current->speed().si() * rotation.spread.si())},
                         surfacing.water_is_final};
}

std::optional<Current> believed_current(const model::Surfacing& surfacing, Radians rotation) {
  if (!surfacing.water) return std::nullopt;
  const double speed = std::hypot(surfacing.water->x.si(), surfacing.water->y.si());
  if (!(speed <= kFastestBelieved)) return std::nullopt;
  return true_current(*surfacing.water, rotation);
}

// ---- Learning -------------------------------------------------------------------------------------------------------

Learning::Guesses Learning::guesses_of(const Mission& m) {
  return {m.horizontal_speed.si(),
          m.stint.count(),
          m.surface.count(),
          m.frame_rotation,
          m.currents.local_correction,
          m.currents.correction_length.si(),
          m.currents.correction_time.count()};
}

void Learning::configure(const Mission& m) {
  const Guesses was = guesses_;
  guesses_ = guesses_of(m);
  if (guesses_.stint != was.stint) stint_ = Estimate{guesses_.stint, kGuessedTimes * guesses_.stint, kTimesFloor};
  if (guesses_.surface != was.surface)
    surface_ = Estimate{guesses_.surface, std::max(kTimesFloor, 0.2 * guesses_.surface), kTimesFloor};
  if (guesses_.speed != was.speed) believed_ = Estimate{guesses_.speed, kSpeedGuess * guesses_.speed, kBelievedFloor};
  const ErrorFilter::Setup setup{guesses_.speed,           kSpeedGuess * guesses_.speed,
                                 degrees(kBiasGuess).si(), kForecastError,
                                 guesses_.length,          guesses_.time};
  if (!(errors_.setup() == setup)) errors_ = ErrorFilter{setup};
}

void Learning::follow_water(const Mission& m) {
  guesses_ = guesses_of(m);
  stint_.guess(guesses_.stint);
  believed_.guess(guesses_.speed);
  errors_.move_guess(guesses_.speed, kSpeedGuess * guesses_.speed);
}

/// A name or number once known is another one only when another one is printed: a connection block prints neither.
void Learning::begin_mission(const model::Surfacing& s) {
  const bool other_file = !s.mission.empty() && !mission_.empty() && !equal_without_case(s.mission, mission_);
  const bool other_number = !s.segment.empty() && !number_.empty() && mission_number(s.segment) != number_;
  if (other_file || other_number) {
    origin_.reset();
    by_waypoints_.clear();
    variation_.reset();
  }
  first_ = !origin_.has_value();
  if (!origin_) origin_ = s.fix;
  if (!s.mission.empty()) mission_ = s.mission;
  if (!s.segment.empty()) number_ = mission_number(s.segment);
}

void Learning::see_rotation(const SurfacingSeen& seen) {
  if (seen.at.magnetic_variation) variation_ = seen.at.magnetic_variation;
  for (std::size_t i = 0; i < seen.aims.size() && i < seen.aims_from.size(); ++i)
    if (const auto r = rotation_by(seen.aims_from[i], seen.aims[i])) by_waypoints_.push_back(*r);
  if (by_waypoints_.size() > kMostLines)
    by_waypoints_.erase(by_waypoints_.begin(), by_waypoints_.end() - static_cast<std::ptrdiff_t>(kMostLines));
  rotation_ = frame_rotation(guesses_.rotation, variation_, *origin_, by_waypoints_);
}

/// Stint and surface interval; gives the time under water of a dive that may teach more.
std::optional<double> Learning::see_times(const SurfacingSeen& seen) {
  if (!seen.before || first_) return std::nullopt;
  const auto before = segment_number(seen.before->segment), now = segment_number(seen.at.segment);
  if (before && now && *now != *before + 1) return std::nullopt;
  const double fixes = between(seen.before->fix_taken, seen.at.fix_taken).count();
  const bool heard = seen.dive_said.has_value();
  const double surface = heard ? between(seen.before->fix_taken, *seen.dive_said).count() + kPostFix : surface_.value();
  const double stint = fixes - surface - kToFix;
  if (stint < kShortestDive || (!(before && now) && stint > 1.7 * stint_.value())) return std::nullopt;
  if (heard) surface_.see(surface);
  stint_.see(stint);
  return stint;
}

void Learning::see_dive(const SurfacingSeen& seen, double dive_time) {
  if (!water_ || !seen.dive) return;
  if (seen.before && seen.before->water && seen.at.water == seen.before->water) return;  // not measured anew
  const auto& from = seen.dive->from;
  const auto moved =
      local_offset(from.lat.radians(), from.lon.radians(), seen.at.fix.lat.radians(), seen.at.fix.lon.radians());
  const double time = dive_time + kToFix;
  const Vector ground{moved.east / time, moved.north / time};
  const Vector headed{ground.east - water_->current.east.si(), ground.north - water_->current.north.si()};
  const double believed = seen.at.believed_speed ? seen.at.believed_speed->si() : believed_.value();
  // A glider cannot believe to have swum faster than it swims: fix, current or drift are wrong.
  if (!(headed.length() <= 1.25 * believed)) return;
  if (!seen.at.believed_speed && headed.length() >= 0.75 * believed) believed_.see(headed.length());
  if (!seen.forecast) return;
  DiveResidual dive;
  dive.at = GeoPoint::from_kernel(
      0.5 * (from.lat.radians() + seen.at.fix.lat.radians()),
      from.lon.radians() + 0.5 * std::remainder(seen.at.fix.lon.radians() - from.lon.radians(), 2 * kPi));
  dive.at_s = epoch_seconds(seen.at.fix_taken) - 0.5 * time;
  dive.heading_east = headed.east / believed;
  dive.heading_north = headed.north / believed;
  dive.east = ground.east - seen.forecast->east.si() - guesses_.speed * dive.heading_east;
  dive.north = ground.north - seen.forecast->north.si() - guesses_.speed * dive.heading_north;
  dive.spread =
      std::hypot(water_->spread.si(), std::hypot(kForecastSpread, seen.dive->drift_known ? 0 : kUnknownDrift));
  errors_.see(dive);
  sources_.see({dive.at, dive.at_s, water_->current.east.si() - seen.forecast->east.si(),
                water_->current.north.si() - seen.forecast->north.si(), water_->spread.si(), seen.shares,
                seen.extrapolated});
  shares_ = seen.shares;
  extrapolated_ = seen.extrapolated;
}

void Learning::see(const SurfacingSeen& seen) {
  begin_mission(seen.at);
  see_rotation(seen);
  water_ = measured_current(seen.at, rotation_);
  if (first_) water_.reset();
  const auto dive_time = see_times(seen);
  if (dive_time) see_dive(seen, *dive_time);
}

Learned Learning::learned() const {
  Learned l;
  l.speed = MetresPerSecond{guesses_.speed + errors_.speed_error()};
  l.speed_spread = MetresPerSecond{errors_.speed_spread()};
  l.believed_speed = MetresPerSecond{believed_.value()};
  l.heading_bias = Radians{errors_.bias()};
  l.heading_bias_spread = Radians{errors_.bias_spread()};
  l.stint = Seconds{stint_.value()};
  l.stint_spread = Seconds{stint_.spread()};
  l.surface = Seconds{surface_.value()};
  l.surface_spread = Seconds{surface_.spread()};
  l.rotation = rotation_;
  l.water = water_;
  l.source_errors = sources_;
  l.forecast_spread = sources_.spread(shares_, extrapolated_);
  if (guesses_.correct && errors_.seen() > 0) {
    ocean::LocalCorrection c;
    c.at = errors_.at();
    c.at_s = errors_.at_s();
    c.added = errors_.error();
    c.spread = MetresPerSecond{errors_.error_spread()};
    c.length = Metres{guesses_.length};
    c.time = Seconds{guesses_.time};
    const double strongest = 0.999 * ocean::LocalCorrection::kStrongest, speed = c.added.speed().si();
    if (speed > strongest) c.added = {strongest / speed * c.added.east, strongest / speed * c.added.north};
    l.correction = c;
  }
  return l;
}

std::optional<Radians> Learning::contradicted() const {
  if (!guesses_.rotation || by_waypoints_.size() < kLinesDecide || !origin_) return std::nullopt;
  const auto lines = frame_rotation(std::nullopt, std::nullopt, *origin_, by_waypoints_);
  if (std::abs(in_degrees(wrapped(lines.clockwise - *guesses_.rotation))) <= kDisagrees) return std::nullopt;
  return lines.clockwise;
}

}  // namespace glidehelm::mission
