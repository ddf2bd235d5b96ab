#include "core/vehicle/steering.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::vehicle {

namespace {

constexpr double kStep = 120.0;  // seconds
constexpr int kMostStints = 200;
constexpr double kShortestLeg = 500.0;     // metres
constexpr double kSmallestRadius = 100.0;  // metres
constexpr double kFarAim = 30'000.0;      // metres: beyond, the local metric bends bearings (0.2 deg at 60 N)
constexpr double kNoMoreTime = 1e-6;       // seconds

struct Vector {
  double east{}, north{};
  [[nodiscard]] double length() const { return std::hypot(east, north); }
};

Vector vector_of(Current c) { return {c.east.si(), c.north.si()}; }

/// Offset of a waypoint seen from a near position in the plane whose north is the position's: the local offset is that of
/// the middle latitude, whose meridian differs from the position's by half the convergence.
Vector towards(double lat, double lon, GeoPoint to) {
  const double to_lat = to.lat.radians(), to_lon = to.lon.radians();
  const auto offset = local_offset(lat, lon, to_lat, to_lon);
  if (offset.length() > kFarAim) {
    const auto line = geodesic(GeoPoint::from_kernel(lat, lon), to);
    return {line.length.si() * line.departing.east(), line.length.si() * line.departing.north()};
  }
  const double half = 0.5 * std::remainder(to_lon - lon, 2 * kPi) * std::sin(0.5 * (lat + to_lat));
  return {offset.east * std::cos(half) - offset.north * std::sin(half),
          offset.east * std::sin(half) + offset.north * std::cos(half)};
}

/// Heading = bearing − asin(cross/Û); |cross| ≥ Û steers square to the bearing, as far up-current as it goes.
double steered(const Vector& aim, Vector believed, double believed_speed) {
  const double bearing = std::atan2(aim.east, aim.north);
  const double cross = believed.east * std::cos(bearing) - believed.north * std::sin(bearing);
  return bearing - std::asin(std::clamp(cross / believed_speed, -1.0, 1.0));
}

/// One dive by the law towards a sequence of waypoints.
class Dive {
 public:
  Dive(const Flight& flight, const Waters& waters, Metres radius)
      : flight_{flight}, waters_{waters}, radius_{radius.si()} {}

  struct Outcome {
    Motion motion;
    double first_heading{};
    bool to_goal{};  ///< steered at the goal itself, not at an aim point
  };

  /// Flies from `from` for `seconds`. `target` runs through `points`; after the last it starts again when `loops`.
  Outcome fly(State from, double seconds, std::span<const GeoPoint> points, std::size_t& target, bool loops,
              Vector believed) {
    Outcome outcome;
    State here = from;
    double reckoned_lat = from.lat, reckoned_lon = from.lon, east = 0, north = 0;
    const double until = from.t_s + seconds;
    outcome.motion.closest = distance_near(here.lat, here.lon, flight_.goal);
    if (outcome.motion.closest <= flight_.goal.radius.si()) outcome.motion.arrival_s = here.t_s;
    bool first = true;
    while (until - here.t_s > kNoMoreTime) {
      Vector aim = towards(reckoned_lat, reckoned_lon, points[target]);
      for (std::size_t passed = 0; aim.length() < radius_ && passed < points.size() && points.size() > 1; ++passed) {
        if (target + 1 == points.size() && !loops) break;
        target = (target + 1) % points.size();
        aim = towards(reckoned_lat, reckoned_lon, points[target]);
      }
      double dt = std::min(kStep, until - here.t_s);
      const double heading = steered(aim, believed, flight_.glider.believed_speed.si());
      if (first) outcome.first_heading = heading;
      first = false;
      const double u_hat = flight_.glider.believed_speed.si();
      const Vector reckoned{u_hat * std::sin(heading) + believed.east, u_hat * std::cos(heading) + believed.north};
      dt = std::min(dt, until_ring(aim, reckoned));
      if (!step(here, heading, dt, outcome.motion, east, north)) break;
      const auto metric = LocalMetric::at(reckoned_lat + 0.5 * reckoned.north * dt / LocalMetric::kEquatorialRadius);
      reckoned_lat += reckoned.north * dt / metric.meridian_radius;
      reckoned_lon += reckoned.east * dt / metric.parallel_radius;
    }
    outcome.motion.end = here;
    const double flown = here.t_s - from.t_s;
    if (flown > 0) outcome.motion.mean = {MetresPerSecond{east / flown}, MetresPerSecond{north / flown}};
    return outcome;
  }

 private:
  /// Seconds until the dead-reckoned position is just inside the ring around its aim; infinite when it never is.
  [[nodiscard]] double until_ring(const Vector& aim, const Vector& v) const {
    const double d = aim.length();
    if (d <= radius_) return kStep;
    const double towards_it = (aim.east * v.east + aim.north * v.north) / d;
    const double sideways = (aim.east * v.north - aim.north * v.east) / d;
    if (towards_it <= 0) return kStep;
    const double speed2 = towards_it * towards_it + sideways * sideways;
    const double miss = std::abs(sideways) * d / std::sqrt(speed2);
    if (miss >= radius_) return kStep;
    const double t = (d * towards_it - std::sqrt(speed2 * radius_ * radius_ - sideways * sideways * d * d)) / speed2;
    return std::max(t + 0.01, 0.01);
  }

  /// One midpoint step of the true position. False when it is lost.
  bool step(State& here, double heading, double dt, Motion& motion, double& east, double& north) {
    const double u = flight_.glider.horizontal_speed.si();
    const Vector through{u * std::sin(heading), u * std::cos(heading)};
    const auto lose = [&](Lost why) {
      motion.lost = why;
      return false;
    };
    const auto c0 = waters_.ocean.dive.sample(here.at(), here.t_s);
    if (!c0) return lose(lost_by(c0.error()));
    const auto m0 = LocalMetric::at(here.lat);
    const double mid_lat = here.lat + 0.5 * dt * (through.north + c0->current.north.si()) / m0.meridian_radius;
    const double mid_lon = here.lon + 0.5 * dt * (through.east + c0->current.east.si()) / m0.parallel_radius;
    const auto c = waters_.ocean.dive.sample(GeoPoint::from_kernel(mid_lat, mid_lon), here.t_s + 0.5 * dt);
    if (!c) return lose(lost_by(c.error()));
    const auto m = LocalMetric::at(mid_lat);
    State next{here.lat + dt * (through.north + c->current.north.si()) / m.meridian_radius,
               here.lon + dt * (through.east + c->current.east.si()) / m.parallel_radius, here.t_s + dt, here.margin};
    if (!waters_.chart.segment_is_clear(here.lat, here.lon, next.lat, next.lon, here.margin))
      return lose(Lost::aground);
    if (here.margin < waters_.margin.si())
      next.margin = std::clamp(waters_.chart.clearance(next.lat, next.lon), here.margin, waters_.margin.si());
    east += c->current.east.si() * dt;
    north += c->current.north.si() * dt;
    note_arrival(here, next, motion);
    here = next;
    return true;
  }

  /// Steps are far shorter than a goal's disc is wide: the entry is found on the straight step.
  void note_arrival(const State& from, const State& to, Motion& motion) const {
    const double before = distance_near(from.lat, from.lon, flight_.goal),
                 after = distance_near(to.lat, to.lon, flight_.goal);
    motion.closest = std::min(motion.closest, after);
    const double radius = flight_.goal.radius.si();
    if (motion.arrival_s || after > radius) return;
    const double share = before > after ? std::clamp((before - radius) / (before - after), 0.0, 1.0) : 0.0;
    motion.arrival_s = from.t_s + share * (to.t_s - from.t_s);
  }

  const Flight& flight_;
  const Waters& waters_;
  double radius_;
};

Vector believed_in(const Flight& flight, const Current& before, int k) {
  if (flight.glider.current_correction == 0) return {};
  return k == 0 ? vector_of(flight.believed_current.value_or(Current{})) : vector_of(before);
}

/// Drift to the dive of stint k.
Motion drift(const State& from, const Flight& flight, const Waters& waters, int k) {
  const double until = flight.fix_s + flight.schedule.dive_time(k).count();
  return move(waters, waters.ocean.surface, from, std::max(0.0, until - from.t_s), {}, &flight.goal);
}

double metres_between(const State& a, const State& b) { return local_offset(a.lat, a.lon, b.lat, b.lon).length(); }

/// The radius of a list by product.md 6 from its leg lengths.
Metres list_radius(std::vector<double> legs, double drift, const ListOptions& options) {
  if (options.radius) return *options.radius;
  if (legs.empty()) return Metres{kSmallestRadius};
  std::vector<double> sorted = legs;
  std::sort(sorted.begin(), sorted.end());
  const double r = std::max({0.1 * sorted[sorted.size() / 2], kSmallestRadius, 2 * drift});
  // Below the first leg: a waypoint inside its own ring is hit at once. Half of it leaves room for an early surfacing.
  return Metres{std::ceil(std::max(10.0, std::min(r, std::max(kSmallestRadius, 0.5 * legs.front()))))};
}

Stint stint_of(const State& dive, const Dive::Outcome& flown) {
  Stint s;
  s.dive = dive.at();
  s.dive_s = dive.t_s;
  s.surface = flown.motion.end.at();
  s.surface_s = flown.motion.end.t_s;
  s.heading = Heading{Radians{flown.first_heading}};
  s.dac = flown.motion.mean;
  return s;
}

}  // namespace

double early_share(int current_correction) { return current_correction == 1 ? 0.01 : 0.05; }

Aim aim_point(GeoPoint dive, Heading wanted, const model::Glider& glider, Current believed, double seconds,
              Metres radius) {
  const double u = glider.believed_speed.si();
  Vector g{u * wanted.east(), u * wanted.north()};
  if (glider.current_correction == 1) g = {g.east + believed.east.si(), g.north + believed.north.si()};
  const double speed = g.length();
  const bool against = wanted.east() * g.east + wanted.north() * g.north < 0;
  Aim aim;
  aim.length = (1 - early_share(glider.current_correction)) * speed * seconds + radius.si();
  const double shortest = std::max(2 * radius.si(), kShortestLeg);
  aim.ends_list = against || aim.length < shortest;
  aim.length = std::max(aim.length, shortest);
  // A null vector has no direction: the wanted heading serves.
  auto direction = speed > 1e-9 ? Bearing::of(g.east, g.north) : Bearing{wanted.from_north()};
  if (against) direction = direction + Radians{kPi};
  aim.at = destination(dive, direction, Metres{aim.length});
  return aim;
}

namespace {

/// Points of a plan's way that the straight way from `from` to the goal needs around land and areas: from each point the
/// farthest predicted surfacing that is in sight, until the goal is.
std::vector<GeoPoint> way_points(GeoPoint from, std::span<const Stint> later, GeoPoint goal, const Waters& waters,
                                 std::size_t at_most) {
  const auto in_sight = [&](GeoPoint a, GeoPoint b) {
    const auto line = geodesic(a, b);
    const int pieces = std::max(1, static_cast<int>(std::ceil(line.length.si() / 20'000.0)));
    GeoPoint last = a;
    for (int i = 1; i <= pieces; ++i) {
      const auto next =
          i == pieces ? b : destination(a, line.departing, line.length * (static_cast<double>(i) / pieces));
      if (!waters.chart.segment_is_clear(last.lat.radians(), last.lon.radians(), next.lat.radians(), next.lon.radians(),
                                         waters.margin.si()))
        return false;
      last = next;
    }
    return true;
  };
  std::vector<GeoPoint> points;
  GeoPoint here = from;
  std::size_t next = 0;
  while (points.size() < at_most && !in_sight(here, goal)) {
    std::size_t farthest = later.size();
    for (std::size_t i = next; i < later.size(); ++i)
      if (in_sight(here, later[i].surface)) farthest = i;
    if (farthest == later.size()) break;
    here = later[farthest].surface;
    points.push_back(here);
    next = farthest + 1;
  }
  return points;
}

}  // namespace

model::WaypointList list_for(std::span<const Stint> stints, const Flight& flight, const Waters& waters,
                             const ListOptions& options) {
  model::WaypointList list;
  list.at_end = options.at_end;
  const auto goal = model::Waypoint{flight.goal.centre, model::WaypointRole::goal};
  const auto most = static_cast<std::size_t>(std::max(1, options.max_waypoints));
  double surface_drift = 0;
  for (std::size_t k = 0; k + 1 < std::min(stints.size(), most); ++k)
    surface_drift = std::max(surface_drift, distance(stints[k].surface, stints[k + 1].dive).si());

  if (stints.empty() || stints.front().arrives) {
    // The goal alone: the glider steers there and stays. Its radius keeps the goal's own disc as the place to be.
    const auto from = stints.empty() ? flight.fix : stints.front().dive;
    const double way = std::min(distance(flight.fix, flight.goal.centre).si(), distance(from, flight.goal.centre).si());
    list.radius =
        options.radius.value_or(Metres{std::clamp(0.1 * way, 10.0, std::max(10.0, 0.5 * flight.goal.radius.si()))});
    list.points = {goal};
    if (stints.empty() || fly_list(list, flight, waters).arrival_s) return list;
    // Steering at the goal misses it here: the heading that arrives is held until it does.
    const auto from_state = state_at(stints.front().dive, stints.front().dive_s, waters);
    const double seconds = stints.front().surface_s - stints.front().dive_s;
    const auto ideal = move(waters, waters.ocean.dive, from_state, seconds,
                            WaterVelocity::of(stints.front().heading, flight.glider.horizontal_speed), &flight.goal);
    const double held = ideal.arrival_s ? std::max(1.0, *ideal.arrival_s - from_state.t_s) : seconds;
    const auto aim = aim_point(from, stints.front().heading, flight.glider, flight.believed_current.value_or(Current{}),
                               held, list.radius);
    list.points.insert(list.points.begin(), {aim.at, model::WaypointRole::aim});
    if (aim.ends_list) list.points.pop_back();
    return list;
  }
  const bool corrects = flight.glider.current_correction == 1;
  std::vector<double> legs;
  Current believed = flight.believed_current.value_or(Current{});
  for (std::size_t k = 0; k < stints.size() && !stints[k].arrives && k + 1 < most; ++k) {
    legs.push_back(aim_point(stints[k].dive, stints[k].heading, flight.glider, corrects ? believed : Current{},
                             stints[k].surface_s - stints[k].dive_s, Metres{0})
                       .length);
    believed = stints[k].dac;
    if (!corrects) break;
  }
  list.radius = list_radius(legs, surface_drift, options);
  believed = flight.believed_current.value_or(Current{});
  bool ended = false;
  for (std::size_t k = 0; k < legs.size() && !ended; ++k) {
    const auto aim = aim_point(stints[k].dive, stints[k].heading, flight.glider, corrects ? believed : Current{},
                               stints[k].surface_s - stints[k].dive_s, list.radius);
    list.points.push_back({aim.at, model::WaypointRole::aim});
    ended = aim.ends_list;
    believed = stints[k].dac;
  }
  if (ended) return list;
  if (!corrects && list.points.size() + 1 < most)
    for (const auto& p : way_points(list.points.back().at, stints.subspan(1), flight.goal.centre, waters,
                                    most - list.points.size() - 1))
      list.points.push_back({p, model::WaypointRole::aim});
  list.points.push_back(goal);
  return list;
}

FlownList fly_list(const model::WaypointList& list, const Flight& flight, const Waters& waters) {
  FlownList flown;
  if (list.points.empty()) return flown;
  std::vector<GeoPoint> points;
  for (const auto& w : list.points) points.push_back(w.at);
  Dive dive{flight, waters, list.radius};
  State now = state_at(flight.fix, flight.fix_s, waters);
  Current met;
  std::size_t target = 0;
  for (int k = 0; k < kMostStints; ++k) {
    const auto drifted = drift(now, flight, waters, k);
    if (drifted.arrival_s && !flown.arrival_s) flown.arrival_s = drifted.arrival_s;
    flown.lost = drifted.lost;
    const double seconds = flight.schedule.stint_length(k).count();
    if (flown.lost || (flown.arrival_s && k > 0) || drifted.end.t_s + seconds > flight.horizon_s) return flown;
    const auto outcome =
        dive.fly(drifted.end, seconds, points, target, list.at_end == model::AtEnd::loop, believed_in(flight, met, k));
    flown.stints.push_back(stint_of(drifted.end, outcome));
    if (outcome.motion.arrival_s && !flown.arrival_s) flown.arrival_s = outcome.motion.arrival_s;
    flown.stints.back().arrives = flown.arrival_s.has_value();
    flown.lost = outcome.motion.lost;
    if (flown.lost || flown.arrival_s) return flown;
    now = outcome.motion.end;
    met = outcome.motion.mean;
  }
  return flown;
}

namespace {

/// One stint towards its own aim, then towards the next one; the goal itself when that comes there in this stint.
Dive::Outcome fly_stint(const Flight& flight, const Waters& waters, const State& from, double seconds,
                        std::optional<Heading> wanted, std::optional<Heading> next, Vector believed,
                        const Motion& ideal) {
  const Current c{MetresPerSecond{believed.east}, MetresPerSecond{believed.north}};
  std::size_t target = 0;
  // Shorter than two stints to go: would steering to the goal itself come there?
  const double reach =
      (flight.glider.horizontal_speed.si() + waters.ocean.dive.fastest().si()) * seconds + flight.goal.radius.si();
  if (!wanted || distance_near(from.lat, from.lon, flight.goal) <= reach) {
    const std::array<GeoPoint, 1> goal{flight.goal.centre};
    Dive straight{flight, waters, Metres{std::max(10.0, 0.25 * flight.goal.radius.si())}};
    auto outcome = straight.fly(from, seconds, goal, target, false, believed);
    outcome.to_goal = true;
    if (!wanted || (outcome.motion.arrival_s && !outcome.motion.lost &&
                    (!ideal.arrival_s || *outcome.motion.arrival_s <= *ideal.arrival_s + 0.02 * seconds)))
      return outcome;
  }
  // A heading that arrives is held until it arrives; then the goal is the target.
  const double held = ideal.arrival_s ? std::max(1.0, *ideal.arrival_s - from.t_s) : seconds;
  const auto probe = aim_point(from.at(), *wanted, flight.glider, c, held, Metres{0});
  const Metres radius{std::max(kSmallestRadius, std::min(0.1 * probe.length, 0.5 * probe.length))};
  const auto aim = aim_point(from.at(), *wanted, flight.glider, c, held, radius);
  std::vector<GeoPoint> points{aim.at};
  if (!aim.ends_list) {
    // With correction 0 the file holds the first aim point and then the goal: aim points there turn later dives back.
    if (ideal.arrival_s || !next || flight.glider.current_correction == 0) {
      points.push_back(flight.goal.centre);
    } else {
      points.push_back(aim_point(ideal.end.at(), *next, flight.glider, ideal.mean, seconds, radius).at);
      points.push_back(flight.goal.centre);
    }
  }
  Dive dive{flight, waters, radius};
  return dive.fly(from, seconds, points, target, false, believed);
}

}  // namespace

FlownList fly_helm(const Helm& helm, const Flight& flight, const Waters& waters) {
  FlownList flown;
  State now = state_at(flight.fix, flight.fix_s, waters);
  Current met;
  for (int k = 0; k < kMostStints; ++k) {
    const auto drifted = drift(now, flight, waters, k);
    if (drifted.arrival_s) {
      flown.arrival_s = drifted.arrival_s;
      if (!flown.stints.empty()) flown.stints.back().arrives = true;
      return flown;
    }
    flown.lost = drifted.lost;
    const double seconds = flight.schedule.stint_length(k).count();
    if (flown.lost || drifted.end.t_s >= flight.horizon_s) return flown;
    const auto wanted = helm(k, drifted.end.at(), drifted.end.t_s);
    Motion ideal;
    std::optional<Heading> next;
    if (wanted) {
      ideal = move(waters, waters.ocean.dive, drifted.end, seconds,
                   WaterVelocity::of(*wanted, flight.glider.horizontal_speed), &flight.goal);
      if (!ideal.lost) next = helm(k + 1, ideal.end.at(), ideal.end.t_s);
    }
    const auto outcome =
        fly_stint(flight, waters, drifted.end, seconds, wanted, next, believed_in(flight, met, k), ideal);
    const bool too_late = outcome.motion.arrival_s ? *outcome.motion.arrival_s > flight.horizon_s
                                                   : outcome.motion.end.t_s > flight.horizon_s;
    if (too_late) return flown;
    auto stint = stint_of(drifted.end, outcome);
    if (wanted) {
      stint.steering_error = Metres{ideal.lost ? 0.0 : metres_between(ideal.end, outcome.motion.end)};
      if (!outcome.to_goal) stint.heading = *wanted;
    }
    stint.arrives = outcome.motion.arrival_s.has_value();
    flown.arrival_s = outcome.motion.arrival_s;
    flown.lost = outcome.motion.arrival_s ? std::nullopt : outcome.motion.lost;
    if (flown.lost) return flown;  // a stint that ends aground is no part of a plan
    flown.stints.push_back(stint);
    if (flown.arrival_s) return flown;
    now = outcome.motion.end;
    met = outcome.motion.mean;
  }
  return flown;
}

FlownList fly_headings(std::span<const Heading> wanted, const Flight& flight, const Waters& waters) {
  return fly_helm(
      [wanted](int k, GeoPoint, double) -> std::optional<Heading> {
        if (static_cast<std::size_t>(k) < wanted.size()) return wanted[static_cast<std::size_t>(k)];
        return std::nullopt;
      },
      flight, waters);
}

}  // namespace glidehelm::vehicle
