#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/geo.hpp"
#include "core/base/units.hpp"

namespace glidehelm::mission {

/// How much of a forecast's mean came from one source; shares of one mean sum to 1.
struct SourceShare {
  std::string source;  ///< its name, empty for the only one: an expired source is left out, so a position would not do
  double share{};      ///< 0 … 1
  friend bool operator==(const SourceShare&, const SourceShare&) = default;
};

/// What one dive says of the forecast: measured depth-averaged current less the mean of the uncorrected forecast.
struct CurrentResidual {
  GeoPoint at;                      ///< middle of the dive
  double at_s{};                    ///< epoch second of its middle
  double east{}, north{};           ///< m/s
  double noise{};                   ///< m/s, standard deviation per component of the measurement alone
  std::vector<SourceShare> shares;  ///< in the forecast's mean along the dive
  bool extrapolated{};              ///< a value was borrowed there: its error counts as twice the source's
  friend bool operator==(const CurrentResidual&, const CurrentResidual&) = default;
};

/// The standard deviation of each source's error, per component, learned from residuals: for each source the scaled
/// inverse-χ² estimate of a variance,
///
///     σ² = (ν₀·σ₀² + S)/(ν₀ + ν),   ν₀ = 8, σ₀ = 0.10 m/s (docs/decisions/012), never below kFloor.
///
/// A residual r of variance V + n² per component (V of the forecast, n the noise) has the squared length 2(V + n²) on
/// average, so q = (|r|²/2 − n²)/V is 1 on average when V is right. Each source takes q·σ² as an observation of its own
/// variance, with 2·share·f degrees of freedom:
///
///  - **Shares.** V = (Σ share·σ)²: sources of one sea err together (the same winds and eddies), and the sum of the
///    spreads is never too small whatever their correlation. A mean of several says how wrong the mean was, not which
///    of them, so all take the same factor; they are told apart where one of them is nearly alone.
///  - **Correlation.** The next dive meets much the same error: with ρ = exp(−d²/2L² − t/T) to the last residual, L = 30 km,
///    T = 24 h (decision 012), squares are correlated by ρ², and a chain of them is worth f = (1 − ρ²)/(1 + ρ²) each.
///  - **Forgetting.** S and ν fall by exp(−t/10 days): what is a month old counts a twentieth.
///  - **One bad value.** |r|² counts at most as 18(V + n²). Of a normal residual that cuts off exp(−9) = 1.2e-4 of
///    the mean; one value that cannot be true makes σ 1.6 times the prior at most, and a repeated one prevails.
///
/// Not separated: the part of a residual that the glider's own speed error makes. It makes σ larger, which is the safe side.
class SourceErrors {
 public:
  static constexpr double kPrior = 0.10;  ///< m/s, σ₀
  static constexpr double kFloor = 0.03;  ///< m/s: a grid has cells, and a dive is not its mean

  /// Takes a residual; one that is not finite or names no source is left out. O(sources).
  void see(const CurrentResidual& residual);
  /// σ of one source; the prior for one that was never seen.
  [[nodiscard]] MetresPerSecond spread(std::string_view source) const;
  /// σ of a mean: Σ share·σ. The prior without shares. Twice as much where a value is extrapolated (product.md 6).
  [[nodiscard]] MetresPerSecond spread(const std::vector<SourceShare>& shares, bool extrapolated = false) const;
  /// Names of the sources that residuals were seen of, in the order of their first one.
  [[nodiscard]] std::vector<std::string> sources() const;
  /// Degrees of freedom that residuals have given to a source, the forgotten ones taken off.
  [[nodiscard]] double freedom(std::string_view source) const;
  friend bool operator==(const SourceErrors&, const SourceErrors&) = default;

 private:
  struct Known {
    std::string source;
    double sum{};      ///< S
    double freedom{};  ///< ν
    friend bool operator==(const Known&, const Known&) = default;
  };
  [[nodiscard]] const Known* find(std::string_view source) const;
  [[nodiscard]] double variance(std::string_view source) const;

  std::vector<Known> known_;
  GeoPoint at_;
  double at_s_{};
  bool any_{};
};

}  // namespace glidehelm::mission
