#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/mission/mission.hpp"

/// The vehicle of a mission in the water that a forecast has.
namespace glidehelm::mission {

/// Shortest and longest stint of a mission.
inline constexpr Seconds kShortestStint{0.1 * 3600}, kLongestStint{72 * 3600.0};

/// Underwater time of a yo of `half_cycles` dives and climbs between `climb_to` and `dive_depth`, from the surface and back to it, at the
/// vertical speed U·tan(glide angle) of a glider whose horizontal speed through water is U.
Seconds stint_of_half_cycles(int half_cycles, const Mission& m);

/// True when speed and glide angle follow from a body whose water the mission does not give: `vehicle.force_balance` without `water`.
[[nodiscard]] bool takes_forecast_water(const Mission& m);
/// True when both dive alike in any one water: the dive profile of one is that of the other.
[[nodiscard]] bool dive_alike(const Mission& a, const Mission& b);

/// Whose water a body is weighed in; `none`: there is no body, speed and angle are configured.
enum class WaterFrom { none, mission, forecast, climatology };
/// "none", "mission", "forecast", "climatology".
std::string_view word(WaterFrom from);
/// For sentences: "no water", "the mission's water", "the forecast's water", "the climatological profile".
std::string_view words(WaterFrom from);

/// A mission whose vehicle was put into water.
struct InWater {
  Mission mission;
  WaterFrom from{};
  std::string
      refused;  ///< why the body does not fly in the forecast's water, so that the climatological one is taken; empty: it does
};

/// The mission with the speed, the glide angle and, where it counts half cycles, the stint that its body has in `layers` (none: the
/// climatological profile). A first stint that is as long as the others stays so. Of a mission that does not take a forecast's water it is
/// the mission itself. Idempotent, and nothing that an earlier call has set counts.
InWater in_water(const Mission& m, std::span<const ocean::WaterLayer> layers);

}  // namespace glidehelm::mission
