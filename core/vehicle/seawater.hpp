#pragma once

#include <span>
#include <vector>

#include "core/base/units.hpp"

/// The water that a hull is weighed in.
namespace glidehelm::vehicle {

inline constexpr double kGravity = 9.80665;  ///< m/s², standard; the true one differs by 0.27 % at most

/// Density of sea water in kg/m³: the international equation of state of 1980 (UNESCO 1981, EOS-80) of practical salinity,
/// temperature (°C) and pressure above the atmosphere's (Pa). For salinities 0 to 42, −2 to 40 °C and 0 to 1000 bar.
double sea_water_density(double salinity, double temperature_c, double pressure_pa);

/// Pressure above the atmosphere's, Pa, at a depth: hydrostatic, in water of 1027 kg/m³ at the surface that the pressure itself
/// compresses by 4.4e-10 /Pa. Within 0.3 % of the standard ocean's (Saunders & Fofonoff 1976) down to 2000 m.
double pressure_at(Metres depth);

/// Temperature (°C, in situ) and practical salinity at a depth.
struct WaterLayer {
  Metres depth;
  double temperature_c{10}, salinity{35};
  friend bool operator==(const WaterLayer&, const WaterLayer&) = default;
};

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

}  // namespace glidehelm::vehicle
