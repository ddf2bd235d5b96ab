#include "core/base/utc.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;

TEST_CASE("a time is written in UTC with a Z and read back") {
  const auto t = utc_from_text("2026-11-25T10:20:30Z");
  REQUIRE(t);
  CHECK(utc_text(*t) == "2026-11-25T10:20:30Z");
  CHECK(utc_text(*t, true) == "2026-11-25T10:20:30.000Z");
  CHECK(epoch_seconds(*t) == 1795602030.0);
  CHECK(utc_text(*utc_from_text("1969-12-31 23:59:59.999"), true) == "1969-12-31T23:59:59.999Z");
  CHECK(utc_from_text("2024-02-29"));
}

TEST_CASE("what is no time is refused") {
  for (const char* text : {"", "2026", "2026-13-01", "2026-02-29", "2026-1-01", "2026-01-01T24:00", "2026-01-01T10:60",
                           "2026-01-01T10:20:60", "2026-01-01T10:20:30+01:00", "2026-01-01T10:20:30.",
                           "2026-01-01T10:20:30Zx", "01.01.2026"}) {
    CAPTURE(text);
    CHECK_FALSE(utc_from_text(text));
  }
}

TEST_CASE("instants and epoch seconds round to the millisecond on both sides of 1970") {
  for (const double s : {0.0, 1.7e9 + 0.123, -12.345, 1.7e9 + 0.9994})
    CHECK(std::abs(epoch_seconds(instant_at(s)) - s) <= 0.000501);
}
