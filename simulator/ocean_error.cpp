#include "simulator/ocean_error.hpp"

#include <cmath>

#include "core/base/local_metric.hpp"
#include "simulator/random.hpp"

namespace glidehelm::simulator {
namespace {

constexpr int kWaves = 64;
constexpr double kM2Period = 12.4206012 * 3600.0;

double middle(double low, double high) { return high - low >= 2 * kPi - 1e-9 ? 0.0 : 0.5 * (low + high); }

}  // namespace

MesoscaleNoise::MesoscaleNoise(const OceanError& spec, double lat0, double lon0, double start_s)
    : lat0_{lat0}, lon0_{lon0}, start_s_{start_s}, fading_{spec.fading_m} {
  const auto metric = LocalMetric::at(lat0);
  meridian_ = metric.meridian_radius;
  parallel_ = metric.parallel_radius;
  if (spec.noise_m_per_s <= 0) return;
  Random random = Random{spec.seed}.stream(41);
  const double k_long = 2 * kPi / (1e3 * spec.longest_km), k_short = 2 * kPi / (1e3 * spec.shortest_km);
  double energy = 0;
  for (int i = 0; i < kWaves; ++i) {
    const double k = k_long * std::pow(k_short / k_long, (i + 0.5) / kWaves);
    const double direction = random.uniform(0, 2 * kPi), phase = random.uniform(0, 2 * kPi);
    const double sigma = std::pow(k / k_long, 2.0 / 3.0) / (3600.0 * spec.lasting_h);
    const double speed = std::sqrt(std::pow(k / k_long, spec.slope + 1));  // amplitude: its square is E(k)·k
    Wave wave{k * std::sin(direction), k * std::cos(direction), speed, sigma * random.normal(), phase};
    wave.k = std::hypot(wave.kx, wave.ky);
    waves_.push_back(wave);
    energy += speed * speed / 2;  // mean of a squared sine
  }
  for (auto& wave : waves_) {
    wave.speed *= spec.noise_m_per_s / std::sqrt(energy);
    bound_ += wave.speed;
  }
}

Current MesoscaleNoise::at(GeoPoint p, Depth z, double t_s) const {
  double dlon = p.lon.radians() - lon0_;
  if (dlon > kPi || dlon < -kPi) dlon = std::remainder(dlon, 2 * kPi);
  const double x = dlon * parallel_;
  const double y = (p.lat.radians() - lat0_) * meridian_;
  double u = 0, v = 0;
  for (const auto& wave : waves_) {
    const double s = wave.speed * std::sin(wave.kx * x + wave.ky * y - wave.omega * (t_s - start_s_) + wave.phase);
    u += s * wave.ky / wave.k;
    v -= s * wave.kx / wave.k;
  }
  const double share = fading_ > 0 ? std::exp(-z.below_surface.si() / fading_) : 1.0;
  return {MetresPerSecond{share * u}, MetresPerSecond{share * v}};
}

PerturbedField::PerturbedField(ocean::FieldRef model, const OceanError& error, double start_s)
    : model_{model},
      error_{error},
      noise_{error, 0.5 * (model.coverage().south + model.coverage().north),
             middle(model.coverage().west, model.coverage().east), start_s},
      start_s_{start_s},
      tide_phase_{Random{error.seed}.stream(42).uniform(0, 2 * kPi)},
      shift_east_{std::sin(degrees(error.shift_toward_deg).si())},
      shift_north_{std::cos(degrees(error.shift_toward_deg).si())},
      tide_east_{std::sin(degrees(error.tide_toward_deg).si())},
      tide_north_{std::cos(degrees(error.tide_toward_deg).si())} {}

MetresPerSecond PerturbedField::fastest() const {
  return MetresPerSecond{model_.fastest().si() + noise_.bound() +
                         std::hypot(1.0, error_.tide_ratio) * error_.tide_m_per_s};
}

/// What the model has at p − shift and t − late, the water has at p and t. Where that place or time is outside the model the
/// unshifted value stands: a shift must not make land or holes.
Expected<ocean::Sample, ocean::NoCurrent> PerturbedField::sample(GeoPoint p, Depth z, double t_s) const {
  auto here = model_.sample(p, z, t_s);
  if (!here) return here;
  if (error_.shift_km != 0 || error_.late_h != 0) {
    const double metres = 1e3 * error_.shift_km;
    const auto metric = LocalMetric::at(p.lat.radians());
    const auto from = GeoPoint::from_kernel(p.lat.radians() - metres * shift_north_ / metric.meridian_radius,
                                            p.lon.radians() - metres * shift_east_ / metric.parallel_radius);
    if (const auto moved = model_.sample(from, z, t_s - 3600.0 * error_.late_h)) here = moved;
  }
  const auto noise = noise_.at(p, z, t_s);
  double east = here->current.east.si() + noise.east.si(), north = here->current.north.si() + noise.north.si();
  if (error_.tide_m_per_s != 0) {
    const double phase = 2 * kPi * (t_s - start_s_) / kM2Period + tide_phase_;
    const double major = error_.tide_m_per_s * std::cos(phase),
                 minor = error_.tide_m_per_s * error_.tide_ratio * std::sin(phase);
    east += major * tide_east_ + minor * tide_north_;
    north += major * tide_north_ - minor * tide_east_;
  }
  return ocean::Sample{{MetresPerSecond{east}, MetresPerSecond{north}}, here->extrapolated};
}

}  // namespace glidehelm::simulator
