#pragma once

#include <cstdio>
#include <string>

/// Dialog lines for tests, printed with the formats of slocum.md 1.2 and by nothing of protocol/.
namespace glidehelm::test {

inline std::string location_line(const char* label, double lat, double lon, double age_s) {
  char text[128];
  std::snprintf(text, sizeof text, "%-13s %9.3f N %9.3f E measured %10.6g secs ago\r\n", label, lat, lon, age_s);
  return text;
}

inline std::string gps_line(double lat, double lon, double age_s) {
  return location_line("GPS Location:", lat, lon, age_s);
}

inline std::string sensor_line(const char* name, const char* unit, double value, double age_s, int long_width = 13) {
  char head[160], text[256];
  const int n = std::snprintf(head, sizeof head, "   sensor:%s(%s)=%.15g", name, unit, value);
  std::snprintf(text, sizeof text, "%s%*.6g secs ago\r\n", head, n > 45 ? long_width : 57 - n, age_s);
  return text;
}

/// 3 May 2026 is a Sunday.
inline std::string time_line(const char* clock = "04:10:20", int mission_time = 9000) {
  char text[96];
  std::snprintf(text, sizeof text, "Curr Time: Sun May  3 %s 2026 MT: %7d\r\n", clock, mission_time);
  return text;
}

inline std::string console_line() {
  return "Connection Event: Carrier Detect found.  9000    Iridium console active and ready...\r\n";
}

inline std::string login_line() { return "  9000    No login script found for processing.\r\n"; }

/// A connection block with one fix, 29°01.25′ N 15°28.4′ W, 48.25 s old, and one sensor.
inline std::string connection_block(const std::string& glider = "alba") {
  return console_line() + "Vehicle Name: " + glider + "\r\n" + time_line() +
         location_line("DR  Location:", 2901.26, -1528.41, 46.5) +
         location_line("GPS TooFar:", 69696969, 69696969, 1e308) +
         location_line("GPS Invalid :", 2901.27, -1528.43, 136.25) + gps_line(2901.25, -1528.4, 48.25) +
         sensor_line("m_battery", "volts", 14.9021, 30.25) + login_line();
}

/// The at-surface block of the same fix, a quarter of a minute later.
inline std::string at_surface_block(const std::string& glider = "alba", int until_diving = 236) {
  return "\r\nGlider " + glider + " at surface.\r\n" +
         "Because:pitch not commanded [behavior surface_4 start_when = 2.0]\r\n" +
         "MissionName:CANARY.MI MissionNum:" + glider + "-2026-122-4-3 (0112.0003)\r\n" + "Vehicle Name: " + glider +
         "\r\n" + time_line("04:10:34", 9014) + gps_line(2901.25, -1528.4, 62.31) +
         sensor_line("m_water_vx", "m/s", -0.0415, 64.0) + sensor_line("m_water_vy", "m/s", 0.1172, 64.0) +
         "devices:(t/m/s) errs:   0/   0/   0 warn:   1/   0/   0 odd:   7/   2/   1\r\n" +
         "ABORT HISTORY: total since reset: 2\r\n\r\n" + "   Hit Control-R to RESUME the mission, i.e. dive!\r\n" +
         "   Hit ! <GliderDos cmd>  to execute <GliderDos cmd>\r\n\r\n" + "Water Velocity Calculations COMPLETE\r\n" +
         "Waypoint: (2910.5000,-1530.0000) Range: 17321m, Bearing: 352deg, Age: 1:4h:m\r\n" +
         "Time until diving is: " + std::to_string(until_diving) + " secs\r\n";
}

}  // namespace glidehelm::test
