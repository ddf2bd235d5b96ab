#include "core/planning/front.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/local_metric.hpp"
#include "core/planning/front_edge.hpp"
#include "core/planning/front_loops.hpp"

// How a front keeps its shape: more markers where they are far apart, fewer where the inside has been reached.
namespace glidehelm::planning {

namespace {

constexpr double kMostTurn = 0.12;  // radians between the normals of neighbours
constexpr double kShortest = 0.15;  // of the spacing: shorter edges are not refined by their turn
constexpr unsigned kLook = 2;       // steps after which walkers are looked at, whether they are inside
constexpr double kTrail = 0.25;     // of the spacing: between markers that a walker leaves behind
constexpr double kStraight =
    0.01;  // of the spacing: by as much a marker at a coast may lie off its neighbours' chord and be dropped

}  // namespace

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

/// Whether the middle one of three markers can be dropped.
bool Front::spare(const Marker& last, const Marker& m, const Marker& next) const {
  if (m.joins || last.joins || m.forward || m.back) return false;
  const auto rests = [](const Marker& x) { return x.stuck || x.idle; };
  const auto before = from_to(last, m), after = from_to(m, next);
  const double length = before.length() + after.length();
  if (last.coast && m.coast && next.coast) {
    const double off = kStraight * spacing_;
    if (length < spacing_ && segment_distance(-before.east, -before.north, after.east, after.north) < off) return true;
    // Along the coast and back on the same way: there is nothing between the two. One that may still walk stays.
    if (!m.done) return false;
    const Offset both{before.east + after.east, before.north + after.north};
    return segment_distance(before.east, before.north, both.east, both.north) < off ||
           segment_distance(-after.east, -after.north, -both.east, -both.north) < off;
  }
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
    trail.forward = trail.back = false;
    trail.unjoin();
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
  auto inside = deep(t_s, std::vector<bool>(markers_.size(), true));
  if (!markers_.back().ends_piece()) {  // one loop, uncut: the walk round begins with a marker that stays
    const auto stays = std::find(inside.begin(), inside.end(), false) - inside.begin();
    if (stays == std::ssize(inside)) return;
    std::rotate(markers_.begin(), markers_.begin() + stays, markers_.end());
    std::rotate(inside.begin(), inside.begin() + stays, inside.end());
  }
  std::vector<Marker> kept;
  kept.reserve(markers_.size());
  bool cut = true;  // before the next marker
  for (std::size_t n = 0; n < markers_.size();) {
    std::size_t end = n;
    if (!inside[n]) {
      kept.push_back(markers_[n++]);
    } else {
      while (end < markers_.size() && inside[end] && (end == n || !markers_[end - 1].ends_piece())) ++end;
      keep_walls(std::span{markers_}.subspan(n, end - n), cut, kept);
      n = end;
    }
    cut = !kept.empty() && kept.back().ends_piece();
  }
  if (kept.size() < 3) return;
  markers_ = closed_loops(kept);
}

/// Keeps of a run of markers inside, all of one piece, what lies at walls: coasts, and the first and last markers at other walls, along
/// which the front's ends run. `cut`: the piece begins with the run.
void Front::keep_walls(std::span<const Marker> run, bool cut, std::vector<Marker>& kept) {
  const bool ends = run.back().ends_piece();
  const auto at_wall = [](const Marker& m) { return m.stuck && !m.coast; };
  const auto first = std::find_if(run.begin(), run.end(), at_wall);
  const auto last = std::find_if(run.rbegin(), run.rend(), at_wall).base();  // one past it
  // In the middle of the reached set no front's end is left.
  const bool skirt = first != run.end() && ((!cut && first == run.begin()) || (!ends && last == run.end()));
  bool gap = cut;
  const auto put = [&](const Marker& m) {
    if (gap && !kept.empty()) kept.back().cut();
    kept.push_back(m);
    gap = m.ends_piece();
  };
  for (auto m = run.begin(); m != run.end();) {
    if (m->coast) {
      auto after = m + 1;
      while (after != run.end() && after->coast && !(after - 1)->joins) ++after;
      const bool alone = gap && (after == run.end() ? ends : !after->stuck);
      if (alone && is_spot(std::span{m, after})) {
        m = after;
        gap = true;
        continue;
      }
      for (; m != after; ++m) {
        put(*m);
        kept.back().done = true;
        kept.back().forward = kept.back().back = false;
      }
    } else if (skirt && first <= m && m < last) {
      if (m != first && m + 1 == last) kept.back().skirt();
      if (m == first || m + 1 == last) put(*m);
      ++m;
    } else {
      gap = true;
      ++m;
    }
  }
  if (gap && !kept.empty()) kept.back().cut();
}

}  // namespace glidehelm::planning
