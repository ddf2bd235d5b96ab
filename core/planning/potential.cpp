#include "core/planning/potential.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "core/planning/flight.hpp"
#include "core/vehicle/goal_distance.hpp"

namespace glidehelm::planning {

namespace {

constexpr double kMuch = 1.1;        // times the horizon: V of what is not reached
constexpr double kLevel = 5e-3;      // share by which a triangle may be too steep before it is lowered
constexpr double kWorthWhile = 30;   // seconds by which V of a node must shrink to be looked at again
constexpr double kSwept = 0.8;       // of the speed through water: a current that is hardly gone against
constexpr std::size_t kRound = 5;    // looks at each triangle after which twice as much is allowed
constexpr int kPlacesOnCircle = 64;  // V between two of them is higher by 0.12 % of radius times slope at most

struct Vector {
  double east{}, north{};
};
/// Nothing in here is so large or small that std::hypot would be needed.
double length(Vector v) { return std::sqrt(v.east * v.east + v.north * v.north); }
double cross(Vector a, Vector b) { return a.east * b.north - a.north * b.east; }
double dot(Vector a, Vector b) { return a.east * b.east + a.north * b.north; }

/// Corners of a triangle in metres from its left one, in the order left, right, apex.
std::array<Vector, 3> corners(const TriangleLattice::Triangle& t) {
  return {{{0, 0}, {t.base, 0}, {0.5 * t.base, t.height}}};
}
std::array<std::size_t, 3> nodes(const TriangleLattice::Triangle& t) { return {t.left, t.right, t.apex}; }

Vector gradient(const TriangleLattice::Triangle& t, const std::vector<double>& left) {
  const double west = left[t.left], east = left[t.right];
  return {(east - west) / t.base, (left[t.apex] - 0.5 * (west + east)) / t.height};
}

/// How fast V falls at most.
double fall_diving(const TriangleWater& w, Vector slope) {
  return w.speed * length(slope) - w.east * slope.east - w.north * slope.north;
}
/// How fast V falls at most in a triangle, and the triangle as it measures there: a gradient is greater where the parallel is shorter, and what
/// falls fastest is at one edge or the other.
struct Fall {
  double rate{};
  TriangleLattice::Triangle at;
};
Fall steepest_fall(const TriangleLattice::Triangle& t, const TriangleWater& w, const std::vector<double>& left) {
  Fall narrow{0, t}, wide{0, t};
  narrow.at.base *= t.narrowest, wide.at.base *= t.widest;
  narrow.rate = fall_diving(w, gradient(narrow.at, left));
  wide.rate = fall_diving(w, gradient(wide.at, left));
  return narrow.rate >= wide.rate ? narrow : wide;
}
double fall_drifting(const TriangleWater& w, Vector slope) {
  return w.drift_spread * length(slope) - w.drift_east * slope.east - w.drift_north * slope.north;
}

/// Seconds straight along `way`; infinite where the current is too strong.
double time_along(const TriangleWater& w, Vector way) {
  const double far = length(way);
  const double with = dot({w.east, w.north}, way) / far, across = cross({w.east, w.north}, way) / far;
  if (std::abs(across) >= w.speed) return std::numeric_limits<double>::infinity();
  const double over_ground = with + std::sqrt(w.speed * w.speed - across * across);
  return over_ground > 0 ? far / over_ground : std::numeric_limits<double>::infinity();
}

/// The slope of V where it is `t` at a corner and linear: first + t·each.
struct SlopeLine {
  Vector first, each;
  [[nodiscard]] Vector at(double t) const { return {first.east + t * each.east, first.north + t * each.north}; }
};
/// `to_b`, `to_c`: from the corner to the others, whose V are known.
SlopeLine slope_line(Vector to_b, Vector to_c, double b, double c) {
  const double area = cross(to_b, to_c);
  const auto solve = [&](double along_b, double along_c) {
    return Vector{(along_b * to_c.north - along_c * to_b.north) / area,
                  (along_c * to_b.east - along_b * to_c.east) / area};
  };
  return {solve(b, c), solve(-1, -1)};
}

/// The values of t for which V falls by 1 s/s; NaN where there is none.
std::array<double, 2> just_steep(const TriangleWater& w, const SlopeLine& line) {
  // U·|first + t·each| = rate + c·(first + t·each), squared.
  const Vector c{w.east, w.north};
  const double u2 = w.speed * w.speed, p = 1 + dot(c, line.first), q = dot(c, line.each);
  const double a = u2 * dot(line.each, line.each) - q * q;
  const double b = u2 * dot(line.first, line.each) - p * q;
  const double k = u2 * dot(line.first, line.first) - p * p;
  const double root = std::sqrt(b * b - a * k);  // NaN when never
  // Both forms of each root, so that neither loses its digits where a is small.
  std::array<double, 2> roots{b >= 0 ? (-b - root) / a : k / (-b + root), b >= 0 ? k / (-b - root) : (-b + root) / a};
  for (auto& t : roots)
    if (!std::isfinite(t) || p + t * q < 0) t = std::nan("");  // the other branch of the square
  return roots;
}
/// The greatest of them below `most`, the least of them above `least`; NaN when there is none.
double below(std::array<double, 2> roots, double most) {
  double best = std::nan("");
  for (const double t : roots)
    if (t < most && !(t <= best)) best = t;
  return best;
}
double above(std::array<double, 2> roots, double least) {
  double best = std::nan("");
  for (const double t : roots)
    if (t > least && !(t >= best)) best = t;
  return best;
}

/// True when the soonest way from the corner leads between the other two.
bool leads_between(const TriangleWater& w, Vector slope, Vector to_b, Vector to_c) {
  const double steep = length(slope);
  if (!(steep > 0)) return false;
  const Vector over_ground{w.east - w.speed * slope.east / steep, w.north - w.speed * slope.north / steep};
  const double side = cross(to_b, to_c);
  return cross(to_b, over_ground) * side >= 0 && cross(over_ground, to_c) * side >= 0;
}

/// Nodes in the order of V, the smaller number first among equals.
class Agenda {
 public:
  void push(double left, std::size_t what) { queue_.push({left, what}); }
  [[nodiscard]] bool empty() const { return queue_.empty(); }
  std::pair<double, std::size_t> pop() {
    auto top = queue_.top();
    queue_.pop();
    return top;
  }

 private:
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

/// What V of corner `a` can be at most by a way through this triangle.
double through(const TriangleLattice::Triangle& t, const TriangleWater& w, const std::vector<double>& left,
               std::size_t a) {
  const auto at = corners(t);
  const auto node = nodes(t);
  const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
  const double now = left[node[a]], of_b = left[node[b]], of_c = left[node[c]];
  if (now <= std::min(of_b, of_c)) return now;  // nobody comes sooner from a corner than from the nearer of the others
  const Vector to_b{at[b].east - at[a].east, at[b].north - at[a].north},
      to_c{at[c].east - at[a].east, at[c].north - at[a].north};
  double best = std::min({now, of_b + time_along(w, to_b), of_c + time_along(w, to_c)});
  const auto line = slope_line(to_b, to_c, of_b, of_c);
  const double t_a = below(just_steep(w, line), best);
  if (t_a > std::min(of_b, of_c) && leads_between(w, line.at(t_a), to_b, to_c)) best = t_a;
  return best;
}

}  // namespace

Potential::Potential(TriangleLattice lattice, const Problem& problem, const ocean::Ocean& ocean,
                     const chart::Chart& chart, const std::function<double(double lat, double lon)>& beyond)
    : lattice_{std::move(lattice)},
      water_{water_of(lattice_, problem, ocean, chart)},
      left_(lattice_.nodes(), kMuch * std::max(0.0, problem.horizon_s - problem.start.fix_s)) {
  bring_outwards(disc_of(problem), beyond);
  level();
  sink_below(disc_of(problem));
  count_rates();
}

std::optional<double> Potential::at(double lat, double lon) const {
  TriangleLattice::Within in;
  if (!lattice_.locate(lat, lon, in)) return std::nullopt;
  if (!water_.triangles[in.index].open) return 0;
  const auto t = lattice_.triangle(in.index);
  return in.left * left_[t.left] + in.right * left_[t.right] + in.apex * left_[t.apex];
}

/// True when a glider at the node can hardly go against the current.
bool Potential::is_swept(std::size_t node) const {
  const auto around = lattice_.around(node);
  return std::any_of(around.triangle.begin(), around.triangle.begin() + around.count, [&](std::uint32_t i) {
    const auto& w = water_.triangles[i];
    return length({w.east, w.north}) > kSwept * w.speed;
  });
}

/// Dijkstra's order with re-opening: a current that outruns the glider may lead back past nodes that are done.
void Potential::bring_outwards(const vehicle::Disc& goal, const std::function<double(double lat, double lon)>& beyond) {
  const vehicle::GoalDistance distance{goal};
  Agenda agenda;
  const auto put = [&](std::size_t node, double left) {
    if (left >= left_[node] - kWorthWhile) return;
    left_[node] = left;
    agenda.push(left, node);
  };
  // Where the current may carry a glider off for good, V is a cliff behind the seed, and the disc must not reach over it.
  const double at_goal = goal.radius.si() + (is_swept(lattice_.seed()) ? lattice_.side() : 0.0);
  for (std::size_t n = 0; n < left_.size(); ++n) {
    const auto p = lattice_.at(n);
    if (distance.least(p.lat, p.lon) <= at_goal) put(n, 0);
    if (lattice_.on_rim(n)) put(n, std::max(0.0, beyond(p.lat, p.lon)));
  }
  put(lattice_.seed(), 0);
  while (!agenda.empty()) {
    const auto [left, node] = agenda.pop();
    if (left > left_[node]) continue;
    const auto around = lattice_.around(node);
    for (int k = 0; k < around.count; ++k) {
      const std::size_t index = around.triangle[static_cast<std::size_t>(k)];
      const auto& water = water_.triangles[index];
      if (!water.open) continue;
      const auto t = lattice_.triangle(index);
      const auto corner = nodes(t);
      for (std::size_t a = 0; a < 3; ++a)
        if (corner[a] != node) put(corner[a], through(t, water, left_, a));
    }
  }
}

/// Lowers what is too steep, the triangles nearest to the goal first, until nothing is.
void Potential::level() {
  // Where currents outrun the glider what is lowered here may come back as less and less: then less is asked.
  double allowed = kLevel;
  Agenda agenda;
  std::vector<bool> waits(water_.triangles.size());
  const auto look_at = [&](std::size_t i) {
    const auto& water = water_.triangles[i];
    if (!water.open || waits[i]) return;
    const auto t = lattice_.triangle(i);
    if (!(steepest_fall(t, water, left_).rate > 1 + allowed)) return;
    waits[i] = true;
    agenda.push(std::min({left_[t.left], left_[t.right], left_[t.apex]}), i);
  };
  for (std::size_t i = 0; i < water_.triangles.size(); ++i) look_at(i);
  std::vector<std::size_t> lowered;
  for (std::size_t done = 1; !agenda.empty(); ++done) {
    if (done % (kRound * water_.triangles.size()) == 0) allowed *= 2;
    const auto index = agenda.pop().second;
    waits[index] = false;
    const auto fall = steepest_fall(lattice_.triangle(index), water_.triangles[index], left_);
    if (!(fall.rate > 1 + allowed)) continue;
    lower(fall.at, water_.triangles[index], fall.rate, lowered);
    for (const auto node : lowered) {
      const auto around = lattice_.around(node);
      for (int k = 0; k < around.count; ++k) look_at(around.triangle[static_cast<std::size_t>(k)]);
    }
  }
}

/// One corner alone, or two of them as much, or two towards the lowest, whichever takes least away; none below the lowest, so that this
/// comes to an end. `lowered`: the corners that were.
void Potential::lower(const TriangleLattice::Triangle& t, const TriangleWater& water, double rate,
                      std::vector<std::size_t>& lowered) {
  const auto node = nodes(t);
  const auto at = corners(t);
  const std::array<double, 3> now{left_[node[0]], left_[node[1]], left_[node[2]]};
  const double lowest = std::min({now[0], now[1], now[2]});
  std::array<double, 3> best{};
  double taken = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    best[i] = lowest + (now[i] - lowest) / rate;
    taken += now[i] - best[i];
  }
  const auto offer = [&](std::array<double, 3> other) {
    const double takes = now[0] + now[1] + now[2] - other[0] - other[1] - other[2];
    if (!(takes < taken) || std::min({other[0], other[1], other[2]}) < lowest) return;
    best = other;
    taken = takes;
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    const auto line = slope_line({at[b].east - at[a].east, at[b].north - at[a].north},
                                 {at[c].east - at[a].east, at[c].north - at[a].north}, now[b], now[c]);
    const auto roots = just_steep(water, line);
    auto one = now, two = now;
    one[a] = below(roots, now[a]);
    const double down = above(roots, now[a]) - now[a];
    two[b] -= down, two[c] -= down;
    offer(one);
    offer(two);
  }
  lowered.clear();
  for (std::size_t i = 0; i < 3; ++i) {
    if (best[i] >= now[i]) continue;
    left_[node[i]] = best[i];
    lowered.push_back(node[i]);
  }
}

/// V is 0 at the seed, but the disc around it is the goal: V sinks by what it is on the circle at most.
void Potential::sink_below(const vehicle::Disc& goal) {
  double most = 0;
  for (int i = 0; i < kPlacesOnCircle; ++i) {
    const auto p = destination(goal.centre, Bearing{Radians{2 * kPi * i / kPlacesOnCircle}}, goal.radius);
    most = std::max(most, at(p.lat.radians(), p.lon.radians()).value_or(0));
  }
  for (auto& left : left_) left -= most;
}

void Potential::count_rates() {
  for (std::size_t i = 0; i < water_.triangles.size(); ++i) {
    const auto& water = water_.triangles[i];
    if (!water.open) continue;
    auto t = lattice_.triangle(i);
    dive_rate_ = std::max(dive_rate_, steepest_fall(t, water, left_).rate);
    const double middle = t.base;
    for (const double parallel : {t.narrowest, t.widest}) {
      t.base = middle * parallel;
      drift_rate_ = std::max(drift_rate_, fall_drifting(water, gradient(t, left_)));
    }
  }
}

}  // namespace glidehelm::planning
