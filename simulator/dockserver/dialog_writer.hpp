#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/geo.hpp"

namespace glidehelm::simulator {

/// A sensor as the surface dialog prints it.
struct SensorValue {
  std::string name, unit;
  double value{};
  std::optional<double> age_s;  ///< none: never updated, printed as 1e+308
};

/// The `Waypoint:` line: range and bearing as the glider computes them, in its own frame and scale.
struct WaypointReport {
  GeoPoint at;
  double range_m{}, bearing_deg{}, age_s{};
};

/// Everything one block of the dialog says. Times are seconds on the glider's clock.
struct Report {
  std::string glider;
  double clock_s{};            ///< what the glider takes for UTC, epoch seconds
  double mission_s{};          ///< since the mission started
  std::string mission_file;    ///< "sim.mi"
  double mission_started_s{};  ///< for the year and day of MissionNum
  int mission_of_day{}, mission_number{}, segment{};
  std::string reason{"pitch not commanded"}, behavior{"surface_4"};
  double start_when{2.0};
  GeoPoint dr;
  double dr_age_s{};
  std::optional<GeoPoint> invalid;  ///< last fix flagged invalid; printed with age 1e+308
  std::optional<GeoPoint> gps;      ///< none: 69696969
  double gps_age_s{};
  std::vector<SensorValue> sensors;
  bool water_measured{};  ///< a dive was flown: a line about the water velocity is printed
  bool water_final{};
  double final_fix_in_s{};  ///< printed while the final fix is awaited
  std::optional<WaypointReport> waypoint;
  double dives_in_s{};
};

/// Text of a Slocum G3 surface dialog (firmware 10–11), byte for byte by slocum.md 1.2; lines end with CR LF.
/// One generation only: the one of the sample logs koskelo, unit_1033 and calanus.
namespace dialog {

/// `value` in DDDMM.mmm with `decimals` (3 or 4), sign on the number; 59.9996′ carries into the next degree.
/// Written from whole units of the last decimal, so no minute of 60 can appear.
double ddmm(double degrees, int decimals);

std::string curr_time_line(double clock_s, double mission_s);
/// `label` is one of "DR  Location:", "GPS TooFar:", "GPS Invalid :", "GPS Location:". `lat` and `lon` in DDDMM.mmm;
/// an age of none prints 1e+308.
std::string location_line(const char* label, double lat, double lon, std::optional<double> age_s);
std::string sensor_line(const SensorValue& sensor);
std::string waypoint_line(const WaypointReport& waypoint);
std::string because_line(const std::string& reason, const std::string& behavior, double start_when);
std::string mission_line(const Report& report);
std::string devices_line(const int (&errs)[3], const int (&warn)[3], const int (&odd)[3]);
/// A line with the mission time in front, as in `  3881    No login script found for processing.`
std::string timed_line(double mission_s, const std::string& text);

/// What the console prints when a call opens: vehicle, time, positions, sensors.
std::string connection_block(const Report& report);
/// From `Glider X at surface.` to `Time until diving is: N secs`.
std::string at_surface_block(const Report& report);

/// `!dockzr *` as typed, with the dockserver's answer when the folder holds nothing.
std::string nothing_to_send();
std::string sending_starts(const std::string& file, const std::string& glider, std::size_t bytes);
std::string sending_ends(const std::string& file, std::size_t bytes);
/// Ctrl-F was pressed: the mafiles are read again.
std::string reread(double mission_s, const std::string& behavior);
/// The re-read brought a behaviour into its error state: the mission is over.
std::string behaviour_error(double mission_s, const std::string& reason);
/// The end of the keystroke window, by Ctrl-R or by time, down to the silence of the dive.
std::string resuming(const Report& report, bool by_key);

}  // namespace dialog
}  // namespace glidehelm::simulator
