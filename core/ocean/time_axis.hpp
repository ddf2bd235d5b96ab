#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glidehelm::ocean {

/// What a field answers before its first and after its last time. `cycle` repeats the last (before the first time: the
/// first) 24.84 h, two periods of the M2 tide, so that a tidal current goes on with its phase; a record shorter than
/// that holds. `hold` keeps the first or last value; `forbid` answers outside_time.
enum class OutsideTime { hold, cycle, forbid };

/// How values between nodes are made. `nearest` in space and time; `linear` in both; `cubic` and `akima` are linear in
/// space and smooth in time (see interpolate_in_time).
enum class Interpolation { nearest, linear, cubic, akima };

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
  /// The largest ratio of neighbouring steps (≥ 1): how far smooth interpolation may overshoot.
  [[nodiscard]] double step_ratio() const;

 private:
  std::vector<double> times_{0.0};
  bool meaningful_{};
  OutsideTime policy_{OutsideTime::hold};
};

/// The value at `fraction` between t[k] and t[k+1] by a cubic Hermite polynomial. Its slopes are, for `cubic`, those of
/// the parabola through three neighbouring points (exact on parabolas), for `akima`, Akima's (1970) weighted mean of
/// neighbouring secants (Eichhorn's scheme in time; no overshoot beside a step). A missing neighbour at the end of the
/// record counts as a straight continuation. `linear` gives the secant. Precondition: k + 1 < t.size() == v.size().
double interpolate_in_time(Interpolation how, std::span<const double> t, std::span<const double> v, std::size_t k,
                           double fraction);

/// A proven bound of |interpolated| / max |node| for vectors interpolated component by component: 1 for nearest and
/// linear, else 1 + √2·(8/27)·2·ratio, because each slope is a mean of neighbouring secants, each at most 2·max/step,
/// and the two slope polynomials of Hermite's form are at most 4/27 each.
double overshoot_bound(Interpolation how, double step_ratio);

}  // namespace glidehelm::ocean
