#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/time.hpp"

/// What the glider said, unchecked: sentinels and stale fixes included. `accept_fix` turns it into a `model::Surfacing`
/// or into the reason why not.
namespace glidehelm::protocol {

/// `GPS Location:  5949.127 N  2317.927 E measured     45.682 secs ago`, complete and exactly as long as the firmware
/// prints it: a line that lost or gained a byte is damaged, not read.
struct Location {
  std::string lat_text, lon_text;  ///< DDMM.mmm as printed
  char lat_letter{'N'}, lon_letter{'E'};
  double age_s{};  ///< as printed, 1e+308 included
  friend bool operator==(const Location&, const Location&) = default;
};

/// `   sensor:m_battery(volts)=16.41                      3.76 secs ago`
struct SensorReading {
  std::string name, unit;
  double value{};
  double age_s{};  ///< as printed, 1e+308 included
  friend bool operator==(const SensorReading&, const SensorReading&) = default;
};

/// `Waypoint: (5949.1700,2317.8900) Range: 86m, Bearing: 324deg, Age: 1:4h:m`: latitude first, unlike a mafile.
struct WaypointLine {
  std::string lat_text, lon_text;
  double range_m{}, bearing_deg{};
  double age_min{};  ///< how long the glider has steered there; hours and minutes as printed
  friend bool operator==(const WaypointLine&, const WaypointLine&) = default;
};

/// `Because:pitch not commanded [behavior surface_4 start_when = 2.0]`
struct BecauseLine {
  std::string text, behavior;
  double start_when{};
  friend bool operator==(const BecauseLine&, const BecauseLine&) = default;
};

/// `MissionName:tvr20233.mi MissionNum:koskelo-2023-312-3-2 (0169.0002)`
struct MissionLine {
  std::string file, number, segment;
  friend bool operator==(const MissionLine&, const MissionLine&) = default;
};

/// `devices:(t/m/s) errs: …/ warn: …/ odd: …`: total/mission/segment.
struct DevicesLine {
  std::array<int, 3> errors{}, warnings{}, oddities{};
  friend bool operator==(const DevicesLine&, const DevicesLine&) = default;
};

/// Whose prompt stood there last.
enum class Console {
  unknown,    ///< a connection that has shown neither
  mission,    ///< `Glider X at surface.`: a mission runs
  gliderdos,  ///< `GliderDos N -1 >`
  gliderlab,  ///< `GliderLAB …`: on the bench
};

/// Of `Water Velocity Calculations`: is the printed m_water_vx/vy the final one of the dive?
enum class WaterState { unknown, waiting, complete };

/// One block of the surface dialog: everything since the line that began it, bound to its `Curr Time` (slocum.md S1).
struct SurfaceBlock {
  std::string vehicle;                  ///< `Vehicle Name:` of the block, else of the connection; lower case
  std::optional<GliderTime> curr_time;  ///< none when the line was missing or damaged
  std::optional<std::int64_t> mission_time_s;
  std::optional<Location> dead_reckoned;  ///< `DR  Location:`, never a fix
  std::optional<Location> too_far;        ///< `GPS TooFar:`
  std::optional<Location> invalid;        ///< `GPS Invalid :`, flagged by the receiver
  std::optional<Location> gps;            ///< `GPS Location:`, the only one that can be a fix
  int line{};                             ///< of the `GPS Location:` line in the stream, from 1; 0 without one
  Instant heard;                          ///< our clock when the `GPS Location:` line was complete
  bool gps_damaged{};                     ///< a `GPS Location:` line was there but not whole
  std::vector<SensorReading> sensors;     ///< in the order printed

  bool at_surface{};  ///< began with `Glider X at surface.`, or has a `Because:` line
  Console console{Console::unknown};
  std::optional<MissionLine> mission;
  std::optional<BecauseLine> because;
  std::optional<WaypointLine> waypoint;
  WaterState water{WaterState::unknown};
  std::optional<DevicesLine> devices;
  std::optional<int> aborts;             ///< `ABORT HISTORY: total since reset`
  std::optional<double> until_diving_s;  ///< `Time until diving`, counted from `heard`
  std::vector<std::string> damaged;      ///< lines that match in part, as they came; at most eight

  /// The last reading of that name.
  [[nodiscard]] const SensorReading* sensor(std::string_view name) const;
  friend bool operator==(const SurfaceBlock&, const SurfaceBlock&) = default;
};

}  // namespace glidehelm::protocol
