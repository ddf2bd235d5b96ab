#pragma once

#include <algorithm>

#include "core/planning/envelope.hpp"
#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// How fast the distance to anything can shrink at most: dives with U + |c|max, drifts with |c|max of the surface.
Envelope reach_of(const Problem& problem, const ocean::Ocean& ocean);

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
///
/// |c|max is `FieldRef::fastest`, of all places and times: a patch around n (Thesis 4.1) would not hold every faster way.
class ToGo {
 public:
  ToGo(const Problem& problem, const ocean::Ocean& ocean);

  /// Seconds from a surfacing that is at least `distance` metres from the goal's centre.
  [[nodiscard]] double from_surfacing(double distance) const { return descent_.least_time(distance - radius_); }
  /// The same from the fix, with its own drift and first stint.
  [[nodiscard]] double from_fix(double distance) const {
    return descent_.least_time_from_fix(distance - radius_, schedule_);
  }

 private:
  const model::DiveSchedule& schedule_;
  double radius_;
  Envelope descent_;
};

}  // namespace glidehelm::planning
