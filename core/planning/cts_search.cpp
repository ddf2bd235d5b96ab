#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/planning/cts_astar.hpp"
#include "core/planning/cts_lanes.hpp"
#include "core/planning/envelope.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/heading_sampling.hpp"
#include "core/planning/search_grid.hpp"
#include "core/planning/to_go.hpp"
#include "core/vehicle/goal_distance.hpp"

namespace glidehelm::planning {

namespace {

using ocean::Lanes;

constexpr double kNever = 1e18;         // seconds
constexpr double kOrderInLayer = 1e-8;  // seconds per metre: less than a second round the Earth

/// A surfacing that a cell is labelled with.
struct Label {
  double lat{}, lon{};
  double f{};  ///< seconds from the fix, h weighted
  std::int32_t parent{-1}, cell{-1};
  float margin{};           ///< clearance to keep from here
  std::uint16_t heading{};  ///< index among the M of its parent
  std::uint16_t stints{};   ///< flown so far
  std::uint8_t repeats{1};  ///< stints flown on this heading from the parent
  bool expanded{};
};

struct Open {
  double f;
  std::int32_t label;
};
/// Order of a heap whose top is the smallest f, then the label created first.
bool after(const Open& a, const Open& b) { return a.f > b.f || (a.f == b.f && a.label > b.label); }

class LabelSearch {
 public:
  LabelSearch(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget,
              const CtsSettings& settings)
      : problem_{problem},
        ocean_{ocean},
        budget_{budget},
        goal_{disc_of(problem)},
        goal_distance_{goal_},
        speed_{problem.glider.horizontal_speed.si()},
        stint_{problem.schedule.stint.count()},
        horizon_{within_objective(problem).horizon_s - problem.start.fix_s},
        at_stint_{wants_least_distance(problem) ? stints_within(within_objective(problem)) : 0},
        reach_{reach_of(problem, ocean)},
        own_to_go_{settings.to_go ? std::nullopt : std::optional<ToGo>{std::in_place, problem, ocean, chart}},
        to_go_{settings.to_go ? *settings.to_go : *own_to_go_},
        anticipated_{std::max(1.0, distance(problem.start.fix, goal_.centre).si() / (speed_ * stint_))},
        grid_{make_grid(settings.cell.si() > 0 ? settings.cell : cell_of(problem))},
        best_of_cell_(grid_.cells(), -1),
        count_{std::clamp(problem.headings, 1, Lanes::kMax)},
        best_arrival_{std::min(kNever, settings.earlier_than_s - problem.start.fix_s)},
        hopeless_{settings.nearest || wants_least_distance(problem)},
        lanes_{problem, ocean, chart, problem.coast_margin.si() + settings.allowance.si(), reach_} {
    if (settings.sampling == HeadingSampling::adaptive)
      adaptive_.emplace(problem.glider.horizontal_speed, problem.seed);
    for (int i = 0; i < count_; ++i) {
      const double turn = 2 * kPi * i / count_;
      turns_[static_cast<std::size_t>(i)] = {speed_ * std::sin(turn), speed_ * std::cos(turn)};
    }
    labels_.reserve(1 << 14);
    heap_.reserve(1 << 14);
  }

  CtsSearch run() {
    begin();
    const bool exhausted = expand_best_first();
    return result(exhausted);
  }

 private:
  [[nodiscard]] SearchGrid make_grid(Metres cell) const {
    const auto& a = problem_.start.fix;
    const double lat = 0.5 * (a.lat.radians() + goal_distance_.lat());
    const double lon = a.lon.radians() + 0.5 * std::remainder(goal_distance_.lon() - a.lon.radians(), 2 * kPi);
    // Whoever reaches the goal within the horizon stays in an ellipse around start and goal; the circle around its
    // middle holds it. Without that hope the start lies within the circle all the same.
    const double way = distance(a, goal_.centre).si();
    const double covered = horizon_ * std::max(reach_.dive, reach_.drift) + goal_.radius.si();
    // A least distance may lie behind the start, where a current carries to.
    const double reach = layered() ? std::min(0.5 * way + covered, 1e7)
                                   : 0.5 * std::clamp(covered, 1.02 * way + 2 * speed_ * stint_, 2e7);
    return SearchGrid{lat, lon, reach, cell.si(), ocean_.dive.coverage()};
  }

  void begin() {
    Label start;
    start.lat = problem_.start.fix.lat.radians();
    start.lon = problem_.start.fix.lon.radians();
    start.margin = static_cast<float>(lanes_.margin_at(start.lat, start.lon));
    parent_distance_ = goal_distance_.least(start.lat, start.lon);
    nearest_distance_ = layered() ? kNever : parent_distance_;
    const double to_go = distance(problem_.start.fix, goal_.centre).si() - goal_.radius.si();
    hopeless_ = hopeless_ || to_go_.from_fix(start.lat, start.lon, parent_distance_) > horizon_;
    add(start, false);  // belongs to no cell: a stint may come back to where it began
    heap_.push_back({0.0, 0});
    if (to_go <= 0) arrive(CtsLanes::Entry{0, 0}, 0, 0);
  }

  /// False when the budget, not the search, came to its end.
  bool expand_best_first() {
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), after);
      const Open top = heap_.back();
      heap_.pop_back();
      if (top.f >= best_arrival_) return true;
      Label& label = labels_[static_cast<std::size_t>(top.label)];
      if (label.expanded || label.f != top.f) continue;  // improved since it was put here
      if (expansions_ >= budget_.work || labels_.size() > CtsAStar::kMostLabels) return false;
      if (expansions_ % 64 == 63 && budget_.expired && budget_.expired()) {
        cut_at_ = expansions_;
        return false;
      }
      label.expanded = true;
      ++expansions_;
      expand(top.label);
    }
    return true;
  }

  [[nodiscard]] CtsSearch result(bool exhausted) const {
    const bool arrives = best_parent_ >= 0;
    CtsSearch r;
    r.arrival_s = arrives ? problem_.start.fix_s + best_arrival_ : std::nan("");
    r.headings = path_to(arrives ? best_parent_ : nearest_);
    if (arrives && best_heading_ >= 0)
      r.headings.insert(r.headings.end(), static_cast<std::size_t>(best_repeats_),
                        adaptive_ ? Heading{Radians{best_drawn_}}
                                  : heading_of(best_parent_, static_cast<std::uint16_t>(best_heading_)));
    r.statistics = statistics();
    r.cut_at = cut_at_;
    r.exhausted = exhausted;
    r.nearest_m = nearest_distance_;
    r.stopped = stopped();
    r.step_s = lanes_.step();
    r.labels = labels_.size();
    r.cells = grid_.cells();
    r.cell_m = grid_.cell_size();
    r.memory_bytes = labels_.capacity() * sizeof(Label) + heap_.capacity() * sizeof(Open) +
                     best_of_cell_.capacity() * sizeof(std::int32_t);
    return r;
  }

  [[nodiscard]] Statistics statistics() const {
    Statistics all = lanes_.statistics();
    all.expansions = expansions_;
    if (own_to_go_) all.current_evaluations += own_to_go_->current_evaluations();
    return all;
  }
  [[nodiscard]] CtsSearch::Stopped stopped() const {
    auto all = lanes_.stopped();
    all.horizon = beyond_horizon_;
    return all;
  }
  /// Seconds from the fix to the surfacing after `stints` stints.
  [[nodiscard]] double surfaced(int stints) const {
    return stints == 0 ? 0.0 : problem_.schedule.surfacing_time(stints - 1).count();
  }
  [[nodiscard]] double dives(int stint) const { return problem_.schedule.dive_time(stint).count(); }

  // ---- one expansion: Algorithm 4.2

  void expand(std::int32_t index) {
    const Label label = labels_[static_cast<std::size_t>(index)];
    if (dives(label.stints) >= horizon_ || (layered() && label.stints >= at_stint_)) {
      beyond_horizon_ = true;
      return;
    }
    parent_distance_ = goal_distance_.least(label.lat, label.lon);
    lanes_.begin({label.lat, label.lon, label.margin, 0});
    arrive(lanes_.drift(label.stints, near_goal(1)), index, 0);
    if (lanes_.lost(0)) return;
    const auto dive = lanes_.at(0);
    if (adaptive_)
      draw_headings(label.stints, dive);
    else
      spread_headings(goal_distance_.direction(label.lat, label.lon), dive);
    lanes_.resize(count_);
    for (int repeat = 1;; ++repeat) {  // lines 5–9
      const int stint = label.stints + repeat - 1;
      arrive(lanes_.fly(stint, near_goal(repeat)), index, repeat);
      keep_lanes_that_stay(index, stint + 1, repeat);
      if (lanes_.count() == 0 || repeat == CtsAStar::kMostRepeats) return;
      if (dives(stint + 1) >= horizon_) {
        beyond_horizon_ = true;
        return;
      }
      arrive(lanes_.drift(stint + 1, near_goal(repeat + 1)), index, repeat);
      lanes_.drop_lost();
    }
  }

  /// Line 3, uniform: the goal's direction first.
  void spread_headings(Offset to_goal, const CtsLanes::Place& dive) {
    const double per = to_goal.length() > 0 ? 1 / to_goal.length() : 0.0;
    const double sin_b = per * to_goal.east, cos_b = per > 0 ? per * to_goal.north : 1.0;
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      lanes_.put(k, dive, sin_b * turns_[k].cos + cos_b * turns_[k].sin, cos_b * turns_[k].cos - sin_b * turns_[k].sin,
                 static_cast<std::uint16_t>(i));
    }
  }
  /// Line 3, adaptive: for the current at the dive.
  void draw_headings(int stint, const CtsLanes::Place& dive) {
    const auto to_goal = goal_distance_.direction(dive.lat, dive.lon);
    const auto current =
        ocean_.dive.sample(GeoPoint::from_kernel(dive.lat, dive.lon), problem_.start.fix_s + dives(stint));
    lanes_.count_evaluation();
    adaptive_->draw(std::atan2(to_goal.east, to_goal.north), current ? current->current : Current{}, expansions_,
                    std::span{draw_}.first(static_cast<std::size_t>(count_)));
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      lanes_.put(k, dive, speed_ * std::sin(draw_[k]), speed_ * std::cos(draw_[k]), static_cast<std::uint16_t>(i));
    }
  }

  /// True when the goal's disc may be entered within `repeats` stints and drifts from the label that is expanded.
  [[nodiscard]] bool near_goal(int repeats) const {
    const double stint = std::max(stint_, problem_.schedule.first_stint.count());
    const double wait = std::max(reach_.surface, problem_.schedule.time_to_dive.count());
    return parent_distance_ <= goal_.radius.si() + repeats * (reach_.dive * stint + reach_.drift * wait);
  }

  /// After `repeats` stints from the parent; none: in the drift before them.
  void arrive(const std::optional<CtsLanes::Entry>& entry, std::int32_t parent, int repeats) {
    if (!entry || entry->t > horizon_ || entry->t >= best_arrival_) return;
    best_arrival_ = entry->t;
    best_parent_ = parent;
    best_heading_ = repeats == 0 ? -1 : entry->heading;
    best_repeats_ = repeats;
    if (repeats > 0) best_drawn_ = draw_[entry->heading];
  }

  /// Lines 7–21: labels the cells of the lanes that left their parent's; what stays is packed to the front.
  void keep_lanes_that_stay(std::int32_t index, int stints, int repeat) {
    const std::int32_t parent_cell = labels_[static_cast<std::size_t>(index)].cell;
    const bool late = surfaced(stints) > horizon_;
    beyond_horizon_ = beyond_horizon_ || late;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(lanes_.count()); ++k) {
      if (lanes_.lost(k) || late) continue;
      const auto place = lanes_.at(k);
      const auto cell = grid_.cell(place.lat, place.lon);
      if (cell < 0)
        beyond_horizon_ = true;  // the box holds everything that is of use in time; the field's edge is a wall before
      else if (cell != parent_cell || layered())
        offer(cell, index, place, lanes_.heading(k), stints, repeat);
      else
        lanes_.move(k, kept++);
    }
    lanes_.resize(static_cast<int>(kept));
  }

  /// Labels a cell with a place when that is better than what it has.
  void offer(std::int32_t cell, std::int32_t parent, const CtsLanes::Place& place, std::uint16_t heading, int stints,
             int repeats) {
    auto& best = best_of_cell_[static_cast<std::size_t>(cell)];
    if (best >= 0 && labels_[static_cast<std::size_t>(best)].stints < stints) {
      if (!layered()) return;
      best = -1;  // of a layer that is done
    }
    const double d = goal_distance_.least(place.lat, place.lon), g = surfaced(stints);
    const double h = layered() ? d * kOrderInLayer : to_go_.from_surfacing(place.lat, place.lon, d);
    const double f = layered() ? g + h : g + problem_.guidance.factor(stints, anticipated_) * h;
    if (f >= best_arrival_) return;
    const Label label{place.lat,
                      place.lon,
                      f,
                      parent,
                      cell,
                      static_cast<float>(place.margin),
                      heading,
                      static_cast<std::uint16_t>(stints),
                      static_cast<std::uint8_t>(repeats),
                      false};
    if (g + h > horizon_ && !hopeless_) {  // told by the bound itself: the weighted f proves nothing
      beyond_horizon_ = true;
      if (d < nearest_distance_) note_nearest(d, add(label, true));
      return;
    }
    std::int32_t index = best;
    if (best >= 0) {
      const Label& other = labels_[static_cast<std::size_t>(best)];
      if (other.stints == stints && other.f <= f) return;
      if (other.expanded || (best == nearest_ && d > nearest_distance_)) index = -1;
    }
    if (index >= 0) {
      labels_[static_cast<std::size_t>(index)] = label;  // nothing was reached from it yet
      if (adaptive_) drawn_[static_cast<std::size_t>(index)] = draw_[label.heading];
    } else {
      best = index = add(label, false);
    }
    if (d < nearest_distance_ && (!layered() || stints == at_stint_)) note_nearest(d, index);
    heap_.push_back({f, index});
    std::push_heap(heap_.begin(), heap_.end(), after);
  }
  std::int32_t add(const Label& label, bool expanded) {
    labels_.push_back(label);
    labels_.back().expanded = expanded;
    if (adaptive_) drawn_.push_back(draw_[label.heading]);
    return static_cast<std::int32_t>(labels_.size()) - 1;
  }
  /// Layer by layer of stints: a cell has a label of its own in each.
  [[nodiscard]] bool layered() const { return at_stint_ > 0; }
  void note_nearest(double d, std::int32_t index) {
    nearest_distance_ = d;
    nearest_ = index;
  }

  [[nodiscard]] Heading heading_of(std::int32_t parent, std::uint16_t heading) const {
    const Label& from = labels_[static_cast<std::size_t>(parent)];
    const auto to_goal = goal_distance_.direction(from.lat, from.lon);
    return Heading::of(to_goal.east, to_goal.north) + Radians{2 * kPi * heading / count_};
  }
  [[nodiscard]] std::vector<Heading> path_to(std::int32_t index) const {
    std::vector<Heading> headings;
    for (; index > 0; index = labels_[static_cast<std::size_t>(index)].parent) {
      const Label& label = labels_[static_cast<std::size_t>(index)];
      headings.insert(headings.end(), label.repeats,
                      adaptive_ ? Heading{Radians{drawn_[static_cast<std::size_t>(index)]}}
                                : heading_of(label.parent, label.heading));
    }
    std::reverse(headings.begin(), headings.end());
    return headings;
  }

  struct Turn {
    double sin{}, cos{};
  };
  using PerLane = std::array<double, Lanes::kMax>;

  const Problem& problem_;
  const ocean::Ocean& ocean_;
  const Budget& budget_;
  vehicle::Disc goal_;
  vehicle::GoalDistance goal_distance_;
  double speed_, stint_, horizon_;
  int at_stint_;  ///< stints of a way of least distance; 0 under MinTime
  Envelope reach_;
  std::optional<ToGo> own_to_go_;
  const ToGo& to_go_;
  double anticipated_;  ///< stints of the way through still water
  SearchGrid grid_;
  std::vector<std::int32_t> best_of_cell_;  ///< label of each cell, −1 none
  int count_;
  double best_arrival_;  ///< seconds from the fix
  bool hopeless_;        ///< not even the bound reaches the goal from the start, or the nearest position is asked for
  CtsLanes lanes_;       ///< of the label that is expanded
  std::vector<Label> labels_;
  std::vector<Open> heap_;
  std::array<Turn, Lanes::kMax> turns_{};
  std::optional<AdaptiveHeadings> adaptive_;  ///< none: uniform headings
  std::array<double, Lanes::kMax> draw_{};    ///< of the label that is expanded, radians; adaptive only
  std::vector<double> drawn_;                 ///< the heading that led to each label; adaptive only
  double parent_distance_{};
  std::uint64_t expansions_{}, cut_at_{};
  bool beyond_horizon_{};
  std::int32_t best_parent_{-1};
  int best_heading_{-1}, best_repeats_{};
  double best_drawn_{};
  std::int32_t nearest_{};
  double nearest_distance_{};
};

}  // namespace

Metres cell_of(const Problem& problem) {
  return problem.cell.si() > 0 ? problem.cell : 0.5 * (problem.glider.horizontal_speed * problem.schedule.stint);
}

CtsSearch search(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget,
                 const CtsSettings& settings) {
  return LabelSearch{problem, ocean, chart, budget, settings}.run();
}

}  // namespace glidehelm::planning
