#include "core/base/geo.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace glidehelm;

TEST_CASE("the geodesic from New York to Singapore is the one printed in GeographicLib's manual") {
  // GeodSolve -i with 40:38:23N 073:46:44W 01:21:33N 103:59:22E prints 003:18:29.9 … 15347628.
  const auto jfk = geo_point(40 + 38 / 60.0 + 23 / 3600.0, -(73 + 46 / 60.0 + 44 / 3600.0));
  const auto sin = geo_point(1 + 21 / 60.0 + 33 / 3600.0, 103 + 59 / 60.0 + 22 / 3600.0);
  const auto line = geodesic(jfk, sin);
  CHECK(line.length.si() == Approx(15'347'628).margin(0.5));
  CHECK(line.departing.degrees() == Approx(3 + 18 / 60.0 + 29.9 / 3600.0).margin(0.05 / 3600.0));
}

TEST_CASE("direct and inverse undo each other") {
  for (const double lat : {-79.0, -20.0, 0.0, 51.5})
    for (double azimuth = 1; azimuth < 360; azimuth += 71) {
      const auto from = geo_point(lat, 179.5);
      const auto to = destination(from, Bearing{degrees(azimuth)}, Metres{123'456.0});
      const auto line = geodesic(from, to);
      CHECK(line.length.si() == Approx(123'456.0).epsilon(1e-12));
      CHECK(line.departing.degrees() == Approx(azimuth).epsilon(1e-9));
    }
}

TEST_CASE("the meridian quadrant has its published length") {
  CHECK(distance(geo_point(0, 0), geo_point(90, 0)).si() == Approx(10'001'965.729).margin(0.001));
}

TEST_CASE("coordinates out of range are refused with what was found and what is allowed") {
  const auto north = Latitude::from_degrees(91);
  REQUIRE_FALSE(north);
  CHECK(north.error().message() == "latitude 91 is out of range: allowed is -90 to 90 degrees");
  CHECK_FALSE(Latitude::from_degrees(std::numeric_limits<double>::quiet_NaN()));
  CHECK_FALSE(Longitude::from_degrees(std::numeric_limits<double>::infinity()));
  CHECK_FALSE(Longitude::from_degrees(361));
  CHECK_FALSE(GeoPoint::from_degrees(-90.0001, 0));
}

TEST_CASE("longitudes are kept in -180 to 180, 180 itself is -180") {
  CHECK(Longitude::from_degrees(180)->degrees() == -180);
  CHECK(Longitude::from_degrees(359.5)->degrees() == Approx(-0.5));
  CHECK(Longitude::from_degrees(-190)->degrees() == Approx(170));
  CHECK(Longitude::from_kernel(7 * kPi).radians() >= -kPi);
  CHECK(Longitude::from_kernel(7 * kPi).radians() < kPi);
}
