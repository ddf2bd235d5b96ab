#include "core/planning/front.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"
#include "core/planning/front_edge.hpp"

namespace glidehelm::planning {

namespace {

constexpr int kFirstHeadings = 120;
constexpr int kWallHalvings = 10;
constexpr double kNearCoast = 100;   // metres: what stops a marker farther from coasts is shallow water
constexpr int kMostContacts = 12;    // of one marker in a step
constexpr double kCheckedWay = 3e4;  // metres

}  // namespace

Front::Front(GeoPoint at, ocean::FieldRef dive, const chart::Chart& chart, double clearance, double spacing)
    : dive_{dive},
      chart_{chart},
      clearance_{clearance},
      spacing_{spacing},
      walk_{chart, clearance},
      lattice_{Squares::about(at.lat.radians(), at.lon.radians(), 0.5 * spacing)} {
  for (int i = 0; i < kFirstHeadings; ++i) {
    const auto n = turned(0, 1, 2 * kPi * i / kFirstHeadings);
    markers_.push_back({at.lat.radians(), at.lon.radians(), n.east, n.north});
  }
}

void Front::move(ocean::FieldRef field, double speed, double t_s, double dt, std::span<Marker* const> moving) {
  ocean::Lanes lanes;
  lanes.count = static_cast<int>(2 * moving.size());
  for (std::size_t n = 0; n < moving.size(); ++n) {
    const Marker& m = *moving[n];
    const std::size_t k = 2 * n;
    const auto heading = turned(m.east, m.north, 0.5 * m.turn * dt);
    const auto metric = LocalMetric::at(m.lat);
    lanes.lat[k] = m.lat;
    lanes.lon[k] = m.lon;
    lanes.lat[k + 1] = m.lat - kBeside * m.east / metric.meridian_radius;  // the front runs to the right of its normal
    lanes.lon[k + 1] = m.lon + kBeside * m.north / LocalMetric::at(lanes.lat[k + 1]).parallel_radius;
    for (const std::size_t lane : {k, k + 1}) {
      lanes.water_east[lane] = speed * heading.east;
      lanes.water_north[lane] = speed * heading.north;
      lanes.lost[lane] = 0;
    }
  }
  field.advance(lanes, t_s, dt);
  evaluations_ += 4 * static_cast<std::size_t>(lanes.count);
  for (std::size_t n = 0; n < moving.size(); ++n) {
    Marker& m = *moving[n];
    const Marker before = m;
    const std::size_t k = 2 * n;
    m.lat = lanes.lat[k];
    m.lon = lanes.lon[k];
    if (lanes.lost[k] == 0 && lanes.lost[k + 1] == 0) {
      // Both metrics at the companion's latitude, as at the start: what the two share cancels.
      const double east = (lanes.lon[k + 1] - m.lon) * LocalMetric::at(lanes.lat[k + 1]).parallel_radius;
      const double north = (lanes.lat[k + 1] - m.lat) * LocalMetric::at(m.lat).meridian_radius;
      const double length = std::hypot(east, north);
      if (length > 0) {
        m.east = -north / length;
        m.north = east / length;
        m.turn = turn_between(before, m) / dt;
      }
    }
    settle(m, before, field, speed, t_s, dt, lanes.lost[k]);
  }
}

bool Front::clear_way(const Marker& from, double lat, double lon) const {
  const double way = local_offset(from.lat, from.lon, lat, lon).length();
  if (chart_.clearance_at_least(from.lat, from.lon) - way >= clearance_) return true;
  return chart_.segment_is_clear(from.lat, from.lon, lat, lon, clearance_);
}

/// After a step: the marker is where it came to, or at the wall on its way there. `lost`: 0, or the NoCurrent it ran into.
void Front::settle(Marker& m, const Marker& before, ocean::FieldRef field, double speed, double t_s, double dt,
                   std::uint8_t lost) {
  if (lost == 0 && clear_way(before, m.lat, m.lon)) {
    m.stuck = false;
    m.left = 0;
    return;
  }
  const auto is = [lost](ocean::NoCurrent reason) { return lost == static_cast<std::uint8_t>(reason); };
  met_dry_ = met_dry_ || (lost != 0 && !is(ocean::NoCurrent::outside_area) && !is(ocean::NoCurrent::outside_time));
  double dlat = m.lat - before.lat, dlon = m.lon - before.lon;
  if (lost != 0) {  // it was not moved: straight on through the water
    const auto metric = LocalMetric::at(before.lat);
    const double way = speed * dt;
    dlat = way * before.north / metric.meridian_radius;
    dlon = way * before.east / metric.parallel_radius;
  }
  double good = 0, bad = 1;
  for (int i = 0; i < kWallHalvings && (dlat != 0 || dlon != 0); ++i) {
    const double u = 0.5 * (good + bad), lat = before.lat + u * dlat, lon = before.lon + u * dlon;
    const bool clear =
        clear_way(before, lat, lon) && field.sample(GeoPoint::from_kernel(lat, lon), t_s + u * dt).has_value();
    (clear ? good : bad) = u;
  }
  m = before;
  m.lat += good * dlat;
  m.lon += good * dlon;
  m.turn = 0;
  m.stuck = true;
  m.left = (1 - good) * dt;
  if (lost != 0) return;
  m.landed = walk_.settle(m);
  m.coast = m.landed || chart_.clearance(m.lat, m.lon) < clearance_ + kNearCoast;  // else it has come between two walls
  met_coast_ = met_coast_ || m.coast;
  met_shallows_ = met_shallows_ || !m.coast;
}

/// The spacing in force: half the distance to a coast, between `kFinest` of the spacing and all of it. A front that touches a round
/// coast of radius R between two markers h apart is late by about 0.5·h^1.5/√R.
double Front::spacing_near(double lat, double lon) const {
  return std::clamp(0.5 * (chart_.clearance_at_least(lat, lon) - clearance_), kFinest * spacing_, spacing_);
}

std::optional<double> Front::advance(ocean::FieldRef field, double speed, double t_s, double dt,
                                     const vehicle::Disc& goal, bool retry) {
  before_ = markers_;
  moving_.clear();
  for (std::size_t i = 0; i < markers_.size(); ++i)
    if (!markers_[i].idle && (!markers_[i].stuck || (retry && !markers_[i].coast))) moving_.push_back(&markers_[i]);
  constexpr std::size_t kBatch = ocean::Lanes::kMax / 2;
  for (std::size_t first = 0; first < moving_.size(); first += kBatch)
    move(field, speed, t_s, dt, std::span{moving_}.subspan(first, std::min(kBatch, moving_.size() - first)));
  graze(field, speed, t_s, dt);
  rest_inside(t_s);
  walk(field, speed, t_s, dt);
  auto arrival = entry(goal, dt, (speed + field.fastest().si()) * dt);
  const auto note = [&](std::optional<double> other) {
    if (other) arrival = std::min(arrival.value_or(dt), *other);
  };
  note(send_off(field, speed, t_s, dt, goal));
  part_at_coasts(field, speed, t_s, dt);
  note(send_off(field, speed, t_s, dt, goal));
  for (int round = 0; round < kMostContacts && fan_out(); ++round)
    for (Marker* m : moving_) move(field, speed, t_s + dt - m->left, m->left, std::span{&m, 1});
  return arrival;
}

std::optional<double> Front::entry(const vehicle::Disc& goal, double dt, double reach) {
  room_ -= reach;
  if (room_ > 0) return std::nullopt;
  const double lat = goal.centre.lat.radians(), lon = goal.centre.lon.radians(), radius = goal.radius.si();
  double nearest = 1e18;
  for (const auto& m : markers_) nearest = std::min(nearest, distance_lower_bound(m.lat, m.lon, lat, lon));
  // Between two markers the front is at most its edge nearer.
  room_ = nearest - radius - 2 * spacing_ - reach;
  if (room_ > 0) return std::nullopt;
  const auto metric = LocalMetric::at(lat);
  const auto place = [&](const Marker& m) {
    return Offset{std::remainder(m.lon - lon, 2 * kPi) * metric.parallel_radius,
                  (m.lat - lat) * metric.meridian_radius};
  };
  std::optional<double> first;
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    const std::size_t j = i + 1 == markers_.size() ? 0 : i + 1;
    const auto a1 = place(markers_[i]), b1 = place(markers_[j]);
    if (a1.length() > radius + 4 * spacing_ + 2 * reach + kCheckedWay) continue;
    const auto a0 = place(before_[i]), b0 = place(before_[j]);
    const bool joined = before_[i].joins;  // its end is a front all the same
    const auto distance_at = [&](double u) {
      const double ax = a0.east + u * (a1.east - a0.east), ay = a0.north + u * (a1.north - a0.north);
      if (joined) return std::hypot(ax, ay);
      const double bx = b0.east + u * (b1.east - b0.east), by = b0.north + u * (b1.north - b0.north);
      return segment_distance(ax, ay, bx, by);
    };
    double outside = 0;
    if (distance_at(0) <= radius) return 0.0;
    if (distance_at(0) > radius + 2 * reach) continue;
    const int parts = std::clamp(static_cast<int>(4 * reach / std::max(1.0, radius)) + 2, 2, 256);
    for (int part = 1; part <= parts; ++part) {
      double inside = static_cast<double>(part) / parts;
      if (first && outside * dt >= *first) break;
      if (distance_at(inside) > radius) {
        outside = inside;
        continue;
      }
      while ((inside - outside) * dt > 0.05) {
        const double middle = 0.5 * (inside + outside);
        (distance_at(middle) <= radius ? inside : outside) = middle;
      }
      first = std::min(first.value_or(dt), inside * dt);
      break;
    }
  }
  return first;
}

void Front::stop(const std::function<bool(double lat, double lon)>& useless) {
  for (auto& m : markers_) m.idle = m.idle || useless(m.lat, m.lon);
}

}  // namespace glidehelm::planning
