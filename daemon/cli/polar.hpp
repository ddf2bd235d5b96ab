#pragma once

#include <ostream>
#include <string>

#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm polar [MISSION] [--forecast] [--depth M] [--csv FILE] [--svg FILE] [--json]`.
struct PolarOptions {
  std::string mission;   ///< whose vehicle.force_balance; empty: the defaults of that section
  bool forecast{};       ///< in the water of the mission's forecast
  double depth_m{50};    ///< of the polar
  std::string csv, svg;  ///< new files; empty: none
  bool json{};
};

/// The glide polar ("spider plot", Thesis Figures 2.11 and 2.12): horizontal against vertical speed for pump volumes of 50 to 300 cm³
/// either way and every pitch, and what the mission's own trim comes to over its yo. A mission without vehicle.force_balance gets a note
/// on `err` and the section's defaults. The water is the mission's own, else with `forecast` that of its forecast, as a plan takes it, else
/// the climatological profile; the answer says which.
///
/// CSV: pumped_cm3,pitch_deg,angle_of_attack_deg,horizontal_m_per_s,vertical_m_per_s. JSON: {"schema": "glidehelm/polar/v1", "depth_m",
/// "water": "mission", "forecast" or "climatology", "yo": {"horizontal_speed_m_per_s", "glide_angle_deg", "down_s", "up_s"}, "best": [{"pumped_cm3", "pitch_deg",
/// "horizontal_m_per_s"}], "points": [the columns]}. Returns 0, 1 when the trim does not fly or there is no
/// forecast, 2 when a file is wrong.
int run_polar(const PolarOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
