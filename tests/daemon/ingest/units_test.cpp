#include "daemon/ingest/units.hpp"

#include <catch2/catch.hpp>

#include "core/base/utc.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {
const Units& units() {
  static const auto loaded = Units::load();
  REQUIRE(loaded);
  return *loaded;
}
double speed(const std::string& unit) {
  const auto scaling = units().scaling(unit, "m/s");
  INFO(unit);
  REQUIRE(scaling);
  CHECK(scaling->intercept == 0);
  return scaling->slope;
}
double seconds(const std::string& unit, double value, const std::string& calendar = "") {
  const auto scaling = units().time_scaling(unit, calendar);
  INFO(unit);
  REQUIRE(scaling);
  return (*scaling)(value);
}
double utc(const char* text) { return epoch_seconds(*utc_from_text(text)); }
}  // namespace

TEST_CASE("speeds in every spelling that files use") {
  for (const char* unit : {"m/s", "m s-1", "m.s-1", "m s^-1", "meters s-1", "meter second-1", "meter/sec", " m s-1 "})
    CHECK(speed(unit) == 1);
  for (const char* unit : {"cm/s", "cm s-1"}) CHECK(speed(unit) == Approx(0.01).epsilon(1e-15));
  // The international knot is 1852 m per hour by definition.
  for (const char* unit : {"kn", "kt", "kts", "knot", "knots", "KN"})
    CHECK(speed(unit) == Approx(1852.0 / 3600).epsilon(1e-15));
  CHECK(speed("km/h") == Approx(1 / 3.6).epsilon(1e-15));
}

TEST_CASE("a unit that cannot be read, or measures something else, is a fault that names it") {
  CHECK(units().scaling("furlongs per whatever", "m/s").error().what ==
        "the unit \"furlongs per whatever\" cannot be read; allowed is any unit of UDUNITS that converts to m/s");
  CHECK(units().scaling("degC", "m/s").error().what == "the unit \"degC\" does not convert to m/s");
  CHECK_FALSE(units().scaling("1", "m/s"));
}

TEST_CASE("degrees of every kind are degrees") {
  for (const char* unit : {"degrees_north", "degree_east", "degrees", "deg", "degreeN", "degrees_E"}) {
    const auto scaling = units().scaling(unit, "degrees");
    INFO(unit);
    REQUIRE(scaling);
    CHECK(scaling->slope == 1);
  }
  CHECK(units().scaling("radians", "degrees")->slope == Approx(57.29577951308232).epsilon(1e-15));
}

TEST_CASE("times count from their epoch in their unit") {
  CHECK(seconds("seconds since 1970-01-01", 1.5e9) == 1.5e9);
  CHECK(seconds("hours since 1950-01-01", 543492) == utc("2012-01-01T12:00:00Z"));
  CHECK(seconds("days since 1900-1-1", 37255) == utc("2002-01-01"));
  CHECK(seconds("hours since 2023-02-25 12:00:00.000 UTC", 120) == utc("2023-03-02T12:00:00Z"));
  CHECK(seconds("days since 2000-12-31 00:00:00", 0.125) == utc("2000-12-31T03:00:00Z"));
  CHECK(seconds("minutes since 2020-02-28T23:00:00Z", 90) == utc("2020-02-29T00:30:00Z"));
}

TEST_CASE("the Gregorian calendars agree after 1582 and differ before, as CF says") {
  CHECK(seconds("days since 1858-11-17", 0, "standard") == utc("1858-11-17"));
  CHECK(seconds("days since 1858-11-17", 0, "proleptic_gregorian") == utc("1858-11-17"));
  // 1 January of year 1 is Julian day 1721423.5 in the mixed calendar and 1721425.5 in the proleptic one; the epoch of
  // 1970 is Julian day 2440587.5.
  CHECK(seconds("days since 1-1-1 00:00:00", 0, "gregorian") == Approx((1721423.5 - 2440587.5) * 86400).epsilon(1e-12));
  CHECK(seconds("days since 1-1-1 00:00:00", 0, "proleptic_gregorian") ==
        Approx((1721425.5 - 2440587.5) * 86400).epsilon(1e-12));
}

TEST_CASE("other calendars and unreadable time units are refused by name") {
  CHECK(units().time_scaling("days since 1950-01-01", "360_day").error().what ==
        "the calendar \"360_day\"; allowed are standard, gregorian and proleptic_gregorian");
  CHECK_FALSE(units().time_scaling("days since 1950-01-01", "noleap"));
  CHECK_FALSE(units().time_scaling("days since yesterday", ""));
  CHECK_FALSE(units().time_scaling("m since 1950-01-01", ""));
}
