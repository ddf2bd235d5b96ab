#include "core/planning/wall_walk.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"

namespace glidehelm::planning {

namespace {

constexpr double kDifference = 5.0;  // metres: the normal is a difference of clearances over that
constexpr double kNear = 100.0;      // metres: nothing farther off the border is brought onto it

constexpr int kTry = 12;  // strides
constexpr double kHeld =
    2 * WallWalk::kShortestStride;  // metres: a walker that comes no farther in kTry strides is held by the current

void shift(double& lat, double& lon, double east, double north) {
  const double middle = lat + 0.5 * north / LocalMetric::at(lat).meridian_radius;
  const auto metric = LocalMetric::at(middle);
  lat += north / metric.meridian_radius;
  lon += east / metric.parallel_radius;
}

/// What a vehicle on the border can do.
struct Motion {
  double along;         ///< speed over ground along τ
  double across, keep;  ///< parts of its heading along ν and τ
};
Motion motion(double current_across, double current_along, double speed) {
  if (speed <= 0) return {current_along, 0, 1};
  if (current_across >= speed) return {0, -1, 0};
  const double across = std::min(1.0, -current_across / speed);
  const double keep = std::sqrt(std::max(0.0, 1 - across * across));
  return {current_along + speed * keep, across, keep};
}

}  // namespace

WallWalk::Border WallWalk::border(double lat, double lon) const {
  const auto metric = LocalMetric::at(lat);
  const double here = chart_.clearance(lat, lon);
  const double east = chart_.clearance(lat, lon + kDifference / metric.parallel_radius) - here;
  const double north = chart_.clearance(lat + kDifference / metric.meridian_radius, lon) - here;
  const double length = std::hypot(east, north);
  const bool found = length > 0.2 * kDifference;  // 1 beside a wall, 0 on the ridge between two
  return {here - level_, found ? east / length : 0, found ? north / length : 0, found};
}

bool WallWalk::settle(Marker& m) const {
  double lat = m.lat, lon = m.lon;
  for (int i = 0; i < 8; ++i) {
    const auto b = border(lat, lon);
    if (!b.found || std::abs(b.above) > kNear) return false;
    shift(lat, lon, -b.above * b.east, -b.above * b.north);
    if (std::abs(b.above) < 0.5) break;
  }
  m.lat = lat;
  m.lon = lon;
  return true;
}

WallWalk::End WallWalk::walk(Marker& m, Way way, const Marker* towards, ocean::FieldRef field, double speed, double t_s,
                             double seconds, std::vector<Marker>& sent) {
  const double left = way == Way::forward ? 1.0 : -1.0;  // τ lies to the left or right of ν
  Border here = border(m.lat, m.lon);
  const auto motion_at = [&](double lat, double lon, const Border& b, double t) -> std::optional<Motion> {
    ++evaluations_;
    const auto sample = field.sample(GeoPoint::from_kernel(lat, lon), t_s + t);
    if (!sample) return std::nullopt;
    const double east = sample->current.east.si(), north = sample->current.north.si();
    return motion(east * b.east + north * b.north, left * (north * b.east - east * b.north), speed);
  };
  const auto heading = [left](const Border& b, const Motion& by) {
    return Offset{by.across * b.east - left * by.keep * b.north, by.across * b.north + left * by.keep * b.east};
  };
  const auto bend_between = [](const Border& a, const Border& b) {
    return !a.found || !b.found
               ? kPi
               : std::abs(std::atan2(a.east * b.north - a.north * b.east, a.east * b.east + a.north * b.north));
  };
  double bent = 0, reach = kLongestStride;
  Marker tried_from = m;
  int strides = 0;
  for (double t = 0; t < seconds - 1e-6;) {
    if (++strides % kTry == 0) {
      if (local_offset(m.lat, m.lon, tried_from.lat, tried_from.lon).length() < kHeld) return End::under_way;
      tried_from = m;
    }
    if (!here.found) return End::no_border;
    double longest = reach;
    if (towards != nullptr) {
      const double distance = local_offset(m.lat, m.lon, towards->lat, towards->lon).length();
      if (distance < kMeet) return End::met;
      longest = std::clamp(0.5 * distance, kShortestStride, reach);
    }
    const auto first = motion_at(m.lat, m.lon, here, t);
    if (!first) return End::no_water;
    if (t == 0 && speed > 0) {
      const auto begin = heading(here, *first);
      m.east = begin.east;
      m.north = begin.north;
    }
    double dt = std::min(seconds - t, longest / std::max(1e-3, std::abs(first->along)));
    std::optional<Motion> there;
    Border end{};
    double lat = 0, lon = 0;
    for (;; dt *= 0.5) {
      const bool shortest = dt * std::abs(first->along) <= kShortestStride;
      const auto follow = [&](double metres, const Border& along) {
        lat = m.lat;
        lon = m.lon;
        shift(lat, lon, -left * metres * along.north, left * metres * along.east);
      };
      follow(0.5 * dt * first->along, here);
      const Border middle = border(lat, lon);
      if (!shortest && bend_between(here, middle) > kMostBend) continue;
      const Border& along = middle.found ? middle : here;
      there = motion_at(lat, lon, along, t + 0.5 * dt);
      if (!there) return End::no_water;
      follow(dt * there->along, along);
      end = border(lat, lon);
      if (shortest || bend_between(along, end) <= kMostBend) break;
    }
    shift(lat, lon, -end.above * end.east, -end.above * end.north);
    if (chart_.bathymetry() != nullptr && !chart_.segment_is_clear(m.lat, m.lon, lat, lon, 0)) return End::no_water;
    reach = std::clamp(2 * dt * std::abs(first->along), kShortestStride, kLongestStride);
    here = end;
    m.lat = lat;
    m.lon = lon;
    t += dt;
    const bool was_behind = m.behind > 0;
    m.behind = std::max(0.0, m.behind - dt * there->along);
    if (speed <= 0) continue;
    const auto now = heading(here, *there);
    // To the land's side.
    if (!was_behind && m.behind == 0)
      bent += left * std::atan2(m.east * now.north - m.north * now.east, m.east * now.east + m.north * now.north);
    bent = std::max(0.0, bent);
    m.east = now.east;
    m.north = now.north;
    for (; bent > kSend && seconds - t > 1; bent -= kSend) {
      const double s = std::sin(left * (bent - kSend)), c = std::cos(bent - kSend);  // still to be turned
      sent.push_back({m.lat, m.lon, now.east * c + now.north * s, now.north * c - now.east * s});
      sent.back().left = seconds - t;
    }
  }
  return End::under_way;
}

}  // namespace glidehelm::planning
