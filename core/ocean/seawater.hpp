#pragma once

#include <span>
#include <vector>

#include "core/base/units.hpp"

/// What sea water weighs: temperature, salinity and pressure, and what follows from them.
namespace glidehelm::ocean {

inline constexpr double kGravity = 9.80665;  ///< m/s², standard; the true one differs by 0.27 % at most

/// Density of sea water in kg/m³: the international equation of state of 1980 (UNESCO 1981, EOS-80) of practical salinity,
/// temperature (°C) and pressure above the atmosphere's (Pa). For salinities 0 to 42, −2 to 40 °C and 0 to 1000 bar.
double sea_water_density(double salinity, double temperature_c, double pressure_pa);

/// How the temperature (°C) of water changes when it is compressed without heat, °C/Pa: the polynomial of Bryden (1973) as in UNESCO
/// (1983), Algorithms for computation of fundamental properties of seawater, of practical salinity, temperature and pressure (Pa).
double adiabatic_lapse_rate(double salinity, double temperature_c, double pressure_pa);

/// Temperature (°C) in situ of water that would have the potential temperature `theta_c` at the surface: the lapse rate integrated over
/// the pressure in one classical Runge–Kutta step. Down to 2000 m a hundred steps differ from it by less than 1e-7 °C.
double in_situ_temperature(double salinity, double theta_c, double pressure_pa);

/// Practical salinity of an absolute one in g/kg: the reference composition (TEOS-10), S_A·35/35.16504. What other composition a
/// place has (up to 0.02 g/kg in the open ocean: 0.02 kg/m³) is not in it.
inline double practical_salinity(double absolute_g_per_kg) { return absolute_g_per_kg * (35 / 35.16504); }

/// Pressure above the atmosphere's, Pa, at a depth: hydrostatic, in water of 1027 kg/m³ at the surface that the pressure itself
/// compresses by 4.4e-10 /Pa. Within 0.3 % of the standard ocean's (Saunders & Fofonoff 1976) down to 2000 m.
double pressure_at(Metres depth);

/// Temperature (°C, in situ) and practical salinity at a depth.
struct WaterLayer {
  Metres depth;
  double temperature_c{10}, salinity{35};
  friend bool operator==(const WaterLayer&, const WaterLayer&) = default;
};

/// False for what no sea has: a temperature outside −3 to 45 °C, a salinity outside 0 to 45, or no number.
bool plausible(const WaterLayer& water);

/// Temperature and salinity by depth: linear between layers, held above the first and below the last.
class WaterColumn {
 public:
  /// Layers by depth, strictly ascending; at least one.
  explicit WaterColumn(std::vector<WaterLayer> layers) : layers_{std::move(layers)} {}
  /// A middle-latitude ocean for those who have no profile: salinity 35, 4 °C below and 16 °C at the surface, falling with
  /// exp(−z/300 m). Ours: a plausible shape, not a measured mean.
  static WaterColumn climatological();

  /// At a depth, which the result repeats.
  [[nodiscard]] WaterLayer at(Metres depth) const;
  /// In situ, kg/m³.
  [[nodiscard]] double density(Metres depth) const;
  [[nodiscard]] std::span<const WaterLayer> layers() const { return layers_; }

 private:
  std::vector<WaterLayer> layers_;
};

}  // namespace glidehelm::ocean
