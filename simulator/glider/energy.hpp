#pragma once

#include "core/base/units.hpp"

namespace glidehelm::simulator {

/// A simple energy model. The buoyancy pump works against the pressure at each lower inflection: (p_a + ρ g z)·ΔV/η;
/// taking water in at the upper one costs nothing (the sea pushes it in). Everything that runs all the time is one power
/// under water and one on the surface, the open satellite call adds its own.
struct EnergySpec {
  double pump_volume_m3{400e-6};  ///< moved at an inflection, from full in to full out
  double pump_efficiency{0.5};
  double dive_w{1.5};     ///< computer, attitude, science under water
  double surface_w{1.5};  ///< the same on the surface, with GPS
  double call_w{6};       ///< added while the satellite modem is in a call
  double battery_wh{};    ///< what it holds when the run starts; 0: not watched, the dialog prints plausible numbers
  double volts_full{16.4}, volts_empty{11.0};  ///< printed, by the share that is left
  friend bool operator==(const EnergySpec&, const EnergySpec&) = default;
};

/// Watt-hours, of a stint with its surface interval or of a run.
struct Energy {
  double pump_wh{}, hotel_wh{}, call_wh{};
  [[nodiscard]] double total_wh() const { return pump_wh + hotel_wh + call_wh; }
  Energy& operator+=(const Energy& e) {
    pump_wh += e.pump_wh;
    hotel_wh += e.hotel_wh;
    call_wh += e.call_wh;
    return *this;
  }
  friend bool operator==(const Energy&, const Energy&) = default;
};

/// Of `inflections` lower inflections whose depths add up to `depths`.
inline double pump_wh(const EnergySpec& spec, int inflections, Metres depths) {
  constexpr double kAtmosphere = 101'325, kWeight = 1025 * 9.81, kJoules = 3600;
  return (kAtmosphere * inflections + kWeight * depths.si()) * spec.pump_volume_m3 / spec.pump_efficiency / kJoules;
}

}  // namespace glidehelm::simulator
