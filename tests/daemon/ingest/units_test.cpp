#include "daemon/ingest/units.hpp"

#include <catch2/catch.hpp>
#include <cmath>

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
  const std::string allowed = "; allowed are standard, gregorian, proleptic_gregorian, julian, noleap and 365_day";
  for (const char* calendar : {"360_day", "all_leap", "366_day"})
    CHECK(units().time_scaling("days since 1950-01-01", calendar).error().what ==
          "the calendar \"" + std::string{calendar} + "\" has days that never were" + allowed);
  for (const char* calendar : {"utc", "TAI"})
    CHECK(units().time_scaling("days since 1950-01-01", calendar).error().what ==
          "the calendar \"" + std::string{calendar} + "\" counts leap seconds" + allowed);
  CHECK(units().time_scaling("days since 1950-01-01", "lunar").error().what == "the calendar \"lunar\"" + allowed);
  CHECK_FALSE(units().time_scaling("days since yesterday", ""));
  CHECK_FALSE(units().time_scaling("m since 1950-01-01", ""));
}

TEST_CASE("malformed speeds are read as what they mean") {
  for (const char* unit : {"mps", "ms-1", "M/S", "Meters/Second"}) CHECK(speed(unit) == 1);
  CHECK(speed("CM/S") == Approx(0.01).epsilon(1e-15));
}

TEST_CASE("malformed time units are read as what they mean") {
  const double six = utc("2020-01-15T06:00:00Z");
  for (const char* unit : {"hrs since 2020/01/15", "Hours Since 2020-1-15", "HOURS SINCE 2020-01-15 00:00:00 UTC",
                           "h since 20200115", "hours since 2020-01-15_00:00:00", "hours after 2020-01-15",
                           "hours from 2020-01-15T00:00:00Z", "hours ref 2020-01-15 0:0:0.0", "hours @ 2020-01-15",
                           "hours since 2020-01-15 00:00:00 +0000", "hours  since  2020-01-15"})
    CHECK(seconds(unit, 6) == six);
  CHECK(seconds("hours since 2020-01-15 00:00:00 -6:00", 0) == six);
  CHECK(seconds("seconds since 2020-01-15T06", 0) == six);
  CHECK(seconds("fortnights since 2020-01-01", 1) == utc("2020-01-15"));
  CHECK(seconds("msec since 2020-01-15", 21.6e6) == six);
}

TEST_CASE("times that are written as dates or as Julian days are read") {
  CHECK(seconds("day as %Y%m%d.%f", 20200115.25) == utc("2020-01-15T06:00:00Z"));
  CHECK(std::isnan(seconds("day as %Y%m%d.%f", 20200231)));
  CHECK(std::isnan(seconds("day as %Y%m%d.%f", 115)));
  // 2000-01-01 00:00 is modified Julian day 51544 and Julian day 2451544.5.
  CHECK(seconds("modified Julian day", 51544) == utc("2000-01-01"));
  CHECK(seconds("Julian day", 2451544.5) == utc("2000-01-01"));
  CHECK(names_epoch("modified Julian day"));
  CHECK(names_epoch("days since 2000-01-01"));
  CHECK_FALSE(names_epoch("days"));
  CHECK(counts_in_months("months since 2000-01-01"));
  CHECK_FALSE(counts_in_months("days since 2000-01-01"));
}

TEST_CASE("a calendar without leap days names real dates, and Julian dates are real days") {
  // 365 days after 1 January are 1 January again; day 59 is 1 March in every year.
  CHECK(seconds("days since 2020-01-01", 59, "noleap") == utc("2020-03-01"));
  CHECK(seconds("days since 2020-01-01", 365, "365_day") == utc("2021-01-01"));
  CHECK(seconds("days since 2000-01-01", 365 * 24 + 30.5, "noleap") == utc("2024-01-31T12:00:00Z"));
  CHECK(seconds("days since 1950-01-01", 365 * 74 + 58, "noleap") == utc("2024-02-28"));
  CHECK(seconds("hours since 1980-03-01 06:00", -6, "noleap") == utc("1980-03-01"));
  CHECK(seconds("days since 1980-03-01", -1, "noleap") == utc("1980-02-28"));
  CHECK(seconds("days since 1969-12-31", 0, "noleap") == utc("1969-12-31"));
  // 1 January 2024 of the Julian calendar is 14 January; 29 February 1900 exists only there and is 13 March.
  CHECK(seconds("days since 2024-01-01", 0, "julian") == utc("2024-01-14"));
  CHECK(seconds("days since 1900-02-29", 0, "julian") == utc("1900-03-13"));
  CHECK_FALSE(units().time_scaling("days since 1900-02-29", "standard"));
}

TEST_CASE("epochs that UDUNITS reads as something else are refused") {
  const auto why = [](const std::string& unit, const std::string& calendar = "") {
    const auto scaling = units().time_scaling(unit, calendar);
    REQUIRE_FALSE(scaling);
    return scaling.error().what;
  };
  const std::string allowed = "; allowed is like \"hours since 1950-01-01 00:00:00\"";
  for (const char* date : {"1-1-1970", "15-01-2020", "01/15/2020", "2020-13-01", "2020-02-30", "2020-00-10"}) {
    const std::string unit = "days since " + std::string{date};
    INFO(unit);
    const auto said = why(unit);
    CHECK((said == "the time unit \"" + unit + "\" cannot be read" + allowed ||
           said == "the time unit \"" + unit + "\" counts from a date that does not exist" + allowed));
  }
  CHECK(why("days since 0000-01-01") ==
        "the time unit \"days since 0000-01-01\" counts from the year 0, which its calendar does not have" + allowed);
  // The proleptic calendar has that year: 719528 days before 1970, by 400-year cycles of 146097 days.
  CHECK(seconds("days since 0000-01-01", 719528, "proleptic_gregorian") == Approx(0).margin(1e-3));
  CHECK_FALSE(units().time_scaling("hours since 2020-01-15 25:00:00", ""));
}
