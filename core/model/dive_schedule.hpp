#pragma once

#include "core/base/time.hpp"

namespace glidehelm::model {

/// When the glider dives and surfaces: drift `time_to_dive` from the fix, dive `first_stint`, drift `surface`, dive
/// `stint`, drift `surface`, … Planners, verifier, lower bound and simulator share it.
struct DiveSchedule {
  Seconds stint{4 * 3600.0};
  Seconds first_stint{4 * 3600.0};
  Seconds surface{15 * 60.0};       ///< between two stints: the glider drifts with the surface current
  Seconds time_to_dive{15 * 60.0};  ///< from the fix to the first dive: drift likewise

  [[nodiscard]] Seconds stint_length(int k) const { return k == 0 ? first_stint : stint; }
  /// Drift before stint k (0-based).
  [[nodiscard]] Seconds drift_before(int k) const { return k == 0 ? time_to_dive : surface; }
  /// From the fix to the dive of stint k.
  [[nodiscard]] Seconds dive_time(int k) const;
  /// From the fix to the surfacing of stint k.
  [[nodiscard]] Seconds surfacing_time(int k) const { return dive_time(k) + stint_length(k); }
  /// From the fix to an arrival after `underwater` seconds of flight, drifts included: an arrival exactly at a
  /// surfacing needs no further drift. Closed form behind product.md's still-water travel time. Precondition ≥ 0.
  [[nodiscard]] Seconds travel_time(Seconds underwater) const;

  friend bool operator==(const DiveSchedule&, const DiveSchedule&) = default;
};

}  // namespace glidehelm::model
