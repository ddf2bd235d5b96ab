#pragma once

#include <optional>
#include <string>

#include "core/base/expected.hpp"
#include "core/base/units.hpp"

namespace glidehelm::simulator {

/// A glider and its water as the force-balance model sees them (Thesis 2.2.3, Table 2.1, after Merckelbach et al. 2010).
/// The Thesis names the parameters and gives no numbers: the defaults are of the size of a Slocum and such that the
/// speeds which its text states for ±200 cm³ come out (0.8 m/s straight down, 0.5 m/s forward at 35°).
struct Body {
  double volume_m3{0.070};               ///< V_g, at the surface
  double wing_area_m2{0.1};              ///< S, to which all coefficients refer
  double aspect_ratio{7};                ///< AR = b²/S
  Radians sweep{degrees(43)};            ///< Ω, of the quarter-chord line
  double span_efficiency{0.8};           ///< e
  double hull_lift{2.4};                 ///< a_h, per radian
  double parasite_drag{0.06};            ///< C_D0, hull and wings
  double hull_induced_drag{2.1};         ///< C_D1,h, per radian squared
  double compressibility_per_pa{5e-10};  ///< ε
  double pump_dive_m3{-200e-6};          ///< ΔV_bp while diving
  double pump_climb_m3{200e-6};          ///< ΔV_bp while climbing
  Radians pitch_dive{degrees(26)};       ///< θ, size
  Radians pitch_climb{degrees(26)};      ///< θ
  double ballast_density{1025};          ///< kg/m³: neutral at the surface in such water with ΔV_bp = 0
  double surface_density{1025};          ///< kg/m³, of the water
  double density_per_m{0};               ///< kg/m⁴, by which the water grows denser with depth
  friend bool operator==(const Body&, const Body&) = default;
};

/// Lift slope of the wings (Thesis 2.37) and of the whole glider, per radian.
double wing_lift_slope(const Body& body);
double lift_slope(const Body& body);
/// C_D1 of hull and wings; the wings' is a_w²/(π·AR·e) (Thesis 2.34, 2.35).
double induced_drag(const Body& body);

/// Angle of attack of a steady glide at pitch θ in (0, π/2]: the smallest positive root of Thesis 2.40,
/// C_D0 + C_D1 α² = (a_h + a_w)·α·tan(θ + α), to 1e-12 rad. Written with sine and cosine it has a sign change between 0
/// and π/2 − θ at every θ, so there is always a root; the linear lift makes it meaningless beyond some 15°.
Radians angle_of_attack(const Body& body, Radians pitch);

/// One steady leg.
struct Flight {
  Radians attack;              ///< α, size
  Radians path;                ///< γ = θ + α, size: of the path below or above the horizon
  MetresPerSecond along;       ///< U
  MetresPerSecond horizontal;  ///< U·cos γ (Thesis 2.46)
  MetresPerSecond vertical;    ///< U·sin γ (2.45), size
};

/// F_B − F_g in newtons at a depth, positive upwards (Thesis 2.30, 2.31 with P = ρ g z; the thermal term is left out: this
/// water has no temperature).
double net_buoyancy(const Body& body, bool down, Metres depth);

/// A leg that the buoyancy cannot drive: a dive that floats or a climb that sinks.
struct NoFlight {
  bool down{};
  Metres depth;
  double newtons{};  ///< F_B − F_g, of the wrong sign
  [[nodiscard]] std::string message() const;
};

/// Speed on a leg at a depth (Thesis 2.42; the errata's signs do not matter: sizes are used, and B.10 agrees):
/// U² = 2 sin γ |F_B − F_g| / (ρ S (C_D0 + C_D1 α²)). α depends on the pitch alone and can be handed in.
Expected<Flight, NoFlight> steady_flight(const Body& body, bool down, Metres depth);
Expected<Flight, NoFlight> steady_flight(const Body& body, bool down, Metres depth, Radians attack);

/// The first depth between the surface and `to` on which a dive floats or a climb sinks; none: it can yo there.
std::optional<NoFlight> cannot_reach(const Body& body, Metres to);

}  // namespace glidehelm::simulator
