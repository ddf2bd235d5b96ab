#include "core/planning/front.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"
#include "core/planning/front_edge.hpp"

// What a front does at coasts and other walls.
namespace glidehelm::planning {

namespace {

constexpr double kOpenShare =
    0.1;                      // of an edge between two coasts: clearance of its middle when there is water between
constexpr int kHalvings = 6;  // of an edge of which one end has met a coast
constexpr int kStraits = 3;   // halvings of an edge whose ends have met two coasts
constexpr int kFan = 6;       // headings to each side of a marker at a wall

}  // namespace

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
    first.unjoin();
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
      if (i != kFan) side.unjoin();
      if (i != 0 && side.left > 1.0) senders.push_back(out.size());
      out.push_back(side);
    }
  }
  markers_ = std::move(out);
  for (const auto i : senders) moving_.push_back(&markers_[i]);
  return !moving_.empty();
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
    side.unjoin();
    out.push_back(side);
  }
}

}  // namespace glidehelm::planning
