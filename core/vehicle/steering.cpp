#include "core/vehicle/steering.hpp"

#include <algorithm>
#include <cmath>

#include "core/vehicle/dive_by_law.hpp"

namespace glidehelm::vehicle {

namespace {

constexpr double kEarlyShareCorrected = 0.01, kEarlyShareUncorrected = 0.05;
constexpr double kWeakCurrent = 0.1;        // of Û: at the end of a stint about the radius of the list
constexpr double kShortestLeg = 500.0;      // metres
constexpr double kHeldOn = 60.0;            // seconds that an arriving heading is held beyond the arrival
constexpr double kSmallestGoalRing = 10.0;  // metres
constexpr double kSmallestRadius = 100.0;   // metres
constexpr double kSightPiece = 20'000.0;  // metres: the sagitta of a geodesic over it is below 10 m to 60°, 50 m to 80°

Current believed_in(const Flight& flight, const Current& met_before, int k) {
  if (flight.glider.current_correction != 1) return {};
  return k == 0 ? flight.believed_current.value_or(Current{}) : met_before;
}

/// What stint k meets and the glider, which has measured nothing yet, does not believe in; none once it has measured.
std::optional<Current> unmeasured_in(const Flight& flight, const Current& expected, std::size_t k) {
  if (k > 0 || flight.believed_current) return std::nullopt;
  return expected;
}

/// Drift to the dive of stint k.
Motion drift(const State& from, const Flight& flight, const Waters& waters, int k) {
  const double until = flight.fix_s + flight.schedule.dive_time(k).count();
  return move(waters, waters.ocean.surface, from, std::max(0.0, until - from.t_s), {}, &flight.goal);
}

double metres_between(const State& a, const State& b) { return local_offset(a.lat, a.lon, b.lat, b.lon).length(); }

/// A heading held for a stint.
Motion hold(const Flight& flight, const Waters& waters, const State& from, double seconds, Heading heading) {
  return move(waters, waters.ocean.dive, from, seconds, WaterVelocity::of(heading, flight.glider.horizontal_speed),
              &flight.goal);
}

/// The radius of a list by product.md 6 from its leg lengths.
Metres list_radius(const std::vector<double>& legs, double drift, const ListOptions& options) {
  if (options.radius) return *options.radius;
  if (legs.empty()) return Metres{kSmallestRadius};
  std::vector<double> sorted = legs;
  std::sort(sorted.begin(), sorted.end());
  const double r = std::max({0.1 * sorted[sorted.size() / 2], kSmallestRadius, 2 * drift});
  return Metres{std::ceil(std::min(r, std::max(kSmallestRadius, 0.5 * legs.front())))};
}

Stint stint_of(const State& dive, const DiveFlown& flown) {
  Stint s;
  s.dive = dive.at();
  s.dive_s = dive.t_s;
  s.surface = flown.motion.end.at();
  s.surface_s = flown.motion.end.t_s;
  s.heading = flown.first_heading;
  s.dac = flown.motion.mean;
  return s;
}

bool in_sight(GeoPoint a, GeoPoint b, const Waters& waters) {
  // Ends inside the margin do not hide each other: what can be kept there is kept.
  const double margin =
      std::min({waters.margin.si(), waters.chart.clearance(a).si() - 1.0, waters.chart.clearance(b).si() - 1.0});
  const auto line = geodesic(a, b);
  const int pieces = std::max(1, static_cast<int>(std::ceil(line.length.si() / kSightPiece)));
  GeoPoint last = a;
  for (int i = 1; i <= pieces; ++i) {
    const auto next = i == pieces ? b : destination(a, line.departing, line.length * (static_cast<double>(i) / pieces));
    if (!waters.chart.segment_is_clear(last.lat.radians(), last.lon.radians(), next.lat.radians(), next.lon.radians(),
                                       margin))
      return false;
    last = next;
  }
  return true;
}

/// The longest leg that is written, metres: product.md 7.1 allows 1.1·(Û + largest believed current)·t_s, and what is
/// written is rounded. Later legs keep a tenth below it: the list alone, flown in all depths, meets other currents there
/// than the plan foresees.
double longest_leg(const Flight& flight, double fastest_current, double seconds, bool first) {
  return (first ? 1.09 : 1.0) * (flight.glider.believed_speed.si() + fastest_current) * seconds;
}

/// True when an aim may follow another one in a list: no farther than a stint flies, and not in its ring. Where the
/// believed current turns from one stint to the next, aim points of two stints can lie so.
bool follows(GeoPoint before, GeoPoint aim, double longest, Metres radius) {
  const double leg = distance(before, aim).si();
  return leg <= longest && leg >= 1.1 * radius.si();
}

/// Shortens an aim from `dive` whose leg from the point `before` is longer than `longest` metres: a glider that did not
/// believe in the current of its stint dives far from where that stint's aim lies. Bisection to a metre; nothing where no
/// part of the way is near enough.
void bring_within(double longest, GeoPoint before, GeoPoint dive, Aim& aim) {
  if (distance(before, aim.at).si() <= longest || distance(before, dive).si() > longest) return;
  const auto bearing = geodesic(dive, aim.at).departing;
  double near = 0, far = aim.length;
  while (far - near > 1.0) {
    const double middle = 0.5 * (near + far);
    (distance(before, destination(dive, bearing, Metres{middle})).si() <= longest ? near : far) = middle;
  }
  aim.length = near;
  aim.at = destination(dive, bearing, Metres{near});
}

/// True for a point whose ring holds the goal: it would be hit together with it, and the goal says the same.
bool stands_for(GeoPoint goal, GeoPoint point, Metres radius) { return distance(point, goal).si() < 1.1 * radius.si(); }

/// Points of a plan's way that the straight way from `from` to the goal needs around land and areas: from each point the
/// farthest of `later` surfacings that is in sight and within `longest` metres, until the goal is. At most `at_most`
/// points.
std::vector<GeoPoint> way_points(GeoPoint from, std::span<const Stint> later, GeoPoint goal, const Waters& waters,
                                 std::size_t at_most, double longest) {
  std::vector<GeoPoint> points;
  GeoPoint here = from;
  std::size_t next = 0;
  while (points.size() < at_most && !in_sight(here, goal, waters)) {
    std::size_t farthest = later.size();
    for (std::size_t i = next; i < later.size(); ++i)
      if (distance(here, later[i].surface).si() <= longest && in_sight(here, later[i].surface, waters)) farthest = i;
    if (farthest == later.size()) break;
    here = later[farthest].surface;
    points.push_back(here);
    next = farthest + 1;
  }
  return points;
}

/// What a stint begins with, beside its dive point.
struct Lead {
  Metres drifted;  ///< since the surfacing before
  std::optional<Current> unmeasured;
};

/// How one stint that may arrive is steered.
struct Steered {
  std::vector<GeoPoint> points;  ///< of the list, as far as this stint can come to them
  Metres radius;
  bool to_goal{};  ///< the goal is all there is
  DiveFlown flown;
};

DiveFlown fly_points(const Flight& flight, const Waters& waters, const State& from, double seconds, Steered& steered,
                     Current believed) {
  std::size_t target = 0;
  return dive_by_law(flight, waters, from, seconds, steered.points, target, steered.radius, true, believed);
}

Metres goal_ring(const Flight& flight, GeoPoint from) {
  const double way = distance(from, flight.goal.centre).si();
  const double largest = std::max(kSmallestGoalRing, 0.5 * flight.goal.radius.si());
  return Metres{std::ceil(std::clamp(0.1 * way, kSmallestGoalRing, largest))};
}

/// Straight at the goal.
Steered steer_to_goal(const Flight& flight, const Waters& waters, const State& from, double seconds, Current believed) {
  Steered s;
  s.points = {flight.goal.centre};
  s.radius = goal_ring(flight, from.at());
  s.to_goal = true;
  s.flown = fly_points(flight, waters, from, seconds, s, believed);
  return s;
}

/// On a heading that arrives when held: it is held until then, the goal comes next.
Steered hold_until_goal(const Flight& flight, const Waters& waters, const State& from, double seconds, Heading wanted,
                        const Motion& ideal, Current believed, const Lead& lead) {
  // The ring of the aim is crossed early_share before its time, and shall not be before the arrival.
  const double share = 1 - early_share(flight.glider, lead.unmeasured);
  const double held = std::min(seconds, (*ideal.arrival_s - from.t_s + kHeldOn) / share);
  const double leg =
      aim_point(from.at(), wanted, flight.glider, believed, held, Metres{0}, lead.drifted, lead.unmeasured).length;
  Steered s;
  // The goal is a point of this list: its ring must lie well inside the disc, or the glider turns before it is there.
  s.radius = std::min(list_radius({leg}, 0, {}), Metres{std::max(kSmallestGoalRing, 0.5 * flight.goal.radius.si())});
  const auto aim_within = [&](Metres radius) {
    return aim_point(from.at(), wanted, flight.glider, believed, held, radius, lead.drifted, lead.unmeasured);
  };
  auto aim = aim_within(s.radius);
  // A ring that holds the goal would be hit together with it.
  while (stands_for(flight.goal.centre, aim.at, s.radius) && s.radius.si() > kSmallestGoalRing) {
    s.radius = Metres{std::max(kSmallestGoalRing, std::floor(0.5 * s.radius.si()))};
    aim = aim_within(s.radius);
  }
  s.points = {aim.at};
  if (!aim.ends_list && !stands_for(flight.goal.centre, aim.at, s.radius)) s.points.push_back(flight.goal.centre);
  s.flown = fly_points(flight, waters, from, seconds, s, believed);
  return s;
}

bool arrives_before(const Steered& s, const Steered& other) {
  if (!s.flown.motion.arrival_s) return false;
  return !other.flown.motion.arrival_s || *s.flown.motion.arrival_s <= *other.flown.motion.arrival_s;
}

/// The steering of a stint that can come to the goal: straight at it or by holding the heading, whichever is there first;
/// none when neither is there within the stint.
std::optional<Steered> steer_home(const Flight& flight, const Waters& waters, const State& from, double seconds,
                                  Heading wanted, const Motion& ideal, Current believed, const Lead& lead) {
  const double reach = (flight.glider.horizontal_speed + waters.ocean.dive.fastest()).si() * seconds;
  if (distance_near(from.lat, from.lon, flight.goal) > reach + flight.goal.radius.si()) return std::nullopt;
  auto straight = steer_to_goal(flight, waters, from, seconds, believed);
  if (ideal.arrival_s) {
    auto held = hold_until_goal(flight, waters, from, seconds, wanted, ideal, believed, lead);
    if (!arrives_before(straight, held) && held.flown.motion.arrival_s) return held;
  }
  return straight.flown.motion.arrival_s ? std::optional{std::move(straight)} : std::nullopt;
}

}  // namespace

double usual_early_share(int current_correction) {
  return current_correction == 1 ? kEarlyShareCorrected : kEarlyShareUncorrected;
}

double early_share(const model::Glider& glider, const std::optional<Current>& unmeasured) {
  if (unmeasured && unmeasured->speed() > kWeakCurrent * glider.believed_speed) return kEarlyShareUncorrected;
  return usual_early_share(glider.current_correction);
}

Aim aim_point(GeoPoint dive, Heading wanted, const model::Glider& glider, Current believed, double seconds,
              Metres radius, Metres drifted, const std::optional<Current>& unmeasured) {
  const double u = glider.believed_speed.si();
  const Heading meant = wanted + -glider.heading_bias;  // what the glider must mean to steer
  double east = u * meant.east(), north = u * meant.north();
  if (glider.current_correction == 1) {
    east += believed.east.si();
    north += believed.north.si();
  }
  const double speed = std::hypot(east, north);
  const bool against = meant.east() * east + meant.north() * north < 0;
  Aim aim;
  aim.length = (1 - early_share(glider, unmeasured)) * speed * seconds + radius.si();
  const double shortest = std::max(2 * radius.si(), kShortestLeg) + drifted.si();
  aim.ends_list = against || aim.length < shortest;
  aim.length = std::max(aim.length, shortest);
  auto direction = speed > 1e-9 ? Bearing::of(east, north) : Bearing{meant.from_north()};
  if (against) direction = direction + Radians{kPi};
  aim.at = destination(dive, direction, Metres{aim.length});
  return aim;
}

namespace {

/// The list when the first stint arrives by `steer_home`; none when it arrives on the way to its ordinary aim.
std::optional<model::WaypointList> arriving_list(const Stint& stint, const Flight& flight, const Waters& waters,
                                                 const ListOptions& options) {
  model::WaypointList list;
  list.at_end = options.at_end;
  const auto from = state_at(stint.dive, stint.dive_s, waters);
  const double seconds = stint.surface_s - stint.dive_s;
  const auto believed = believed_in(flight, {}, 0);
  const auto ideal = hold(flight, waters, from, seconds, stint.heading);
  const auto steered = steer_home(flight, waters, from, seconds, stint.heading, ideal, believed,
                                  {distance(flight.fix, stint.dive), unmeasured_in(flight, ideal.mean, 0)});
  if (!steered) return std::nullopt;
  list.radius = options.radius.value_or(steered->radius);
  for (const auto& p : steered->points) list.points.push_back({p, model::WaypointRole::aim});
  if (list.points.back().at == flight.goal.centre) list.points.back().role = model::WaypointRole::goal;
  const bool says_it_twice =
      list.points.size() > 1 && stands_for(flight.goal.centre, list.points.front().at, list.radius);
  if (says_it_twice || list.points.size() > static_cast<std::size_t>(std::max(1, options.max_waypoints)))
    list.points.erase(list.points.begin());
  return list;
}

}  // namespace

namespace {

/// Makes the list of a plan whose first stint does not arrive by steering home.
class ListMaker {
 public:
  ListMaker(std::span<const Stint> stints, const Flight& flight, const Waters& waters, const ListOptions& options)
      : stints_{stints},
        flight_{flight},
        waters_{waters},
        options_{options},
        most_{static_cast<std::size_t>(std::max(1, options.max_waypoints))},
        corrects_{flight.glider.current_correction == 1} {}

  /// The list as product.md has it.
  model::WaypointList make() {
    list_.at_end = options_.at_end;
    choose_radius();
    const bool open = add_aims();
    if (!open) return list_;
    if (!corrects_ && list_.points.size() + 1 < most_) {
      fastest_ = std::max(fastest_, stints_[0].dac.speed().si());
      const double longest = longest_leg(flight_, fastest_, flight_.schedule.stint.count(), false);
      for (const auto& p : way_points(list_.points.back().at, stints_.subspan(1), flight_.goal.centre, waters_,
                                      most_ - list_.points.size() - 1, longest))
        list_.points.push_back({p, WaypointRole::aim});
    }
    while (!list_.points.empty() && stands_for(flight_.goal.centre, list_.points.back().at, list_.radius))
      list_.points.pop_back();
    list_.points.push_back({flight_.goal.centre, WaypointRole::goal});
    return list_;
  }

 private:
  using WaypointRole = model::WaypointRole;

  [[nodiscard]] Current believed(std::size_t k) const {
    return believed_in(flight_, k == 0 ? Current{} : stints_[k - 1].dac, static_cast<int>(k));
  }
  /// Before the dive of stint k.
  [[nodiscard]] Metres drifted(std::size_t k) const {
    return distance(k == 0 ? flight_.fix : stints_[k - 1].surface, stints_[k].dive);
  }
  [[nodiscard]] Aim aim_of(std::size_t k, Metres radius) const {
    const Stint& s = stints_[k];
    return aim_point(s.dive, s.heading, flight_.glider, believed(k), s.surface_s - s.dive_s, radius, drifted(k),
                     unmeasured_in(flight_, s.dac, k));
  }

  void choose_radius() {
    double largest_drift = 0;
    for (std::size_t k = 0; k < stints_.size() && (k == 0 || !stints_[k].arrives) && k + 1 < most_; ++k) {
      if (k > 0 && !corrects_) break;
      legs_.push_back(aim_of(k, Metres{0}).length);
      if (k + 1 < stints_.size()) largest_drift = std::max(largest_drift, drifted(k + 1).si());
    }
    list_.radius = list_radius(legs_, largest_drift, options_);
  }

  /// False when the last of them ends the list.
  bool add_aims() {
    for (std::size_t k = 0; k < legs_.size(); ++k) {
      const Seconds surface = k == 0 ? flight_.schedule.time_to_dive : flight_.schedule.surface;
      const double drift = surface.count() > 0 ? drifted(k).si() / surface.count() : 0.0;
      fastest_ = std::max({fastest_, believed(k).speed().si(), drift});
      const double longest = longest_leg(flight_, fastest_, stints_[k].surface_s - stints_[k].dive_s, k == 0);
      if (k == 0 && !options_.radius) {
        const double too_long = distance(flight_.fix, aim_of(0, list_.radius).at).si() - longest;
        if (too_long > 0) list_.radius = Metres{std::max(kSmallestRadius, std::floor(list_.radius.si() - too_long))};
      }
      auto aim = aim_of(k, list_.radius);
      if (k > 0) bring_within(longest, list_.points.back().at, stints_[k].dive, aim);
      if (k > 0 && !follows(list_.points.back().at, aim.at, longest, list_.radius)) return true;
      list_.points.push_back({aim.at, WaypointRole::aim});
      if (aim.ends_list) return false;
    }
    return true;
  }

  std::span<const Stint> stints_;
  const Flight& flight_;
  const Waters& waters_;
  const ListOptions& options_;
  std::size_t most_;
  bool corrects_;
  model::WaypointList list_;
  std::vector<double> legs_;
  double fastest_{};  ///< m/s, that glider or forecast believe in up to the leg at hand
};

/// True when the list alone comes to no harm: it arrives, or flies on to the horizon or the end of the forecast.
bool comes_through(const model::WaypointList& list, const Flight& flight, const Waters& waters) {
  const auto flown = fly_list(list, flight, waters);
  return flown.arrival_s || !flown.lost || (*flown.lost == Lost::left_forecast && flown.stints.size() >= 2);
}

}  // namespace

model::WaypointList list_for(std::span<const Stint> stints, const Flight& flight, const Waters& waters,
                             const ListOptions& options) {
  const auto goal = model::Waypoint{flight.goal.centre, model::WaypointRole::goal};
  if (stints.empty()) return {{goal}, options.radius.value_or(goal_ring(flight, flight.fix)), options.at_end};
  if (stints.front().arrives)
    if (auto list = arriving_list(stints.front(), flight, waters, options)) return std::move(*list);

  const auto whole = ListMaker{stints, flight, waters, options}.make();
  if (whole.points.back().role != model::WaypointRole::goal || comes_through(whole, flight, waters)) return whole;
  // Land, an area or the edge of the field lies between the last aim and the goal.
  auto list = whole;
  list.points.pop_back();
  for (; !list.points.empty(); list.points.pop_back())
    for (const bool to_goal : {false, true}) {
      auto shorter = list;
      if (to_goal) shorter.points.push_back(goal);
      if (shorter.points.size() < whole.points.size() && comes_through(shorter, flight, waters)) return shorter;
    }
  return whole;
}

namespace {

/// Keeps the position nearest to the goal.
class Closest {
 public:
  explicit Closest(GeoPoint start) : at_{start} {}
  void note(const Motion& motion) {
    if (motion.closest >= metres_) return;
    metres_ = motion.closest;
    at_ = motion.closest_at.at();
  }
  [[nodiscard]] GeoPoint at() const { return at_; }

 private:
  double metres_{1e18};
  GeoPoint at_;
};

}  // namespace

FlownList fly_list(const model::WaypointList& list, const Flight& flight, const Waters& waters) {
  FlownList flown;
  flown.closest = flight.fix;
  if (list.points.empty()) return flown;
  std::vector<GeoPoint> points;
  for (const auto& w : list.points) points.push_back(w.at);
  State now = state_at(flight.fix, flight.fix_s, waters);
  Closest closest{flight.fix};
  Current met;
  std::size_t target = 0;
  for (int k = 0; k < kMostListStints; ++k) {
    const auto drifted = drift(now, flight, waters, k);
    closest.note(drifted);
    flown.closest = closest.at();
    flown.arrival_s = drifted.arrival_s;
    flown.lost = drifted.lost;
    const double seconds = flight.schedule.stint_length(k).count();
    if (flown.lost || (flown.arrival_s && k > 0) || drifted.end.t_s + seconds > flight.horizon_s) return flown;
    const auto dive = dive_by_law(flight, waters, drifted.end, seconds, points, target, list.radius,
                                  list.at_end == model::AtEnd::loop, believed_in(flight, met, k));
    closest.note(dive.motion);
    flown.closest = closest.at();
    if (!flown.arrival_s) flown.arrival_s = dive.motion.arrival_s;
    flown.stints.push_back(stint_of(drifted.end, dive));
    flown.stints.back().arrives = flown.arrival_s.has_value();
    flown.lost = dive.motion.lost;
    if (flown.lost || flown.arrival_s) return flown;
    now = dive.motion.end;
    met = dive.motion.mean;
  }
  return flown;
}

namespace {

/// A flight with a new list at each surfacing.
class Relay {
 public:
  /// `foreseen` are the stints of an earlier pass: what ground points are chosen from. Empty in the first pass.
  Relay(const Helm& helm, const Flight& flight, const Waters& waters, std::span<const Stint> foreseen)
      : helm_{helm}, flight_{flight}, waters_{waters}, foreseen_{foreseen}, closest_{flight.fix} {}

  FlownList fly() {
    State now = state_at(flight_.fix, flight_.fix_s, waters_);
    for (int k = 0; k < kMostStints; ++k) {
      const auto drifted = drift(now, flight_, waters_, k);
      closest_.note(drifted);
      drift_speed_ = drifted.mean.speed().si();
      drifted_ = Metres{metres_between(now, drifted.end)};
      if (drifted.arrival_s && *drifted.arrival_s <= flight_.horizon_s) {
        flown_.arrival_s = drifted.arrival_s;
        if (!flown_.stints.empty()) flown_.stints.back().arrives = true;
        break;
      }
      flown_.lost = drifted.lost;
      if (flown_.lost || drifted.end.t_s >= flight_.horizon_s || !fly_stint(k, drifted.end)) break;
      now = last_.end;
    }
    flown_.closest = closest_.at();
    return std::move(flown_);
  }
  /// True when somewhere land or an area hides the goal from the end of a leg, so that a list has ground points.
  [[nodiscard]] bool needs_ground_points() const { return needs_ground_points_; }

 private:
  /// False when the flight ends with, or before, this stint.
  bool fly_stint(int k, const State& from) {
    const double seconds = flight_.schedule.stint_length(k).count();
    const auto believed = believed_in(flight_, last_.mean, k);
    const auto wanted = helm_(k, from.at(), from.t_s);
    std::optional<Steered> steered;
    if (!wanted) {
      steered = steer_to_goal(flight_, waters_, from, seconds, believed);
    } else {
      const auto ideal = hold(flight_, waters_, from, seconds, *wanted);
      const Lead lead{drifted_, unmeasured_in(flight_, ideal.mean, static_cast<std::size_t>(k))};
      steered = steer_home(flight_, waters_, from, seconds, *wanted, ideal, believed, lead);
      if (!steered) steered = steer_on(k, from, seconds, *wanted, ideal, believed, lead);
    }
    const Motion& motion = steered->flown.motion;
    const bool too_late = (motion.arrival_s ? *motion.arrival_s : from.t_s + seconds) > flight_.horizon_s;
    if (too_late) return false;
    if (motion.lost && !motion.arrival_s) {
      flown_.lost = motion.lost;
      return false;
    }
    closest_.note(motion);
    auto stint = stint_of(from, steered->flown);
    if (!steered->to_goal) stint.heading = *wanted;
    const auto held = hold(flight_, waters_, from, motion.end.t_s - from.t_s, stint.heading);
    stint.steering_error = Metres{metres_between(held.end, motion.end)};
    stint.arrives = motion.arrival_s.has_value();
    flown_.arrival_s = motion.arrival_s;
    flown_.stints.push_back(stint);
    last_ = motion;
    return !flown_.arrival_s;
  }

  /// Towards w_1 and then the second point of the list that this surfacing brings.
  Steered steer_on(int k, const State& from, double seconds, Heading wanted, const Motion& ideal, Current believed,
                   const Lead& lead) {
    const double leg =
        aim_point(from.at(), wanted, flight_.glider, believed, seconds, Metres{0}, lead.drifted, lead.unmeasured)
            .length;
    Steered s;
    s.radius = list_radius({leg}, 0, {});
    const auto aim =
        aim_point(from.at(), wanted, flight_.glider, believed, seconds, s.radius, lead.drifted, lead.unmeasured);
    s.points = {aim.at};
    if (!aim.ends_list && stands_for(flight_.goal.centre, aim.at, s.radius)) {
      s.points = {flight_.goal.centre};
    } else if (!aim.ends_list) {
      if (const auto second = second_point(k, aim.at, ideal, s.radius)) s.points.push_back(*second);
      s.points.push_back(flight_.goal.centre);
    }
    s.flown = fly_points(flight_, waters_, from, seconds, s, believed);
    return s;
  }

  /// What follows w_1 before the goal.
  std::optional<GeoPoint> second_point(int k, GeoPoint first, const Motion& ideal, Metres radius) {
    if (flight_.glider.current_correction != 1) {
      const auto later = foreseen_.subspan(std::min(foreseen_.size(), static_cast<std::size_t>(k) + 1));
      const double fastest = std::max(ideal.mean.speed().si(), drift_speed_);
      const auto ground = way_points(first, later, flight_.goal.centre, waters_, 1,
                                     longest_leg(flight_, fastest, flight_.schedule.stint.count(), false));
      needs_ground_points_ = needs_ground_points_ || !ground.empty() || !in_sight(first, flight_.goal.centre, waters_);
      return ground.empty() ? std::nullopt : std::optional{ground.front()};
    }
    if (ideal.lost) return std::nullopt;
    const auto dive = drift(ideal.end, flight_, waters_, k + 1);
    if (dive.lost) return std::nullopt;
    const auto next = helm_(k + 1, dive.end.at(), dive.end.t_s);
    if (!next) return std::nullopt;
    const double seconds = flight_.schedule.stint_length(k + 1).count();
    const Metres drifted{metres_between(ideal.end, dive.end)};
    auto aim = aim_point(dive.end.at(), *next, flight_.glider, ideal.mean, seconds, radius, drifted);
    const double fastest = std::max({believed_in(flight_, last_.mean, k).speed().si(), ideal.mean.speed().si(),
                                     drift_speed_, dive.mean.speed().si()});
    const double longest = longest_leg(flight_, fastest, seconds, false);
    bring_within(longest, first, dive.end.at(), aim);
    return follows(first, aim.at, longest, radius) ? std::optional{aim.at} : std::nullopt;
  }

  const Helm& helm_;
  const Flight& flight_;
  const Waters& waters_;
  std::span<const Stint> foreseen_;
  Closest closest_;
  FlownList flown_;
  Motion last_;
  double drift_speed_{};  ///< of the drift before the stint at hand
  Metres drifted_;        ///< in it
  bool needs_ground_points_{};
};

}  // namespace

FlownList fly_helm(const Helm& helm, const Flight& flight, const Waters& waters) {
  Relay relay{helm, flight, waters, {}};
  auto flown = relay.fly();
  if (!relay.needs_ground_points()) return flown;
  // The ground points of a list are surfacings of the plan: a first pass foresees them.
  const auto foreseen = flown.stints;
  return Relay{helm, flight, waters, foreseen}.fly();
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
