#include "core/planning/front_loops.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/local_metric.hpp"

namespace glidehelm::planning {

namespace {

struct Piece {
  std::size_t first, last;  ///< markers, both part of it
};

/// Pieces of a polygon of which the last marker joins.
std::vector<Piece> pieces_of(const std::vector<Marker>& markers) {
  std::vector<Piece> pieces;
  std::size_t first = 0;
  for (std::size_t i = 0; i < markers.size(); ++i)
    if (markers[i].ends_piece()) {
      pieces.push_back({first, i});
      first = i + 1;
    }
  return pieces;
}

/// For each piece the one that its end joins: of all pairs that are left the nearest, again and again. Two that are each other's nearest are
/// paired in the same round, which gives the same pairs.
std::vector<std::size_t> followers(const std::vector<Marker>& markers, const std::vector<Piece>& pieces) {
  struct Place {
    double x, y;
  };
  const double scale = std::cos(markers.front().lat);
  const auto place = [&](std::size_t i) { return Place{markers[i].lon * scale, markers[i].lat}; };
  std::vector<Place> ends, begins;
  for (const auto& p : pieces) {
    ends.push_back(place(p.last));
    begins.push_back(place(p.first));
  }
  const auto nearest = [](const Place& at, const std::vector<Place>& of, const std::vector<std::size_t>& among) {
    std::size_t best = among.front();
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t k : among) {
      const double dx = of[k].x - at.x, dy = of[k].y - at.y, d2 = dx * dx + dy * dy;
      if (d2 < least) {
        least = d2;
        best = k;
      }
    }
    return best;
  };
  const std::size_t none = pieces.size();
  std::vector<std::size_t> follower(pieces.size(), none), leader(pieces.size(), none);
  std::vector<std::size_t> open_ends, open_begins;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    open_ends.push_back(k);
    open_begins.push_back(k);
  }
  while (!open_ends.empty()) {
    std::vector<std::size_t> wanted(pieces.size(), none);
    for (const std::size_t b : open_begins) wanted[b] = nearest(begins[b], ends, open_ends);
    bool any = false;
    for (const std::size_t e : open_ends) {
      const std::size_t b = nearest(ends[e], begins, open_begins);
      if (wanted[b] != e) continue;
      follower[e] = b;
      leader[b] = e;
      any = true;
    }
    if (!any) {  // equal distances in a ring
      follower[open_ends.front()] = open_begins.front();
      leader[open_begins.front()] = open_ends.front();
    }
    std::erase_if(open_ends, [&](std::size_t k) { return follower[k] != none; });
    std::erase_if(open_begins, [&](std::size_t k) { return leader[k] != none; });
  }
  return follower;
}

}  // namespace

std::vector<Marker> closed_loops(const std::vector<Marker>& markers) {
  const auto joint = std::find_if(markers.rbegin(), markers.rend(), [](const Marker& m) { return m.ends_piece(); });
  if (joint == markers.rend()) return markers;
  std::vector<Marker> turned(joint.base(), markers.end());
  turned.insert(turned.end(), markers.begin(), joint.base());
  const auto pieces = pieces_of(turned);
  const auto follower = followers(turned, pieces);
  std::vector<Marker> loops;
  loops.reserve(turned.size());
  std::vector<bool> taken(pieces.size());
  for (std::size_t start = 0; start < pieces.size(); ++start) {
    if (taken[start]) continue;
    for (std::size_t k = start; !taken[k]; k = follower[k]) {
      taken[k] = true;
      loops.insert(loops.end(), turned.begin() + static_cast<std::ptrdiff_t>(pieces[k].first),
                   turned.begin() + static_cast<std::ptrdiff_t>(pieces[k].last) + 1);
      loops.back().closes = follower[k] == start;
    }
  }
  return loops;
}

}  // namespace glidehelm::planning
