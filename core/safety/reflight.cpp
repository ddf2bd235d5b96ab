#include "core/safety/reflight.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"

namespace glidehelm::safety {

namespace {

struct Position {
  double lat{}, lon{};
  [[nodiscard]] GeoPoint at() const { return GeoPoint::from_kernel(lat, lon); }
};
/// Metres, or metres per second, of east and north.
struct Vector {
  double east{}, north{};
};

Position moved(const Position& p, const Vector& metres, double lat_of_metric) {
  const auto metric = LocalMetric::at(lat_of_metric);
  return {p.lat + metres.north / metric.meridian_radius, p.lon + metres.east / metric.parallel_radius};
}

/// One midpoint step: `half` is the velocity at its start, `full` the one half a step later.
Position half_way(const Position& p, const Vector& v, double dt) {
  return moved(p, {v.east * dt / 2, v.north * dt / 2}, p.lat);
}

/// Place of `p` in a plane around `centre` that keeps distances from it (azimuthal equidistant).
Vector seen_from(const GeoPoint& centre, const GeoPoint& p) {
  const auto g = geodesic(centre, p);
  return {g.length.si() * g.departing.east(), g.length.si() * g.departing.north()};
}

/// Where the straight line a → b enters the disc around the origin, as a fraction of the way; none when it does not.
std::optional<double> entry(const Vector& a, const Vector& b, double radius) {
  const double de = b.east - a.east, dn = b.north - a.north;
  const double dd = de * de + dn * dn;
  const double outside = a.east * a.east + a.north * a.north - radius * radius;
  if (outside < 0) return 0.0;
  const double towards = a.east * de + a.north * dn;
  const double root2 = towards * towards - dd * outside;
  if (towards >= 0 || root2 < 0) return std::nullopt;
  const double fraction = outside / (-towards + std::sqrt(root2));
  return fraction <= 1.0 ? std::optional{fraction} : std::nullopt;
}

FlightEnd end_for(ocean::NoCurrent reason) {
  switch (reason) {
    case ocean::NoCurrent::land:
      return FlightEnd::land;
    case ocean::NoCurrent::outside_area:
      return FlightEnd::outside_area;
    case ocean::NoCurrent::outside_time:
      return FlightEnd::outside_time;
    default:
      return FlightEnd::no_data;
  }
}

/// A flight under way.
class Flyer {
 public:
  Flyer(const FlightOrder& order, ocean::FieldRef full) : order_{order}, field_{full} {}

  Flight fly() {
    now_ = order_.fix_s;
    here_ = {order_.fix.lat.radians(), order_.fix.lon.radians()};
    if (distance(order_.fix, order_.goal) <= order_.goal_radius) arrive(now_);
    note_position(0, true);
    Current believed = order_.glider.current_correction == 1 ? order_.believed_current.value_or(Current{}) : Current{};
    for (int k = 0; k < kMostStints; ++k) {
      StintFlown stint;
      stint.believed = believed;
      const auto met_adrift = drift(k);
      if (!met_adrift) return finished(met_adrift.error());
      stint.drift = *met_adrift;
      stint.dived = here_.at();
      stint.dived_s = now_;
      const auto met = dive(k, believed);
      if (!met) return finished(met.error());
      stint.met = *met;
      stint.surfaced = here_.at();
      stint.surfaced_s = now_;
      flight_.stints.push_back(stint);
      if (order_.glider.current_correction == 1) believed = stint.met;
    }
    return finished(FlightEnd::stints);
  }

 private:
  Flight finished(FlightEnd end) {
    flight_.end = end;
    if (!flight_.arrival_s) flight_.arrival_index = flight_.track.size();
    return std::move(flight_);
  }

  void arrive(double at_s) {
    flight_.arrival_s = at_s;
    flight_.arrival_index = flight_.track.size();
  }

  void note_position(int stint, bool drifting) {
    flight_.track.push_back({here_.lat, here_.lon, now_, stint, drifting});
  }

  Expected<Vector, FlightEnd> current_at(const Position& p, double depth, double t_s) {
    auto sample = field_.sample(p.at(), Depth{Metres{depth}}, t_s);
    // Below the bottom the deepest value above it counts: found by halving to half a metre.
    double wet = 0, dry = depth;
    if (!sample && sample.error() == ocean::NoCurrent::below_bottom) {
      sample = field_.sample(p.at(), Depth{}, t_s);
      while (sample && dry - wet > 0.5) {
        const double middle = 0.5 * (wet + dry);
        const auto deeper = field_.sample(p.at(), Depth{Metres{middle}}, t_s);
        if (deeper) sample = deeper;
        (deeper ? wet : dry) = middle;
      }
    }
    if (!sample) return unexpected(end_for(sample.error()));
    const Vector c{sample->current.east.si(), sample->current.north.si()};
    if (!std::isfinite(c.east) || !std::isfinite(c.north)) return unexpected(FlightEnd::not_finite);
    flight_.fastest_current = std::max(flight_.fastest_current, std::hypot(c.east, c.north));
    return c;
  }

  /// Takes the step to `next`; notes an arrival on the way.
  void step_to(const Position& next, double dt, int stint, bool drifting) {
    if (!flight_.arrival_s) {
      // A step is far shorter than a kilometre: the cheap lower bound spares the geodesics of the open sea.
      const double goal_lat = order_.goal.lat.radians(), goal_lon = order_.goal.lon.radians();
      if (distance_lower_bound(here_.lat, here_.lon, goal_lat, goal_lon) < order_.goal_radius.si() + 1000.0) {
        const auto fraction =
            entry(seen_from(order_.goal, here_.at()), seen_from(order_.goal, next.at()), order_.goal_radius.si());
        if (fraction) arrive(now_ + *fraction * dt);
      }
    }
    here_ = next;
    now_ += dt;
    note_position(stint, drifting);
  }

  /// The longest step allowed before `until`, or why there is none.
  Expected<double, FlightEnd> step_before(double until) const {
    if (now_ >= order_.horizon_s) return unexpected(FlightEnd::horizon);
    return std::min({kStep, until - now_, order_.horizon_s - now_});
  }

  static Current mean(const Vector& sum, double seconds) {
    if (seconds <= 0) return {};
    return {MetresPerSecond{sum.east / seconds}, MetresPerSecond{sum.north / seconds}};
  }

  /// Drifts to the dive of stint k; gives the mean surface current.
  Expected<Current, FlightEnd> drift(int k) {
    const double from = now_, until = order_.fix_s + order_.schedule.dive_time(k).count();
    Vector sum;
    while (until - now_ > kInstant) {
      const auto dt = step_before(until);
      if (!dt) return unexpected(dt.error());
      const auto c0 = current_at(here_, 0, now_);
      if (!c0) return unexpected(c0.error());
      const Position middle = half_way(here_, *c0, *dt);
      const auto c = current_at(middle, 0, now_ + *dt / 2);
      if (!c) return unexpected(c.error());
      sum = {sum.east + c->east * *dt, sum.north + c->north * *dt};
      step_to(moved(here_, {c->east * *dt, c->north * *dt}, middle.lat), *dt, k, true);
    }
    return mean(sum, now_ - from);
  }

  /// Velocities of the true and of the dead-reckoned position at one instant.
  struct Motion {
    Vector current, truly, reckoned;
    Vector target;  ///< of the waypoint, seen from the dead-reckoned position
  };
  Expected<Motion, FlightEnd> motion(const Position& here, const Geodesic& aim, double depth, double t_s,
                                     Current believed) {
    const auto c = current_at(here, depth, t_s);
    if (!c) return unexpected(c.error());
    const double heading =
        steered_heading(aim.departing.from_north().si(), believed, order_.glider.believed_speed.si());
    const double east = std::sin(heading), north = std::cos(heading);
    const double truly = heading + order_.glider.heading_bias.si();
    const double u = order_.glider.horizontal_speed.si(), u_believed = order_.glider.believed_speed.si();
    return Motion{*c,
                  {u * std::sin(truly) + c->east, u * std::cos(truly) + c->north},
                  {u_believed * east + believed.east.si(), u_believed * north + believed.north.si()},
                  {aim.length.si() * aim.departing.east(), aim.length.si() * aim.departing.north()}};
  }

  /// Flies stint k; gives the mean current met.
  Expected<Current, FlightEnd> dive(int k, Current believed) {
    const double from = now_, length = order_.schedule.stint_length(k).count(), until = from + length;
    Position reckoned = here_;
    Vector sum;
    while (until - now_ > kInstant) {
      if (!hits(reckoned)) return unexpected(FlightEnd::list_finished);
      auto dt = step_before(until);
      if (!dt) return unexpected(dt.error());
      const auto start = motion(here_, aim_, yo_depth(order_.glider, now_ - from, length), now_, believed);
      if (!start) return unexpected(start.error());
      flight_.farthest_target = std::max(flight_.farthest_target, std::hypot(start->target.east, start->target.north));
      // The ring is looked for in the plane around the waypoint; a step that crosses it ends there.
      const Vector to_ring{-start->target.east, -start->target.north};
      const Vector after{to_ring.east + start->reckoned.east * *dt, to_ring.north + start->reckoned.north * *dt};
      const auto fraction = steers_only_ ? std::nullopt : entry(to_ring, after, order_.radius.si());
      if (fraction) *dt = std::min(*dt, *fraction * *dt + kIntoRing);
      const Position middle = half_way(here_, start->truly, *dt),
                     middle_reckoned = half_way(reckoned, start->reckoned, *dt);
      const double t_middle = now_ + *dt / 2;
      const auto v = motion(middle, geodesic(middle_reckoned.at(), order_.points[target_]),
                            yo_depth(order_.glider, t_middle - from, length), t_middle, believed);
      if (!v) return unexpected(v.error());
      reckoned = moved(reckoned, {v->reckoned.east * *dt, v->reckoned.north * *dt}, middle_reckoned.lat);
      sum = {sum.east + v->current.east * *dt, sum.north + v->current.north * *dt};
      step_to(moved(here_, {v->truly.east * *dt, v->truly.north * *dt}, middle.lat), *dt, k, false);
    }
    return mean(sum, now_ - from);
  }

  /// Passes over the waypoints that the dead-reckoned position has hit. False when the list has run out. When all rings
  /// hold the position (a list of one point does from its arrival on) the glider steers on to the target it has. The way
  /// to the target in hand stays in `aim_`.
  bool hits(const Position& reckoned) {
    steers_only_ = false;
    const auto here = reckoned.at();
    for (std::size_t passed = 0;; ++passed) {
      aim_ = geodesic(here, order_.points[target_]);
      if (aim_.length >= order_.radius) return true;
      const bool last = target_ + 1 == order_.points.size();
      if (last && order_.at_end == model::AtEnd::wait) return false;
      if (passed == order_.points.size() || order_.points.size() == 1) {
        steers_only_ = true;
        return true;
      }
      target_ = last ? 0 : target_ + 1;
    }
  }

  static constexpr double kInstant = 1e-3;  // seconds: shorter than anything that matters, longer than rounding
  static constexpr double kIntoRing = 0.1;  // seconds past the crossing: inside for certain, centimetres deep

  const FlightOrder& order_;
  ocean::FieldRef field_;
  Flight flight_;
  Position here_;
  double now_{};
  std::size_t target_{};
  Geodesic aim_{};
  bool steers_only_{};
};

}  // namespace

std::string_view word(FlightEnd end) {
  switch (end) {
    case FlightEnd::horizon:
      return "horizon";
    case FlightEnd::stints:
      return "60 stints flown";
    case FlightEnd::list_finished:
      return "end of the list";
    case FlightEnd::land:
      return "land";
    case FlightEnd::no_data:
      return "no data";
    case FlightEnd::outside_area:
      return "outside the area of the forecast";
    case FlightEnd::outside_time:
      return "outside the time of the forecast";
    case FlightEnd::not_finite:
      return "a current that is not a number";
  }
  return "unknown";
}

double yo_depth(const model::Glider& glider, double since_dive, double length) {
  const double lower = glider.dive_depth.si(), upper = std::min(glider.climb_to.si(), lower);
  const double vertical = glider.horizontal_speed.si() * std::tan(glider.glide_angle.si());
  double depth = vertical * since_dive;
  if (depth > lower) {
    const double height = lower - upper;
    const double s = height > 0 ? std::fmod(depth - lower, 2 * height) : 0.0;
    depth = s <= height ? lower - s : upper + (s - height);
  }
  return std::max(0.0, std::min(depth, vertical * (length - since_dive)));
}

double steered_heading(double bearing, Current believed, double believed_speed) {
  const double cross = believed.east.si() * std::cos(bearing) - believed.north.si() * std::sin(bearing);
  return bearing - std::asin(std::clamp(cross / believed_speed, -1.0, 1.0));
}

Flight fly(const FlightOrder& order, ocean::FieldRef full) { return Flyer{order, full}.fly(); }

}  // namespace glidehelm::safety
