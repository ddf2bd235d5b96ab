#pragma once

#include <algorithm>
#include <optional>

#include "core/planning/cost_to_go.hpp"
#include "core/planning/envelope.hpp"
#include "core/planning/planner.hpp"
#include "core/planning/purse.hpp"

namespace glidehelm::planning {

/// h(n) of CTS-A*: a lower bound of the time from a surfacing to the goal's disc.
///
/// All heuristics are one theorem. Let a potential V ≤ 0 on the goal's disc fall by at most `dive` per second while a
/// glider dives, whatever its heading, and by at most `drift` while it drifts. Then nothing on the dive schedule brings V to zero
/// sooner than an Envelope of these rates covers a distance V: `Envelope::least_time(V)` is admissible, and consistent over a drift
/// and a stint.
///
///  - `straight_line` (Thesis 4.1): V is the distance to the disc; both rates are the greatest speed over ground, diving or drifting.
///    With the squared distance, as printed there, V would be no length and the quotient no time.
///  - `envelope`: V is the distance; rates U + |c|max of the dive field, |c|max of the surface field. It is at least the former:
///    an Envelope with smaller rates takes longer.
///  - `cost_to_go`: V is the potential of cost_to_go.hpp, in seconds, with its rates; the envelope where that is more.
///
/// |c|max is `FieldRef::fastest`, of all places and times: a patch around n (Thesis 4.1) would not hold every faster way.
class ToGo {
 public:
  ToGo(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart);

  /// Seconds from a surfacing at a place (radians) that is at least `distance` metres from the goal's centre.
  [[nodiscard]] double from_surfacing(double lat, double lon, double distance) const {
    const double by_distance = descent_.least_time(distance - radius_);
    return water_ ? std::max(by_distance, water_descent_.least_time(water_->at(lat, lon))) : by_distance;
  }
  /// The same from the fix, with its own drift and first stint.
  [[nodiscard]] double from_fix(double lat, double lon, double distance) const {
    const double by_distance = descent_.least_time_from_fix(distance - radius_, schedule_);
    return water_ ? std::max(by_distance, water_descent_.least_time_from_fix(water_->at(lat, lon), schedule_))
                  : by_distance;
  }
  /// What making it has cost.
  [[nodiscard]] std::uint64_t current_evaluations() const { return water_ ? water_->current_evaluations() : 0; }

 private:
  model::DiveSchedule schedule_;
  double radius_;
  Envelope descent_;
  std::optional<CostToGo> water_;  ///< of `cost_to_go`
  Envelope water_descent_;
};

/// The ToGo of all searches of one answer: made, and paid for, when the first of them asks. Its arguments must outlive it; for one thread.
class SharedToGo {
 public:
  SharedToGo(const Problem& problem, Members members, const chart::Chart& chart)
      : problem_{problem}, members_{members}, chart_{chart} {}
  SharedToGo(const Problem&, Members, chart::Chart&&) = delete;  // it would be gone before the first search
  /// Precondition: there is a member.
  const ToGo& get(Purse& purse);

 private:
  const Problem& problem_;
  Members members_;
  const chart::Chart& chart_;
  std::optional<ToGo> made_;
};

}  // namespace glidehelm::planning
