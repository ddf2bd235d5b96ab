#include "core/mission/source_errors.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::mission {

namespace {

constexpr double kPriorFreedom = 8;       // ν₀: four dives that are far apart
constexpr double kMemory = 10 * 86400.0;  // s
constexpr double kFarthest = 18;          // of (V + n²), for |r|²
constexpr double kLength = 30'000;        // m, L of decision 012
constexpr double kTime = 24 * 3600.0;     // s, T of decision 012
constexpr double kExtrapolated = 2;       // product.md 6

}  // namespace

const SourceErrors::Known* SourceErrors::find(std::string_view source) const {
  const auto at = std::find_if(known_.begin(), known_.end(), [&](const Known& k) { return k.source == source; });
  return at == known_.end() ? nullptr : &*at;
}

double SourceErrors::variance(std::string_view source) const {
  const auto* known = find(source);
  const double sum = known != nullptr ? known->sum : 0, freedom = known != nullptr ? known->freedom : 0;
  return (kPriorFreedom * kPrior * kPrior + sum) / (kPriorFreedom + freedom);
}

MetresPerSecond SourceErrors::spread(std::string_view source) const {
  return MetresPerSecond{std::sqrt(variance(source))};
}

MetresPerSecond SourceErrors::spread(const std::vector<SourceShare>& shares, bool extrapolated) const {
  double sum = 0, all = 0;
  for (const auto& s : shares) {
    sum += s.share * std::sqrt(variance(s.source));
    all += s.share;
  }
  return MetresPerSecond{(extrapolated ? kExtrapolated : 1) * (all > 0 ? sum / all : kPrior)};
}

double SourceErrors::freedom(std::string_view source) const {
  const auto* known = find(source);
  return known != nullptr ? known->freedom : 0;
}

void SourceErrors::see(const CurrentResidual& r) {
  for (const double v : {r.east, r.north, r.noise, r.at_s})
    if (!std::isfinite(v)) return;
  double all = 0;
  for (const auto& s : r.shares) {
    if (!(s.share >= 0) || !std::isfinite(s.share)) return;
    all += s.share;
  }
  if (!(all > 0)) return;

  const double t = any_ ? std::max(0.0, r.at_s - at_s_) : 0, d = any_ ? distance(at_, r.at).si() : 0;
  const double rho = any_ ? std::exp(-0.5 * d * d / (kLength * kLength) - t / kTime) : 0;
  const double fresh = (1 - rho * rho) / (1 + rho * rho);
  for (auto& known : known_) {
    known.sum *= std::exp(-t / kMemory);
    known.freedom *= std::exp(-t / kMemory);
  }

  const double of_mean = std::pow(spread(r.shares, r.extrapolated).si(), 2), noise = r.noise * r.noise;
  const double squared = std::min(r.east * r.east + r.north * r.north, kFarthest * (of_mean + noise));
  const double factor = (0.5 * squared - noise) / of_mean;
  std::vector<double> before;  // each source's variance as it was for `of_mean`
  for (const auto& s : r.shares) before.push_back(variance(s.source));
  for (std::size_t i = 0; i < r.shares.size(); ++i) {
    const auto& source = r.shares[i].source;
    const double share = r.shares[i].share;
    if (!(share > 0)) continue;
    if (find(source) == nullptr) known_.push_back({source, 0, 0});
    auto& known = *std::find_if(known_.begin(), known_.end(), [&](const Known& k) { return k.source == source; });
    const double freedom = 2 * share / all * fresh;
    known.freedom += freedom;
    // At the floor the sum stops too: quiet weeks must not have to be made up for before σ grows again.
    const double least = kFloor * kFloor * (kPriorFreedom + known.freedom) - kPriorFreedom * kPrior * kPrior;
    known.sum = std::max(known.sum + freedom * factor * before[i], least);
  }
  at_ = r.at;
  at_s_ = std::max(r.at_s, any_ ? at_s_ : r.at_s);
  any_ = true;
}

std::vector<std::string> SourceErrors::sources() const {
  std::vector<std::string> names;
  for (const auto& known : known_) names.push_back(known.source);
  return names;
}

}  // namespace glidehelm::mission
