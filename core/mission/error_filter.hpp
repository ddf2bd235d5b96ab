#pragma once

#include <array>

#include "core/base/current.hpp"
#include "core/base/geo.hpp"

namespace glidehelm::mission {

/// What one dive says: its mean velocity over ground less forecast and first guess, and how the glider headed.
struct DiveResidual {
  GeoPoint at;                             ///< middle of the dive
  double at_s{};                           ///< epoch second of its middle
  double east{}, north{};                  ///< m/s: velocity over ground − forecast mean − U0·(mean heading)
  double heading_east{}, heading_north{};  ///< mean of the unit vectors headed along; shorter than 1 when it turned
  double spread{};                         ///< m/s, standard deviation of each component
};

/// Tells apart what goes with the glider (speed, heading bias) and what stays with the water (error of the forecast):
/// a Kalman filter of four states: δU (m/s, true speed less the first guess), β (heading bias, radians clockwise) and the
/// forecast's error near the glider (east, north).
///
///     residual = δU·ĥ + U0·β·ĥ⊥ + error + noise,   ĥ⊥ = ĥ turned a quarter clockwise
///
/// δU and β hardly change (biofouling: 0.02 m/s and 2° in 30 days). The error of the forecast is a first-order
/// autoregressive process with standard deviation `error_spread` whose correlation falls as exp(−d²/2L² − t/T) with
/// distance and time between two dives: far away or days later nothing of it is left, and speed and bias stay. On a
/// straight way a constant error and a wrong speed look the same; the spreads say so.
///
/// Robust: an innovation n > 3 standard deviations away counts as 9/n of them, so a dive that cannot be true moves
/// little and one that is repeated prevails. Two scalar updates per dive, no inversion.
class ErrorFilter {
 public:
  struct Setup {
    double speed{0.3};           ///< U0, m/s
    double speed_spread{0.03};   ///< of the first guess, m/s
    double bias_spread{0.0873};  ///< radians
    double error_spread{0.10};   ///< of the forecast, m/s per component
    double length{30'000};       ///< L, m
    double time{24 * 3600.0};    ///< T, s
    friend bool operator==(const Setup&, const Setup&) = default;
  };
  ErrorFilter() : ErrorFilter{Setup{}} {}
  explicit ErrorFilter(const Setup& setup);

  void see(const DiveResidual& dive);
  /// Another first guess of the speed after dives: as if it had been the one from the beginning. What the dives say of the speed stays what
  /// it is; as much of the guess as is left in it moves along. Exact where no innovation was cut and no bias is learned (its column has U0).
  void move_guess(double speed, double spread);

  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] int seen() const { return seen_; }
  /// δU; true speed is U0 + δU. Kept within −50 % and +30 % of U0.
  [[nodiscard]] double speed_error() const;
  [[nodiscard]] double speed_spread() const;
  /// β, kept within ±30°.
  [[nodiscard]] double bias() const;
  [[nodiscard]] double bias_spread() const;
  /// Error of the forecast at the last dive, and its standard deviation per component (the larger one).
  [[nodiscard]] Current error() const;
  [[nodiscard]] double error_spread() const;
  [[nodiscard]] GeoPoint at() const { return at_; }
  [[nodiscard]] double at_s() const { return at_s_; }
  friend bool operator==(const ErrorFilter&, const ErrorFilter&) = default;

 private:
  using State = std::array<double, 4>;
  void forget(const DiveResidual& until);
  void update(double observed, const State& row, double variance);

  Setup setup_;
  State x_{};
  State by_guess_{1, 0, 0, 0};  ///< how x would have moved with the mean of the first guess of δU
  std::array<State, 4> p_{};
  GeoPoint at_;
  double at_s_{};
  int seen_{};
};

}  // namespace glidehelm::mission
