#pragma once

#include <algorithm>
#include <cmath>

#include "core/model/dive_schedule.hpp"
#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// What no glider can outrun: one that dives at `dive` m/s and drifts at `drift` m/s over ground, always straight to its
/// goal, on the dive schedule. The heuristic of CTS-A*; its proof stands in cts_astar.hpp.
///
/// Seconds and metres. Precondition: dive > 0, stint > 0, the others not negative.
struct Envelope {
  double dive{}, drift{};     ///< U + fastest current below, fastest current at the surface
  double stint{}, surface{};  ///< of the schedule, after its first stint

  /// What one surface interval and one stint cover.
  [[nodiscard]] double cycle() const { return drift * surface + dive * stint; }

  /// The least time over a distance, from a surfacing on. Zero for distances ≤ 0; grows with the distance; never more than
  /// surface + stint + least_time(distance − cycle()): consistent.
  [[nodiscard]] double least_time(double distance) const {
    if (distance <= 0) return 0;
    const double full = std::floor(distance / cycle());
    return full * (surface + stint) + within(distance - full * cycle(), surface, stint);
  }
  /// The same from a fix: its own drift and first stint come before.
  [[nodiscard]] double least_time_from_fix(double distance, const model::DiveSchedule& schedule) const {
    const double wait = schedule.time_to_dive.count(), first = schedule.first_stint.count();
    const double covered = drift * wait + dive * first;
    if (distance <= covered) return within(distance, wait, first);
    return wait + first + least_time(distance - covered);
  }

 private:
  /// Over a distance that one drift of `wait` and one dive of `dive_time` cover.
  [[nodiscard]] double within(double distance, double wait, double dive_time) const {
    if (distance <= 0) return 0;
    const double drifted = drift * wait;
    if (distance <= drifted) return distance / drift;
    return wait + std::min(dive_time, (distance - drifted) / dive);
  }
};

/// How fast the distance to anything can shrink at most: dives with U + |c|max, drifts with |c|max of the surface.
Envelope reach_of(const Problem& problem, const ocean::Ocean& ocean);

}  // namespace glidehelm::planning
