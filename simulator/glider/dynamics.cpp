#include "simulator/glider/dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/base/local_metric.hpp"
#include "core/base/utc.hpp"

namespace glidehelm::simulator {

std::string Accident::message() const {
  const char* word = what == What::aground      ? "aground"
                     : what == What::left_truth ? "left the area of the true ocean"
                     : what == What::sank       ? "cannot climb"
                                                : "the true ocean has no data after this time";
  char place[64];
  std::snprintf(place, sizeof place, "%.5f, %.5f", at.lat.degrees(), at.lon.degrees());
  return std::string{word} + " at " + place + ", " + utc_text(instant_at(t_s));
}

Dynamics::Dynamics(Hull hull, ocean::Ocean truth, const chart::Chart& chart)
    : hull_{hull}, truth_{truth}, chart_{&chart}, seabed_{hull.seabed, truth.dive} {
  if (!hull_.body) return;
  attack_dive_ = angle_of_attack(*hull_.body, hull_.body->pitch_dive);
  attack_climb_ = angle_of_attack(*hull_.body, hull_.body->pitch_climb);
}

void Dynamics::place(GeoPoint at, double t_s) {
  lat_ = at.lat.radians();
  lon_ = at.lon.radians();
  t_s_ = clean_s_ = t_s;
  depth_ = 0;
}

Leg Dynamics::leg(bool down, Metres depth) const {
  const double clean =
      hull_.fouling_per_day == 0 ? 1.0 : std::pow(1 - hull_.fouling_per_day, (t_s_ - clean_s_) / 86'400.0);
  if (!hull_.body) {
    const double u = hull_.speed.si() * clean;
    return {u, u * std::tan(hull_.glide_angle.si()), hull_.glide_angle.si()};
  }
  const auto flight = steady_flight(*hull_.body, down, depth, down ? attack_dive_ : attack_climb_);
  if (!flight) return {};
  return {clean * flight->horizontal.si(), clean * flight->vertical.si(), flight->path.si()};
}

/// ∫ dz/w(z) by Simpson's rule: w changes by tens of percent over a dive at most, smoothly.
double Dynamics::climb_seconds() const {
  const auto slowness = [&](double z) {
    const double w = leg(false, Metres{z}).vertical;
    return w > 0 ? 1 / w : std::numeric_limits<double>::infinity();
  };
  if (!hull_.body) return depth_ * slowness(depth_);
  constexpr int kPieces = 8;
  double sum = slowness(0) + slowness(depth_);
  for (int i = 1; i < kPieces; ++i) sum += (i % 2 == 1 ? 4 : 2) * slowness(depth_ * i / kPieces);
  return sum * depth_ / (3 * kPieces);
}

void Dynamics::begin_dive(const DiveOrders& orders) {
  orders_ = orders;
  half_cycles_ = pumped_ = touched_ = 0;
  pumped_depths_ = 0;
  coming_up_ = false;
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
  if (seabed_.exists())
    if (const auto floor = seabed_.depth(position(), t_s_, Metres{1}); floor && floor->si() < 0.5)
      return Accident{Accident::What::aground, position(), t_s_};
  // One array read excludes land nearly everywhere; only beside the shore is the coastline itself asked.
  constexpr double kNearShore = 500.0;
  if (chart_->has_coast() && chart_->clearance_at_least(lat_, lon_) < kNearShore && chart_->is_land(position()))
    return Accident{Accident::What::aground, position(), t_s_};
  return std::nullopt;
}

void Dynamics::turn_up() {
  down_ = false;
  ++half_cycles_;
  ++pumped_;
  pumped_depths_ += depth_;
}

/// The yo turns at its limits; the last climb starts when the way up takes all the time that is left.
void Dynamics::turn(double remaining, double dt) {
  if (coming_up_ || yo_is_over() || climb_seconds() >= remaining - 2 * dt) {
    if (down_) turn_up();
  } else if (down_) {
    const bool floats = leg().vertical <= 0;
    if (depth_ >= hull_.dive_depth.si() || floats) turn_up();
  } else if (depth_ <= hull_.climb_to.si()) {
    ++half_cycles_;
    down_ = !yo_is_over();
  }
}

/// The altimeter turns a dive in time; what it does not hear, the hull feels.
void Dynamics::meet_floor() {
  if (!seabed_.exists()) return;
  const auto floor = seabed_.depth(position(), t_s_, Metres{depth_ + std::max(1.0, hull_.altimeter_range.si())});
  if (!floor) return;
  const double altitude = floor->si() - depth_;
  if (altitude <= 0) {
    ++touched_;
    depth_ = floor->si();
    if (down_) turn_up();
  } else if (down_ && orders_.altimeter && altitude <= hull_.altimeter_range.si() &&
             altitude <= hull_.target_altitude.si()) {
    turn_up();
  }
}

std::optional<Accident> Dynamics::swim(Heading wanted, double dt, double remaining) {
  turn(remaining, dt);
  meet_floor();
  const Heading heading = wanted + hull_.heading_bias;
  const auto now = leg();
  if (!down_ && now.vertical <= 0) return Accident{Accident::What::sank, position(), t_s_};
  const double u = now.horizontal;
  const double sink = down_ ? now.vertical : -now.vertical;
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
