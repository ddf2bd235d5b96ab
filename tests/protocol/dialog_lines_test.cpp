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
    const auto read = location(test::location_line(label.c_str(), 2901.250, -1528.407, 48.253), label);
    REQUIRE(read);
    CHECK(read->value == Location{"2901.250", "-1528.407", 'N', 'E', 48.253});
  }
  CHECK(location(test::gps_line(69696969, 69696969, 1e308))->value.age_s == 1e308);
  CHECK(location(test::gps_line(3712.004, 231.409, 37.125))->value.lon_text == "231.409");
  CHECK(location(test::gps_line(2812.005, -17033.6, 0.75))->value.lon_text == "-17033.600");
}

TEST_CASE("a location line that lost one byte anywhere is damaged") {
  for (const auto& line : {test::gps_line(2901.250, 1528.407, 48.253), test::gps_line(3712.004, 231.409, 145.5)}) {
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
  const auto rest = rest_of(test::gps_line(2901.250, 1528.407, 48.253), "GPS Location:");
  for (std::size_t size = 0; size < rest.size(); ++size) CHECK_FALSE(parse_location(rest.substr(0, size), 13));
  CHECK_FALSE(parse_location(rest + "s", 13));
  CHECK_FALSE(parse_location(rest + "7", 13));
  CHECK(parse_location(rest + "GPS", 13));  // a lost line end glues the next label to it
  CHECK(parse_location(rest + "  ", 13));
  for (const std::string wrong : {"  29O1.250 N  1528.407 E measured     48.253 secs ago",
                                  "  2901.250 n  1528.407 E measured     48.253 secs ago",
                                  "  2901.250 N  1528.407 E measured       -e+1 secs ago",
                                  "  2901..50 N  1528.407 E measured     48.253 secs ago",
                                  "  2901.250 N  1528.407 E measured        nan secs ago",
                                  "  2901.250 N  1528.407 E measured        inf secs ago"})
    CHECK_FALSE(parse_location(wrong, 13));
}

TEST_CASE("times are read by a table of months and checked by the day of the week") {
  const auto read = [](const char* text) { return parse_curr_time(text); };
  const auto time = read(" Wed Jun  3 17:45:08 2026 MT:    7207");
  REQUIRE(time);
  CHECK(time->value.time.time_since_epoch().count() == 1780508708);  // date -u -d '2026-06-03 17:45:08' +%s
  CHECK(time->value.mission_time_s == 7207);
  CHECK(read(" Sat Feb 29 23:59:59 2020 MT:  150300"));
  CHECK_FALSE(read(" Thu Jun  3 17:45:08 2026 MT:    7207"));  // it was a Wednesday
  CHECK_FALSE(read(" Wed Jun  2 17:45:08 2026 MT:    7207"));
  CHECK_FALSE(read(" Wed Jun  3 17:45:08 2025 MT:    7207"));
  CHECK_FALSE(read(" Wed Jun  3 24:45:08 2026 MT:    7207"));
  CHECK_FALSE(read(" Wed Jun  3 17:60:08 2026 MT:    7207"));
  CHECK_FALSE(read(" Wed Jun 3 17:45:08 2026 MT:    7207"));  // the day is padded to two
  CHECK_FALSE(read(" Wed Feb 30 17:45:08 2022 MT:    7207"));
  CHECK_FALSE(read(" Wed Jun  3 17:45:08 2026"));
  CHECK_FALSE(read(" Wed Jun  3 17:45:08 2026 MT:    72x"));
  CHECK_FALSE(read(" Mi Jun  3 17:45:08 2026 MT:    7207"));
  CHECK(read(" Wed Jun  3 17:45:08 2026 MT: 12345678"));  // a field only has a least width
}

TEST_CASE("a time that lost one byte anywhere is damaged") {
  const std::string rest = " Wed Jun  3 17:45:08 2026 MT:    7207";
  REQUIRE(parse_curr_time(rest));
  for (std::size_t i = 0; i < rest.size(); ++i) {
    auto shorter = rest;
    shorter.erase(i, 1);
    INFO("without byte " << i);
    CHECK_FALSE(parse_curr_time(shorter));
  }
}

TEST_CASE("sensor lines of both firmware widths are read") {
  const auto read = [](const std::string& line) { return parse_sensor(rest_of(line, "sensor:"), 3); };
  CHECK(read(test::sensor_line("m_battery", "volts", 14.9021, 30.25))->value ==
        SensorReading{"m_battery", "volts", 14.9021, 30.25});
  CHECK(read(test::sensor_line("m_water_vx", "m/s", -0.041507311923804, 50.312))->value.value == -0.041507311923804);
  CHECK(read(test::sensor_line("u_use_current_correction", "nodim", 1, 1e308))->value.age_s == 1e308);
  for (const int width : {11, 13}) {
    const auto line = test::sensor_line("m_leakdetect_voltage_forward", "volts", 2.51318181818182, 6.104, width);
    CHECK(read(line)->value.value == 2.51318181818182);
  }
  CHECK(read(test::sensor_line("m_charge", "%", 99.5, 3.9))->value.unit == "%");
  CHECK_FALSE(read(test::sensor_line("m_leakdetect_voltage_forward", "volts", 2.51318181818182, 6.104, 12)));
}

TEST_CASE("a sensor line that lost a byte before its age is damaged when its age stands in a column") {
  const auto rest = rest_of(test::sensor_line("m_water_vx", "m/s", -0.0415073, 50.312), "sensor:");
  for (std::size_t i = 0; i < rest.size(); ++i) {
    auto shorter = rest;
    shorter.erase(i, 1);
    CHECK_FALSE(parse_sensor(shorter, 3));
  }
  for (std::size_t size = 0; size < rest.size(); ++size) CHECK_FALSE(parse_sensor(rest.substr(0, size), 3));
  CHECK_FALSE(parse_sensor("m_x(m)=nan                                   1.5 secs ago", 3));
}

TEST_CASE("the waypoint line gives latitude first") {
  const auto read = parse_waypoint(" (3715.0000,-230.0000) Range: 18204m, Bearing: 131deg, Age: 12:07h:m");
  REQUIRE(read);
  CHECK(read->value == WaypointLine{"3715.0000", "-230.0000", 18204, 131, 727});
  CHECK_FALSE(parse_waypoint(" (3715.0000,-230.0000) Range: 18204m, Bearing: 131deg, Age: 12:07h"));
  CHECK_FALSE(parse_waypoint(" (3715.0000,-230.0000) Range: 1820"));
  CHECK_FALSE(parse_waypoint(" (,) Range: 1m, Bearing: 1deg, Age: 1:1h:"));
  // A coordinate that lost one of its four decimals, or its point.
  CHECK_FALSE(parse_waypoint(" (3715.000,-230.0000) Range: 18204m, Bearing: 131deg, Age: 12:07h:m"));
  CHECK_FALSE(parse_waypoint(" (3715.0000,-2300000) Range: 18204m, Bearing: 131deg, Age: 12:07h:m"));
  CHECK_FALSE(parse_waypoint(" (3715.0000,-23e.0000) Range: 18204m, Bearing: 131deg, Age: 12:07h:m"));
  CHECK(parse_waypoint(" (3715.0000,-230.0000) Range: 1m, Bearing: 1deg, Age: 999999999:999999999h:m"));
}

TEST_CASE("reason, mission, devices, window and prompt lines are read") {
  CHECK(parse_because("Hit a waypoint [behavior surface_4 start_when = 8.0]")->value ==
        BecauseLine{"Hit a waypoint", "surface_4", 8.0});
  CHECK_FALSE(parse_because("pitch not commanded [behavior surface_4 start_when ="));
  CHECK_FALSE(parse_because(" [behavior surface_4 start_when = 8.0]"));
  CHECK(parse_mission("A_EAST_2.MI MissionNum:calma-2026-122-1-2 (0281.0002)")->value ==
        MissionLine{"A_EAST_2.MI", "calma-2026-122-1-2", "0281.0002"});
  CHECK_FALSE(parse_mission("A_EAST_2.MI MissionNum:calma-2026-122-1-2 (0281.00"));
  CHECK_FALSE(parse_mission("A_EAST_2.MI MissionNum:calma-2026-122-1-2 (0281.0002"));
  const auto devices = parse_devices(" errs:   0/   1/   2 warn:  21/   5/   3 odd: 140/  60/   9");
  REQUIRE(devices);
  CHECK(devices->value == DevicesLine{{0, 1, 2}, {21, 5, 3}, {140, 60, 9}});
  CHECK_FALSE(parse_devices(" errs:   0/   1/   2 warn:  21/"));
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
  CHECK(vehicle_name(" Unit_2044 ") == "unit_2044");
  CHECK(vehicle_name("ab-29") == "ab-29");
  for (const std::string bad : {"", " ", "../x", "a b", "a/b", "_x", "-x", "k\xc3\xb6ln"})
    CHECK_FALSE(vehicle_name(bad));
  CHECK(vehicle_name(std::string(32, 'a')));
  CHECK_FALSE(vehicle_name(std::string(33, 'a')));
}
