#pragma once

#include <cstdint>
#include <vector>

#include "core/ocean/field.hpp"

namespace glidehelm::simulator {

/// How the water differs from what a model says of it.
struct OceanError {
  double shift_km{};          ///< everything lies this much elsewhere …
  double shift_toward_deg{};  ///< … in this direction, clockwise from north
  double late_h{};            ///< everything happens this much later
  double noise_m_per_s{};     ///< root mean square speed of the added eddies, at the surface
  double longest_km{80};      ///< wavelengths of the added eddies
  double shortest_km{10};     ///<
  double slope{-3};           ///< of their kinetic energy spectrum: E(k) ∝ k^slope
  double lasting_h{72};       ///< e-folding time of a wave's correlation, of the longest ones
  double fading_m{};          ///< e-folding depth of the added eddies; 0: as strong at every depth
  double tide_m_per_s{};      ///< added M2 current, major axis: an error of amplitude and phase of the model's tide
  double tide_toward_deg{};   ///< direction of its major axis
  double tide_ratio{0.3};     ///< minor to major axis
  std::uint64_t seed{1};
  friend bool operator==(const OceanError&, const OceanError&) = default;
};

/// Random mesoscale eddies with a stated spectrum, free of divergence: a sum of n = 64 plane waves of a stream function
///
///   ψ(x, y, t) = Σ a_i cos(k_i·x − ω_i t + φ_i),   u = −∂ψ/∂y, v = ∂ψ/∂x,
///
/// with |k_i| spaced evenly in log k between the longest and the shortest wavelength, directions and phases drawn, and
/// a_i²k_i² proportional to E(k_i)·k_i (the energy of one step in log k), scaled so that the mean of u² + v² over space is the
/// square of the stated speed. ω_i is drawn normal with standard deviation (k_i/k_longest)^(2/3)/lasting: the correlation of a
/// wave falls as exp(−½(σ_ω τ)²), sooner for small eddies than for large ones. In plane metres about (lat0, lon0), with the
/// parallel's radius at lat0.
class MesoscaleNoise {
 public:
  MesoscaleNoise(const OceanError& spec, double lat0, double lon0, double start_s);
  [[nodiscard]] Current at(GeoPoint p, Depth z, double t_s) const;
  /// Never more than this.
  [[nodiscard]] double bound() const { return bound_; }

  struct Wave {
    double kx, ky, speed, omega, phase;  ///< rad/m, rad/m, m/s, rad/s, rad
    double k{};                          ///< rad/m: length of (kx, ky)
  };
  [[nodiscard]] const std::vector<Wave>& waves() const { return waves_; }

 private:
  double lat0_, lon0_, start_s_, meridian_, parallel_, fading_, bound_{};
  std::vector<Wave> waves_;
};

/// A field with such an error: the truth of a scenario whose forecast is the field itself.
class PerturbedField {
 public:
  /// The middle of `model`'s coverage is the origin of the noise; of a field without bounds (0, 0).
  PerturbedField(ocean::FieldRef model, const OceanError& error, double start_s);

  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double t_s) const;
  [[nodiscard]] ocean::Coverage coverage() const { return model_.coverage(); }
  [[nodiscard]] MetresPerSecond fastest() const;

 private:
  ocean::FieldRef model_;
  OceanError error_;
  MesoscaleNoise noise_;
  double start_s_, tide_phase_;
  double shift_east_, shift_north_, tide_east_, tide_north_;  ///< unit vectors of the two directions
};

}  // namespace glidehelm::simulator
