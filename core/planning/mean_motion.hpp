#pragma once

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// Why a segment cannot be flown.
enum class NoPassage { no_current, forecast_end, too_strong };

/// What a glider on its dive schedule does on average over a stint and a surface interval: it makes t_s/(t_s + t_d) of its speed
/// through water, and is carried by the mean of both currents, weighted with their times. So times over segments are
/// times on the clock, surface drifts included, although a segment knows nothing of surfacings.
class MeanMotion {
 public:
  MeanMotion(const Problem& problem, const ocean::Ocean& ocean);
  [[nodiscard]] double speed() const { return speed_; }      ///< m/s through water
  [[nodiscard]] double fastest() const { return fastest_; }  ///< m/s over ground, never exceeded
  /// The mean current at a place (radians) and epoch second; none where one of the two has none.
  [[nodiscard]] Expected<Current, NoPassage> current(double lat, double lon, double t_s) const;

 private:
  ocean::Ocean ocean_;
  double under_;  ///< share of the time under water
  double speed_, fastest_;
};

}  // namespace glidehelm::planning
