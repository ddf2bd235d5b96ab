#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/ocean/interpolation.hpp"

namespace glidehelm::ocean {

/// What a field answers before its first and after its last time. `cycle` repeats the last (before the first time: the
/// first) 24.84 h, two periods of the M2 tide, so that a tidal current goes on with its phase; a record shorter than
/// that holds. `hold` keeps the first or last value; `forbid` answers outside_time.
enum class OutsideTime { hold, cycle, forbid };

inline constexpr double kTidalCycle = 24.84 * 3600.0;  ///< seconds

/// Two neighbouring times and the way between them. `next == first` when the instant is exactly `first` or there is
/// nothing to interpolate.
struct TimeBracket {
  std::size_t first{}, next{};
  double fraction{};
};

/// The times of a field (epoch seconds, ascending) and its policy outside them.
class TimeAxis {
 public:
  TimeAxis() = default;
  /// `meaningful` false: a field without a time axis, the same at every instant whatever the policy.
  TimeAxis(std::vector<double> times_s, bool meaningful, OutsideTime policy);

  /// Nothing outside the times when that is forbidden, or when `t_s` is not a number. O(log n).
  [[nodiscard]] std::optional<TimeBracket> bracket(double t_s) const;
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] bool meaningful() const { return meaningful_; }
  [[nodiscard]] OutsideTime policy() const { return policy_; }

 private:
  std::vector<double> times_{0.0};
  bool meaningful_{};
  OutsideTime policy_{OutsideTime::hold};
};

}  // namespace glidehelm::ocean
