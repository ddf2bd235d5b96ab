#pragma once

#include <optional>

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// What a glider on its dive schedule does on average over a stint and a surface interval: it makes t_s/(t_s + t_d) of its speed
/// through water, and is carried by the mean of both currents, weighted with their times. So times over segments are
/// times on the clock, surface drifts included, although a segment knows nothing of surfacings.
class MeanMotion {
 public:
  MeanMotion(const Problem& problem, const ocean::Ocean& ocean);
  [[nodiscard]] double speed() const { return speed_; }      ///< m/s through water
  [[nodiscard]] double fastest() const { return fastest_; }  ///< m/s over ground, never exceeded
  /// The mean current at a place (radians) and epoch second; none where one of the two has none.
  [[nodiscard]] Expected<Current, ocean::NoCurrent> current(double lat, double lon, double t_s) const;

 private:
  ocean::Ocean ocean_;
  double under_;  ///< share of the time under water
  double speed_, fastest_;
};

/// Why a segment cannot be flown.
enum class NoPassage { no_current, forecast_end, too_strong };

/// Seconds that a straight segment (radians) takes from epoch second `t_s`, by the constrained motion model.
///
/// Recursive splitting (Garau, "The path planner", eq. 2): a segment whose currents at both ends differ by more than a twentieth
/// of the speed is halved; over a piece the mean of its ends counts. Departures: the *vectors* are compared and the middle
/// as well, since an eddy has equal speeds on both sides; currents are taken at the time at which the vehicle is there; seven
/// halvings at most. `evaluations` counts samples.
Expected<double, NoPassage> segment_time(const MeanMotion& motion, double lat0, double lon0, double lat1, double lon1,
                                         double t_s, std::uint64_t& evaluations);

}  // namespace glidehelm::planning
