#include "core/mission/error_filter.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::mission {

namespace {
constexpr double kMonth = 30 * 86400.0;
constexpr double kSpeedWander = 0.02, kBiasWander = 2 * kPi / 180;  // in a month
constexpr double kFarthest = 3.0;                                   // standard deviations that an innovation counts for
constexpr double kSlowest = -0.5, kFastest = 0.3;                   // of U0
constexpr double kLargestBias = kPi / 6;
}  // namespace

ErrorFilter::ErrorFilter(const Setup& setup) : setup_{setup} {
  p_[0][0] = setup.speed_spread * setup.speed_spread;
  p_[1][1] = setup.bias_spread * setup.bias_spread;
  p_[2][2] = p_[3][3] = setup.error_spread * setup.error_spread;
}

/// From the last dive to this one: the forecast's error is remembered as far as it is correlated, the rest of its
/// variance comes back.
void ErrorFilter::forget(const DiveResidual& until) {
  if (seen_ == 0) return;
  const double d = distance(at_, until.at).si(), t = std::max(0.0, until.at_s - at_s_);
  const double rho = std::exp(-0.5 * d * d / (setup_.length * setup_.length) - t / setup_.time);
  for (std::size_t i = 2; i < 4; ++i) {
    x_[i] *= rho;
    by_guess_[i] *= rho;
    for (std::size_t k = 0; k < 4; ++k) {
      p_[i][k] *= rho;
      p_[k][i] *= rho;
    }
    p_[i][i] += (1 - rho * rho) * setup_.error_spread * setup_.error_spread;
  }
  p_[0][0] += kSpeedWander * kSpeedWander * t / kMonth;
  p_[1][1] += kBiasWander * kBiasWander * t / kMonth;
}

void ErrorFilter::update(double observed, const State& row, double variance) {
  State pr{};
  double innovation = observed, s = variance, of_guess = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    innovation -= row[i] * x_[i];
    of_guess += row[i] * by_guess_[i];
    for (std::size_t k = 0; k < 4; ++k) pr[i] += p_[i][k] * row[k];
  }
  for (std::size_t i = 0; i < 4; ++i) s += row[i] * pr[i];
  const double limit = kFarthest * std::sqrt(s), off = std::abs(innovation);
  if (off > limit) innovation *= limit * limit / (off * off);
  for (std::size_t i = 0; i < 4; ++i) x_[i] += pr[i] / s * innovation;
  for (std::size_t i = 0; i < 4; ++i) by_guess_[i] -= pr[i] / s * of_guess;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k) p_[i][k] -= pr[i] * pr[k] / s;
}

void ErrorFilter::see(const DiveResidual& dive) {
  for (const double v : {dive.east, dive.north, dive.heading_east, dive.heading_north, dive.spread, dive.at_s})
    if (!std::isfinite(v)) return;
  forget(dive);
  const double variance = std::max(dive.spread * dive.spread, 1e-6);
  const double u = setup_.speed;
  update(dive.east, {dive.heading_east, u * dive.heading_north, 1, 0}, variance);
  update(dive.north, {dive.heading_north, -u * dive.heading_east, 0, 1}, variance);
  at_ = dive.at;
  at_s_ = dive.at_s;
  ++seen_;
}

void ErrorFilter::move_guess(double speed, double spread) {
  // Seen from the old guess the new one is a first mean of δU that lies `moved` higher; then δU itself is counted from the new one.
  const double moved = speed - setup_.speed;
  for (std::size_t i = 0; i < 4; ++i) x_[i] += by_guess_[i] * moved;
  x_[0] -= moved;
  setup_.speed = speed;
  setup_.speed_spread = spread;
}

double ErrorFilter::speed_error() const { return std::clamp(x_[0], kSlowest * setup_.speed, kFastest * setup_.speed); }
double ErrorFilter::speed_spread() const { return std::sqrt(std::max(0.0, p_[0][0])); }
double ErrorFilter::bias() const { return std::clamp(x_[1], -kLargestBias, kLargestBias); }
double ErrorFilter::bias_spread() const { return std::sqrt(std::max(0.0, p_[1][1])); }
Current ErrorFilter::error() const { return {MetresPerSecond{x_[2]}, MetresPerSecond{x_[3]}}; }
double ErrorFilter::error_spread() const { return std::sqrt(std::max({0.0, p_[2][2], p_[3][3]})); }

}  // namespace glidehelm::mission
