#include "core/planning/rrt.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "core/planning/draws.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/mean_motion.hpp"
#include "core/planning/searched_plan.hpp"
#include "core/planning/segment_time.hpp"
#include "core/planning/way_headings.hpp"

namespace glidehelm::planning {

namespace {

constexpr std::size_t kNearest = 5;
constexpr double kBias = 0.1;          // share of draws that are the other tree's root
constexpr double kWider = 0.5;         // of the way, beyond start and goal on all sides
constexpr std::size_t kFlown = 3;      // ways
constexpr double kSameCurrent = 1e-3;  // m/s

struct Place {
  double lat{}, lon{};  ///< radians; longitudes run on
};
struct Node {
  Place at;
  double seconds{};  ///< from the start, or to the goal
  double margin{};   ///< clearance that segments from here keep
  std::int32_t parent{-1};
};
using Tree = std::vector<Node>;

/// The box in which places are drawn.
struct Box {
  double south, north, west, east;
};
Box box_of(const Problem& problem, const ocean::Ocean& ocean) {
  const auto& goal = disc_of(problem).centre;
  const double lat0 = problem.start.fix.lat.radians(), lon0 = problem.start.fix.lon.radians();
  const double lat1 = goal.lat.radians(), lon1 = lon0 + std::remainder(goal.lon.radians() - lon0, 2 * kPi);
  const auto metric = LocalMetric::at(0.5 * (lat0 + lat1));
  const double wider = kWider * distance(problem.start.fix, goal).si();
  const double up = wider / metric.meridian_radius, across = wider / metric.parallel_radius;
  const auto coverage = ocean.dive.coverage();
  return {std::max(std::min(lat0, lat1) - up, coverage.south), std::min(std::max(lat0, lat1) + up, coverage.north),
          std::min(lon0, lon1) - across, std::max(lon0, lon1) + across};
}

/// Where the currents change most between four times within the horizon, in words; none when they do not.
std::optional<std::string> change_of(const Problem& problem, const ocean::Ocean& ocean) {
  const auto box = box_of(problem, ocean);
  const double horizon = problem.horizon_s - problem.start.fix_s;
  double most = kSameCurrent;
  std::optional<std::string> words;
  for (int i = 0; i < 25; ++i) {
    const auto at = GeoPoint::from_kernel(box.south + (box.north - box.south) * (0.1 + 0.2 * (i % 5)),
                                          box.west + (box.east - box.west) * (0.1 + 0.2 * (i / 5)));
    for (const auto& field : {ocean.dive, ocean.surface}) {
      const auto first = field.sample(at, problem.start.fix_s);
      for (const double share : {0.13, 0.37, 1.0}) {  // no multiples of each other: a tide would hide
        const auto later = field.sample(at, problem.start.fix_s + share * horizon);
        if (!first || !later) continue;
        const double change = std::hypot((later->current.east - first->current.east).si(),
                                         (later->current.north - first->current.north).si());
        if (change <= most) continue;
        most = change;
        char text[128];
        std::snprintf(text, sizeof text, "by %.2f m/s within %.1f h at %.4f,%.4f", change, share * horizon / 3600,
                      at.lat.degrees(), at.lon.degrees());
        words = text;
      }
    }
  }
  return words;
}

class Growth {
 public:
  Growth(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres allowance)
      : problem_{problem},
        chart_{chart},
        motion_{problem, ocean},
        goal_{disc_of(problem)},
        box_{box_of(problem, ocean)},
        random_{problem.seed, 0},
        margin_{(problem.coast_margin + allowance).si()},
        longest_{std::min((problem.glider.horizontal_speed * problem.schedule.stint).si(),
                          distance(problem.start.fix, goal_.centre).si() / 6)} {
    const vehicle::Waters waters{ocean, chart, problem.coast_margin};
    const auto fix = vehicle::state_at(problem.start.fix, problem.start.fix_s, waters);
    const auto dive = vehicle::move(waters, ocean.surface, fix, problem.schedule.time_to_dive.count(), {}, &goal_);
    there_ = dive.arrival_s.has_value();
    stuck_ = dive.lost.has_value();
    start_s_ = dive.end.t_s;
    plant(from_start_, {dive.end.lat, dive.end.lon});
    const double lon = dive.end.lon + std::remainder(goal_.centre.lon.radians() - dive.end.lon, 2 * kPi);
    plant(from_goal_, {goal_.centre.lat.radians(), lon});
  }

  RrtWays run(const Budget& budget) {
    RrtWays result;
    if (there_ || stuck_) {  // steering at the goal is all that is left to do, or nothing is
      result.arrives = there_;
      result.exhausted = true;
      result.ways.emplace_back();
      return result;
    }
    while (meetings_.size() < static_cast<std::size_t>(Rrt::kWays) && statistics_.expansions < Rrt::kMostRounds) {
      if (statistics_.expansions >= budget.work) break;
      if (statistics_.expansions % 64 == 63 && budget.expired && budget.expired()) {
        result.cut_at = statistics_.expansions;
        break;
      }
      ++statistics_.expansions;
      const auto ahead = grow(from_start_, place(from_goal_.front().at), true);
      const auto back = grow(from_goal_, place(from_start_.front().at), false);
      if (ahead) join(*ahead, true);
      if (back) join(*back, false);
    }
    result.exhausted =
        meetings_.size() >= static_cast<std::size_t>(Rrt::kWays) || statistics_.expansions >= Rrt::kMostRounds;
    result.arrives = !meetings_.empty();
    result.met_margin = met_margin_;
    result.ways = ways();
    result.statistics = statistics_;
    return result;
  }

 private:
  struct Meeting {
    std::int32_t ahead, back;
    double seconds;    ///< of the whole way
    double between_s;  ///< of the segment that joins the trees
  };

  void plant(Tree& tree, Place at) const {
    tree.push_back({at, 0, std::max(0.0, std::min(margin_, chart_.clearance(at.lat, at.lon) - 1.0)), -1});
  }

  /// Random(towards).
  Place place(Place towards) {
    if (random_.next() < kBias) return towards;
    const double up = random_.next(), across = random_.next();
    return {box_.south + up * (box_.north - box_.south), box_.west + across * (box_.east - box_.west)};
  }

  /// GenerateSuccessors and Insert: the new node of the tree, none when none of the nearest can grow.
  std::optional<std::int32_t> grow(Tree& tree, Place towards, bool forwards) {
    std::array<std::pair<double, std::int32_t>, kNearest> nearest;
    const std::size_t count = nearest_to(tree, towards, nearest);
    std::optional<Node> best;
    double least = 1e18;
    for (std::size_t i = 0; i < count; ++i) {
      const Node& from = tree[static_cast<std::size_t>(nearest[i].second)];
      const double way = nearest[i].first, share = way > longest_ ? longest_ / way : 1.0;
      if (!(way > 0.05 * longest_)) continue;
      const Place to{from.at.lat + share * (towards.lat - from.at.lat),
                     from.at.lon + share * (towards.lon - from.at.lon)};
      const double off = local_offset(to.lat, to.lon, towards.lat, towards.lon).length();
      if (off >= least) continue;
      const auto seconds = passage(from.at, from.margin, to, margin_, forwards);
      if (!seconds || !keeps_horizon(from.seconds + *seconds)) continue;
      least = off;
      best = Node{to, from.seconds + *seconds, margin_, nearest[i].second};
    }
    if (!best) return std::nullopt;
    tree.push_back(*best);
    return static_cast<std::int32_t>(tree.size()) - 1;
  }
  static std::size_t nearest_to(const Tree& tree, Place to,
                                std::array<std::pair<double, std::int32_t>, kNearest>& nearest) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < tree.size(); ++i) {
      const std::pair now{local_offset(tree[i].at.lat, tree[i].at.lon, to.lat, to.lon).length(),
                          static_cast<std::int32_t>(i)};
      if (count == kNearest && now.first >= nearest.back().first) continue;
      if (count < kNearest) ++count;
      std::size_t k = count - 1;
      for (; k > 0 && nearest[k - 1].first > now.first; --k) nearest[k] = nearest[k - 1];
      nearest[k] = now;
    }
    return count;
  }
  [[nodiscard]] bool keeps_horizon(double seconds) const { return start_s_ + seconds <= problem_.horizon_s; }

  /// Seconds over a segment between a node and a place, flown from the node or to it.
  std::optional<double> passage(Place node, double node_margin, Place other, double other_margin, bool from_node) {
    if (!chart_.segment_is_clear(node.lat, node.lon, other.lat, other.lon, std::min(node_margin, other_margin))) {
      met_margin_ = true;
      return std::nullopt;
    }
    const Place &a = from_node ? node : other, &b = from_node ? other : node;
    ++statistics_.cost_evaluations;
    const auto seconds = segment_time(motion_, a.lat, a.lon, b.lat, b.lon, start_s_, statistics_.current_evaluations);
    return seconds ? std::optional{*seconds} : std::nullopt;
  }

  /// GetNewTrajectory: the new node with every node of the other tree that is near enough.
  void join(std::int32_t index, bool is_ahead) {
    const Tree &own = is_ahead ? from_start_ : from_goal_, &other = is_ahead ? from_goal_ : from_start_;
    const Node node = own[static_cast<std::size_t>(index)];
    std::optional<Meeting> best;
    for (std::size_t i = 0; i < other.size(); ++i) {
      const Node& mate = other[i];
      if (local_offset(node.at.lat, node.at.lon, mate.at.lat, mate.at.lon).length() > longest_) continue;
      const auto between = passage(node.at, node.margin, mate.at, mate.margin, is_ahead);
      if (!between) continue;
      const double all = node.seconds + *between + mate.seconds;
      if (!keeps_horizon(all) || (best && all >= best->seconds)) continue;
      const auto mate_index = static_cast<std::int32_t>(i);
      best = Meeting{is_ahead ? index : mate_index, is_ahead ? mate_index : index, all, *between};
    }
    if (best) meetings_.push_back(*best);
  }

  [[nodiscard]] std::vector<std::vector<WayPoint>> ways() const {
    std::vector<std::vector<WayPoint>> result;
    auto quickest = meetings_;
    std::stable_sort(quickest.begin(), quickest.end(),
                     [](const Meeting& a, const Meeting& b) { return a.seconds < b.seconds; });
    for (std::size_t i = 0; i < std::min(kFlown, quickest.size()); ++i) {
      auto way = way_to(quickest[i].ahead);
      const double meet_s = way.back().t_s + quickest[i].between_s;
      const double left = from_goal_[static_cast<std::size_t>(quickest[i].back)].seconds;
      for (auto k = quickest[i].back; k >= 0; k = from_goal_[static_cast<std::size_t>(k)].parent) {
        const Node& n = from_goal_[static_cast<std::size_t>(k)];
        way.push_back({n.at.lat, n.at.lon, meet_s + left - n.seconds});
      }
      result.push_back(std::move(way));
    }
    if (result.empty()) result.push_back(way_to(nearest_to_goal()));
    return result;
  }
  [[nodiscard]] std::vector<WayPoint> way_to(std::int32_t index) const {
    std::vector<WayPoint> way;
    for (; index >= 0; index = from_start_[static_cast<std::size_t>(index)].parent) {
      const Node& n = from_start_[static_cast<std::size_t>(index)];
      way.push_back({n.at.lat, n.at.lon, start_s_ + n.seconds});
    }
    std::reverse(way.begin(), way.end());
    return way;
  }
  [[nodiscard]] std::int32_t nearest_to_goal() const {
    const auto to_goal = [&](const Node& n) { return vehicle::distance_near(n.at.lat, n.at.lon, goal_); };
    return static_cast<std::int32_t>(
        std::min_element(from_start_.begin(), from_start_.end(),
                         [&](const Node& a, const Node& b) { return to_goal(a) < to_goal(b); }) -
        from_start_.begin());
  }

  const Problem& problem_;
  const chart::Chart& chart_;
  MeanMotion motion_;
  vehicle::Disc goal_;
  Box box_;
  Draws random_;
  double margin_, longest_;
  double start_s_{};        ///< epoch second of the first dive
  bool there_{}, stuck_{};  ///< the drift before it ends the way
  Tree from_start_, from_goal_;
  std::vector<Meeting> meetings_;
  Statistics statistics_;
  bool met_margin_{};
};

}  // namespace

RrtWays grow_trees(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget,
                   Metres allowance) {
  return Growth{problem, ocean, chart, allowance}.run(budget);
}

Expected<Plan, PlanFailure> Rrt::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                      const Budget& budget, const std::function<void(const Plan&)>& better) const {
  if (wants_least_distance(problem)) return unexpected(only_least_time("rrt"));
  if (!members.empty())
    if (const auto change = change_of(problem, members.front()))
      return unexpected(
          PlanFailure{NoPlan::unsuited_method,
                      "rrt grows a tree back from the goal, whose nodes have no times, and needs currents "
                      "that stay as they are: here they change " +
                          *change});
  return plan_by_search(problem, members, chart, budget, better, [&](const ocean::Ocean& ocean) -> Search {
    return [&](Purse& purse, Metres allowance) {
      const auto found = grow_trees(problem, ocean, chart, purse.rest(), allowance);
      purse.take(found.statistics, found.cut_at != 0);
      std::vector<std::vector<Heading>> ways;
      for (const auto& way : found.ways)
        ways.push_back(headings_along(way, problem, ocean, chart, problem.coast_margin + allowance));
      return Found{"rrt",           std::move(ways),  found.arrives,
                   found.exhausted, found.met_margin, "the trees from start and goal have not met"};
    };
  });
}

}  // namespace glidehelm::planning
