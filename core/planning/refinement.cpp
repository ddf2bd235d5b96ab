#include "core/planning/refinement.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/planning/held_flight.hpp"
#include "core/planning/link_chain.hpp"

namespace glidehelm::planning {

namespace {

using Eigen::Vector2d;
using LaneValues = std::array<double, ocean::Lanes::kMax>;

constexpr double kPlaceStep = 500.0;  // metres, largest step of differences
constexpr int kMostRounds = 100;
constexpr int kMostDampings = 6, kMostIdle = 3;
constexpr double kWorthwhile = 0.5;  // metres of a round

/// A way as it was flown.
struct Way {
  std::vector<double> headings;
  double arrival_s{HeldLanes::kNever};
  double gain{-std::numeric_limits<double>::infinity()};  ///< metres over the way before
  [[nodiscard]] bool arrives() const { return arrival_s < HeldLanes::kNever; }
};

class Refinement {
 public:
  Refinement(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres margin,
             const Budget& budget)
      : problem_{problem}, budget_{budget}, flight_{problem, ocean, chart, margin} {
    lat0_ = problem.start.fix.lat.radians();
    lon0_ = problem.start.fix.lon.radians();
  }

  Refined run(std::span<const Heading> headings) {
    for (const auto h : headings) way_.headings.push_back(h.from_north().si());
    if (!way_.headings.empty())
      for (const double buffer : {4000.0, 1000.0, 250.0}) polish(buffer);
    return result();
  }

 private:
  /// Rounds with one buffer, until they no longer pay.
  void polish(double buffer) {
    flight_.set_buffer(Metres{buffer});
    // Differences must be finer than the slope of the toll.
    const double step = std::min(kPlaceStep, buffer / 3);
    steps_ = {step, step / (problem_.glider.horizontal_speed.si() * problem_.schedule.stint.count())};
    if (cut_ || !measure()) return;
    kept_margin_ = true;
    damping_ = 0;
    int dampings = 0, idle = 0;
    while (rounds_ < kMostRounds && statistics_.expansions < budget_.work && !cut_) {
      if (budget_.expired && budget_.expired()) {
        cut_ = true;
        return;
      }
      ++statistics_.expansions;
      if (!differentiate()) return;
      const double damped = std::max(1.0, damping_);
      free_ = step_along(links_, to_end_, {damping_, 0}).gains;
      held_ = step_along(links_, to_end_, {0, damped}).gains;
      Way better = step_forward();
      if (!(better.gain > 0)) {
        if (++dampings > kMostDampings) break;
        damping_ = damping_ == 0 ? 1 : 4 * damping_;
        continue;
      }
      dampings = 0;
      damping_ = damping_ > 1 ? 0.25 * damping_ : 0;
      way_ = std::move(better);
      ++rounds_;
      if (!measure()) return;
      idle = way_.gain < kWorthwhile ? idle + 1 : 0;
      if (idle > 0 && (damping_ == 0 || idle > kMostIdle)) break;
    }
  }

  /// Flies the way at hand anew: its arrival, and the instant at which its distance counts. False when it cannot be flown.
  bool measure() {
    HeldLanes lanes;
    lanes.begin(1, lat0_, lon0_);
    LaneValues headings{};
    way_.arrival_s = HeldLanes::kNever;
    for (int k = 0; k < stints(); ++k) {
      headings[0] = way_.headings[static_cast<std::size_t>(k)];
      flight_.fly(lanes, k, headings, problem_.horizon_s, true);
      statistics_.cost_evaluations += 1;
      if (lanes.arrival_s[0] < HeldLanes::kNever) {
        way_.headings.resize(static_cast<std::size_t>(k) + 1);
        way_.arrival_s = lanes.arrival_s[0];
        break;
      }
      if (!lanes.flies(0)) return false;
    }
    until_s_ = way_.arrives() ? way_.arrival_s
                              : flight_.dive_s(stints() - 1) + problem_.schedule.stint_length(stints() - 1).count();
    if (until_s_ > problem_.horizon_s) return false;
    remaining_ = flight_.to_goal(lanes.at.lat[0], lanes.at.lon[0]);
    return true;
  }

  /// The links of the way up to the instant that counts.
  bool differentiate() {
    links_.clear();
    double lat = lat0_, lon = lon0_;
    for (int k = 0; k < stints(); ++k) {
      const auto measured =
          measure_link(flight_, k, lat, lon, way_.headings[static_cast<std::size_t>(k)], until_s_, steps_);
      statistics_.cost_evaluations += kLinkLanes;
      if (!measured) return false;
      links_.push_back(measured->link);
      lat = measured->end_lat;
      lon = measured->end_lon;
    }
    const auto& goal = flight_.goal().centre;
    const auto off = local_offset(goal.lat.radians(), goal.lon.radians(), lat, lon);
    to_end_ = {off.east, off.north};
    return true;
  }

  /// Forwards on lanes: shares of both kinds of turns, and of the first without feedback; the last lane flies the way as it is.
  [[nodiscard]] Way step_forward() {
    static constexpr std::array<double, 6> kShares{1.0, 0.6, 0.3, 0.1, 0.03, 0.01};
    constexpr auto n = kShares.size(), kAsItIs = 3 * n;
    std::array<std::vector<double>, kAsItIs> flown;
    HeldLanes lanes;
    lanes.begin(static_cast<int>(kAsItIs) + 1, lat0_, lon0_);
    LaneValues headings{};
    for (std::size_t k = 0; k < links_.size(); ++k) {
      for (std::size_t i = 0; i < kAsItIs; ++i) {
        const auto& gain = i < 2 * n ? free_[k] : held_[k];
        const auto off = local_offset(links_[k].lat, links_[k].lon, lanes.at.lat[i], lanes.at.lon[i]);
        const double answer = i < n || i >= 2 * n ? gain.feedback.dot(Vector2d{off.east, off.north}) : 0.0;
        headings[i] = way_.headings[k] + kShares[i % n] * gain.turn + std::clamp(answer, -kLongestTurn, kLongestTurn);
        if (lanes.flies(i)) flown[i].push_back(headings[i]);
      }
      headings[kAsItIs] = way_.headings[k];
      flight_.fly(lanes, static_cast<int>(k), headings, until_s_, true);
      statistics_.cost_evaluations += kAsItIs + 1;
    }
    const double now = merit(lanes, kAsItIs);
    Way best;
    for (std::size_t i = 0; i < kAsItIs; ++i) {
      if (!lanes.flies(i) && lanes.at.lost[i] != HeldLanes::kArrived) continue;
      const double gain = now - merit(lanes, i);
      if (gain > best.gain) best = {flown[i], lanes.arrival_s[i], gain};
    }
    return best;
  }
  /// Toll, and the distance to the goal at the instant that counts; for a lane that came in before, less by what a glider in
  /// still water does in the time gained.
  [[nodiscard]] double merit(const HeldLanes& lanes, std::size_t i) const {
    if (lanes.arrival_s[i] < HeldLanes::kNever)
      return lanes.toll[i] + flight_.goal().radius.si() -
             problem_.glider.horizontal_speed.si() * std::max(0.0, until_s_ - lanes.arrival_s[i]);
    return lanes.toll[i] + flight_.to_goal(lanes.at.lat[i], lanes.at.lon[i]);
  }

  [[nodiscard]] Refined result() {
    flight_.set_buffer(Metres{0});
    Refined r;
    for (const double h : way_.headings) r.headings.emplace_back(Radians{h});
    r.arrival_s = way_.arrives() ? way_.arrival_s : std::nan("");
    r.remaining_m = remaining_;
    r.rounds = rounds_;
    statistics_.current_evaluations = flight_.evaluations();
    r.statistics = statistics_;
    r.kept_margin = kept_margin_;
    r.cut = cut_;
    return r;
  }
  [[nodiscard]] int stints() const { return static_cast<int>(way_.headings.size()); }

  const Problem& problem_;
  const Budget& budget_;
  HeldFlight flight_;
  double lat0_{}, lon0_{}, until_s_{}, remaining_{};
  Way way_;
  std::vector<ChainLink> links_;
  Vector2d to_end_ = Vector2d::Zero();  ///< from the goal's centre, metres
  std::vector<Gain> free_, held_;       ///< damped by a price on turning, and on leaving the way
  Steps steps_;
  double damping_{};
  int rounds_{};
  bool kept_margin_{};
  bool cut_{};
  Statistics statistics_;
};

}  // namespace

Refined refine(std::span<const Heading> headings, const Problem& problem, const ocean::Ocean& ocean,
               const chart::Chart& chart, Metres margin, const Budget& budget) {
  return Refinement{problem, ocean, chart, margin, budget}.run(headings);
}

std::vector<Heading> headings_of(const Plan& plan, const Problem& problem, const ocean::Ocean& ocean,
                                 const chart::Chart& chart) {
  HeldFlight flight{problem, ocean, chart, Metres{0}};
  std::vector<Heading> headings;
  HeldLanes lanes;
  lanes.begin(1, problem.start.fix.lat.radians(), problem.start.fix.lon.radians());
  for (std::size_t k = 0; k < plan.stints.size(); ++k) {
    const auto& stint = plan.stints[k];
    const double lat = stint.surface.lat.radians(), lon = stint.surface.lon.radians();
    double heading = stint.heading.from_north().si();
    HeldLanes tried;
    for (int i = 0; i < 4; ++i) {
      tried = lanes;
      LaneValues held{};
      held[0] = heading;
      flight.fly(tried, static_cast<int>(k), held, 1e18, false);
      if (stint.arrives || i == 3) break;
      const auto off = local_offset(tried.at.lat[0], tried.at.lon[0], lat, lon);
      const double way = problem.glider.horizontal_speed.si() * (stint.surface_s - stint.dive_s);
      heading +=
          std::clamp((off.east * std::cos(heading) - off.north * std::sin(heading)) / std::max(1.0, way), -0.3, 0.3);
    }
    headings.emplace_back(Radians{heading});
    lanes = tried;
  }
  return headings;
}

}  // namespace glidehelm::planning
