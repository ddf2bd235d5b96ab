#include "config/yaml_reader/values.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "core/base/units.hpp"
#include "core/base/utc.hpp"

using namespace glidehelm;
using namespace glidehelm::config;

TEST_CASE("a printed number reads back to exactly the same quantity") {
  for (const double unit : {1.0, 60.0, 3600.0, 1000.0, kPi / 180})
    for (const double value :
         {26.0, 0.1, 1.0 / 3.0, 123456.789, 29.1667, -15.500000000000002, 1e-7, 9007199254740992.0}) {
      CAPTURE(unit, value);
      const double si = value * unit;
      CHECK(std::stod(yaml_number(si, unit)) * unit == si);
    }
  CHECK(yaml_number(26 * (kPi / 180), kPi / 180) == "26");
  CHECK(yaml_number(0.3) == "0.3");
}

TEST_CASE("texts are printed so that YAML reads them as texts") {
  for (const char* text :
       {"yes", "null", "7", "a: b", "a # b", "*.nc", "\"q\"", "back\\slash", "[x]", "line\nend", "plain-1", "/a/b.c"}) {
    CAPTURE(text);
    const auto document = read_yaml("k: " + yaml_text(text) + "\n", "f");
    REQUIRE(document.errors.empty());
    CHECK(document.root.find("k")->text == text);
    CHECK(
        (document.root.find("k")->quoted || std::string_view{text} == "plain-1" || std::string_view{text} == "/a/b.c"));
  }
}

TEST_CASE("the end of a key says the unit") {
  CHECK(unit_of("horizontal_speed_m_per_s") == "m/s");
  CHECK(unit_of("radius_m") == "m");
  CHECK(unit_of("cell_km") == "km");
  CHECK(unit_of("max_min") == "min");
  CHECK(unit_of("stint_h") == "h");
  CHECK(unit_of("lat_deg") == "°");
  CHECK(unit_of("budget_s") == "s");
  CHECK(unit_of("half_cycles").empty());
}

TEST_CASE("plain words that some YAML reads as a number are known") {
  for (const char* text : {"7", "-7", "+7", "007", "1.5", ".5", "5.", "1e5", "1.5E-3", "1_000", "0x1F", "0o17", "12:30",
                           "12:30:45.5", ".nan", "-.inf", ".Inf"}) {
    CAPTURE(text);
    CHECK(looks_like_number(text));
  }
  for (const char* text : {"", "-", ".", "a7", "7a", "1.2.3", "127.0.0.1:6500", "2026-11-25", "e5", "1e", "1e+", "nan",
                           "0x", "leg-2", ":7", "_7"}) {
    CAPTURE(text);
    CHECK_FALSE(looks_like_number(text));
  }
}

TEST_CASE("a range says what it takes in words") {
  Range range;
  CHECK(range.text().empty());
  range.low = 0;
  CHECK(range.text() == "from 0");
  range.low_open = true;
  CHECK(range.text() == "above 0");
  range.high = 100000;
  CHECK(range.text() == "above 0, up to 100000");
  CHECK_FALSE(range.contains(0));
  CHECK(range.contains(100000));
  range.low_open = false;
  CHECK(range.text() == "0 to 100000");
  CHECK(range.contains(0));
  CHECK_FALSE(range.contains(100000.1));
}

TEST_CASE("an error of a key that is not in the file stands at what is nearest around it") {
  Reading reading{"f"};
  reading.places[""] = {1, 1};
  reading.places["a"] = {2, 3};
  reading.places["a.b[1].c"] = {4, 5};
  CHECK(reading.place_of("a.b[1].c") == Place{4, 5});
  CHECK(reading.place_of("a.b[1].d") == Place{2, 3});
  CHECK(reading.place_of("x.y") == Place{1, 1});
}

TEST_CASE("times are printed in UTC, with milliseconds only when there are any") {
  CHECK(yaml_time(*utc_from_text("2026-11-25T10:20:30Z")) == "2026-11-25T10:20:30Z");
  CHECK(yaml_time(*utc_from_text("2026-11-25T10:20:30.25Z")) == "2026-11-25T10:20:30.250Z");
}
