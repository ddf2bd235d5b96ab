#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/geo.hpp"

namespace glidehelm::simulator {

/// Generations of firmware whose dialogs differ (slocum.md 1.5).
enum class Firmware {
  g1,  ///< G1 and early G2 over a telephone modem (2012): no `Carrier Detect found`, upper-case names, abort history also in the
       ///< connection block
  g2,  ///< G2, older firmware: upper-case mission names, narrow ages behind long sensor names
  g3,  ///< G3, firmware 10 and 11
};

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

/// Aborts since the glider was reset; the lines on the last one are printed when `total` is above 0.
struct AbortHistory {
  int total{};
  std::string cause{"MS_ABORT_USER_INTERRUPT"}, details;
  double at_s{};  ///< on the glider's clock
  int mission_number{}, segment{};
};

/// Everything one block of the dialog says. Times are seconds on the glider's clock.
struct Report {
  Firmware firmware{Firmware::g3};
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
  AbortHistory aborts;
};

/// Text of a Slocum surface dialog, byte for byte by slocum.md 1.2 and 1.5; lines end with CR LF. What a generation prints
/// otherwise than G3 does is chosen by `Firmware`.
namespace dialog {

/// `value` in DDDMM.mmm with `decimals` (3 or 4), sign on the number; 59.9996′ carries into the next degree.
/// Written from whole units of the last decimal, so no minute of 60 can appear.
double ddmm(double degrees, int decimals);

std::string curr_time_line(double clock_s, double mission_s);
/// `label` is one of "DR  Location:", "GPS TooFar:", "GPS Invalid :", "GPS Location:". `lat` and `lon` in DDDMM.mmm;
/// an age of none prints 1e+308.
std::string location_line(const char* label, double lat, double lon, std::optional<double> age_s);
/// Behind a head of more than 45 characters the age stands in a field of 13, in one of 11 on firmware before G3.
std::string sensor_line(const SensorValue& sensor, Firmware firmware = Firmware::g3);
std::string waypoint_line(const WaypointReport& waypoint);
std::string because_line(const std::string& reason, const std::string& behavior, double start_when);
std::string mission_line(const Report& report);
std::string devices_line(const int (&errs)[3], const int (&warn)[3], const int (&odd)[3]);
/// One line, or seven when something was aborted.
std::string abort_lines(const Report& report);
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
/// `s *.sbd *.tbd`: files come from the glider. The names are those of the log in hand, compressed ones on G3.
std::vector<std::string> science_files(const Report& report);
std::string science_starts(const std::string& file, const std::string& glider, std::size_t bytes);
std::string science_ends(const std::string& file, std::size_t bytes);
/// A block of the dockserver, as it falls into the middle of a glider's line: nothing was to be sent.
std::string dockserver_block();
/// A key that nobody expected: ('CR') and two others that take turns by `which`.
std::string wrong_key(int which);
/// `H n`: the glider hangs up and calls again in n minutes.
std::string hangs_up(double mission_s, const std::string& behavior, int minutes);
/// A line of the kind that each generation prints between others when it likes.
std::string chatter(const Report& report);
/// Ctrl-F was pressed: the mafiles are read again.
std::string reread(double mission_s, const std::string& behavior);
/// The re-read brought a behaviour into its error state: the mission is over.
std::string behaviour_error(double mission_s, const std::string& reason);
/// The end of the keystroke window, by Ctrl-R or by time, down to the silence of the dive.
std::string resuming(const Report& report, bool by_key);

}  // namespace dialog
}  // namespace glidehelm::simulator
