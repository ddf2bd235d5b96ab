#include "core/planning/cts_astar.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/planning/flight.hpp"
#include "core/planning/search_grid.hpp"

namespace glidehelm::planning {

namespace {

using ocean::Lanes;

/// A surfacing that a cell is labelled with.
struct Node {
  double lat{}, lon{};
  double bearing{};  ///< to the goal, radians
  float h{}, margin{};
  std::int32_t parent{-1}, cell{-1};
  std::uint16_t heading{};  ///< index among M, counted from the parent's direction to the goal
  std::uint16_t stints{};   ///< flown so far
  std::uint8_t repeats{1};  ///< stints flown on this heading from the parent
};

struct Open {
  double f;
  std::int32_t node;
  [[nodiscard]] bool after(const Open& other) const { return f > other.f || (f == other.f && node > other.node); }
};
bool later(const Open& a, const Open& b) { return a.after(b); }

/// The least time over a distance by a vehicle that dives at `dive` and drifts at `drift` m/s, from a surfacing on.
struct Envelope {
  double dive{}, drift{}, stint{}, surface{};

  [[nodiscard]] double least_time(double distance) const {
    if (distance <= 0) return 0;
    const double drifted = drift * surface, cycle = drifted + dive * stint;
    const double full = std::floor(distance / cycle);
    const double rest = distance - full * cycle;
    const double time = full * (surface + stint);
    return rest <= drifted ? time + (drift > 0 ? rest / drift : 0.0) : time + surface + (rest - drifted) / dive;
  }
};

/// Direction and lower bound of the distance to the goal, on the sphere.
struct Sight {
  double bearing{}, distance{};
};

class Search {
 public:
  Search(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget)
      : problem_{problem},
        ocean_{ocean},
        chart_{chart},
        budget_{budget},
        goal_{disc_of(problem)},
        waters_{waters_of(problem, ocean, chart)},
        speed_{problem.glider.horizontal_speed.si()},
        stint_{problem.schedule.stint.count()},
        fastest_{ocean.dive.fastest().si()},
        envelope_{speed_ + fastest_, ocean.surface.fastest().si(), stint_, problem.schedule.surface.count()},
        grid_{make_grid()},
        labels_(grid_.cells(), -1) {
    const auto dt = vehicle::lane_step(ocean, problem.start.fix, goal_.centre, problem.start.fix_s, stint_,
                                       problem.glider.horizontal_speed);
    steps_ = std::max(1, static_cast<int>(std::lround(stint_ / dt)));
    margin_ = problem.coast_margin.si() > 0 ? problem.coast_margin.si() + 0.005 * speed_ * stint_ : 0.0;
    count_ = std::clamp(problem.headings, 1, Lanes::kMax);
    for (int i = 0; i < count_; ++i) {
      const double turn = 2 * kPi * i / count_;
      turns_[static_cast<std::size_t>(i)] = {std::sin(turn), std::cos(turn)};
    }
    nodes_.reserve(1 << 14);
    heap_.reserve(1 << 14);
  }

  CtsSearch run() {
    begin();
    CtsSearch result;
    result.exhausted = true;
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), later);
      const Open top = heap_.back();
      heap_.pop_back();
      if (top.f >= best_arrival_) break;
      const Node& node = nodes_[static_cast<std::size_t>(top.node)];
      if (node.cell >= 0 && labels_[static_cast<std::size_t>(node.cell)] != top.node) continue;  // relabelled since
      if (statistics_.expansions >= budget_.work) {
        result.exhausted = false;
        break;
      }
      if (statistics_.expansions % 64 == 63 && budget_.expired && budget_.expired()) {
        result.exhausted = false;
        result.cut_at = statistics_.expansions;
        break;
      }
      ++statistics_.expansions;
      expand(top.node);
    }
    result.arrival_s = best_arrival_ < 1e17 ? problem_.start.fix_s + best_arrival_ : std::nan("");
    result.headings = path_to(best_arrival_ < 1e17 ? best_parent_ : nearest_);
    if (best_arrival_ < 1e17 && best_heading_ >= 0)
      for (int i = 0; i < best_repeats_; ++i)
        result.headings.push_back(heading_of(best_parent_, static_cast<std::uint16_t>(best_heading_)));
    result.statistics = statistics_;
    result.step_s = stint_ / steps_;
    result.labels = nodes_.size();
    result.cells = grid_.cells();
    return result;
  }

 private:
  [[nodiscard]] SearchGrid make_grid() const {
    const auto& a = problem_.start.fix;
    const double lat = 0.5 * (a.lat.radians() + goal_.centre.lat.radians());
    const double lon = a.lon.radians() + 0.5 * std::remainder(goal_.centre.lon.radians() - a.lon.radians(), 2 * kPi);
    // Whoever reaches the goal within the horizon stays in the ellipse of start and goal; the circle around its middle holds it.
    const double horizon = problem_.horizon_s - problem_.start.fix_s;
    const double reach = 0.5 * std::min(2e7, horizon * std::max(envelope_.dive, envelope_.drift) + goal_.radius.si());
    const double cell = problem_.cell.si() > 0 ? problem_.cell.si() : 0.5 * speed_ * stint_;
    return SearchGrid{lat, lon, reach, cell, ocean_.dive.coverage()};
  }

  [[nodiscard]] Sight sight(double lat, double lon) const {
    const double goal_lat = goal_.centre.lat.radians(), dlon = goal_.centre.lon.radians() - lon;
    const double s0 = std::sin(lat), c0 = std::cos(lat), s1 = std::sin(goal_lat), c1 = std::cos(goal_lat),
                 sd = std::sin(dlon), cd = std::cos(dlon);
    const double east = sd * c1, north = c0 * s1 - s0 * c1 * cd;
    // The angle by its tangent: exact near and far, where the haversine of distance_lower_bound needs an arc sine more.
    const double angle = std::atan2(std::hypot(east, north), s0 * s1 + c0 * c1 * cd);
    return {std::atan2(east, north), angle * kSmallestRadius};
  }

  void begin() {
    Node start;
    start.lat = problem_.start.fix.lat.radians();
    start.lon = problem_.start.fix.lon.radians();
    const auto s = sight(start.lat, start.lon);
    start.bearing = s.bearing;
    start.margin = static_cast<float>(margin_in_force(start.lat, start.lon, margin_));
    start.h = static_cast<float>(0);
    nearest_ = 0;
    nearest_distance_ = s.distance;
    nodes_.push_back(start);  // belongs to no cell: a stint may come back to where it began
    heap_.push_back({0.0, 0});
  }

  /// The margin that can be kept from a place: its clearance when that is smaller, never less than `at_least`'s promise to move outwards.
  [[nodiscard]] double margin_in_force(double lat, double lon, double wanted) const {
    if (chart_.clearance_at_least(lat, lon) >= wanted) return wanted;
    return std::min(wanted, chart_.clearance(lat, lon));
  }

  /// Seconds from the fix to the surfacing after `stints` stints.
  [[nodiscard]] double surfaced(int stints) const {
    return stints == 0 ? 0.0 : problem_.schedule.surfacing_time(stints - 1).count();
  }

  void expand(std::int32_t index) {
    const Node node = nodes_[static_cast<std::size_t>(index)];
    Place from{node.lat, node.lon, node.margin};
    if (!drift(from, node.stints, index)) return;
    pending_ = 0;
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double sin_b = std::sin(node.bearing), cos_b = std::cos(node.bearing);
      lanes_.lat[k] = from.lat;
      lanes_.lon[k] = from.lon;
      lanes_.water_east[k] = speed_ * (sin_b * turns_[k].cos + cos_b * turns_[k].sin);
      lanes_.water_north[k] = speed_ * (cos_b * turns_[k].cos - sin_b * turns_[k].sin);
      lanes_.lost[k] = 0;
      margins_[k] = from.margin;
      which_[k] = static_cast<std::uint16_t>(i);
    }
    lanes_.count = count_;
    for (int repeat = 1; repeat <= CtsAStar::kMostRepeats && lanes_.count > 0; ++repeat) {
      const int stint = node.stints + repeat - 1;
      if (surfaced(stint + 1) > horizon() + stint_) return;
      if (repeat > 1 && !drift_lanes(stint)) return;
      fly_lanes(index, stint, repeat);
      keep_lanes_that_stay(index, stint, repeat);
    }
  }

  struct Place {
    double lat, lon, margin;
  };
  [[nodiscard]] double horizon() const { return problem_.horizon_s - problem_.start.fix_s; }

  /// Drifts to the dive of stint `stint`; false when lost. Arrivals in the drift count.
  bool drift(Place& p, int stint, std::int32_t index) {
    const double seconds = problem_.schedule.drift_before(stint).count();
    if (seconds <= 0) return true;
    Lanes& one = drift_;
    one.count = 1;
    one.lat[0] = p.lat;
    one.lon[0] = p.lon;
    one.water_east[0] = one.water_north[0] = 0;
    one.lost[0] = 0;
    const double t0 = surfaced(stint);
    ocean_.surface.advance(one, problem_.start.fix_s + t0, seconds);
    statistics_.current_evaluations += 4;
    if (one.lost[0] != 0) return false;
    if (!clear(p.lat, p.lon, one.lat[0], one.lon[0], p.margin)) return false;
    if (const auto share = crossing(p.lat, p.lon, one.lat[0], one.lon[0])) arrive(t0 + *share * seconds, index, -1, 0);
    p = {one.lat[0], one.lon[0],
         p.margin < margin_ ? std::max(p.margin, margin_in_force(one.lat[0], one.lon[0], margin_)) : p.margin};
    return true;
  }

  /// The surface interval of lanes that fly on with their heading.
  bool drift_lanes(int stint) {
    const double seconds = problem_.schedule.drift_before(stint).count();
    if (seconds <= 0) return true;
    drift_ = lanes_;
    for (int i = 0; i < drift_.count; ++i)
      drift_.water_east[static_cast<std::size_t>(i)] = drift_.water_north[static_cast<std::size_t>(i)] = 0;
    ocean_.surface.advance(drift_, problem_.start.fix_s + surfaced(stint), seconds);
    statistics_.current_evaluations += 4 * static_cast<std::uint64_t>(drift_.count);
    for (int i = 0; i < drift_.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      lanes_.lost[k] = drift_.lost[k];
      if (drift_.lost[k] == 0 && !clear(lanes_.lat[k], lanes_.lon[k], drift_.lat[k], drift_.lon[k], margins_[k]))
        lanes_.lost[k] = kAground;
      lanes_.lat[k] = drift_.lat[k];
      lanes_.lon[k] = drift_.lon[k];
    }
    return true;
  }

  /// Flies one stint on every lane: land and goal are looked at after every integration step.
  void fly_lanes(std::int32_t index, int stint, int repeat) {
    const double seconds = problem_.schedule.stint_length(stint).count(), dt = seconds / steps_;
    const double t0 = problem_.schedule.dive_time(stint).count();
    const Node& parent = nodes_[static_cast<std::size_t>(index)];
    const double way = envelope_.dive * seconds;
    const bool near_land = chart_.clearance_at_least(lanes_.lat[0], lanes_.lon[0]) < margin_ + way * (1 + repeat);
    const bool near_goal =
        sight(parent.lat, parent.lon).distance <=
        goal_.radius.si() + 1.02 * (way + envelope_.drift * problem_.schedule.surface.count()) * (1 + repeat);
    for (int step = 0; step < steps_; ++step) {
      if (near_land || near_goal) before_ = lanes_;
      ocean_.dive.advance(lanes_, problem_.start.fix_s + t0 + step * dt, dt);
      statistics_.current_evaluations += 4 * static_cast<std::uint64_t>(lanes_.count);
      if (near_land) check_land();
      if (near_goal) check_goal(index, repeat, t0 + step * dt, dt);
    }
    statistics_.cost_evaluations += static_cast<std::uint64_t>(lanes_.count);
  }

  void check_land() {
    for (int i = 0; i < lanes_.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (lanes_.lost[k] != 0) continue;
      if (!clear(before_.lat[k], before_.lon[k], lanes_.lat[k], lanes_.lon[k], margins_[k])) {
        lanes_.lost[k] = kAground;
        continue;
      }
      if (margins_[k] < margin_)
        margins_[k] = std::max(margins_[k], margin_in_force(lanes_.lat[k], lanes_.lon[k], margin_));
    }
  }

  [[nodiscard]] bool clear(double lat0, double lon0, double lat1, double lon1, double margin) const {
    return chart_.segment_is_clear(lat0, lon0, lat1, lon1, margin);
  }

  /// Where a chord enters the goal's disc, as a share of it.
  [[nodiscard]] std::optional<double> crossing(double lat0, double lon0, double lat1, double lon1) const {
    const double radius = goal_.radius.si();
    const double lat = goal_.centre.lat.radians(), lon = goal_.centre.lon.radians();
    const auto a = local_offset(lat, lon, lat0, lon0), b = local_offset(lat, lon, lat1, lon1);
    const double outside = a.east * a.east + a.north * a.north - radius * radius;
    if (outside <= 0) return 0.0;
    const double de = b.east - a.east, dn = b.north - a.north, dd = de * de + dn * dn;
    const double towards = a.east * de + a.north * dn;
    const double root2 = towards * towards - dd * outside;
    if (towards >= 0 || root2 < 0) return std::nullopt;
    const double share = outside / (-towards + std::sqrt(root2));
    return share <= 1.0 ? std::optional{share} : std::nullopt;
  }

  void check_goal(std::int32_t index, int repeat, double t0, double dt) {
    for (int i = 0; i < lanes_.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (lanes_.lost[k] != 0) continue;
      const auto share = crossing(before_.lat[k], before_.lon[k], lanes_.lat[k], lanes_.lon[k]);
      if (!share) continue;
      arrive(t0 + *share * dt, index, which_[k], repeat);
      lanes_.lost[k] = kArrived;
    }
  }

  void arrive(double time, std::int32_t parent, int heading, int repeats) {
    if (time > horizon() || time >= best_arrival_) return;
    best_arrival_ = time;
    best_parent_ = parent;
    best_heading_ = heading;
    best_repeats_ = repeats;
  }

  /// Labels the cells of the lanes that left their parent's; what stays is packed to the front for another stint.
  void keep_lanes_that_stay(std::int32_t index, int stint, int repeat) {
    const std::int32_t parent_cell = nodes_[static_cast<std::size_t>(index)].cell;
    const bool late = surfaced(stint + 1) > horizon();
    int kept = 0;
    for (int i = 0; i < lanes_.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (lanes_.lost[k] != 0 || late) continue;
      const auto cell = grid_.cell(lanes_.lat[k], lanes_.lon[k]);
      if (cell < 0) continue;
      if (cell != parent_cell) {
        label(cell, index, lanes_.lat[k], lanes_.lon[k], margins_[k], which_[k], stint + 1, repeat);
        continue;
      }
      const auto to = static_cast<std::size_t>(kept++);
      lanes_.lat[to] = lanes_.lat[k];
      lanes_.lon[to] = lanes_.lon[k];
      lanes_.water_east[to] = lanes_.water_east[k];
      lanes_.water_north[to] = lanes_.water_north[k];
      lanes_.lost[to] = 0;
      margins_[to] = margins_[k];
      which_[to] = which_[k];
    }
    lanes_.count = kept;
  }

  void label(std::int32_t cell, std::int32_t parent, double lat, double lon, double margin, std::uint16_t heading,
             int stints, int repeats) {
    const double g = surfaced(stints);
    const auto s = sight(lat, lon);
    const double h = envelope_.least_time(s.distance - goal_.radius.si());
    if (g + h >= best_arrival_ || g + h > horizon()) return;
    auto& current = labels_[static_cast<std::size_t>(cell)];
    if (current >= 0) {
      const Node& other = nodes_[static_cast<std::size_t>(current)];
      if (other.stints < stints || (other.stints == stints && other.h <= static_cast<float>(h))) return;
    }
    const auto index = static_cast<std::int32_t>(nodes_.size());
    nodes_.push_back({lat, lon, s.bearing, static_cast<float>(h), static_cast<float>(margin), parent, cell, heading,
                      static_cast<std::uint16_t>(stints), static_cast<std::uint8_t>(repeats)});
    current = index;
    if (s.distance < nearest_distance_) {
      nearest_distance_ = s.distance;
      nearest_ = index;
    }
    heap_.push_back({g + h, index});
    std::push_heap(heap_.begin(), heap_.end(), later);
  }

  [[nodiscard]] Heading heading_of(std::int32_t parent, std::uint16_t heading) const {
    return Heading{Radians{nodes_[static_cast<std::size_t>(parent)].bearing + 2 * kPi * heading / count_}};
  }

  [[nodiscard]] std::vector<Heading> path_to(std::int32_t index) const {
    std::vector<Heading> headings;
    for (; index > 0; index = nodes_[static_cast<std::size_t>(index)].parent) {
      const auto& node = nodes_[static_cast<std::size_t>(index)];
      for (int i = 0; i < node.repeats; ++i) headings.push_back(heading_of(node.parent, node.heading));
    }
    std::reverse(headings.begin(), headings.end());
    return headings;
  }

  static constexpr std::uint8_t kAground = 200, kArrived = 201;
  static constexpr double kSmallestRadius = 6'335'439.0;  // of curvature of WGS84: makes distances lower bounds
  struct Turn {
    double sin{}, cos{};
  };

  const Problem& problem_;
  const ocean::Ocean& ocean_;
  const chart::Chart& chart_;
  const Budget& budget_;
  vehicle::Disc goal_;
  vehicle::Waters waters_;
  double speed_, stint_, fastest_;
  Envelope envelope_;
  SearchGrid grid_;
  std::vector<std::int32_t> labels_;
  std::vector<Node> nodes_;
  std::vector<Open> heap_;
  std::array<Turn, Lanes::kMax> turns_{};
  Lanes lanes_{}, before_{}, drift_{};
  std::array<double, Lanes::kMax> margins_{};
  std::array<std::uint16_t, Lanes::kMax> which_{};
  int count_{}, steps_{}, pending_{};
  double margin_{};
  Statistics statistics_;
  double best_arrival_{1e18};
  std::int32_t best_parent_{-1};
  int best_heading_{-1}, best_repeats_{};
  std::int32_t nearest_{};
  double nearest_distance_{};
};

}  // namespace

CtsSearch search(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget) {
  return Search{problem, ocean, chart, budget}.run();
}

Expected<Plan, PlanFailure> CtsAStar::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                           const Budget& budget, const std::function<void(const Plan&)>& better) const {
  if (members.empty()) return unexpected(PlanFailure{NoPlan::no_forecast, "no forecast is given"});
  if (auto wrong = check_ends(problem, members.front(), chart)) return unexpected(*wrong);
  const auto found = search(problem, members.front(), chart, budget);
  const bool reaches = !std::isnan(found.arrival_s);
  const auto waters = waters_of(problem, members.front(), chart);
  auto flight = flight_of(problem);
  // Without an arrival the flight ends with the last heading: steering on to the goal is what the search found impossible.
  if (!reaches)
    flight.horizon_s =
        std::min(flight.horizon_s,
                 problem.start.fix_s + problem.schedule.dive_time(static_cast<int>(found.headings.size())).count() - 1);
  const auto flown = vehicle::fly_headings(found.headings, flight, waters);
  auto plan = plan_from("cts-astar", flown, problem, found.statistics);
  plan.cut_at = found.cut_at;
  if (!plan.reaches_goal()) {
    if (found.headings.empty() && found.exhausted)
      return unexpected(
          PlanFailure{NoPlan::boxed_in, "no stint from the start stays clear of land and inside the field"});
    if (!reaches)
      plan.reason = found.exhausted ? "every way within the horizon was searched: none comes to the goal"
                                    : "the search was stopped before it came to the goal";
  }
  if (better) better(plan);
  return plan;
}

}  // namespace glidehelm::planning
