#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/units.hpp"
#include "simulator/dockserver/dialog_writer.hpp"
#include "simulator/glider/behaviours.hpp"

namespace glidehelm::simulator {

/// Every sensor that a simulated dialog may print, in the order of the alphabet.
inline constexpr std::array<std::string_view, 19> kDialogSensors{"c_wpt_lat",
                                                                 "c_wpt_lon",
                                                                 "m_avg_speed",
                                                                 "m_battery",
                                                                 "m_coulomb_amphr_total",
                                                                 "m_final_water_vx",
                                                                 "m_final_water_vy",
                                                                 "m_gps_mag_var",
                                                                 "m_initial_water_vx",
                                                                 "m_initial_water_vy",
                                                                 "m_iridium_signal_strength",
                                                                 "m_leakdetect_voltage",
                                                                 "m_lithium_battery_relative_charge",
                                                                 "m_vacuum",
                                                                 "m_water_vx",
                                                                 "m_water_vy",
                                                                 "u_use_current_correction",
                                                                 "x_last_wpt_lat",
                                                                 "x_last_wpt_lon"};

/// What a dialog tells of the glider's frame and of its current, and what it keeps to itself.
struct Telling {
  std::vector<std::string> without;  ///< sensors that are not in its list (config.srf, slocum.md 1.3)
  Radians variation_error{};         ///< m_gps_mag_var as printed less that of its frame
  /// The final current is awaited during the whole call, as 3 of 63 recorded prompts have it: m_water_vx/vy are the initial
  /// one, no m_final_water is printed. The glider has the final one by its dive, and nobody hears of it.
  bool water_awaited{};
  bool waypoint_line{true};  ///< at-surface blocks have a `Waypoint:` line
  friend bool operator==(const Telling&, const Telling&) = default;
};
/// What of a whole report is told.
void tell_only(const Telling& tells, Report& report);

/// What a glider on the surface says of itself at epoch second `now_s`, with `dives_in_s` seconds left in its keystroke
/// window. Positions and fix are the last ones taken (during a call there is no new fix, slocum.md 4.6); the currents
/// and the waypoint bearing are in its rotated frame. Battery and vacuum drain linearly with mission time: plausible
/// numbers that nothing depends on.
Report report_of(const Glider& glider, double now_s, double dives_in_s);

}  // namespace glidehelm::simulator
