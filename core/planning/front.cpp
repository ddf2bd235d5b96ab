#include "core/planning/front.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"

namespace glidehelm::planning {

namespace {

constexpr int kFirstHeadings = 120;
constexpr double kMostTurn = 0.12;   // radians between the normals of neighbours
constexpr double kSmoothTurn = 1.0;  // radians: beyond it an edge is a cusp, not a smooth arc
constexpr double kShortest = 0.15;   // of the spacing: shorter edges are not refined by their turn
constexpr int kWallHalvings = 6;
constexpr int kFan = 6;              // headings to each side of a marker at a wall
constexpr int kMostContacts = 12;    // of one marker in a step
constexpr double kCheckedWay = 3e4;  // metres

Offset turned(double east, double north, double clockwise) {
  const double s = std::sin(clockwise), c = std::cos(clockwise);
  return {east * c + north * s, north * c - east * s};
}
double turn_between(const Marker& a, const Marker& b) {  // clockwise from a's normal to b's
  return std::atan2(b.east * a.north - b.north * a.east, a.east * b.east + a.north * b.north);
}
/// Planar offset; edges are short against the Earth.
Offset from_to(const Marker& a, const Marker& b) {
  const auto metric = LocalMetric::at(0.5 * (a.lat + b.lat));
  return {(b.lon - a.lon) * metric.parallel_radius, (b.lat - a.lat) * metric.meridian_radius};
}
void shift(Marker& m, const Offset& by) {
  const auto metric = LocalMetric::at(m.lat);
  const double lat = m.lat + by.north / metric.meridian_radius;
  m.lon += by.east / LocalMetric::at(0.5 * (m.lat + lat)).parallel_radius;
  m.lat = lat;
}
double segment_distance(double x0, double y0, double x1, double y1) {
  const double dx = x1 - x0, dy = y1 - y0, l2 = dx * dx + dy * dy;
  const double u = l2 > 0 ? std::clamp(-(x0 * dx + y0 * dy) / l2, 0.0, 1.0) : 0.0;
  return std::hypot(x0 + u * dx, y0 + u * dy);
}

}  // namespace

Front::Front(GeoPoint at, ocean::FieldRef dive, const chart::Chart& chart, double clearance, double spacing)
    : dive_{dive},
      chart_{chart},
      clearance_{clearance},
      spacing_{spacing},
      lattice_{Lattice::about(at.lat.radians(), at.lon.radians(), 0.5 * spacing)} {
  for (int i = 0; i < kFirstHeadings; ++i) {
    const auto n = turned(0, 1, 2 * kPi * i / kFirstHeadings);
    markers_.push_back({at.lat.radians(), at.lon.radians(), n.east, n.north});
  }
}

void Front::move_batch(ocean::FieldRef field, double speed, double t_s, double dt, std::size_t first,
                       std::size_t last) {
  ocean::Lanes lanes;
  std::array<Offset, ocean::Lanes::kMax / 2> held;
  lanes.count = static_cast<int>(2 * (last - first));
  for (std::size_t n = first; n < last; ++n) {
    const Marker& m = markers_[moving_[n]];
    const std::size_t k = 2 * (n - first);
    const auto heading = held[n - first] = turned(m.east, m.north, 0.5 * m.turn * dt);
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
  for (std::size_t n = first; n < last; ++n) {
    Marker& m = markers_[moving_[n]];
    const Marker before = m;
    const std::size_t k = 2 * (n - first);
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
  met_land_ = met_land_ || lost == 0;
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
}

std::optional<double> Front::advance(ocean::FieldRef field, double speed, double t_s, double dt,
                                     const vehicle::Disc& goal, bool retry) {
  before_ = markers_;
  moving_.clear();
  for (std::size_t i = 0; i < markers_.size(); ++i)
    if (!markers_[i].idle && (!markers_[i].stuck || retry)) moving_.push_back(i);
  constexpr std::size_t kBatch = ocean::Lanes::kMax / 2;
  for (std::size_t first = 0; first < moving_.size(); first += kBatch)
    move_batch(field, speed, t_s, dt, first, std::min(first + kBatch, moving_.size()));
  const auto arrival = entry(goal, dt, (speed + field.fastest().si()) * dt);
  for (int round = 0; round < kMostContacts && fan_out(); ++round)
    for (std::size_t n = 0; n < moving_.size(); ++n) {
      const double left = markers_[moving_[n]].left;
      move_batch(field, speed, t_s + dt - left, left, n, n + 1);
    }
  return arrival;
}

std::int64_t Front::wall_cell(const Marker& m) const {
  const double size = 0.5 * spacing_ / 6.371e6;
  const auto row = static_cast<std::int64_t>(std::floor(m.lat / size));
  const auto column = static_cast<std::int64_t>(std::floor(m.lon * std::cos(size * static_cast<double>(row)) / size));
  return row * 0x100000000 + column;
}

/// Markers that have just met a wall send headings to all sides. `moving_` are the new markers, which still have what the
/// step had left at the wall. False when there are none.
bool Front::fan_out() {
  moving_.clear();
  bool any = false;
  for (auto& m : markers_) {
    if (!m.stuck) m.fanned = false;
    if (m.stuck && !m.fanned) {
      m.fanned = !walls_.insert(wall_cell(m)).second;
      any = any || !m.fanned;
    }
  }
  if (!any) return false;
  std::vector<Marker> out;
  out.reserve(markers_.size() + 64);
  for (auto& m : markers_) {
    if (!m.stuck || m.fanned) {
      out.push_back(m);
      continue;
    }
    m.fanned = true;
    for (int i = -kFan; i <= kFan; ++i) {
      Marker side = m;
      const auto n = turned(m.east, m.north, i * kPi / (kFan + 0.5));
      side.east = n.east;
      side.north = n.north;
      side.stuck = i == 0;
      side.joins = i == kFan && m.joins;
      if (i != 0 && side.left > 1.0) moving_.push_back(out.size());
      out.push_back(side);
    }
  }
  markers_ = std::move(out);
  return !moving_.empty();
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

/// The front's end at a wall: it sends headings to the wall's side, which follow the wall round corners. Once in each cell.
void Front::creep(const Marker& a, const Marker& b, std::vector<Marker>& out) {
  const Marker& end = a.stuck ? b : a;
  if (!creeps_.insert(wall_cell(end)).second) return;
  for (int i = 1; i <= kFan; ++i) {  // clockwise order along the front
    Marker side = end;
    const int k = a.stuck ? i - kFan - 1 : i;
    const auto n = turned(end.east, end.north, k * kPi / (kFan + 1));
    side.east = n.east;
    side.north = n.north;
    side.turn = 0;
    side.joins = false;
    out.push_back(side);
  }
}

/// The markers between two neighbours.
void Front::add_between(const Marker& a, const Marker& b, std::vector<Marker>& out) {
  if (a.joins || (a.idle && b.idle)) return;
  const auto way = from_to(a, b);
  const double length = way.length(), turn = turn_between(a, b);
  if (length <= kShortest * spacing_) return;
  const bool wall = a.stuck || b.stuck;
  const double wanted = std::max(length / spacing_, wall ? 0.0 : std::min(std::abs(turn), kSmoothTurn) / kMostTurn);
  const int parts = std::min(static_cast<int>(std::ceil(wanted)), 16);
  if (parts < 2 && !(wall && a.stuck != b.stuck)) return;
  // The front runs to the right of its normals: (north, −east).
  const bool along = a.north * way.east - a.east * way.north > 0 && b.north * way.east - b.east * way.north > 0;
  const bool smooth = !wall && std::abs(turn) < kSmoothTurn && along;
  if (wall && !(a.stuck && b.stuck)) creep(a, b, out);
  const bool near_wall = chart_.clearance_at_least(a.lat, a.lon) - length < clearance_;
  for (int i = 1; i < parts; ++i) {
    const double u = static_cast<double>(i) / parts, u2 = u * u, u3 = u2 * u;
    Marker m = a;
    m.stuck = m.fanned = m.joins = m.idle = false;
    m.turn = (1 - u) * a.turn + u * b.turn;
    if (smooth) {
      const double h10 = length * (u3 - 2 * u2 + u), h01 = 3 * u2 - 2 * u3, h11 = length * (u3 - u2);
      shift(m, {h10 * a.north + h01 * way.east + h11 * b.north, -h10 * a.east + h01 * way.north - h11 * b.east});
      const double d10 = length * (3 * u2 - 4 * u + 1), d01 = 6 * u - 6 * u2, d11 = length * (3 * u2 - 2 * u);
      const Offset t{d10 * a.north + d01 * way.east + d11 * b.north, -d10 * a.east + d01 * way.north - d11 * b.east};
      const double l = t.length();
      m.east = -t.north / l;
      m.north = t.east / l;
    } else {
      shift(m, {u * way.east, u * way.north});
      const auto n = wall ? Offset{-way.north / length, way.east / length} : turned(a.east, a.north, u * turn);
      m.east = n.east;
      m.north = n.north;
      if (wall) m.turn = 0;
    }
    // Nothing is put behind land.
    if (near_wall && !clear_way(a, m.lat, m.lon) && !clear_way(b, m.lat, m.lon)) continue;
    out.push_back(m);
  }
}

void Front::stop(const std::function<bool(double lat, double lon)>& useless) {
  for (auto& m : markers_) m.idle = m.idle || useless(m.lat, m.lon);
}

void Front::refine() {
  std::vector<Marker> out;
  out.reserve(markers_.size() + markers_.size() / 4);
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    const Marker& m = markers_[i];
    const Marker& next = markers_[i + 1 == markers_.size() ? 0 : i + 1];
    if (!out.empty() && i + 1 < markers_.size() && !m.joins && !out.back().joins) {
      const Marker& last = out.back();
      const double length = from_to(last, m).length() + from_to(m, next).length();
      const auto rests = [](const Marker& x) { return x.stuck || x.idle; };
      const bool resting = rests(last) && rests(m) && rests(next);
      const bool free = !rests(last) && !rests(m) && !rests(next);
      if (resting ? length < spacing_
                  : free && length < 0.6 * spacing_ && std::abs(turn_between(last, m)) < 0.5 * kMostTurn &&
                        std::abs(turn_between(last, next)) < 0.8 * kMostTurn)
        continue;
    }
    out.push_back(m);
    if (out.size() < kMostMarkers)
      add_between(m, next, out);
    else
      complete_ = false;
  }
  markers_ = std::move(out);
}

bool Front::blocked(std::int64_t row, std::int64_t column, double t_s) {
  const auto key = row * 0x100000000 + column;
  const auto known = blocked_.find(key);
  if (known != blocked_.end()) return known->second;
  const double lat = lattice_.lat + (static_cast<double>(row) + 0.5) / lattice_.per_lat;
  const double lon = lattice_.lon + (static_cast<double>(column) + 0.5) / lattice_.per_lon;
  const bool blocked =
      !(chart_.clearance_at_least(lat, lon) >= clearance_ || chart_.clearance(lat, lon) >= clearance_) ||
      !dive_.sample(GeoPoint::from_kernel(lat, lon), t_s);
  blocked_.emplace(key, blocked);
  return blocked;
}

void Front::prune(double t_s) {
  if (markers_.size() < after_prune_ + after_prune_ / 8) return;
  const auto deep =
      deep_inside(markers_, lattice_, [&](std::int64_t row, std::int64_t column) { return blocked(row, column, t_s); });
  std::vector<Marker> kept;
  kept.reserve(markers_.size());
  const std::size_t count = markers_.size();
  std::size_t begin = 0;  // of the walk round: right after a marker that stays
  while (begin < count && deep[begin]) ++begin;
  if (begin == count) return;
  for (std::size_t n = 0; n < count;) {
    const std::size_t at = (begin + n) % count;
    if (!deep[at]) {
      kept.push_back(markers_[at]);
      ++n;
      continue;
    }
    // A run that goes. Its first and last markers at walls stay: there the front's ends run along the walls.
    std::size_t length = 0, first = count, last = count;
    for (; n + length < count && deep[(begin + n + length) % count]; ++length)
      if (markers_[(begin + n + length) % count].stuck) {
        if (first == count) first = n + length;
        last = n + length;
      }
    if (first == count) {
      kept.back().joins = true;
    } else {
      kept.push_back(markers_[(begin + first) % count]);
      kept.back().joins = true;
      if (last != first) kept.push_back(markers_[(begin + last) % count]);
      kept.back().joins = last != first ? markers_[(begin + last) % count].joins : false;
    }
    n += length;
  }
  if (kept.size() < 3) return;
  markers_ = std::move(kept);
  after_prune_ = markers_.size();
}

}  // namespace glidehelm::planning
