#include "core/planning/travel_time.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/vehicle/constrained_motion.hpp"

namespace glidehelm::planning {

namespace {

constexpr double kSmallestStep = 1.0 / 128;  // of the segment
constexpr double kSafety = 0.9, kMostChange = 4;

Current mean(const Current& a, const Current& b) { return {0.5 * (a.east + b.east), 0.5 * (a.north + b.north)}; }

/// The march over one segment. Places and steps are shares of it.
class March {
 public:
  March(const MeanMotion& motion, double lat0, double lon0, double lat1, double lon1, double t_s,
        std::uint64_t& evaluations, double tolerance)
      : motion_{motion},
        evaluations_{evaluations},
        tolerance_{tolerance},
        lat0_{lat0},
        lon0_{lon0},
        dlat_{lat1 - lat0},
        dlon_{lon1 - lon0},
        t_s_{t_s},
        way_{local_offset(lat0, lon0, lat1, lon1)} {}

  [[nodiscard]] Expected<double, NoPassage> seconds() {
    auto near = current(0, 0);
    double done = 0, elapsed = 0, step = 1;
    while (near && done < 1) {
      step = std::min(step, 1 - done);
      const auto s = take(done, elapsed, step, *near);
      const double change =
          s ? std::clamp(kSafety * std::sqrt(tolerance_ / std::max(s->error, 1e-12)), 1 / kMostChange, kMostChange)
            : 1 / kMostChange;
      if (step > kSmallestStep && (!s || s->error > tolerance_)) {
        step = std::max(kSmallestStep, change * step);
        continue;
      }
      if (!s) return unexpected(s.error());
      done = step == 1 - done ? 1 : done + step;
      elapsed += s->seconds;
      near = s->far;
      step = std::max(kSmallestStep, change * step);
    }
    if (!near) return unexpected(near.error());
    return elapsed;
  }

 private:
  struct Step {
    double seconds;  ///< by halves
    double error;    ///< share by which the whole differs
    Current far;
  };

  [[nodiscard]] Expected<Current, NoPassage> current(double share, double after_s) {
    ++evaluations_;
    return motion_.current(lat0_ + share * dlat_, lon0_ + share * dlon_, t_s_ + after_s);
  }
  [[nodiscard]] std::optional<double> crossing(double step, const Current& c) const {
    return vehicle::crossing_time({step * way_.east, step * way_.north}, motion_.speed(), c.east.si(), c.north.si());
  }

  /// From a place over half a step to another: sampled when the vehicle would come there by the near current, and again at the better
  /// time where the change of the current over it could count.
  struct Half {
    double seconds;
    Current far;
  };
  [[nodiscard]] Expected<Half, NoPassage> half(const Current& near, double share, double elapsed, double step) {
    const auto guess = crossing(step, near);
    if (!guess) return unexpected(NoPassage::too_strong);
    auto far = current(share, elapsed + *guess);
    if (!far) return unexpected(far.error());
    auto seconds = crossing(step, mean(near, *far));
    if (seconds && could_be_late(near, *far, *guess, *seconds, step)) {
      far = current(share, elapsed + *seconds);
      if (!far) return unexpected(far.error());
      seconds = crossing(step, mean(near, *far));
    }
    if (!seconds) return unexpected(NoPassage::too_strong);
    return Half{*seconds, *far};
  }
  /// If all of the change were one of time, the current at the better time would differ by the share of the guess's error.
  [[nodiscard]] bool could_be_late(const Current& near, const Current& far, double guess, double seconds,
                                   double step) const {
    const double change = std::hypot(far.east.si() - near.east.si(), far.north.si() - near.north.si());
    return change * std::abs(guess - seconds) > tolerance_ * step * way_.length();
  }

  [[nodiscard]] Expected<Step, NoPassage> take(double done, double elapsed, double step, const Current& near) {
    const auto first = half(near, done + 0.5 * step, elapsed, 0.5 * step);
    if (!first) return unexpected(first.error());
    const double end = step == 1 - done ? 1 : done + step;
    const auto second = half(first->far, end, elapsed + first->seconds, 0.5 * step);
    if (!second) return unexpected(second.error());
    const auto whole = crossing(step, mean(near, second->far));
    if (!whole) return unexpected(NoPassage::too_strong);
    const double seconds = first->seconds + second->seconds;
    return Step{seconds, std::abs(*whole - seconds) / std::max(seconds, 1e-9), second->far};
  }

  const MeanMotion& motion_;
  std::uint64_t& evaluations_;
  double tolerance_;
  double lat0_, lon0_, dlat_, dlon_, t_s_;
  Offset way_;
};

}  // namespace

Expected<double, NoPassage> travel_time(const MeanMotion& motion, double lat0, double lon0, double lat1, double lon1,
                                        double t_s, std::uint64_t& evaluations, double tolerance) {
  return March{motion, lat0, lon0, lat1, lon1, t_s, evaluations, tolerance}.seconds();
}

}  // namespace glidehelm::planning
