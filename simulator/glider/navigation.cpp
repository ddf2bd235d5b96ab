#include "simulator/glider/navigation.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"

namespace glidehelm::simulator {

Heading aim(Bearing bearing, Current believed, MetresPerSecond speed) {
  const double cross = believed.east.si() * bearing.north() - believed.north.si() * bearing.east();
  const double sine = std::clamp(cross / speed.si(), -1.0, 1.0);
  return Heading{bearing.from_north()} + Radians{-std::asin(sine)};
}

int Navigator::first_target(GeoPoint here) const {
  const int count = static_cast<int>(list_.waypoints.size());
  if (list_.initial >= 0) return list_.initial;
  if (list_.initial == -1) {
    // A file holds 1e-4 minute, 0.2 m: the same place may come back a rounding away.
    constexpr Metres kSame{1.0};
    for (int i = 0; achieved_ && i < count; ++i)
      if (distance(list_.waypoints[static_cast<std::size_t>(i)], *achieved_) < kSame) return (i + 1) % count;
    return 0;
  }
  const auto nearer = [&](const GeoPoint& a, const GeoPoint& b) { return distance(here, a) < distance(here, b); };
  return static_cast<int>(std::min_element(list_.waypoints.begin(), list_.waypoints.end(), nearer) -
                          list_.waypoints.begin());
}

void Navigator::read(GotoList list, GeoPoint here, double now_s) {
  list_ = std::move(list);
  target_ = first_target(here);
  legs_left_ = list_.legs == -2 ? static_cast<int>(list_.waypoints.size()) - target_ : list_.legs;
  ended_ = false;
  since_s_ = now_s;
}

void Navigator::dive(GeoPoint at, double, Current measured) {
  lat_ = at.lat.radians();
  lon_ = at.lon.radians();
  used_ = belief_.correction == 0 ? Current{} : measured;
}

bool Navigator::is_hit(GeoPoint goal) const {
  if (list_.stop_when == 5) return false;
  // The geodesic distance never falls below this bound: a far waypoint needs no geodesic.
  const bool far = distance_lower_bound(lat_, lon_, goal.lat.radians(), goal.lon.radians()) > list_.radius.si();
  if (list_.stop_when == 15) return far || distance(reckoned(), goal) > list_.radius;
  return !far && distance(reckoned(), goal) < list_.radius;
}

void Navigator::hit_all(double now_s) {
  const int count = static_cast<int>(list_.waypoints.size());
  for (int tries = 0; tries < count && !ended_; ++tries) {  // a list inside one radius must not spin for ever
    const auto goal = waypoint();
    if (!is_hit(goal)) return;
    ++hits_;
    achieved_ = goal;
    achieved_s_ = now_s;
    if (legs_left_ > 0 && --legs_left_ == 0) {
      ended_ = true;
      return;
    }
    target_ = (target_ + 1) % count;
    since_s_ = now_s;
  }
}

Heading Navigator::cycle(double now_s, double dt, std::optional<MetresPerSecond> speed_now) {
  hit_all(now_s);
  if (!ended_) heading_ = aim(geodesic(reckoned(), waypoint()).departing, used_, belief_.speed);
  const double u = speed_now.value_or(belief_.speed).si();
  const auto metric = LocalMetric::at(lat_);
  lat_ += dt * (u * heading_.north() + used_.north.si()) / metric.meridian_radius;
  lon_ += dt * (u * heading_.east() + used_.east.si()) / metric.parallel_radius;
  return heading_;
}

}  // namespace glidehelm::simulator
