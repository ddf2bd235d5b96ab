#include "core/planning/lattice_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/lattice.hpp"
#include "core/planning/optimal_course.hpp"
#include "core/planning/segment_time.hpp"
#include "core/planning/travel_time.hpp"

namespace glidehelm::planning {

namespace {

constexpr std::size_t kMostLabels = 8'000'000;
constexpr double kNever = 1e18;  // seconds
constexpr double kSlack = 1.0;   // metres, as vehicle::gained_margin

/// A node with a way to it.
struct Label {
  double t{}, f{};  ///< epoch seconds
  std::int32_t parent{-1};
  std::int32_t row{}, column{};
  float margin{};  ///< clearance to keep from here
  bool expanded{};
};

struct Open {
  double f;
  std::int32_t label;
};
bool after(const Open& a, const Open& b) { return a.f > b.f || (a.f == b.f && a.label > b.label); }

class LatticeSearch {
 public:
  LatticeSearch(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget,
                const LatticeRules& rules)
      : problem_{problem},
        chart_{chart},
        budget_{budget},
        rules_{rules},
        goal_{disc_of(problem)},
        motion_{problem, ocean},
        margin_{problem.coast_margin.si() + rules.allowance.si()},
        start_{first_dive(ocean)},
        goal_lat_{goal_.centre.lat.radians()},
        goal_lon_{start_.lon + std::remainder(goal_.centre.lon.radians() - start_.lon, 2 * kPi)},
        lattice_{{start_.lat, start_.lon},
                 {goal_lat_, goal_lon_},
                 reach(),
                 rules.spacing.si() > 0 ? rules.spacing.si() : cell_of(problem).si(),
                 rules.grid,
                 ocean.dive.coverage()} {}

  LatticeWay run() {
    LatticeWay way;
    way.arrival_s = std::numeric_limits<double>::quiet_NaN();
    way.spacing_m = lattice_.spacing();
    way.exhausted = true;
    if (lost_at_start_) {
      way.stopped.no_water = true;
      return way;
    }
    best_of_node_.assign(lattice_.nodes(), -1);
    begin();
    way.exhausted = expand_best_first();
    way.arrives = arrival_ < kNever;
    if (way.arrives) way.arrival_s = arrival_;
    way.points = points(way.arrives ? last_ : nearest_);
    if (way.arrives) way.points.push_back(entry_);
    way.statistics = statistics_;
    way.cut_at = cut_at_;
    way.stopped = stopped_;
    return way;
  }

 private:
  WayPoint first_dive(const ocean::Ocean& ocean) {
    const auto waters = waters_of(problem_, ocean, chart_);
    const auto fix = vehicle::state_at(problem_.start.fix, problem_.start.fix_s, waters);
    const auto drift = vehicle::move(waters, ocean.surface, fix, problem_.schedule.time_to_dive.count(), {}, nullptr);
    lost_at_start_ = drift.lost.has_value();
    return {drift.end.lat, drift.end.lon, drift.end.t_s, 0};
  }
  [[nodiscard]] double reach() const {
    const double way = vehicle::distance_near(start_.lat, start_.lon, goal_);
    const double covered = (problem_.horizon_s - start_.t_s) * motion_.fastest() + goal_.radius.si();
    return 0.5 * std::clamp(covered, 1.1 * way + 4 * cell_of(problem_).si(), 2e7);
  }

  void begin() {
    const Label start{start_.t_s,
                      start_.t_s,
                      -1,
                      lattice_.start_row(),
                      lattice_.start_column(),
                      static_cast<float>(margin_in_force(start_.lat, start_.lon) - kSlack),
                      false};
    nearest_distance_ = vehicle::distance_near(start_.lat, start_.lon, goal_);
    if (nearest_distance_ <= goal_.radius.si())
      arrive(start_.t_s, 0, {start_.lat, start_.lon, start_.t_s, start.margin});
    best_of_node_[static_cast<std::size_t>(lattice_.index(start.row, start.column))] = 0;
    labels_.push_back(start);
    open_.push_back({start.f, 0});
  }

  /// False when the budget, not the search, came to its end.
  bool expand_best_first() {
    while (!open_.empty()) {
      std::pop_heap(open_.begin(), open_.end(), after);
      const Open top = open_.back();
      open_.pop_back();
      if (top.f >= arrival_ && !rules_.beyond_goal) return true;
      Label& label = labels_[static_cast<std::size_t>(top.label)];
      if (label.expanded || label.f != top.f) continue;  // improved since it was put here
      if (statistics_.expansions >= budget_.work || labels_.size() > kMostLabels) return false;
      if (statistics_.expansions % 64 == 63 && budget_.expired && budget_.expired()) {
        cut_at_ = statistics_.expansions;
        return false;
      }
      label.expanded = true;
      ++statistics_.expansions;
      expand(top.label);
    }
    return true;
  }

  void expand(std::int32_t index) {
    const Label from = labels_[static_cast<std::size_t>(index)];
    const double lat = lattice_.lat(from.row), lon = lattice_.lon(from.row, from.column);
    const double to_goal = vehicle::distance_near(lat, lon, goal_);
    // The metric changes along long lattices: half as much again holds every step.
    near_ = to_goal <= goal_.radius.si() + 1.5 * lattice_.longest_step();
    if (near_) {
      const double share = 1 - goal_.radius.si() / std::max(to_goal, goal_.radius.si());
      pass(index, from, lat + share * (goal_lat_ - lat), lon + share * (goal_lon_ - lon), -1, -1);
    }
    const auto best_course = course_beyond(from);
    for (const auto& step : lattice_.steps(from.row)) {
      const int row = from.row + step.rows, column = from.column + step.columns;
      if (!lattice_.contains(row, column)) {
        stopped_.no_water = true;
        continue;
      }
      const auto known = best_of_node_[static_cast<std::size_t>(lattice_.index(row, column))];
      if (known >= 0 && labels_[static_cast<std::size_t>(known)].t <= from.t) continue;
      const double lat1 = lattice_.lat(row), lon1 = lattice_.lon(row, column);
      if (best_course) {
        const auto edge = local_offset(lat, lon, lat1, lon1);
        if (std::abs((*best_course - Course::of(edge.east, edge.north)).si()) >= rules_.cone->si()) continue;
      }
      pass(index, from, lat1, lon1, row, column);
    }
  }

  /// What the cone lies around; none where all edges are examined.
  [[nodiscard]] std::optional<Course> course_beyond(const Label& from) {
    if (!rules_.cone || from.parent < 0) return std::nullopt;
    const auto to = place(from), before = place(labels_[static_cast<std::size_t>(from.parent)]);
    if (chart_.clearance_at_least(to.lat, to.lon) < margin_ + 1.5 * lattice_.longest_step()) return std::nullopt;
    return optimal_course(motion_, before, to, statistics_.current_evaluations);
  }

  /// The segment to a node, or without one into the goal's disc.
  void pass(std::int32_t index, const Label& from, double lat1, double lon1, int row, int column) {
    const double lat0 = lattice_.lat(from.row), lon0 = lattice_.lon(from.row, from.column);
    bool enters = row < 0;
    if (near_ && !enters) {
      if (const auto share = vehicle::entry_into(goal_, lat0, lon0, lat1, lon1)) {
        enters = true;
        lat1 = lat0 + *share * (lat1 - lat0);
        lon1 = lon0 + *share * (lon1 - lon0);
      }
    }
    if (!chart_.segment_is_clear(lat0, lon0, lat1, lon1, from.margin)) {
      stopped_.margin = true;
      return;
    }
    ++statistics_.cost_evaluations;
    auto& samples = statistics_.current_evaluations;
    const auto seconds = rules_.step_control ? travel_time(motion_, lat0, lon0, lat1, lon1, from.t, samples)
                                             : segment_time(motion_, lat0, lon0, lat1, lon1, from.t, samples);
    if (!seconds) {
      stopped_.forecast_end = stopped_.forecast_end || seconds.error() == NoPassage::forecast_end;
      stopped_.no_water = stopped_.no_water || seconds.error() == NoPassage::no_current;
      stopped_.too_strong = stopped_.too_strong || seconds.error() == NoPassage::too_strong;
      return;
    }
    const double t = from.t + *seconds;
    if (enters)
      arrive(t, index, {lat1, lon1, t, from.margin});
    else
      offer(index, from, t, lat1, lon1, row, column);
  }

  void arrive(double t, std::int32_t from, const WayPoint& entry) {
    if (t > problem_.horizon_s) stopped_.horizon = true;
    if (t > problem_.horizon_s || t >= arrival_) return;
    arrival_ = t;
    last_ = from;
    entry_ = entry;
  }

  void offer(std::int32_t parent, const Label& from, double t, double lat, double lon, int row, int column) {
    auto& best = best_of_node_[static_cast<std::size_t>(lattice_.index(row, column))];
    if (best >= 0 && labels_[static_cast<std::size_t>(best)].t <= t) return;
    if (t > problem_.horizon_s) {
      stopped_.horizon = true;
      return;
    }
    const double f = rules_.estimates ? t + least_time(lat, lon) : t;
    if (f >= arrival_ && !rules_.beyond_goal) return;
    const auto margin = std::max(from.margin, static_cast<float>(margin_in_force(lat, lon) - kSlack));
    const Label label{t, f, parent, row, column, margin, false};
    if (best >= 0 && !labels_[static_cast<std::size_t>(best)].expanded) {
      labels_[static_cast<std::size_t>(best)] = label;  // nothing was reached from it yet
    } else {
      best = static_cast<std::int32_t>(labels_.size());
      labels_.push_back(label);
    }
    const double d = vehicle::distance_near(lat, lon, goal_);
    if (d < nearest_distance_) {
      nearest_distance_ = d;
      nearest_ = best;
    }
    open_.push_back({f, best});
    std::push_heap(open_.begin(), open_.end(), after);
  }

  /// A thousandth less than the bound, ten times the error of a segment's length.
  [[nodiscard]] double least_time(double lat, double lon) const {
    const double d = distance_lower_bound(lat, lon, goal_lat_, goal_lon_) - goal_.radius.si();
    return std::max(0.0, 0.999 * d / motion_.fastest());
  }
  [[nodiscard]] WayPoint place(const Label& label) const {
    return {lattice_.lat(label.row), lattice_.lon(label.row, label.column), label.t, label.margin};
  }
  [[nodiscard]] double margin_in_force(double lat, double lon) const {
    if (chart_.clearance_at_least(lat, lon) >= margin_) return margin_ + kSlack;
    return std::min(margin_ + kSlack, chart_.clearance(lat, lon));
  }
  [[nodiscard]] std::vector<WayPoint> points(std::int32_t index) const {
    std::vector<WayPoint> way;
    for (; index >= 0; index = labels_[static_cast<std::size_t>(index)].parent) {
      const Label& label = labels_[static_cast<std::size_t>(index)];
      way.push_back(place(label));
    }
    std::reverse(way.begin(), way.end());
    return way;
  }

  const Problem& problem_;
  const chart::Chart& chart_;
  const Budget& budget_;
  const LatticeRules& rules_;
  vehicle::Disc goal_;
  MeanMotion motion_;
  double margin_;
  bool lost_at_start_{};
  WayPoint start_;
  double goal_lat_, goal_lon_;
  Lattice lattice_;
  std::vector<std::int32_t> best_of_node_;  ///< label of each node, −1 none
  std::vector<Label> labels_;
  std::vector<Open> open_;
  bool near_{};  ///< the goal may be reached from the node that is expanded
  double arrival_{kNever};
  std::int32_t last_{-1}, nearest_{0};
  WayPoint entry_;
  double nearest_distance_{};
  Statistics statistics_;
  std::uint64_t cut_at_{};
  LatticeWay::Stopped stopped_;
};

}  // namespace

std::string reason_for(const LatticeWay& way) {
  if (!way.exhausted) return "the search was stopped before it came to the goal";
  std::string text;
  const auto add = [&text](bool holds, const char* part) {
    if (holds) text += std::string{text.empty() ? "" : ", "} + part;
  };
  add(way.stopped.horizon, "the horizon");
  add(way.stopped.forecast_end, "the end of the forecast");
  add(way.stopped.too_strong, "currents in which no course of the lattice can be held");
  add(way.stopped.margin, "the margin to land and areas");
  add(way.stopped.no_water, "land, missing data or the edge of the forecast's area");
  return text.empty() ? "no segment leads out of the start"
                      : "no way over the lattice reaches the goal; ways end at: " + text;
}

LatticeWay search_lattice(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
                          const Budget& budget, const LatticeRules& rules) {
  return LatticeSearch{problem, ocean, chart, budget, rules}.run();
}

}  // namespace glidehelm::planning
