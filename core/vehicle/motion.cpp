#include "core/vehicle/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace glidehelm::vehicle {

namespace {

constexpr double kStepTolerance = 0.02;  // metres per step
constexpr double kLongestStep = 1200.0, kShortestStep = 10.0;
constexpr double kCrossing = 0.05;  // seconds
constexpr double kNear = 50'000.0;  // metres: where the local metric is exact enough

/// One Runge–Kutta step of one lane.
struct Stepper {
  ocean::FieldRef field;
  WaterVelocity through_water;
  ocean::Lanes lanes{};

  Stepper(ocean::FieldRef f, WaterVelocity v) : field{f}, through_water{v} {
    lanes.count = 1;
    lanes.water_east[0] = v.east;
    lanes.water_north[0] = v.north;
  }
  /// False when a stage has no current; `lanes.lost[0]` says why.
  bool step(State& s, double dt) {
    lanes.lat[0] = s.lat;
    lanes.lon[0] = s.lon;
    lanes.lost[0] = 0;
    field.advance(lanes, s.t_s, dt);
    if (lanes.lost[0] != 0) return false;
    s.lat = lanes.lat[0];
    s.lon = lanes.lon[0];
    s.t_s += dt;
    return true;
  }
};

double gap(const State& a, const State& b) { return local_offset(a.lat, a.lon, b.lat, b.lon).length(); }

/// Smallest distance from the disc's centre to the straight segment between two states.
double closest_on(const State& a, const State& b, const Disc& disc) {
  const auto to_a = local_offset(disc.centre.lat.radians(), disc.centre.lon.radians(), a.lat, a.lon);
  const auto to_b = local_offset(disc.centre.lat.radians(), disc.centre.lon.radians(), b.lat, b.lon);
  const double de = to_b.east - to_a.east, dn = to_b.north - to_a.north;
  const double length2 = de * de + dn * dn;
  const double f = length2 > 0 ? std::clamp(-(to_a.east * de + to_a.north * dn) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(to_a.east + f * de, to_a.north + f * dn);
}

}  // namespace

std::string_view word(Lost reason) {
  switch (reason) {
    case Lost::aground:
      return "aground";
    case Lost::left_area:
      return "left the area of the forecast";
    case Lost::left_forecast:
      return "left the time of the forecast";
    case Lost::no_data:
      return "no current data";
  }
  return "?";
}

Lost lost_by(ocean::NoCurrent reason) {
  switch (reason) {
    case ocean::NoCurrent::land:
      return Lost::aground;
    case ocean::NoCurrent::outside_area:
      return Lost::left_area;
    case ocean::NoCurrent::outside_time:
      return Lost::left_forecast;
    case ocean::NoCurrent::no_data:
    case ocean::NoCurrent::below_bottom:
      return Lost::no_data;
  }
  return Lost::no_data;
}

State state_at(GeoPoint p, double t_s, const Waters& waters) {
  State s{p.lat.radians(), p.lon.radians(), t_s, waters.margin.si()};
  if (waters.chart.clearance_at_least(s.lat, s.lon) < s.margin)
    s.margin = std::min(s.margin, waters.chart.clearance(s.lat, s.lon));
  return s;
}

double distance_near(double lat, double lon, const Disc& disc) {
  const double centre_lat = disc.centre.lat.radians(), centre_lon = disc.centre.lon.radians();
  const double bound = distance_lower_bound(lat, lon, centre_lat, centre_lon);
  return bound > kNear ? bound : local_offset(lat, lon, centre_lat, centre_lon).length();
}

namespace {

/// The first instant of the step from `from` (of length dt) inside the disc: bisection on the time at which a step of that
/// length ends inside. Precondition: a step of length `inside` ends inside, `from` is outside.
double crossing(Stepper& stepper, const State& from, double inside, const Disc& goal) {
  double outside = 0;
  while (inside - outside > kCrossing) {
    const double middle = 0.5 * (inside + outside);
    State s = from;
    if (!stepper.step(s, middle)) return from.t_s + inside;
    (distance_near(s.lat, s.lon, goal) <= goal.radius.si() ? inside : outside) = middle;
  }
  return from.t_s + inside;
}

/// Looks for an arrival between two states of one step.
std::optional<double> arrival_in(Stepper& stepper, const State& from, const State& to, const Disc& goal) {
  const double radius = goal.radius.si(), dt = to.t_s - from.t_s;
  if (distance_near(from.lat, from.lon, goal) <= radius) return from.t_s;
  if (distance_near(to.lat, to.lon, goal) <= radius) return crossing(stepper, from, dt, goal);
  // Both ends outside: the track may cut the disc in between. A bend of the track moves it off the chord by less than
  // an eighth of its length; only then is it worth looking closer.
  if (closest_on(from, to, goal) > radius + gap(from, to) / 8) return std::nullopt;
  for (int i = 1; i < 8; ++i) {
    State s = from;
    if (!stepper.step(s, dt * i / 8)) return std::nullopt;
    if (distance_near(s.lat, s.lon, goal) <= radius) return crossing(stepper, from, dt * i / 8, goal);
  }
  return std::nullopt;
}

}  // namespace

Motion move(const Waters& waters, ocean::FieldRef field, State from, double duration, WaterVelocity through_water,
            const Disc* goal) {
  Stepper stepper{field, through_water};
  Motion motion;
  const double until = from.t_s + duration;
  double step = std::min(600.0, duration), east = 0, north = 0;
  if (goal != nullptr) motion.closest = distance_near(from.lat, from.lon, *goal);
  if (goal != nullptr && motion.closest <= goal->radius.si()) motion.arrival_s = from.t_s;
  State now = from;
  while (until - now.t_s > 1e-6) {
    const double dt = std::min(step, until - now.t_s);
    State whole = now, halves = now;
    const bool has_current = stepper.step(whole, dt) && stepper.step(halves, dt / 2) && stepper.step(halves, dt / 2);
    const double difference = has_current ? gap(whole, halves) : 1e9;
    if (difference > kStepTolerance && dt > kShortestStep) {
      step = std::max(kShortestStep, dt / 2);
      continue;
    }
    if (!has_current) {
      motion.lost = lost_by(static_cast<ocean::NoCurrent>(stepper.lanes.lost[0]));
      break;
    }
    halves.t_s = now.t_s + dt;  // the sum of two halves rounds
    if (!waters.chart.segment_is_clear(now.lat, now.lon, halves.lat, halves.lon, now.margin)) {
      if (dt > kShortestStep) {
        step = std::max(kShortestStep, dt / 2);
        continue;
      }
      motion.lost = Lost::aground;
      break;
    }
    if (goal != nullptr && !motion.arrival_s) motion.arrival_s = arrival_in(stepper, now, halves, *goal);
    const auto way = local_offset(now.lat, now.lon, halves.lat, halves.lon);
    east += way.east - through_water.east * dt;
    north += way.north - through_water.north * dt;
    if (now.margin < waters.margin.si())
      halves.margin = std::clamp(waters.chart.clearance(halves.lat, halves.lon), now.margin, waters.margin.si());
    now = halves;
    if (goal != nullptr) motion.closest = std::min(motion.closest, distance_near(now.lat, now.lon, *goal));
    if (difference < kStepTolerance / 8) step = std::min(kLongestStep, step * 2);
  }
  motion.end = now;
  const double flown = now.t_s - from.t_s;
  if (flown > 0) motion.mean = {MetresPerSecond{east / flown}, MetresPerSecond{north / flown}};
  return motion;
}

double lane_step(const ocean::Ocean& ocean, GeoPoint from, GeoPoint to, double t_s, double stint, MetresPerSecond speed,
                 double tolerance) {
  const auto line = geodesic(from, to);
  double steps = std::ceil(stint / 3600.0);
  for (; stint / steps > 300.0; steps *= 2) {
    double worst = 0;
    for (int place = 0; place < 9; ++place) {
      const auto p = destination(from, line.departing, line.length * (place / 8.0));
      std::array<ocean::Lanes, 2> probes{};
      for (int fine = 0; fine < 2; ++fine) {
        auto& lanes = probes[static_cast<std::size_t>(fine)];
        lanes.count = 4;
        for (std::size_t i = 0; i < 4; ++i) {
          const Heading heading{line.departing.from_north() + degrees(90.0 * static_cast<double>(i))};
          const auto v = WaterVelocity::of(heading, speed);
          lanes.lat[i] = p.lat.radians();
          lanes.lon[i] = p.lon.radians();
          lanes.water_east[i] = v.east;
          lanes.water_north[i] = v.north;
          lanes.lost[i] = 0;
        }
        const double n = steps * (fine + 1);
        for (int k = 0; k < static_cast<int>(n); ++k) ocean.dive.advance(lanes, t_s + k * stint / n, stint / n);
      }
      for (std::size_t i = 0; i < 4; ++i)
        if (probes[0].lost[i] == 0 && probes[1].lost[i] == 0)
          worst = std::max(
              worst, local_offset(probes[0].lat[i], probes[0].lon[i], probes[1].lat[i], probes[1].lon[i]).length());
    }
    if (worst <= tolerance * speed.si() * stint) break;
  }
  return stint / steps;
}

}  // namespace glidehelm::vehicle
