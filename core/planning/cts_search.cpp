#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/planning/cts_astar.hpp"
#include "core/planning/envelope.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/heading_sampling.hpp"
#include "core/planning/search_grid.hpp"

namespace glidehelm::planning {

namespace {

using ocean::Lanes;

constexpr double kSmallestRadius = 6'335'439.0;  // of curvature of WGS84: makes distances lower bounds
constexpr double kNever = 1e18;                  // seconds
constexpr double kOrderInLayer = 1e-8;           // seconds per metre: less than a second round the Earth

/// A surfacing that a cell is labelled with.
struct Label {
  double lat{}, lon{};
  double f{};  ///< seconds from the fix
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
        chart_{chart},
        budget_{budget},
        goal_{disc_of(problem)},
        goal_lat_{goal_.centre.lat.radians()},
        goal_lon_{goal_.centre.lon.radians()},
        goal_cos_{std::cos(goal_lat_)},
        speed_{problem.glider.horizontal_speed.si()},
        stint_{problem.schedule.stint.count()},
        horizon_{within_objective(problem).horizon_s - problem.start.fix_s},
        margin_{problem.coast_margin.si() + settings.allowance.si()},
        at_stint_{wants_least_distance(problem) ? stints_within(within_objective(problem)) : 0},
        envelope_{speed_ + ocean.dive.fastest().si(), ocean.surface.fastest().si(), stint_,
                  problem.schedule.surface.count()},
        grid_{make_grid(settings.cell.si() > 0 ? settings.cell : cell_of(problem))},
        best_of_cell_(grid_.cells(), -1),
        step_{vehicle::lane_step(ocean, problem.start.fix, goal_.centre, problem.start.fix_s, stint_,
                                 problem.glider.horizontal_speed)},
        count_{std::clamp(problem.headings, 1, Lanes::kMax)},
        best_arrival_{std::min(kNever, settings.earlier_than_s - problem.start.fix_s)},
        hopeless_{settings.nearest || wants_least_distance(problem)} {
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
    const double lat = 0.5 * (a.lat.radians() + goal_lat_);
    const double lon = a.lon.radians() + 0.5 * std::remainder(goal_lon_ - a.lon.radians(), 2 * kPi);
    // Whoever reaches the goal within the horizon stays in an ellipse around start and goal; the circle around its
    // middle holds it. Without that hope the start lies within the circle all the same.
    const double way = distance(a, goal_.centre).si();
    const double covered = horizon_ * std::max(envelope_.dive, envelope_.drift) + goal_.radius.si();
    // A least distance may lie behind the start, where a current carries to.
    const double reach = layered() ? std::min(0.5 * way + covered, 1e7)
                                   : 0.5 * std::clamp(covered, 1.02 * way + 2 * speed_ * stint_, 2e7);
    return SearchGrid{lat, lon, reach, cell.si(), ocean_.dive.coverage()};
  }

  void begin() {
    Label start;
    start.lat = problem_.start.fix.lat.radians();
    start.lon = problem_.start.fix.lon.radians();
    start.margin = static_cast<float>(margin_in_force(start.lat, start.lon) - kSlack);
    parent_distance_ = least_distance(start.lat, start.lon);
    nearest_distance_ = layered() ? kNever : parent_distance_;
    const double to_go = distance(problem_.start.fix, goal_.centre).si() - goal_.radius.si();
    hopeless_ =
        hopeless_ || envelope_.least_time_from_fix(parent_distance_ - goal_.radius.si(), problem_.schedule) > horizon_;
    add(start, false);  // belongs to no cell: a stint may come back to where it began
    heap_.push_back({0.0, 0});
    if (to_go <= 0) arrive(0, 0, -1, 0);
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
      if (statistics_.expansions >= budget_.work || labels_.size() > CtsAStar::kMostLabels) return false;
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

  [[nodiscard]] CtsSearch result(bool exhausted) const {
    const bool arrives = best_parent_ >= 0;
    CtsSearch r;
    r.arrival_s = arrives ? problem_.start.fix_s + best_arrival_ : std::nan("");
    r.headings = path_to(arrives ? best_parent_ : nearest_);
    if (arrives && best_heading_ >= 0)
      r.headings.insert(r.headings.end(), static_cast<std::size_t>(best_repeats_),
                        adaptive_ ? Heading{Radians{best_drawn_}}
                                  : heading_of(best_parent_, static_cast<std::uint16_t>(best_heading_)));
    r.statistics = statistics_;
    r.cut_at = cut_at_;
    r.exhausted = exhausted;
    r.nearest_m = nearest_distance_;
    r.stopped = stopped_;
    r.step_s = step_;
    r.labels = labels_.size();
    r.cells = grid_.cells();
    r.cell_m = grid_.cell_size();
    r.memory_bytes = labels_.capacity() * sizeof(Label) + heap_.capacity() * sizeof(Open) +
                     best_of_cell_.capacity() * sizeof(std::int32_t);
    return r;
  }

  /// A lower bound of the geodesic distance to the goal's centre: half the chord is x = sin(angle/2), and all series are
  /// cut where they are below what they stand for.
  [[nodiscard]] double least_distance(double lat, double lon) const {
    const double s = sine_at_most(0.5 * std::abs(goal_lat_ - lat));
    const double t = sine_at_most(
        0.5 * std::abs(std::abs(goal_lon_ - lon) <= kPi ? goal_lon_ - lon : std::remainder(goal_lon_ - lon, 2 * kPi)));
    const double x2 = s * s + cosine_at_most(lat) * goal_cos_ * t * t, x = std::sqrt(std::max(0.0, x2));
    return 2 * kSmallestRadius * x * (1 + x2 * (1.0 / 6 + x2 * (3.0 / 40 + x2 * (15.0 / 336))));
  }
  /// 0 ≤ x ≤ π/2; to 2e-4 there, to 1e-9 for x < 0.3.
  static double sine_at_most(double x) {
    const double x2 = x * x;
    return x * (1 - x2 * (1.0 / 6 - x2 * (1.0 / 120 - x2 * (1.0 / 5040))));
  }
  /// |x| ≤ π/2, to 5e-7.
  static double cosine_at_most(double x) {
    const double x2 = x * x;
    return 1 - x2 * (1.0 / 2 - x2 * (1.0 / 24 - x2 * (1.0 / 720 - x2 * (1.0 / 40320 - x2 * (1.0 / 3628800)))));
  }
  /// Direction to the goal on the sphere, not normalised.
  [[nodiscard]] Offset towards_goal(double lat, double lon) const {
    const double dlon = goal_lon_ - lon;
    return {std::sin(dlon) * goal_cos_,
            std::cos(lat) * std::sin(goal_lat_) - std::sin(lat) * goal_cos_ * std::cos(dlon)};
  }

  [[nodiscard]] double margin_in_force(double lat, double lon) const {
    if (chart_.clearance_at_least(lat, lon) >= margin_) return margin_;
    return std::min(margin_, chart_.clearance(lat, lon));
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
      stopped_.horizon = true;
      return;
    }
    parent_distance_ = least_distance(label.lat, label.lon);
    set_lane(0, label.lat, label.lon, 0, 0, label.margin);
    lanes_.count = 1;
    drift(label.stints, index, 0);
    if (lanes_.lost[0] != 0) return;
    const double lat = lanes_.lat[0], lon = lanes_.lon[0], margin = margins_[0], room = rooms_[0];
    if (adaptive_)
      draw_headings(label.stints, lat, lon, margin, room);
    else
      spread_headings(towards_goal(label.lat, label.lon), lat, lon, margin, room);
    lanes_.count = count_;
    for (int repeat = 1;; ++repeat) {  // lines 5–9
      const int stint = label.stints + repeat - 1;
      fly(index, stint, repeat);
      keep_lanes_that_stay(index, stint + 1, repeat);
      if (lanes_.count == 0 || repeat == CtsAStar::kMostRepeats) return;
      if (dives(stint + 1) >= horizon_) {
        stopped_.horizon = true;
        return;
      }
      drift(stint + 1, index, repeat);
      drop_lost();
    }
  }

  /// Line 3, uniform: the goal's direction first. Lanes at the dive.
  void spread_headings(Offset to_goal, double lat, double lon, double margin, double room) {
    const double per = to_goal.length() > 0 ? 1 / to_goal.length() : 0.0;
    const double sin_b = per * to_goal.east, cos_b = per > 0 ? per * to_goal.north : 1.0;
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      set_lane(k, lat, lon, sin_b * turns_[k].cos + cos_b * turns_[k].sin,
               cos_b * turns_[k].cos - sin_b * turns_[k].sin, margin);
      rooms_[k] = room;
      which_[k] = static_cast<std::uint16_t>(i);
    }
  }
  /// Line 3, adaptive: for the current at the dive.
  void draw_headings(int stint, double lat, double lon, double margin, double room) {
    const auto to_goal = towards_goal(lat, lon);
    const auto current = ocean_.dive.sample(GeoPoint::from_kernel(lat, lon), problem_.start.fix_s + dives(stint));
    ++statistics_.current_evaluations;
    adaptive_->draw(std::atan2(to_goal.east, to_goal.north), current ? current->current : Current{},
                    statistics_.expansions, std::span{draw_}.first(static_cast<std::size_t>(count_)));
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      set_lane(k, lat, lon, speed_ * std::sin(draw_[k]), speed_ * std::cos(draw_[k]), margin);
      rooms_[k] = room;
      which_[k] = static_cast<std::uint16_t>(i);
    }
  }

  void set_lane(std::size_t k, double lat, double lon, double east, double north, double margin) {
    lanes_.lat[k] = lat;
    lanes_.lon[k] = lon;
    lanes_.water_east[k] = east;
    lanes_.water_north[k] = north;
    lanes_.lost[k] = 0;
    margins_[k] = margin;
    rooms_[k] = 0;
  }

  /// The surface interval before `stint`, for all lanes, after `repeats` stints of this expansion.
  void drift(int stint, std::int32_t index, int repeats) {
    const double seconds = problem_.schedule.drift_before(stint).count(), t0 = dives(stint) - seconds;
    if (seconds <= 0) return;
    std::copy_n(lanes_.water_east.begin(), lanes_.count, east_kept_.begin());
    std::copy_n(lanes_.water_north.begin(), lanes_.count, north_kept_.begin());
    std::fill_n(lanes_.water_east.begin(), lanes_.count, 0.0);
    std::fill_n(lanes_.water_north.begin(), lanes_.count, 0.0);
    remember_places();
    ocean_.surface.advance(lanes_, problem_.start.fix_s + t0, seconds);
    statistics_.current_evaluations += 4 * static_cast<std::uint64_t>(lanes_.count);
    std::copy_n(east_kept_.begin(), lanes_.count, lanes_.water_east.begin());
    std::copy_n(north_kept_.begin(), lanes_.count, lanes_.water_north.begin());
    check_land(envelope_.drift * seconds);
    if (near_goal(repeats + 1)) check_goal(index, repeats, t0, seconds);
    note_lost();
  }

  /// Flies one stint on every lane: land and goal are looked at after every integration step.
  void fly(std::int32_t index, int stint, int repeat) {
    const double seconds = problem_.schedule.stint_length(stint).count(), t0 = dives(stint);
    const int steps = std::max(1, static_cast<int>(std::ceil(seconds / step_ - 1e-9)));
    const double dt = seconds / steps;
    const bool goal_near = near_goal(repeat), land_near = !spend_room(envelope_.dive * seconds);
    for (int step = 0; step < steps; ++step) {
      if (land_near || goal_near) remember_places();
      ocean_.dive.advance(lanes_, problem_.start.fix_s + t0 + step * dt, dt);
      if (land_near) check_land(envelope_.dive * dt);
      if (goal_near) check_goal(index, repeat, t0 + step * dt, dt);
    }
    const auto flown = static_cast<std::uint64_t>(lanes_.count);
    statistics_.current_evaluations += 4 * flown * static_cast<std::uint64_t>(steps);
    statistics_.cost_evaluations += flown;
    note_lost();
  }

  void remember_places() {
    std::copy_n(lanes_.lat.begin(), lanes_.count, lat_before_.begin());
    std::copy_n(lanes_.lon.begin(), lanes_.count, lon_before_.begin());
  }

  /// True when the goal's disc may be entered within `repeats` stints and drifts from the label that is expanded.
  [[nodiscard]] bool near_goal(int repeats) const {
    const double stint = std::max(stint_, problem_.schedule.first_stint.count());
    const double wait = std::max(envelope_.surface, problem_.schedule.time_to_dive.count());
    return parent_distance_ <= goal_.radius.si() + repeats * (envelope_.dive * stint + envelope_.drift * wait);
  }

  /// True when every lane has room for `reach` metres; it is spent at once.
  bool spend_room(double reach) {
    const auto n = static_cast<std::size_t>(lanes_.count);
    for (std::size_t k = 0; k < n; ++k)
      if (rooms_[k] - reach < margins_[k]) return false;
    for (std::size_t k = 0; k < n; ++k) rooms_[k] -= reach;
    return true;
  }
  /// After a step on which no lane came farther than `reach`. A lane spends its room first.
  void check_land(double reach) {
    for (int i = 0; i < lanes_.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      rooms_[k] -= reach;
      if (rooms_[k] < margins_[k] && lanes_.lost[k] == 0) check_land_closely(k);
    }
  }
  void check_land_closely(std::size_t k) {
    const double lat0 = lat_before_[k], lon0 = lon_before_[k], lat1 = lanes_.lat[k], lon1 = lanes_.lon[k];
    rooms_[k] = chart_.clearance_at_least(lat1, lon1);
    const double way = local_offset(lat0, lon0, lat1, lon1).length();
    if (rooms_[k] - way >= margins_[k]) return;
    if (!chart_.segment_is_clear(lat0, lon0, lat1, lon1, margins_[k])) lanes_.lost[k] = kAground;
    if (margins_[k] < margin_) margins_[k] = std::max(margins_[k], margin_in_force(lat1, lon1) - kSlack);
  }

  void check_goal(std::int32_t index, int repeats, double t0, double dt) {
    for (int i = 0; i < lanes_.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (lanes_.lost[k] != 0) continue;
      const auto share = vehicle::entry_into(goal_, lat_before_[k], lon_before_[k], lanes_.lat[k], lanes_.lon[k]);
      if (!share) continue;
      arrive(t0 + *share * dt, index, repeats == 0 ? -1 : which_[k], repeats);
      lanes_.lost[k] = kArrived;
    }
  }

  void arrive(double time, std::int32_t parent, int heading, int repeats) {
    if (time > horizon_ || time >= best_arrival_) return;
    best_arrival_ = time;
    best_parent_ = parent;
    best_heading_ = heading;
    best_repeats_ = repeats;
    if (heading >= 0) best_drawn_ = draw_[static_cast<std::size_t>(heading)];
  }

  void note_lost() {
    for (int i = 0; i < lanes_.count; ++i) {
      const auto lost = lanes_.lost[static_cast<std::size_t>(i)];
      stopped_.margin = stopped_.margin || lost == kAground;
      stopped_.forecast_end = stopped_.forecast_end || lost == kForecastEnd;
      stopped_.no_water = stopped_.no_water || (lost != 0 && lost < kAground && lost != kForecastEnd);
    }
  }

  void move_lane(std::size_t from, std::size_t to) {
    set_lane(to, lanes_.lat[from], lanes_.lon[from], lanes_.water_east[from], lanes_.water_north[from], margins_[from]);
    rooms_[to] = rooms_[from];
    which_[to] = which_[from];
  }
  void drop_lost() {
    int kept = 0;
    for (int i = 0; i < lanes_.count; ++i)
      if (lanes_.lost[static_cast<std::size_t>(i)] == 0)
        move_lane(static_cast<std::size_t>(i), static_cast<std::size_t>(kept++));
    lanes_.count = kept;
  }

  /// Lines 7–21: labels the cells of the lanes that left their parent's; what stays is packed to the front.
  void keep_lanes_that_stay(std::int32_t index, int stints, int repeat) {
    const std::int32_t parent_cell = labels_[static_cast<std::size_t>(index)].cell;
    const bool late = surfaced(stints) > horizon_;
    stopped_.horizon = stopped_.horizon || late;
    int kept = 0;
    for (int i = 0; i < lanes_.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (lanes_.lost[k] != 0 || late) continue;
      const auto cell = grid_.cell(lanes_.lat[k], lanes_.lon[k]);
      if (cell < 0)
        stopped_.horizon = true;  // the box holds everything that is of use in time; the field's edge is a wall before
      else if (cell != parent_cell || layered())
        offer(cell, index, k, stints, repeat);
      else
        move_lane(k, static_cast<std::size_t>(kept++));
    }
    lanes_.count = kept;
  }

  /// Labels a cell with lane k when that is better than what it has.
  void offer(std::int32_t cell, std::int32_t parent, std::size_t k, int stints, int repeats) {
    auto& best = best_of_cell_[static_cast<std::size_t>(cell)];
    if (best >= 0 && labels_[static_cast<std::size_t>(best)].stints < stints) {
      if (!layered()) return;
      best = -1;  // of a layer that is done
    }
    const double d = least_distance(lanes_.lat[k], lanes_.lon[k]);
    const double f = layered() ? surfaced(stints) + d * kOrderInLayer
                               : surfaced(stints) + envelope_.least_time(d - goal_.radius.si());
    if (f >= best_arrival_) return;
    const Label label{lanes_.lat[k],
                      lanes_.lon[k],
                      f,
                      parent,
                      cell,
                      static_cast<float>(margins_[k]),
                      which_[k],
                      static_cast<std::uint16_t>(stints),
                      static_cast<std::uint8_t>(repeats),
                      false};
    if (f > horizon_ && !hopeless_) {
      stopped_.horizon = true;
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
    const auto to_goal = towards_goal(from.lat, from.lon);
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

  static constexpr std::uint8_t kAground = 200, kArrived = 201;  // beside ocean::NoCurrent
  static constexpr auto kForecastEnd = static_cast<std::uint8_t>(ocean::NoCurrent::outside_time);
  static constexpr double kSlack = 1.0;  // metres, as vehicle::gained_margin
  struct Turn {
    double sin{}, cos{};
  };
  using PerLane = std::array<double, Lanes::kMax>;

  const Problem& problem_;
  const ocean::Ocean& ocean_;
  const chart::Chart& chart_;
  const Budget& budget_;
  vehicle::Disc goal_;
  double goal_lat_, goal_lon_, goal_cos_;
  double speed_, stint_, horizon_, margin_;
  int at_stint_;  ///< stints of a way of least distance; 0 under MinTime
  Envelope envelope_;
  SearchGrid grid_;
  std::vector<std::int32_t> best_of_cell_;  ///< label of each cell, −1 none
  double step_;
  int count_;
  double best_arrival_;  ///< seconds from the fix
  bool hopeless_;        ///< not even the bound reaches the goal from the start, or the nearest position is asked for
  std::vector<Label> labels_;
  std::vector<Open> heap_;
  std::array<Turn, Lanes::kMax> turns_{};
  std::optional<AdaptiveHeadings> adaptive_;  ///< none: uniform headings
  PerLane draw_{};                            ///< of the label that is expanded, radians; adaptive only
  std::vector<double> drawn_;                 ///< the heading that led to each label; adaptive only
  Lanes lanes_{};
  PerLane lat_before_{}, lon_before_{};
  PerLane east_kept_{}, north_kept_{};
  PerLane margins_{};  ///< clearance that a lane keeps
  PerLane rooms_{};    ///< lower bound of the clearance that it has
  std::array<std::uint16_t, Lanes::kMax> which_{};
  double parent_distance_{};
  Statistics statistics_;
  std::uint64_t cut_at_{};
  CtsSearch::Stopped stopped_;
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
