#include "core/vehicle/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/vehicle/goal_distance.hpp"

namespace glidehelm::vehicle {

namespace {

constexpr double kStepTolerance = 0.02;  // metres per step
constexpr double kLongestStep = 1200.0, kShortestStep = 10.0;
constexpr double kCrossing = 0.05;    // seconds
constexpr double kNoMoreTime = 1e-6;  // seconds: shorter than anything that matters, longer than rounding
constexpr double kSlack = 1.0;        // metres: distances of the chart round, and a track that slides along is not lost
constexpr int kGrazes = 8;            // parts of a step in which an arrival is looked for

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

double gained_margin(const State& there, double before, const Waters& waters) {
  const double clearance = waters.chart.clearance(there.lat, there.lon);
  return std::max(before, std::min(clearance - kSlack, waters.margin.si()));
}

State state_at(GeoPoint p, double t_s, const Waters& waters) {
  State s{p.lat.radians(), p.lon.radians(), t_s, waters.margin.si()};
  if (waters.chart.clearance_at_least(s.lat, s.lon) < s.margin)
    s.margin = std::min(s.margin, waters.chart.clearance(s.lat, s.lon) - kSlack);
  return s;
}

double distance_near(double lat, double lon, const Disc& disc) { return GoalDistance{disc}.near(lat, lon); }

std::optional<double> entry_into(const Disc& disc, double lat0, double lon0, double lat1, double lon1) {
  const GoalDistance goal{disc};
  return entry_into(disc.radius, goal.near(lat0, lon0), goal.near(lat1, lon1), local_offset(lat0, lon0, lat1, lon1));
}

std::optional<double> entry_into(Metres disc_radius, double before, double after, const Offset& way) {
  const double radius = disc_radius.si();
  if (before <= radius) return 0.0;
  const double length2 = way.east * way.east + way.north * way.north;
  if (length2 <= 0 || before - radius > std::sqrt(length2)) return std::nullopt;
  // In the triangle of the step and the centre: the projection of the centre onto the step, by the law of cosines.
  const double along = 0.5 * (length2 + before * before - after * after);  // step · (centre − start)
  const double root2 = along * along - length2 * (before * before - radius * radius);
  if (along <= 0 || root2 < 0) return std::nullopt;
  const double fraction = (before * before - radius * radius) / (along + std::sqrt(root2));
  return fraction <= 1.0 ? std::optional{fraction} : std::nullopt;
}

namespace {

/// The first instant of the step from `from` inside the disc. Precondition: `from` is outside, a step of length `inside`
/// ends inside.
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
  const double before = distance_near(from.lat, from.lon, goal), after = distance_near(to.lat, to.lon, goal);
  if (before <= radius) return from.t_s;
  // Both ends outside: the track may cut the disc in between, but no track of one step is longer than 1.5 times its
  // chord plus what the shortest step can cover.
  const bool may_graze = before + after - 2 * radius <= 1.5 * gap(from, to) + 20.0;
  if (after > radius && !may_graze) return std::nullopt;
  for (int i = 1; i <= kGrazes; ++i) {
    State s = from;
    if (!stepper.step(s, dt * i / kGrazes)) break;
    if (distance_near(s.lat, s.lon, goal) <= radius) return crossing(stepper, from, dt * i / kGrazes, goal);
  }
  return after <= radius ? std::optional{to.t_s} : std::nullopt;
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
  motion.closest_at = from;
  State now = from;
  while (until - now.t_s > kNoMoreTime) {
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
    if (now.margin < waters.margin.si()) halves.margin = gained_margin(halves, now.margin, waters);
    now = halves;
    if (goal != nullptr) {
      const double near = distance_near(now.lat, now.lon, *goal);
      if (near < motion.closest) {
        motion.closest = near;
        motion.closest_at = now;
      }
    }
    if (difference < kStepTolerance / 8) step = std::min(kLongestStep, step * 2);
  }
  motion.end = now;
  const double flown = now.t_s - from.t_s;
  if (flown > 0) motion.mean = {MetresPerSecond{east / flown}, MetresPerSecond{north / flown}};
  return motion;
}

namespace {

constexpr std::size_t kProbes = 4;

ocean::Lanes probes_at(GeoPoint p, Bearing along, MetresPerSecond speed) {
  ocean::Lanes lanes{};
  lanes.count = static_cast<int>(kProbes);
  for (std::size_t i = 0; i < kProbes; ++i) {
    const auto v = WaterVelocity::of(Heading{along.from_north() + degrees(90.0 * static_cast<double>(i))}, speed);
    lanes.lat[i] = p.lat.radians();
    lanes.lon[i] = p.lon.radians();
    lanes.water_east[i] = v.east;
    lanes.water_north[i] = v.north;
    lanes.lost[i] = 0;
  }
  return lanes;
}

/// How far apart a stint in `steps` and one in twice as many end, in metres; lost probes do not count.
double probe_difference(ocean::FieldRef field, const ocean::Lanes& start, double t_s, double stint, int steps) {
  const auto flown = [&](int n) {
    auto lanes = start;
    for (int k = 0; k < n; ++k) field.advance(lanes, t_s + k * stint / n, stint / n);
    return lanes;
  };
  const auto coarse = flown(steps), fine = flown(2 * steps);
  double worst = 0;
  for (std::size_t i = 0; i < kProbes; ++i)
    if (coarse.lost[i] == 0 && fine.lost[i] == 0)
      worst = std::max(worst, local_offset(coarse.lat[i], coarse.lon[i], fine.lat[i], fine.lon[i]).length());
  return worst;
}

}  // namespace

double lane_step(const ocean::Ocean& ocean, GeoPoint from, GeoPoint to, double t_s, double stint, MetresPerSecond speed,
                 double tolerance) {
  constexpr double kLongestLaneStep = 3600.0, kShortestLaneStep = 300.0;
  const auto line = geodesic(from, to);
  int steps = std::max(1, static_cast<int>(std::ceil(stint / kLongestLaneStep)));
  for (; stint / steps > kShortestLaneStep; steps *= 2) {
    double worst = 0;
    for (int place = 0; place < 9; ++place) {
      const Metres way = line.length * (place / 8.0);
      const auto probes = probes_at(destination(from, line.departing, way), line.departing, speed);
      worst = std::max(worst, probe_difference(ocean.dive, probes, t_s + (way / speed).count(), stint, steps));
    }
    if (worst <= tolerance * speed.si() * stint) break;
  }
  return stint / steps;
}

}  // namespace glidehelm::vehicle
