#include "protocol/dialog_lines.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/base/utc.hpp"
#include "tests/protocol/dialog_text.hpp"

using namespace glidehelm;
using namespace glidehelm::protocol;

namespace {

/// Behind the label, without the line end.
std::string rest_of(const std::string& line, const std::string& label) {
  const auto at = line.find(label);
  return line.substr(at + label.size(), line.find('\r') - at - label.size());
}
std::optional<Parsed<Location>> location(const std::string& line, const std::string& label = "GPS Location:") {
  return parse_location(rest_of(line, label), label.size());
}

}  // namespace

TEST_CASE("the four location lines are read as the firmware prints them") {
  for (const std::string label : {"DR  Location:", "GPS TooFar:", "GPS Invalid :", "GPS Location:"}) {
    const auto read = location(test::location_line(label.c_str(), 5949.127, -2317.927, 45.682), label);
    REQUIRE(read);
    CHECK(read->value == Location{"5949.127", "-2317.927", 'N', 'E', 45.682});
  }
  CHECK(location(test::gps_line(69696969, 69696969, 1e308))->value.age_s == 1e308);
  CHECK(location(test::gps_line(6127.509, 228.117, 40.584))->value.lon_text == "228.117");
  CHECK(location(test::gps_line(3310.021, -11741.8, 0.51))->value.lon_text == "-11741.800");
}

TEST_CASE("a location line that lost one byte anywhere is damaged") {
  for (const auto& line : {test::gps_line(5949.127, 2317.927, 45.682), test::gps_line(6127.509, 228.117, 145.5)}) {
    const auto rest = rest_of(line, "GPS Location:");
    for (std::size_t i = 0; i < rest.size(); ++i) {
      auto shorter = rest;
      shorter.erase(i, 1);
      INFO("without byte " << i << ": " << shorter);
      CHECK_FALSE(parse_location(shorter, 13));
    }
  }
}

TEST_CASE("a location line is damaged by every cut, and by words that are not its own") {
  const auto rest = rest_of(test::gps_line(5949.127, 2317.927, 45.682), "GPS Location:");
  for (std::size_t size = 0; size < rest.size(); ++size) CHECK_FALSE(parse_location(rest.substr(0, size), 13));
  CHECK_FALSE(parse_location(rest + "s", 13));
  CHECK_FALSE(parse_location(rest + "7", 13));
  CHECK(parse_location(rest + "GPS", 13));  // a lost line end glues the next label to it
  CHECK(parse_location(rest + "  ", 13));
  for (const std::string wrong : {"  59O9.127 N  2317.927 E measured     45.682 secs ago",
                                  "  5949.127 n  2317.927 E measured     45.682 secs ago",
                                  "  5949.127 N  2317.927 E measured       -e+1 secs ago",
                                  "  5949..27 N  2317.927 E measured     45.682 secs ago",
                                  "  5949.127 N  2317.927 E measured        nan secs ago",
                                  "  5949.127 N  2317.927 E measured        inf secs ago"})
    CHECK_FALSE(parse_location(wrong, 13));
}

TEST_CASE("times are read by a table of months and checked by the day of the week") {
  const auto read = [](const char* text) { return parse_curr_time(text); };
  const auto time = read(" Thu Nov  9 10:06:56 2023 MT:    3881");
  REQUIRE(time);
  CHECK(time->value.time.time_since_epoch().count() == 1699524416);  // date -u -d '2023-11-09 10:06:56' +%s
  CHECK(time->value.mission_time_s == 3881);
  CHECK(read(" Sat Feb 29 23:59:59 2020 MT:  263958"));
  CHECK_FALSE(read(" Fri Nov  9 10:06:56 2023 MT:    3881"));  // it was a Thursday
  CHECK_FALSE(read(" Thu Nov  8 10:06:56 2023 MT:    3881"));
  CHECK_FALSE(read(" Thu Nov  9 10:06:56 2022 MT:    3881"));
  CHECK_FALSE(read(" Thu Nov  9 24:06:56 2023 MT:    3881"));
  CHECK_FALSE(read(" Thu Nov  9 10:60:56 2023 MT:    3881"));
  CHECK_FALSE(read(" Thu Nov 9 10:06:56 2023 MT:    3881"));  // the day is padded to two
  CHECK_FALSE(read(" Wed Feb 30 10:06:56 2022 MT:    3881"));
  CHECK_FALSE(read(" Thu Nov  9 10:06:56 2023"));
  CHECK_FALSE(read(" Thu Nov  9 10:06:56 2023 MT:    38x"));
  CHECK_FALSE(read(" Do Nov  9 10:06:56 2023 MT:    3881"));
}

TEST_CASE("sensor lines of both firmware widths are read") {
  const auto read = [](const std::string& line) { return parse_sensor(rest_of(line, "sensor:"), 3); };
  CHECK(read(test::sensor_line("m_battery", "volts", 14.9021, 30.25))->value ==
        SensorReading{"m_battery", "volts", 14.9021, 30.25});
  CHECK(read(test::sensor_line("m_water_vx", "m/s", -0.036495223037396, 48.684))->value.value == -0.036495223037396);
  CHECK(read(test::sensor_line("u_use_current_correction", "nodim", 1, 1e308))->value.age_s == 1e308);
  for (const int width : {11, 13}) {
    const auto line = test::sensor_line("m_leakdetect_voltage_forward", "volts", 2.47625152625153, 5.011, width);
    CHECK(read(line)->value.value == 2.47625152625153);
  }
  CHECK(read(test::sensor_line("m_charge", "%", 99.5, 3.9))->value.unit == "%");
}

TEST_CASE("a sensor line that lost a byte before its age is damaged when its age stands in a column") {
  const auto rest = rest_of(test::sensor_line("m_water_vx", "m/s", -0.0364952, 48.684), "sensor:");
  for (std::size_t i = 0; i < rest.size(); ++i) {
    auto shorter = rest;
    shorter.erase(i, 1);
    CHECK_FALSE(parse_sensor(shorter, 3));
  }
  for (std::size_t size = 0; size < rest.size(); ++size) CHECK_FALSE(parse_sensor(rest.substr(0, size), 3));
  CHECK_FALSE(parse_sensor("m_x(m)=nan                                   1.5 secs ago", 3));
}

TEST_CASE("the waypoint line gives latitude first") {
  const auto read = parse_waypoint(" (6115.0000,-245.0000) Range: 27673m, Bearing: 149deg, Age: 14:52h:m");
  REQUIRE(read);
  CHECK(read->value == WaypointLine{"6115.0000", "-245.0000", 27673, 149});
  CHECK_FALSE(parse_waypoint(" (6115.0000,-245.0000) Range: 27673m, Bearing: 149deg, Age: 14:52h"));
  CHECK_FALSE(parse_waypoint(" (6115.0000,-245.0000) Range: 2767"));
  CHECK_FALSE(parse_waypoint(" (,) Range: 1m, Bearing: 1deg, Age: 1:1h:"));
}

TEST_CASE("reason, mission, devices, window and prompt lines are read") {
  CHECK(parse_because("Hit a waypoint [behavior surface_4 start_when = 8.0]")->value ==
        BecauseLine{"Hit a waypoint", "surface_4", 8.0});
  CHECK_FALSE(parse_because("pitch not commanded [behavior surface_4 start_when ="));
  CHECK_FALSE(parse_because(" [behavior surface_4 start_when = 8.0]"));
  CHECK(parse_mission("A_MER_27.MI MissionNum:rusalka-2012-200-1-2 (0273.0002)")->value ==
        MissionLine{"A_MER_27.MI", "rusalka-2012-200-1-2", "0273.0002"});
  CHECK_FALSE(parse_mission("A_MER_27.MI MissionNum:rusalka-2012-200-1-2 (0273.00"));
  CHECK_FALSE(parse_mission("A_MER_27.MI MissionNum:rusalka-2012-200-1-2 (0273.0002"));
  const auto devices = parse_devices(" errs:   0/   1/   2 warn:  34/   6/   1 odd: 277/  72/   4");
  REQUIRE(devices);
  CHECK(devices->value == DevicesLine{{0, 1, 2}, {34, 6, 1}, {277, 72, 4}});
  CHECK_FALSE(parse_devices(" errs:   0/   1/   2 warn:  34/"));
  CHECK(parse_until_diving(" 235 secs")->value == 235);
  CHECK(parse_until_diving(" 0 secs")->value == 0);
  CHECK_FALSE(parse_until_diving(" -5 secs"));
  CHECK_FALSE(parse_until_diving(" 23"));
  CHECK_FALSE(parse_until_diving(" 99999 secs"));  // longer than a day
  CHECK(parse_extension(" 5 minutes")->value == 300);
  CHECK_FALSE(parse_extension(" 0 minutes"));
  const auto prompt = parse_prompt("A 8 >dir");
  REQUIRE(prompt);
  CHECK((prompt->value.state == 'A' && prompt->value.code == 8 && prompt->used == 5));
  CHECK(parse_prompt("N -1 >")->value.code == -1);
  CHECK_FALSE(parse_prompt("cmd>  to execute"));
}

TEST_CASE("a vehicle name is a word of at most 32 letters, digits, dashes and underscores") {
  CHECK(vehicle_name(" Unit_1033 ") == "unit_1033");
  CHECK(vehicle_name("ru-29") == "ru-29");
  for (const std::string bad : {"", " ", "../x", "a b", "a/b", "_x", "-x", "k\xc3\xb6ln"})
    CHECK_FALSE(vehicle_name(bad));
  CHECK(vehicle_name(std::string(32, 'a')));
  CHECK_FALSE(vehicle_name(std::string(33, 'a')));
}
