#pragma once

#include <vector>

namespace glidehelm::mission {

/// One number learned from surfacings: the median of the newest seven observations, in which the configured first guess
/// counts as two until five are there. So one surfacing moves nothing, two move it half way, and one bad surfacing among
/// three or more moves it no farther than to its good neighbour.
///
/// The spread is the one of the first guess until three observations are there, then 1.4826 times the median distance
/// from the value (the standard deviation of a normal sample), never below the floor.
class Estimate {
 public:
  Estimate() = default;
  Estimate(double first_guess, double guess_spread, double floor)
      : guess_{first_guess}, guess_spread_{guess_spread}, floor_{floor} {}

  /// Takes an observation; one that is not finite is left out.
  void see(double observed);
  /// Another first guess; what was observed stays.
  void guess(double first_guess) { guess_ = first_guess; }
  [[nodiscard]] double value() const;
  [[nodiscard]] double spread() const;
  [[nodiscard]] int seen() const { return count_; }
  [[nodiscard]] double first_guess() const { return guess_; }
  friend bool operator==(const Estimate&, const Estimate&) = default;

 private:
  double guess_{}, guess_spread_{}, floor_{};
  std::vector<double> newest_;
  int count_{};
};

/// Of an even number the mean of the two in the middle. Precondition: at least one.
double median_of(std::vector<double> values);

}  // namespace glidehelm::mission
