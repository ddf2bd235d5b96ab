#include "core/planning/front.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"
#include "core/planning/front_edge.hpp"

namespace glidehelm::planning {

namespace {

constexpr int kFirstHeadings = 120;
constexpr double kMostTurn = 0.12;  // radians between the normals of neighbours
constexpr double kShortest = 0.15;  // of the spacing: shorter edges are not refined by their turn
constexpr int kWallHalvings = 10;
constexpr double kFinest = 0.15;  // of the spacing: beside coasts
constexpr double kOpenShare =
    0.1;                       // of an edge between two coasts: clearance of its middle when there is water between
constexpr int kHalvings = 6;   // of an edge of which one end has met a coast
constexpr int kStraits = 3;    // halvings of an edge whose ends have met two coasts
constexpr unsigned kLook = 2;  // steps after which walkers are looked at, whether they are inside
constexpr double kNearCoast = 100;  // metres: what stops a marker farther from coasts is shallow water
constexpr double kTrail = 0.25;     // of the spacing: between markers that a walker leaves behind
constexpr double kStraight =
    0.01;  // of the spacing: by as much a marker at a coast may lie off its neighbours' chord and be dropped
constexpr int kFan = 6;              // headings to each side of a marker at a wall
constexpr int kMostContacts = 12;    // of one marker in a step
constexpr double kCheckedWay = 3e4;  // metres

}  // namespace

Front::Front(GeoPoint at, ocean::FieldRef dive, const chart::Chart& chart, double clearance, double spacing)
    : dive_{dive},
      chart_{chart},
      clearance_{clearance},
      spacing_{spacing},
      walk_{chart, clearance},
      lattice_{Lattice::about(at.lat.radians(), at.lon.radians(), 0.5 * spacing)} {
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

/// Moves the front's ends along their coasts.
void Front::walk(ocean::FieldRef field, double speed, double t_s, double dt) {
  const std::size_t n = markers_.size();
  for (std::size_t i = 0; i < n; ++i) {
    Marker& m = markers_[i];
    if (!m.coast || m.done || m.landed || m.idle) continue;
    const Marker &next = markers_[i + 1 == n ? 0 : i + 1], &last = markers_[i == 0 ? n - 1 : i - 1];
    m.forward = !m.joins && (m.forward || !next.stuck);
    m.back = !last.joins && (m.back || !last.stuck);
    if (m.forward && m.back) {  // nothing beside it at the coast any more: as if it had just come
      m.landed = true;
      m.left = dt;
      continue;
    }
    if (m.forward)
      walk_one(i, WallWalk::Way::forward, field, speed, t_s, dt);
    else if (m.back)
      walk_one(i, WallWalk::Way::back, field, speed, t_s, dt);
  }
}

void Front::walk_one(std::size_t i, WallWalk::Way way, ocean::FieldRef field, double speed, double t_s, double dt) {
  const std::size_t n = markers_.size();
  const bool forward = way == WallWalk::Way::forward;
  Marker &m = markers_[i], &ahead = markers_[forward ? (i + 1 == n ? 0 : i + 1) : (i == 0 ? n - 1 : i - 1)];
  std::vector<Marker> sent;
  const auto end = walk_.walk(m, way, ahead.coast ? &ahead : nullptr, field, speed, t_s, dt, sent);
  if (!sent.empty()) sent_.push_back({i, forward, std::move(sent)});
  if (end == WallWalk::End::under_way) return;
  m.forward = m.back = false;
  if (end == WallWalk::End::met) (forward ? ahead.back : ahead.forward) = false;
  met_shallows_ = met_shallows_ || end == WallWalk::End::no_water;
}

bool Front::water_between(const Marker& a, const Marker& b) const {
  return chart_.clearance(0.5 * (a.lat + b.lat), 0.5 * (a.lon + b.lon)) - clearance_ >
         kOpenShare * from_to(a, b).length();
}

/// Where one of two neighbours has just met a coast and the other has not, the way that grazes its corner lies between them; where
/// both have, on two sides of a strait, the way into that. It is looked for by halving the edge as it was before the step.
void Front::graze(ocean::FieldRef field, double speed, double t_s, double dt) {
  if (std::none_of(moving_.begin(), moving_.end(), [](const Marker* m) { return m->landed; })) return;
  std::vector<Marker> now, before;
  const auto put = [&](const Marker& then, const Marker& m) {
    before.push_back(then);
    now.push_back(m);
  };
  const std::function<void(Marker, Marker, Marker, Marker, int)> look = [&](Marker a0, Marker a1, Marker b0, Marker b1,
                                                                            int straits) {
    const auto middle = [&] {
      const Marker m0 = FrontEdge{a0, b0}.at(0.5);
      Marker m1 = m0, *moved = &m1;
      move(field, speed, t_s, dt, std::span{&moved, 1});
      return std::pair{m0, m1};
    };
    if (a1.landed && b1.landed) {
      if (straits == 0 || !water_between(a1, b1)) return;
      const auto [m0, m1] = middle();
      look(a0, a1, m0, m1, straits - 1);
      put(m0, m1);
      look(m0, m1, b0, b1, straits - 1);
    } else if ((a1.landed && !b1.stuck) || (b1.landed && !a1.stuck)) {
      bool nearer_a = false, nearer_b = false;
      for (int i = 0; i < kHalvings; ++i) {
        const auto [m0, m1] = middle();
        const bool for_a = m1.stuck == a1.stuck;
        (for_a ? a0 : b0) = m0;
        (for_a ? a1 : b1) = m1;
        (for_a ? nearer_a : nearer_b) = true;
      }
      if (nearer_a) put(a0, a1);
      if (nearer_b) put(b0, b1);
    }
  };
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    const std::size_t j = i + 1 == markers_.size() ? 0 : i + 1;
    now.push_back(markers_[i]);
    before.push_back(before_[i]);
    const Marker &a0 = before_[i], &b0 = before_[j];
    if (!a0.stuck && !b0.stuck && !a0.joins && !a0.idle && !b0.idle) look(a0, markers_[i], b0, markers_[j], kStraits);
  }
  markers_ = std::move(now);
  before_ = std::move(before);
}

/// Puts what walkers have sent off between them and the front, and moves it for what was left of the step. Gives the arrival of the
/// first of them at the goal.
std::optional<double> Front::send_off(ocean::FieldRef field, double speed, double t_s, double dt,
                                      const vehicle::Disc& goal) {
  if (sent_.empty()) return std::nullopt;
  std::vector<Marker> out;
  std::vector<std::size_t> moving;
  const auto put = [&](const Marker& m) {
    moving.push_back(out.size());
    out.push_back(m);
  };
  std::size_t next = 0;
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    const bool sends = next < sent_.size() && sent_[next].from == i;
    const bool forward = sends && sent_[next].forward;
    if (sends && !forward) std::for_each(sent_[next].markers.begin(), sent_[next].markers.end(), put);
    out.push_back(markers_[i]);
    if (sends && forward) std::for_each(sent_[next].markers.rbegin(), sent_[next].markers.rend(), put);
    next += sends ? 1 : 0;
  }
  markers_ = std::move(out);
  sent_.clear();
  std::optional<double> first;
  for (const auto i : moving) {
    Marker* m = &markers_[i];
    const Marker before = *m;
    move(field, speed, t_s + dt - before.left, before.left, std::span{&m, 1});
    const auto share = vehicle::entry_into(goal, before.lat, before.lon, m->lat, m->lon);
    if (share) first = std::min(first.value_or(dt), dt - (1 - *share) * before.left);
  }
  // What comes back to a coast at once is of no use: the walkers are there.
  for (auto i = moving.rbegin(); i != moving.rend(); ++i)
    if (markers_[*i].landed) markers_.erase(markers_.begin() + static_cast<std::ptrdiff_t>(*i));
  return first;
}

/// Whether a walker is beyond a marker that met the same coast beside it: one that runs along the wall and touches it at last.
bool Front::has_passed(const Marker& walker, const Marker& m) const {
  const auto way = from_to(walker, m);
  const double ahead = way.east * walker.east + way.north * walker.north;
  const double beside = std::abs(way.east * walker.north - way.north * walker.east);
  return ahead < WallWalk::kMeet && beside < WallWalk::kMeet + 0.3 * std::abs(ahead) &&
         way.length() < kFinest * spacing_;
}

/// Markers that have just met a coast become two, which walk to both sides for what is left of the step.
void Front::part_at_coasts(ocean::FieldRef field, double speed, double t_s, double dt) {
  if (std::none_of(markers_.begin(), markers_.end(), [](const Marker& m) { return m.landed; })) return;
  std::vector<Marker> out;
  std::vector<std::size_t> parted;
  out.reserve(markers_.size() + 64);
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    Marker& m = markers_[i];
    if (!m.landed) {
      out.push_back(m);
      continue;
    }
    m.landed = false;
    const Marker& next = markers_[i + 1 == markers_.size() ? 0 : i + 1];
    if (!out.empty() && !out.back().joins && !m.joins &&
        ((out.back().forward && has_passed(out.back(), m)) || (next.back && has_passed(next, m))))
      continue;
    Marker first = m;
    first.joins = false;
    first.back = m.forward = true;
    parted.push_back(out.size());
    out.push_back(first);
    out.push_back(m);
  }
  markers_ = std::move(out);
  for (const auto i : parted) {
    const double left = markers_[i].left;
    walk_one(i, WallWalk::Way::back, field, speed, t_s + dt - left, left);
    walk_one(i + 1, WallWalk::Way::forward, field, speed, t_s + dt - left, left);
  }
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
    if (m.stuck && !m.coast && !m.fanned) {
      m.fanned = !walls_.insert(wall_cell(m)).second;
      any = any || !m.fanned;
    }
  }
  if (!any) return false;
  std::vector<Marker> out;
  std::vector<std::size_t> senders;
  out.reserve(markers_.size() + 64);
  for (auto& m : markers_) {
    if (!m.stuck || m.coast || m.fanned) {
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
      if (i != 0 && side.left > 1.0) senders.push_back(out.size());
      out.push_back(side);
    }
  }
  markers_ = std::move(out);
  for (const auto i : senders) moving_.push_back(&markers_[i]);
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
  const bool coasts = a.coast && b.coast;
  if (coasts && !(a.forward && b.back)) return;  // the coast itself
  const FrontEdge edge{a, b};
  const double length = edge.length();
  if (length <= kShortest * spacing_) return;
  // Two ends that walk towards each other: along one coast, unless there is water between.
  if (coasts && !water_between(a, b)) return;
  const bool wall = (a.stuck && !a.coast) || (b.stuck && !b.coast);
  const double turn = edge.shape() == FrontEdge::Shape::chord ? 0.0 : std::abs(edge.turn());
  const double spacing = wall ? spacing_ : spacing_near(0.5 * (a.lat + b.lat), 0.5 * (a.lon + b.lon));
  const double wanted =
      std::max({length / spacing, std::min(turn, FrontEdge::kSmoothTurn) / kMostTurn, coasts ? 2.0 : 0.0});
  const int parts = std::min(static_cast<int>(std::ceil(wanted)), 16);
  if (parts < 2 && !(wall && a.stuck != b.stuck)) return;
  if (wall && !(a.stuck && b.stuck)) creep(a, b, out);
  const bool near_wall = chart_.clearance_at_least(a.lat, a.lon) - length < clearance_;
  for (int i = 1; i < parts; ++i) {
    const Marker m = edge.at(static_cast<double>(i) / parts);
    // Nothing is put behind land.
    if (near_wall && !clear_way(a, m.lat, m.lon) && !clear_way(b, m.lat, m.lon)) continue;
    out.push_back(m);
  }
}

void Front::stop(const std::function<bool(double lat, double lon)>& useless) {
  for (auto& m : markers_) m.idle = m.idle || useless(m.lat, m.lon);
}

/// Whether the middle one of three markers can be dropped.
bool Front::spare(const Marker& last, const Marker& m, const Marker& next) const {
  if (m.joins || last.joins || m.forward || m.back) return false;
  const auto rests = [](const Marker& x) { return x.stuck || x.idle; };
  const auto before = from_to(last, m), after = from_to(m, next);
  const double length = before.length() + after.length();
  if (last.coast && m.coast && next.coast)
    return length < spacing_ &&
           segment_distance(-before.east, -before.north, after.east, after.north) < kStraight * spacing_;
  if (last.coast || m.coast || next.coast) return false;
  if (rests(last) && rests(m) && rests(next)) return length < spacing_;
  return !rests(last) && !rests(m) && !rests(next) && length < 0.6 * spacing_near(m.lat, m.lon) &&
         std::abs(turn_between(last, m)) < 0.5 * kMostTurn && std::abs(turn_between(last, next)) < 0.8 * kMostTurn;
}

void Front::refine() {
  std::vector<Marker> out;
  out.reserve(markers_.size() + markers_.size() / 4);
  const std::size_t n = markers_.size();
  const auto far_apart = [this](const Marker& a, const Marker& b) {
    return a.coast && b.coast && from_to(a, b).length() > kTrail * spacing_;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Marker& m = markers_[i];
    const Marker& next = markers_[i + 1 == n ? 0 : i + 1];
    if (!out.empty() && i + 1 < n && spare(out.back(), m, next)) continue;
    Marker trail = m;  // what a walker leaves behind
    trail.forward = trail.back = trail.joins = false;
    if (m.forward && !out.empty() && !out.back().joins && far_apart(out.back(), m)) out.push_back(trail);
    out.push_back(m);
    if (m.back && !m.joins && far_apart(m, next)) out.push_back(trail);
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

std::vector<bool> Front::deep(double t_s, std::vector<bool> asked) {
  Surroundings around;
  around.blocked = [&](std::int64_t row, std::int64_t column) { return blocked(row, column, t_s); };
  const double beside = clearance_ + 1.1 * spacing_;  // the middles of nine cells of half the spacing
  around.beside_coast = [&](const Marker& m) { return m.coast || chart_.clearance_at_least(m.lat, m.lon) < beside; };
  around.is_open_to = [&](const Marker& m, double lat, double lon) {
    return clear_way(m, lat, lon) && dive_.sample(GeoPoint::from_kernel(lat, lon), t_s).has_value();
  };
  for (std::size_t i = 0; i < markers_.size(); ++i) asked[i] = asked[i] && !markers_[i].done;
  auto inside = deep_inside(markers_, lattice_, around, asked);
  for (std::size_t i = 0; i < markers_.size(); ++i) inside[i] = inside[i] || markers_[i].done;
  // A narrow wedge of water ahead, or a strait on the way along the coast, is what no look finds: an end of the front at a coast
  // is inside when its neighbour in the water is, too, and has no other end to meet; what has just come, when all have
  // that came with it side by side.
  const std::size_t n = markers_.size();
  const auto next = [n](std::size_t i) { return i + 1 == n ? 0 : i + 1; };
  for (std::size_t i = 0, count = 0; i < n; i += count + 1) {
    for (count = 0; i + count < n && markers_[i + count].coast; ++count) {
    }
    if (count == 0) continue;
    const std::size_t before = i == 0 ? n - 1 : i - 1, after = next(i + count - 1);
    const bool open_before = !markers_[before].joins && !markers_[before].stuck && !inside[before];
    const bool open_after = !markers_[i + count - 1].joins && !markers_[after].stuck && !inside[after];
    for (std::size_t first = i; first < i + count;) {  // stretches without a joining edge
      std::size_t last = first;
      while (last + 1 < i + count && !markers_[last].joins) ++last;
      const bool open = (first == i && open_before) || (last + 1 == i + count && open_after);
      bool all = !open;
      for (std::size_t k = first; k <= last; ++k) all = all && inside[k];
      for (std::size_t k = first; k <= last; ++k) {
        const Marker& m = markers_[k];
        const bool faces = (m.forward && k != last) || (m.back && k != first);
        if (m.landed || faces)
          inside[k] = all;
        else if ((k == first && first == i && open_before) || (k == last && last + 1 == i + count && open_after))
          inside[k] = false;
      }
      first = last + 1;
    }
  }
  return inside;
}

/// What comes to a coast inside the reached set, or walks on there, is done.
void Front::rest_inside(double t_s) {
  ++steps_;
  const std::size_t n = markers_.size();
  std::vector<bool> asked(n);
  bool any = false;
  for (std::size_t i = 0; i < n; ++i) {
    const Marker& m = markers_[i];
    if (!m.landed && !(steps_ % kLook == 0 && (m.forward || m.back))) continue;
    any = asked[i] = asked[i == 0 ? n - 1 : i - 1] = asked[i + 1 == n ? 0 : i + 1] = true;
  }
  if (!any) return;
  const auto inside = deep(t_s, asked);
  for (std::size_t i = 0; i < n; ++i)
    if (inside[i] && markers_[i].coast) {
      markers_[i].done = true;
      markers_[i].landed = markers_[i].forward = markers_[i].back = false;
    }
}

/// Whether a stretch of coast, with gaps on both sides, ends where it begins: a spot that the inside has touched, or all round an
/// island.
bool Front::is_spot(std::span<const Marker> coast) const {
  return from_to(coast.front(), coast.back()).length() < 2 * spacing_;
}

void Front::prune(double t_s) {
  if (markers_.size() < after_prune_ + after_prune_ / 8) return;
  auto deep_ones = deep(t_s, std::vector<bool>(markers_.size(), true));
  const auto stays = std::find(deep_ones.begin(), deep_ones.end(), false);
  if (stays == deep_ones.end()) return;
  // The walk round begins with one that stays.
  std::rotate(markers_.begin(), markers_.begin() + (stays - deep_ones.begin()), markers_.end());
  std::rotate(deep_ones.begin(), stays, deep_ones.end());
  const std::size_t count = markers_.size();
  std::vector<Marker> kept;
  kept.reserve(count);
  for (std::size_t n = 0; n < count;) {
    if (!deep_ones[n]) {
      kept.push_back(markers_[n++]);
      continue;
    }
    // A run that goes. Coasts stay, and the first and last markers at other walls: there the front's ends run along the walls.
    std::size_t end = n, first = count, last = count;
    for (; end < count && deep_ones[end]; ++end)
      if (markers_[end].stuck && !markers_[end].coast) {
        if (first == count) first = end;
        last = end;
      }
    bool gap = kept.back().joins;
    while (n < end) {
      if (markers_[n].coast) {
        std::size_t after = n + 1;
        while (after < end && markers_[after].coast && !markers_[after - 1].joins) ++after;
        const bool alone = gap && (markers_[after - 1].joins || (after < end && !markers_[after].stuck));
        if (alone && is_spot(std::span{markers_}.subspan(n, after - n))) {
          n = after;
          continue;
        }
        kept.back().joins = kept.back().joins || gap;
        for (; n < after; ++n) {
          kept.push_back(markers_[n]);
          kept.back().done = true;
          kept.back().forward = kept.back().back = false;
        }
        gap = kept.back().joins;
      } else if (n == first || n == last) {
        if (n != first) kept.back().joins = true;
        kept.push_back(markers_[n++]);
        gap = false;
      } else {
        gap = true;
        ++n;
      }
    }
    if (gap && last == count) kept.back().joins = true;
  }
  if (kept.size() < 3) return;
  markers_ = std::move(kept);
  after_prune_ = markers_.size();
}

}  // namespace glidehelm::planning
