#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/units.hpp"
#include "core/ocean/seawater.hpp"

/// The glider as a body: how fast it glides for what its pump moves (Thesis 2.2.3; Merckelbach, Smeed & Griffiths 2010).
namespace glidehelm::vehicle {

using ocean::WaterColumn, ocean::WaterLayer, ocean::kGravity;

/// What a hull is (Thesis Table 2.1). The defaults are in the range that is published for Slocum gliders; a team's own values come
/// from its flight-model calibration.
struct Hull {
  double volume_m3{0.070};               ///< V_g at atmospheric pressure and `reference_c`
  std::optional<double> mass_kg;         ///< m_g; none: neutral at `neutral_at` with the pump in its middle
  Metres neutral_at{100};                ///< only without a mass
  double compressibility_per_pa{5e-10};  ///< ε
  double expansion_per_c{7e-5};          ///< α_T
  double reference_c{13.2};              ///< T_0
  double area_m2{0.1};                   ///< S: the area that the coefficients are of
  double drag{0.1};                      ///< C_D0, parasite drag
  double induced_drag_per_rad2{2.88};    ///< C_D1 = C_D1,h + C_D1,w
  double lift_per_rad{6.1};              ///< a_h + a_w
  friend bool operator==(const Hull&, const Hull&) = default;
};

/// Lift slope of swept wings, per radian (2.37): 2π·A/(2 + √(A²(1 + tan²Ω) + 4)) for aspect ratio A and sweep Ω.
double wing_lift_slope(double aspect_ratio, Radians sweep);
/// Induced drag of wings with lift slope a, per square radian (2.35): a²/(π·A·e).
double wing_induced_drag(double lift_slope, double aspect_ratio, double span_efficiency = 0.8);

/// Where wings stall: the lift is linear in the angle of attack only well below.
inline constexpr Radians kLargestAttack = degrees(8);
/// Angle of attack at a pitch (both positive, whatever way the glider goes): the smallest root of 2.40,
/// (a_h + a_w)·α·tan(θ + α) = C_D0 + C_D1·α², to 1e-13 rad. None below `kLargestAttack`: the pitch is too flat for the lift to carry
/// the hull against its drag.
std::optional<Radians> angle_of_attack(const Hull& hull, Radians pitch);
/// 2.49: the pitch that goes with an angle of attack > 0.
Radians pitch_of(const Hull& hull, Radians angle_of_attack);

/// Buoyancy less weight, N, positive upwards (2.30, 2.31), at a depth of a column with the pump at `pumped_m3` (ΔV_bp).
double net_buoyancy(const Hull& hull, const WaterColumn& water, Metres depth, double pumped_m3);
/// ΔV_bp, m³, with which the hull floats at a depth (B.11).
double neutral_volume(const Hull& hull, const WaterColumn& water, Metres depth);

/// Steady motion.
struct Glide {
  MetresPerSecond path;        ///< U along the glide path
  MetresPerSecond horizontal;  ///< U·cos γ
  MetresPerSecond vertical;    ///< U·sin γ, positive upwards
  Radians glide_angle;         ///< γ = θ + α, positive
  Radians angle_of_attack;
};
/// 2.42 with |θ| = `pitch` and the net buoyancy's sign as the way up or down. None as `angle_of_attack`. `density` in kg/m³.
std::optional<Glide> steady_glide(const Hull& hull, Radians pitch, double net_buoyancy_n, double density);
/// Straight up or down without lift: a profiling float (B.10). m/s, positive upwards.
MetresPerSecond float_speed(const Hull& hull, double net_buoyancy_n, double density);

/// How a glider is trimmed.
struct Trim {
  Radians pitch_down{degrees(26)}, pitch_up{degrees(26)};
  double pumped_down_m3{-230 * 1e-6}, pumped_up_m3{230 * 1e-6};  ///< ΔV_bp of dives and climbs
  friend bool operator==(const Trim&, const Trim&) = default;
};

/// A body, how it is trimmed, and the water it is in. Without water `column` is WaterColumn::climatological; a mission's body is then put
/// into the forecast's, where that has one (mission::in_water).
struct FlightModel {
  Hull hull;
  Trim trim;
  std::vector<WaterLayer> water;
  [[nodiscard]] WaterColumn column() const {
    return water.empty() ? WaterColumn::climatological() : WaterColumn{water};
  }
  friend bool operator==(const FlightModel&, const FlightModel&) = default;
};

/// Means over the yo between two depths: what the point model takes.
struct YoMeans {
  MetresPerSecond horizontal;  ///< way through water per time
  Radians glide_angle;         ///< whose tangent is vertical way per horizontal way
  Seconds down, up;            ///< of one dive and one climb
};
/// Means of one dive from `upper` to `lower` and one climb back (the glide is steady at each depth; integrated over depth in steps
/// of at most 2 m by the midpoint rule). The failure says where the glider does not sink or climb, or that the pitch is too flat.
Expected<YoMeans, std::string> yo_means(const Hull& hull, const Trim& trim, const WaterColumn& water, Metres upper,
                                        Metres lower);

/// A point of the glide polar ("spider plot", Thesis Figures 2.11 and 2.12).
struct PolarPoint {
  double pumped_m3{};  ///< ΔV_bp; negative dives
  Radians pitch, angle_of_attack;
  MetresPerSecond horizontal, vertical;  ///< vertical positive upwards
};
/// The polar at a depth: for each of `pumped` a curve over pitches from the flattest possible to 89°, in degrees.
std::vector<std::vector<PolarPoint>> glide_polar(const Hull& hull, const WaterColumn& water, Metres depth,
                                                 const std::vector<double>& pumped_m3);

}  // namespace glidehelm::vehicle
