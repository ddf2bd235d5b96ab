#include "simulator/glider/dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/local_metric.hpp"
#include "core/base/utc.hpp"

namespace glidehelm::simulator {

std::string Accident::message() const {
  const char* word = what == What::aground      ? "aground"
                     : what == What::left_truth ? "left the area of the true ocean"
                                                : "the true ocean has no data after this time";
  char place[64];
  std::snprintf(place, sizeof place, "%.5f, %.5f", at.lat.degrees(), at.lon.degrees());
  return std::string{word} + " at " + place + ", " + utc_text(instant_at(t_s));
}

void Dynamics::place(GeoPoint at, double t_s) {
  lat_ = at.lat.radians();
  lon_ = at.lon.radians();
  t_s_ = t_s;
  depth_ = 0;
}

void Dynamics::begin_dive() {
  down_ = true;
  depth_ = deepest_ = 0;
  swum_s_ = sum_east_ = sum_north_ = water_east_ = water_north_ = 0;
}

/// Water without a value carries on with the last current; what counts as land depends on the chart (header).
std::optional<Accident> Dynamics::current_at(const ocean::FieldRef& field, double lat, double lon, double depth,
                                             double t_s, Current& into) {
  const auto p = GeoPoint::from_kernel(lat, lon);
  const auto sample = field.sample(p, Depth{Metres{depth}}, t_s);
  if (sample) {
    into = last_ = sample->current;
    return std::nullopt;
  }
  switch (sample.error()) {
    case ocean::NoCurrent::outside_area:
      return Accident{Accident::What::left_truth, p, t_s};
    case ocean::NoCurrent::outside_time:
      return Accident{Accident::What::truth_ended, p, t_s};
    case ocean::NoCurrent::land:
      if (!chart_->has_coast()) return Accident{Accident::What::aground, p, t_s};
      break;
    case ocean::NoCurrent::no_data:
    case ocean::NoCurrent::below_bottom:
      break;
  }
  into = last_;
  return std::nullopt;
}

std::optional<Accident> Dynamics::move(const ocean::FieldRef& field, double east, double north, double dt,
                                       double sink) {
  Current c;
  if (auto accident = current_at(field, lat_, lon_, depth_, t_s_, c)) return accident;
  const auto here = LocalMetric::at(lat_);
  const double mid_lat = lat_ + 0.5 * dt * (north + c.north.si()) / here.meridian_radius;
  const double mid_lon = lon_ + 0.5 * dt * (east + c.east.si()) / here.parallel_radius;
  if (auto accident = current_at(field, mid_lat, mid_lon, std::max(0.0, depth_ + 0.5 * dt * sink), t_s_ + 0.5 * dt, c))
    return accident;
  const auto mid = LocalMetric::at(mid_lat);
  lat_ += dt * (north + c.north.si()) / mid.meridian_radius;
  lon_ += dt * (east + c.east.si()) / mid.parallel_radius;
  t_s_ += dt;
  water_east_ += dt * c.east.si();
  water_north_ += dt * c.north.si();
  // One array read excludes land nearly everywhere; only beside the shore is the coastline itself asked.
  constexpr double kNearShore = 500.0;
  if (chart_->has_coast() && chart_->clearance_at_least(lat_, lon_) < kNearShore && chart_->is_land(position()))
    return Accident{Accident::What::aground, position(), t_s_};
  return std::nullopt;
}

/// The yo turns at its limits; the last climb starts when the way up takes all the time that is left.
void Dynamics::turn(double remaining, double dt) {
  const double rate = hull_.speed.si() * std::tan(hull_.glide_angle.si());
  if (depth_ >= rate * (remaining - 2 * dt))
    down_ = false;
  else if (depth_ >= hull_.dive_depth.si())
    down_ = false;
  else if (depth_ <= hull_.climb_to.si())
    down_ = true;
}

std::optional<Accident> Dynamics::swim(Heading wanted, double dt, double remaining) {
  turn(remaining, dt);
  const Heading heading = wanted + hull_.heading_bias;
  const double u = hull_.speed.si();
  const double rate = u * std::tan(hull_.glide_angle.si());
  const double sink = down_ ? rate : -rate;
  if (auto accident = move(truth_.dive, u * heading.east(), u * heading.north(), dt, sink)) return accident;
  depth_ = std::clamp(depth_ + sink * dt, 0.0, hull_.dive_depth.si());
  deepest_ = std::max(deepest_, depth_);
  swum_s_ += dt;
  sum_east_ += dt * heading.east();
  sum_north_ += dt * heading.north();
  if (remaining <= dt) depth_ = 0;
  return std::nullopt;
}

std::optional<Accident> Dynamics::drift(double until_s) {
  constexpr double kLongestStep = 60.0;
  const double wet_east = water_east_, wet_north = water_north_;  // the means belong to the dive
  while (t_s_ < until_s) {
    const double dt = std::min(kLongestStep, until_s - t_s_);
    auto accident = move(truth_.surface, hull_.leeway.east.si(), hull_.leeway.north.si(), dt, 0.0);
    water_east_ = wet_east;
    water_north_ = wet_north;
    if (accident) return accident;
    if (until_s - t_s_ < 1e-6) t_s_ = until_s;  // rounding must not leave a step of nanoseconds
  }
  return std::nullopt;
}

DiveTruth Dynamics::dive_truth() const {
  if (swum_s_ == 0) return {};
  return {{MetresPerSecond{water_east_ / swum_s_}, MetresPerSecond{water_north_ / swum_s_}},
          Heading::of(sum_east_, sum_north_)};
}

}  // namespace glidehelm::simulator
