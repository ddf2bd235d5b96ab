#include "core/base/azimuth.hpp"

#include <catch2/catch.hpp>
#include <type_traits>

using namespace glidehelm;

static_assert(!std::is_convertible_v<Heading, Course> && !std::is_constructible_v<Heading, Course>,
              "a course is never taken for a heading");
static_assert(!std::is_convertible_v<double, Metres>, "a bare number is no length");

TEST_CASE("azimuths run clockwise from north: east is the sine") {
  const auto east = Heading{degrees(90)};
  CHECK(east.east() == Approx(1));
  CHECK(east.north() == Approx(0).margin(1e-15));
  CHECK(Course::of(0, -1).degrees() == Approx(180));
  CHECK(Course::of(-1, 0).degrees() == Approx(270));
}

TEST_CASE("azimuths stay below a full turn and never negative, whatever comes in") {
  for (double a = -1000; a <= 1000; a += 0.37) {
    const double d = Heading{degrees(a)}.degrees();
    CHECK(d >= 0);
    CHECK(d < 360);
    CHECK(std::abs(std::remainder(d - a, 360)) < 1e-9);
  }
  CHECK(Heading{Radians{-1e-18}}.degrees() == 0);
}

TEST_CASE("a difference of azimuths is the short turn with its sign") {
  CHECK(in_degrees(Heading{degrees(10)} - Heading{degrees(350)}) == Approx(20));
  CHECK(in_degrees(Heading{degrees(350)} - Heading{degrees(10)}) == Approx(-20));
  CHECK(in_degrees(wrapped(degrees(-180))) == Approx(180));
}
