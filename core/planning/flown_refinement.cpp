#include "core/planning/flown_refinement.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/base/local_metric.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/link_chain.hpp"

namespace glidehelm::planning {

namespace {

/// Metres beyond the margin where nearness to land is taxed: from one that can be followed to one that hardly holds a way off.
constexpr std::array kBuffers{250.0, 50.0};
constexpr int kMostRounds = 20;
constexpr double kWorthwhile = 3e-6;  // of the travel time, won in a round
constexpr double kIncredible = 0.1;   // of the travel time: a step that promises more has left what its quadratics know
/// From bold to careful.
constexpr std::array<Damping, 6> kDampings{{{0, 0}, {0, 1}, {1, 1}, {4, 4}, {32, 32}, {128, 128}}};
constexpr std::array kShares{1.0, 0.5, 0.2};

/// Clearance beyond the margin that refined flights keep: what another integrator, and the chords of its steps, may differ by. The verifier flies
/// the list with its own, and refuses a file that is nearer than the margin.
Metres spare_of(const Problem& problem) { return 0.005 * (problem.glider.horizontal_speed * problem.schedule.stint); }

class FlightRefinement {
 public:
  FlightRefinement(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart)
      : problem_{problem},
        waters_{ocean, chart, problem.coast_margin + spare_of(problem)},
        held_{problem, ocean, chart, waters_.margin} {}

  RefinedFlight run(const Plan& plan, const Budget& budget) {
    RefinedFlight answer;
    way_ = plan.stints;
    best_s_ = problem_.horizon_s;
    if (fly([&](std::size_t k, GeoPoint) { return way_[k].heading; }).lost)
      return answer;  // nearer to land than the spare
    best_s_ = plan.arrival_s;
    for (const double buffer : kBuffers) {
      polish(buffer, budget, answer);
      const bool taxed = std::any_of(links_.begin(), links_.end(), [](const ChainLink& l) { return l.toll.value > 0; });
      if (!taxed) break;  // no land is near
    }
    answer.statistics.cost_evaluations += flights_ * way_.size();
    answer.statistics.current_evaluations = held_.evaluations();
    return answer;
  }

 private:
  /// Rounds with one buffer, until they no longer pay.
  void polish(double buffer, const Budget& budget, RefinedFlight& answer) {
    held_.set_buffer(Metres{buffer});
    const double step = buffer / 3;  // finer than the slope of the toll
    steps_ = {step, step / (problem_.glider.horizontal_speed.si() * problem_.schedule.stint.count())};
    for (int round = 0; round < kMostRounds && answer.statistics.expansions < budget.work && !answer.cut; ++round) {
      answer.cut = budget.expired && budget.expired();
      if (answer.cut) return;
      ++answer.statistics.expansions;
      if (!measure(answer.statistics)) return;
      auto flown = improve();
      if (!flown) return;
      const double won = best_s_ - *flown->arrival_s;
      best_s_ = *flown->arrival_s;
      way_ = flown->stints;
      answer.flown = std::move(flown);
      if (won < kWorthwhile * (best_s_ - problem_.start.fix_s)) return;
    }
  }

  /// The links of the way at hand, up to its arrival.
  bool measure(Statistics& statistics) {
    links_.clear();
    GeoPoint from = problem_.start.fix;
    for (std::size_t k = 0; k < way_.size(); ++k) {
      const auto m = measure_link(held_, static_cast<int>(k), from.lat.radians(), from.lon.radians(),
                                  way_[k].heading.from_north().si(), best_s_, steps_);
      if (!m) return false;
      statistics.cost_evaluations += kLinkLanes;
      links_.push_back(m->link);
      const auto& centre = held_.goal().centre;
      const auto off = local_offset(centre.lat.radians(), centre.lon.radians(), m->end_lat, m->end_lon);
      to_end_ = {off.east, off.north};
      from = way_[k].surface;
    }
    return !links_.empty();
  }

  /// The first step, from bold to careful, whose headings are earlier when they are flown by themselves. Not flown are those that promise what is
  /// not worthwhile, or what cannot be.
  std::optional<vehicle::FlownList> improve() {
    const double travel = best_s_ - problem_.start.fix_s;
    for (const auto damping : kDampings) {
      const auto step = step_along(links_, to_end_, damping);
      // Through water, not over ground, and toll counts as way: the scale of what is won, not the time itself.
      const double promised = step.promises / problem_.glider.horizontal_speed.si();
      if (!(promised >= kWorthwhile * travel && promised <= kIncredible * travel)) continue;
      for (const double share : kShares) {
        const auto found = fly([&](std::size_t k, GeoPoint dive) { return answer(step.gains[k], share, k, dive); });
        if (!found.arrival_s) continue;
        auto flown =
            fly([&](std::size_t k, GeoPoint) { return (k < found.stints.size() ? found.stints[k] : way_[k]).heading; });
        if (flown.arrival_s && *flown.arrival_s < best_s_) return flown;
      }
    }
    return std::nullopt;
  }
  /// The heading of stint k under a step, and under its feedback on where the glider dives.
  [[nodiscard]] Heading answer(const Gain& gain, double share, std::size_t k, GeoPoint dive) const {
    const auto& meant = way_[k].dive;
    const auto off = local_offset(meant.lat.radians(), meant.lon.radians(), dive.lat.radians(), dive.lon.radians());
    const double back = gain.feedback.dot(Eigen::Vector2d{off.east, off.north});
    return way_[k].heading + Radians{share * gain.turn + std::clamp(back, -kLongestTurn, kLongestTurn)};
  }

  /// A flight by the law, on the headings of as many stints as the way has, given up where it is no earlier.
  template <class HeadingOf>
  vehicle::FlownList fly(const HeadingOf& heading_of) {
    ++flights_;
    auto flight = flight_of(problem_);
    flight.horizon_s = std::min(flight.horizon_s, best_s_);
    return vehicle::fly_helm(
        [&](int stint, GeoPoint dive, double) -> std::optional<Heading> {
          const auto k = static_cast<std::size_t>(stint);
          return k < way_.size() ? std::optional{heading_of(k, dive)} : std::nullopt;
        },
        flight, waters_);
  }

  const Problem& problem_;
  vehicle::Waters waters_;
  HeldFlight held_;
  Steps steps_;
  std::vector<vehicle::Stint> way_;  ///< as it was flown
  double best_s_{};                  ///< epoch second of its arrival
  std::vector<ChainLink> links_;
  Eigen::Vector2d to_end_ = Eigen::Vector2d::Zero();
  std::uint64_t flights_{};
};

}  // namespace

RefinedFlight refine_flown(const Plan& plan, const Problem& problem, const ocean::Ocean& ocean,
                           const chart::Chart& chart, const Budget& budget) {
  if (!plan.reaches_goal() || plan.stints.empty()) return {};
  return FlightRefinement{problem, ocean, chart}.run(plan, budget);
}

}  // namespace glidehelm::planning
