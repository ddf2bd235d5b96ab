#include "simulator/dockserver/dialog_writer.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>

namespace glidehelm::simulator::dialog {
namespace {

constexpr const char* kEol = "\r\n";
constexpr double kNever = 1e308;
constexpr double kUnset = 69696969;

// All formats are literals of this file, so the compiler has checked them against their arguments.
__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...) {
  std::array<char, 512> buffer{};
  va_list arguments;
  va_start(arguments, format);
  const int n = std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
  va_end(arguments);
  return {buffer.data(), n < 0 ? 0U : std::min(static_cast<std::size_t>(n), buffer.size() - 1)};
}

int whole(double seconds) { return static_cast<int>(std::floor(seconds)); }

struct Civil {
  int year, month, day, hour, minute, second, week_day, day_of_year;
};

Civil civil(double clock_s) {
  using namespace std::chrono;
  const sys_seconds t{seconds{static_cast<std::int64_t>(std::floor(clock_s))}};
  const auto day = floor<days>(t);
  const year_month_day date{day};
  const hh_mm_ss time{t - day};
  const auto of_year = (day - sys_days{date.year() / January / 1}).count();
  return {static_cast<int>(date.year()),
          static_cast<int>(static_cast<unsigned>(date.month())),
          static_cast<int>(static_cast<unsigned>(date.day())),
          static_cast<int>(time.hours().count()),
          static_cast<int>(time.minutes().count()),
          static_cast<int>(time.seconds().count()),
          static_cast<int>(weekday{day}.c_encoding()),
          static_cast<int>(of_year)};
}

std::string position_line(const char* label, const std::optional<GeoPoint>& p, std::optional<double> age_s) {
  if (!p) return location_line(label, kUnset, kUnset, std::nullopt);
  return location_line(label, ddmm(p->lat.degrees(), 3), ddmm(p->lon.degrees(), 3), age_s);
}

std::string where_and_sensors(const Report& r) {
  std::string s = "Vehicle Name: " + r.glider + kEol + curr_time_line(r.clock_s, r.mission_s);
  s += position_line("DR  Location:", r.dr, r.dr_age_s);
  s += position_line("GPS TooFar:", std::nullopt, std::nullopt);
  s += position_line("GPS Invalid :", r.invalid, std::nullopt);
  s += position_line("GPS Location:", r.gps, r.gps_age_s);
  for (const auto& sensor : r.sensors) s += sensor_line(sensor, r.firmware);
  return s;
}

/// DOS names in capitals before G3.
std::string file_name(const std::string& name, Firmware firmware) {
  std::string shown = name;
  if (firmware != Firmware::g3)
    for (char& c : shown)
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return shown;
}

std::string log_name(const Report& r, int segment, const char* compressed, const char* plain) {
  return text("%04d%04d.%s", r.mission_number, segment, r.firmware == Firmware::g3 ? compressed : plain);
}

std::string block_of(const std::string& command) {
  return "<dockserver command=\"" + command + "\">" + kEol + " not found>*<" + kEol +
         "[dockzr | dockszr] [?][-v N][-nosmartdir][-f rf | irid][-cd dir][-noremove] [-archive]" + kEol +
         "  [-d <path1>] <file11> <file12> ... <file1N>" + kEol +
         "  [[-d <path2> <file21> <file22> ... <file2N>] ... ]" + kEol + "</dockserver>";
}

}  // namespace

double ddmm(double degrees, int decimals) {
  const double unit = decimals == 3 ? 1e3 : 1e4;
  const auto minutes = static_cast<std::int64_t>(std::llround(std::fabs(degrees) * 60.0 * unit));
  const auto per_degree = static_cast<std::int64_t>(60 * unit);
  const double size =
      static_cast<double>(minutes / per_degree * static_cast<std::int64_t>(100 * unit) + minutes % per_degree) / unit;
  return degrees < 0 ? -size : size;
}

std::string curr_time_line(double clock_s, double mission_s) {
  static constexpr std::array<const char*, 7> kDays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  static constexpr std::array<const char*, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                       "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const auto c = civil(clock_s);
  return text("Curr Time: %s %s %2d %02d:%02d:%02d %d MT: %7d", kDays[static_cast<std::size_t>(c.week_day)],
              kMonths[static_cast<std::size_t>(c.month - 1)], c.day, c.hour, c.minute, c.second, c.year,
              whole(mission_s)) +
         kEol;
}

std::string location_line(const char* label, double lat, double lon, std::optional<double> age_s) {
  return text("%-13s %9.3f N %9.3f E measured %10.6g secs ago", label, lat, lon, age_s.value_or(kNever)) + kEol;
}

std::string sensor_line(const SensorValue& sensor, Firmware firmware) {
  constexpr std::size_t kAgeEnds = 57, kLongHead = 45;
  const int behind_long = firmware == Firmware::g3 ? 13 : 11;
  const auto head = text("   sensor:%s(%s)=%.15g", sensor.name.c_str(), sensor.unit.c_str(), sensor.value);
  const auto width = head.size() > kLongHead ? behind_long : static_cast<int>(kAgeEnds - head.size());
  return head + text("%*.6g secs ago", width, sensor.age_s.value_or(kNever)) + kEol;
}

std::string waypoint_line(const WaypointReport& w) {
  const int age = whole(w.age_s);
  return text("Waypoint: (%.4f,%.4f) Range: %dm, Bearing: %ddeg, Age: %d:%dh:m", ddmm(w.at.lat.degrees(), 4),
              ddmm(w.at.lon.degrees(), 4), whole(w.range_m), whole(w.bearing_deg), age / 3600, age % 3600 / 60) +
         kEol;
}

std::string because_line(const std::string& reason, const std::string& behavior, double start_when) {
  return text("Because:%s [behavior %s start_when = %.1f]", reason.c_str(), behavior.c_str(), start_when) + kEol;
}

std::string mission_line(const Report& r) {
  const auto c = civil(r.mission_started_s);  // the day of the year counts from 0
  return text("MissionName:%s MissionNum:%s-%d-%03d-%d-%d (%04d.%04d)", file_name(r.mission_file, r.firmware).c_str(),
              r.glider.c_str(), c.year, c.day_of_year, r.mission_of_day, r.segment, r.mission_number, r.segment) +
         kEol;
}

std::string devices_line(const int (&e)[3], const int (&w)[3], const int (&o)[3]) {
  return text("devices:(t/m/s) errs: %3d/ %3d/ %3d warn: %3d/ %3d/ %3d odd: %3d/ %3d/ %3d", e[0], e[1], e[2], w[0],
              w[1], w[2], o[0], o[1], o[2]) +
         kEol;
}

std::string timed_line(double mission_s, const std::string& what) {
  return text("%6d    ", whole(mission_s)) + what + kEol;
}

std::string abort_lines(const Report& r) {
  const auto& a = r.aborts;
  const std::string head = "ABORT HISTORY: ";
  std::string s = head + text("total since reset: %d", a.total) + kEol;
  if (a.total == 0) return s;
  const auto c = civil(a.at_s);
  s += head + "last abort cause: " + a.cause + kEol + head + "last abort details: " + a.details + kEol;
  s += head +
       text("last abort time: %04d-%02d-%02dT%02d:%02d:%02d", c.year, c.month, c.day, c.hour, c.minute, c.second) +
       kEol;
  s += head + "last abort segment: " + r.glider +
       text("-%d-%03d-0-%d (%04d.%04d)", c.year, c.day_of_year, a.segment, a.mission_number, a.segment) + kEol;
  return s + head + "last abort mission: " + file_name(r.mission_file, r.firmware) + kEol;
}

std::string connection_block(const Report& r) {
  const bool modem = r.firmware == Firmware::g1;
  std::string s =
      modem ? std::string{kEol} + "NO CARRIER" + kEol + kEol + "RING" + kEol + kEol + "CONNECT 4800/ARQ/V32/LAPM" + kEol
            : std::string{"Connection Event: Carrier Detect found."};
  s += timed_line(r.mission_s, "Iridium console active and ready...") + where_and_sensors(r);
  if (modem) s += abort_lines(r);
  return s + timed_line(r.mission_s, "No login script found for processing.") + kEol + kEol + kEol + kEol;
}

std::string at_surface_block(const Report& r) {
  std::string s = "Glider " + r.glider + " at surface." + kEol + because_line(r.reason, r.behavior, r.start_when) +
                  mission_line(r) + where_and_sensors(r);
  s += devices_line({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
  s += abort_lines(r);
  for (const char* line :
       {"", "   Hit Control-R to RESUME the mission, i.e. dive!",
        "   Hit Control-C to END    the mission, i.e. GliderDos",
        "   Hit Control-E to extend surface time by 5 minutes.", "   Hit Control-W to get device warning reports.",
        r.firmware == Firmware::g1 ? "   Hit Control-F to re-read yo, goto_l, sample, drift_ mafiles."
                                   : "   Hit Control-F to re-read yo, goto_l, surface, sample, drift_ mafiles.",
        "   Hit H <n> <0:1> to Hangup and call back in <n> minutes at 0-primary 1-alternate number.",
        "   Hit S [-f={rf}|{irid] [-num=<n>] [-t=<s>] [filespec ...] to send log files",
        "   Hit ! <GliderDos cmd>  to execute <GliderDos cmd>",
        "   Hit Control-T to consci to science computer when comms ready:",
        "                                               ... communications ready for consci.", ""})
    s += std::string{line} + kEol;
  if (r.water_measured)
    s += r.water_final
             ? std::string{"Water Velocity Calculations COMPLETE"} + kEol
             : text("Water Velocity Calculations waiting for final gps fix(ideally %d secs)", whole(r.final_fix_in_s)) +
                   kEol;
  if (r.waypoint) s += waypoint_line(*r.waypoint);
  return s + text("Time until diving is: %d secs", whole(std::max(0.0, r.dives_in_s))) + kEol;
}

std::string nothing_to_send() { return std::string{"!dockzr *"} + kEol + block_of("!dockzr *") + kEol; }

std::string dockserver_block() { return block_of("dockzr -archive *"); }

std::string sending_starts(const std::string& file, const std::string& glider, std::size_t bytes) {
  return "Starting zModem transfer of " + file + " to/from " + glider + " size is " + std::to_string(bytes) + kEol;
}

std::string sending_ends(const std::string& file, std::size_t bytes) {
  std::string s;
  for (std::size_t sent = 1024; sent < bytes; sent += 1024)
    s += "Total Bytes sent/received: " + std::to_string(sent) + kEol;
  return s + "Total Bytes sent/received: " + std::to_string(bytes) + kEol + "zModem transfer DONE for file " + file +
         kEol + "deleting >" + file + "< Successful" + kEol;
}

std::vector<std::string> science_files(const Report& r) {
  return {log_name(r, r.segment, "scd", "sbd"), log_name(r, r.segment, "tcd", "tbd")};
}

std::string science_starts(const std::string& file, const std::string& glider, std::size_t bytes) {
  return "**B00000000000000" + std::string{kEol} + sending_starts(file, glider, bytes);
}

std::string science_ends(const std::string& file, std::size_t bytes) {
  std::string s = kEol;
  for (std::size_t got = 1024; got < bytes; got += 1024)
    s += "Total Bytes sent/received: " + std::to_string(got) + kEol;
  return s + "Total Bytes sent/received: " + std::to_string(bytes) + kEol + "zModem transfer DONE for file " + file +
         kEol;
}

std::string wrong_key(int which) {
  if (which % 3 == 0) return std::string{"I heard a character ('CR'), but not the right one"} + kEol;
  return text("I heard a keystroke ('%s'), but not the right one!", which % 3 == 1 ? "NUL" : "LF") + kEol;
}

std::string hangs_up(double mission_s, const std::string& behavior, int minutes) {
  return timed_line(mission_s, "behavior " + behavior + text(": ! succeeded:callback %d", minutes));
}

std::string chatter(const Report& r) {
  switch (r.firmware) {
    case Firmware::g1:
      return text("Megabytes used      on CF file system = %.6f", 20 + r.mission_s * 1e-5) + kEol;
    case Firmware::g2:
      return text("DRIVER_ODDITY:iridium:1801:xxx_ctrl() ran %.1f secs late", 1 + std::fmod(r.mission_s, 7)) + kEol;
    case Firmware::g3:
      break;
  }
  return text(":OOD:digifin_mgr_ctrl:OUT OF DEADBAND: M_FIN:%.4f C_FIN:0.0000",
              0.1 + std::fmod(r.mission_s, 10) * 0.01) +
         kEol;
}

std::string reread(double mission_s, const std::string& behavior) {
  return "^F" + timed_line(mission_s, "behavior " + behavior + ": MAFILES will be re-read");
}

std::string behaviour_error(double mission_s, const std::string& reason) {
  return timed_line(mission_s, "ERROR behavior goto_list: " + reason) +
         timed_line(mission_s, "behavior goto_list: STATE Active -> Error") +
         timed_line(mission_s, "Mission completed: MS_ABORT_BEH_ERROR(6)") + kEol + "GliderDos A 6 >";
}

std::string resuming(const Report& r, bool by_key) {
  const auto log = [&](int segment) { return log_name(r, segment, "mcg", "mlg"); };
  std::string s;
  if (by_key) {
    s += "^R" + timed_line(r.mission_s, "behavior " + r.behavior + ": User typed Control-R, resuming") + kEol + kEol;
    s += std::string{"   I heard a Control-R"} + kEol;
  } else {
    s += timed_line(r.mission_s, "behavior " + r.behavior + ": TIMED OUT WAITING FOR A CHARACTER");
  }
  s += std::string{"   RESUMING MISSION"} + kEol + kEol;
  s += timed_line(r.mission_s, log(r.segment) + " LOG FILE CLOSED");
  s += std::string{"Doing system wide housekeeping......."} + kEol;
  if (r.gps) {
    s += text("   m_lat(lat) %.6f", ddmm(r.gps->lat.degrees(), 4)) + kEol;
    s += text("   m_lon(lon) %.6f", ddmm(r.gps->lon.degrees(), 4)) + kEol;
  }
  s += std::string{"Housekeeping is done"} + kEol;
  s += timed_line(r.mission_s + 3, log(r.segment + 1) + " LOG FILE OPENED");
  s += timed_line(r.mission_s + 4, "behavior " + r.behavior + ": SUBSTATE 7 ->10 : Waiting for final gps fix");
  s += r.behavior + ": Waiting for final GPS fix." + kEol;
  return s + timed_line(r.mission_s + 8, "disabling Iridium console...");
}

}  // namespace glidehelm::simulator::dialog
