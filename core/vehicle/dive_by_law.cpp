#include "core/vehicle/dive_by_law.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vehicle/goal_distance.hpp"
#include "core/vehicle/yo.hpp"

namespace glidehelm::vehicle {

namespace {

constexpr double kStep = 300.0;       // seconds
constexpr double kYoStep = 60.0;      // seconds: 9 m of depth for a usual glider
constexpr double kTurnStep = 60.0;    // seconds: in the ring of the last point, which a held heading leads past
constexpr double kNoTimeLeft = 1e-6;  // seconds
constexpr double kIntoRing = 0.01;    // seconds past a ring's crossing
constexpr double kPlane = 50'000.0;   // metres: where a plane is good enough for a bearing

struct Vector {
  double east{}, north{};
  /// Of metres: nothing so large or small that std::hypot would be needed.
  [[nodiscard]] double length() const { return std::sqrt(east * east + north * north); }
  /// From north, clockwise; north where it has no direction.
  [[nodiscard]] SineCosine azimuth() const {
    const double l = length();
    return l == 0 ? SineCosine{0, 1} : SineCosine{east / l, north / l};
  }
};

/// Of the sum of two angles.
SineCosine sum(SineCosine a, SineCosine b) {
  return {a.sine * b.cosine + a.cosine * b.sine, a.cosine * b.cosine - a.sine * b.sine};
}
Heading heading_of(SineCosine h) { return Heading{Radians{std::atan2(h.sine, h.cosine)}}; }

class Dive {
 public:
  Dive(const Flight& flight, const Waters& waters, const State& from, Metres radius, Current believed)
      : flight_{flight},
        waters_{waters},
        here_{from},
        reckoned_lat_{from.lat},
        reckoned_lon_{from.lon},
        radius_{radius.si()},
        believed_{believed},
        latitudes_{from.lat},
        to_goal_{flight.goal},
        away_{to_goal_.near(from.lat, from.lon)} {
    motion_.closest_at = from;
    motion_.closest = away_;
    if (motion_.closest <= flight.goal.radius.si()) motion_.arrival_s = from.t_s;
  }

  DiveFlown fly(double seconds, std::span<const GeoPoint> points, std::size_t& target, bool loops) {
    DiveFlown flown;
    begin_ = here_.t_s;
    seconds_ = seconds;
    const double until = begin_ + seconds, u_hat = flight_.glider.believed_speed.si();
    const double longest = waters_.full ? kYoStep : kStep;
    const auto bias = SineCosine::of(flight_.glider.heading_bias.si());
    bool first = true;
    while (until - here_.t_s > kNoTimeLeft) {
      const Vector aim = next_aim(points, target, loops);
      const auto heading = steered_heading(aim.azimuth(), believed_, flight_.glider.believed_speed);
      const auto truly = sum(heading, bias);
      if (first) flown.first_heading = heading_of(truly);
      first = false;
      const Vector reckoned{u_hat * heading.sine + believed_.east.si(), u_hat * heading.cosine + believed_.north.si()};
      const double dt = std::min({longest, until - here_.t_s, until_ring(aim, reckoned)});
      if (!step(truly, dt)) break;
      reckon(reckoned, dt);
    }
    motion_.end = here_;
    const double time = here_.t_s - begin_;
    if (time > 0) motion_.mean = {MetresPerSecond{east_ / time}, MetresPerSecond{north_ / time}};
    flown.motion = motion_;
    return flown;
  }

 private:
  [[nodiscard]] LocalMetric metric_at(double lat) const { return LocalMetric::of(latitudes_.at(lat)); }

  /// Distance and direction of a waypoint from the dead-reckoned position, as a vector in the plane whose north is that position's own. The
  /// straight offset is seen from the middle of the way, where the meridian has turned by half the convergence.
  [[nodiscard]] Vector seen(GeoPoint to) const {
    const double to_lat = to.lat.radians(), dlon = longitude_difference(reckoned_lon_, to.lon.radians());
    const auto middle = latitudes_.at(0.5 * (reckoned_lat_ + to_lat));
    const auto metric = LocalMetric::of(middle);
    const Vector offset{dlon * metric.parallel_radius, (to_lat - reckoned_lat_) * metric.meridian_radius};
    if (offset.length() > kPlane) {
      const auto line = geodesic(GeoPoint::from_kernel(reckoned_lat_, reckoned_lon_), to);
      return {line.length.si() * line.departing.east(), line.length.si() * line.departing.north()};
    }
    const auto half = turns_.at(0.5 * dlon * middle.sine);
    return {offset.east * half.cosine - offset.north * half.sine, offset.east * half.sine + offset.north * half.cosine};
  }

  /// Passes over the points that are hit; gives the way to the one to steer to.
  [[nodiscard]] Vector next_aim(std::span<const GeoPoint> points, std::size_t& target, bool loops) const {
    Vector aim = seen(points[target]);
    for (std::size_t passed = 0; aim.length() < radius_ && passed < points.size() && points.size() > 1; ++passed) {
      if (target + 1 == points.size() && !loops) break;
      target = (target + 1) % points.size();
      aim = seen(points[target]);
    }
    return aim;
  }

  /// Seconds until the dead-reckoned position is inside the ring around its aim; a whole step when it is not soon.
  [[nodiscard]] double until_ring(const Vector& aim, const Vector& v) const {
    const double d = aim.length();
    if (d <= radius_) return kTurnStep;
    const double towards_it = (aim.east * v.east + aim.north * v.north) / d;
    const double sideways = (aim.east * v.north - aim.north * v.east) / d;
    const double speed2 = towards_it * towards_it + sideways * sideways;
    if (towards_it <= 0 || std::abs(sideways) * d >= radius_ * std::sqrt(speed2)) return kStep;
    const double root = std::sqrt(speed2 * radius_ * radius_ - sideways * sideways * d * d);
    return std::max((d * towards_it - root) / speed2, 0.0) + kIntoRing;
  }

  void reckon(const Vector& v, double dt) {
    const auto start = metric_at(reckoned_lat_);
    const auto metric = metric_at(reckoned_lat_ + 0.5 * v.north * dt / start.meridian_radius);
    reckoned_lat_ += v.north * dt / metric.meridian_radius;
    reckoned_lon_ += v.east * dt / metric.parallel_radius;
  }

  bool lose(Lost why) {
    motion_.lost = why;
    return false;
  }

  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> current_at(GeoPoint p, double t_s) const {
    if (!waters_.full) return waters_.ocean.dive.sample(p, t_s);
    return current_above_bottom(*waters_.full, p, yo_depth(flight_.glider, t_s - begin_, seconds_), t_s);
  }

  /// One midpoint step of the true position. False when it is lost; the position then stays where the step began.
  bool step(SineCosine heading, double dt) {
    const double u = flight_.glider.horizontal_speed.si();
    const Vector through{u * heading.sine, u * heading.cosine};
    const auto c0 = current_at(here_.at(), here_.t_s);
    if (!c0) return lose(lost_by(c0.error()));
    const auto m0 = metric_at(here_.lat);
    const double lat = here_.lat + 0.5 * dt * (through.north + c0->current.north.si()) / m0.meridian_radius;
    const double lon = here_.lon + 0.5 * dt * (through.east + c0->current.east.si()) / m0.parallel_radius;
    const auto c = current_at(GeoPoint::from_kernel(lat, lon), here_.t_s + 0.5 * dt);
    if (!c) return lose(lost_by(c.error()));
    const auto m = metric_at(lat);
    const Offset way{dt * (through.east + c->current.east.si()), dt * (through.north + c->current.north.si())};
    State next{here_.lat + way.north / m.meridian_radius, here_.lon + way.east / m.parallel_radius, here_.t_s + dt,
               here_.margin};
    if (!waters_.chart.segment_is_clear(here_.lat, here_.lon, next.lat, next.lon, here_.margin))
      return lose(Lost::aground);
    if (here_.margin < waters_.margin.si()) next.margin = gained_margin(next, here_.margin, waters_);
    east_ += c->current.east.si() * dt;
    north_ += c->current.north.si() * dt;
    note_arrival(next, way);
    here_ = next;
    return true;
  }

  void note_arrival(const State& to, const Offset& way) {
    const double before = std::exchange(away_, to_goal_.near(to.lat, to.lon));
    if (away_ < motion_.closest) {
      motion_.closest = away_;
      motion_.closest_at = to;
    }
    if (motion_.arrival_s) return;
    const auto fraction = entry_into(flight_.goal.radius, before, away_, way);
    if (fraction) motion_.arrival_s = here_.t_s + *fraction * (to.t_s - here_.t_s);
  }

  const Flight& flight_;
  const Waters& waters_;
  State here_;
  double begin_{}, seconds_{};  ///< of this dive
  double reckoned_lat_, reckoned_lon_;
  double radius_;
  Current believed_;
  AnglesNear latitudes_, turns_{0};
  GoalDistance to_goal_;
  double away_;  ///< metres from here to the goal
  Motion motion_;
  double east_{}, north_{};  ///< integral of the current met, metres
};

}  // namespace

SineCosine steered_heading(SineCosine bearing, Current believed, MetresPerSecond believed_speed) {
  const double cross = believed.east.si() * bearing.cosine - believed.north.si() * bearing.sine;
  const double share = std::clamp(cross / believed_speed.si(), -1.0, 1.0);
  return sum(bearing, {-share, std::sqrt(1 - share * share)});
}

DiveFlown dive_by_law(const Flight& flight, const Waters& waters, const State& from, double seconds,
                      std::span<const GeoPoint> points, std::size_t& target, Metres radius, bool loops,
                      Current believed) {
  return Dive{flight, waters, from, radius, believed}.fly(seconds, points, target, loops);
}

}  // namespace glidehelm::vehicle
