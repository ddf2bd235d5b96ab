#include "protocol/latlon.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace glidehelm;
using namespace glidehelm::protocol;

namespace {

double lat(const char* text) { return degrees_from_ddmm(text, Axis::latitude).value(); }
double lon(const char* text) { return degrees_from_ddmm(text, Axis::longitude).value(); }
NoCoordinate::Why why(const char* text, Axis axis = Axis::latitude) {
  return degrees_from_ddmm(text, axis).error().why;
}
std::string written(double deg) { return ddmm(Latitude::from_degrees(deg).value()); }

}  // namespace

TEST_CASE("degrees and minutes are told by arithmetic, not by counting digits") {
  // One division and one addition of exact integers: half a unit in the last place of 180 is 1.4e-14.
  constexpr double kExact = 3e-14;
  CHECK(std::abs(lat("2901.257") - (29 + 1.257 / 60)) < kExact);
  CHECK(std::abs(lon("-17033.600") - -(170 + 33.6 / 60)) < kExact);
  CHECK(std::abs(lon("801") - (8 + 1.0 / 60)) < kExact);
  CHECK(std::abs(lat("5400") - 54) < kExact);
  CHECK(std::abs(lon("054.00") - 54.0 / 60) < kExact);
  CHECK(std::abs(lon("231.409") - (2 + 31.409 / 60)) < kExact);
  CHECK(std::abs(lon("-07300.0") - -73) < kExact);
  CHECK(std::abs(lon("+0030.25") - 30.25 / 60) < kExact);
  CHECK(std::abs(lat("3117.6204") - (31 + 17.6204 / 60)) < kExact);
  CHECK(lon("5") == 5.0 / 60);
  CHECK(lat("9000") == 90);
  CHECK(lon("-18000.000") == -180);
}

TEST_CASE("the sign survives at zero degrees") {
  CHECK(lat("-0030.5") == -30.5 / 60);
  CHECK(written(-30.5 / 60) == "-30.5000");
  CHECK(std::signbit(lat("-0000.0001")));
  CHECK(written(lat("-0.0001")) == "-0.0001");
  CHECK(written(-0.0) == "0.0000");
  CHECK(written(-1e-9) == "0.0000");  // 0.6e-7 minute rounds to nothing, and nothing has no sign
}

TEST_CASE("59.99996 minutes carry into the next degree") {
  CHECK(written(12 + 59.99996 / 60) == "1300.0000");
  CHECK(written(-(12 + 59.99996 / 60)) == "-1300.0000");
  CHECK(written(12 + 59.99994 / 60) == "1259.9999");
  CHECK(written(89 + 59.99996 / 60) == "9000.0000");
  CHECK(ddmm_from_units(kUnitsPerDegree - 1) == "59.9999");
  CHECK(ddmm_from_units(-180 * kUnitsPerDegree) == "-18000.0000");
}

TEST_CASE("every unit near a whole degree is written and read back to itself") {
  for (const std::int64_t degree : {-180, -90, -73, -1, 0, 1, 59, 89, 90, 117, 180})
    for (std::int64_t offset = -1500; offset <= 1500; ++offset) {
      const std::int64_t units = degree * kUnitsPerDegree + offset;
      if (std::abs(units) > 180 * kUnitsPerDegree) continue;
      const auto text = ddmm_from_units(units);
      const auto back = degrees_from_ddmm(text, Axis::longitude);
      REQUIRE(back);
      REQUIRE(minute_units(*back) == units);
    }
}

TEST_CASE("what is no coordinate is refused with its reason") {
  using enum NoCoordinate::Why;
  CHECK(why("69696969.000") == sentinel);
  CHECK(why("-69696969") == sentinel);
  CHECK(why("9000000") == sentinel);
  CHECK(why("99999999999999999999999999") == sentinel);
  CHECK(why("5960.000") == minutes);
  CHECK(why("-0099.9", Axis::longitude) == minutes);
  CHECK(degrees_from_ddmm("5959.999999999", Axis::latitude).has_value());
  CHECK(why("9000.001") == range);
  CHECK(why("-18000.0001", Axis::longitude) == range);
  CHECK(why("17033.6") == range);
  CHECK(why("2901257") == range);
  for (const char* text : {"", "-", "+", ".5", "2901.", "59..1", "59.1.2", "1e3", "0x10", " 2901.1", "2901.1 ", "nan",
                           "inf", "--5", "2901,257", "59O1.2"})
    CHECK(why(text) == not_a_number);
}

TEST_CASE("a refusal says what was found and what is wrong with it") {
  CHECK(degrees_from_ddmm("5960.000", Axis::latitude).error().message() ==
        "latitude '5960.000' has 60 minutes or more");
  CHECK(degrees_from_ddmm("18000.1", Axis::longitude).error().message() == "longitude '18000.1' is beyond 180 degrees");
  CHECK(degrees_from_ddmm("69696969.000", Axis::latitude).error().message() ==
        "latitude '69696969.000' means that the glider never had one");
}

TEST_CASE("the dialog prints coordinates with exactly three decimals") {
  for (const char* text : {"2901.257", "-17033.600", "0.000", "231.409", "69696969.000"})
    CHECK(is_dialog_coordinate(text));
  for (const char* text : {"2901.12", "2901.2570", "2901", ".127", "+2901.257", "2901.1a7", "59.9.127", "-.127", "",
                           "02901.257", "-00.500"})
    CHECK_FALSE(is_dialog_coordinate(text));
}

TEST_CASE("latitudes and longitudes come out as types") {
  CHECK(std::abs(latitude_from_ddmm("-3330.000").value().degrees() + 33.5) < 1e-13);
  CHECK(std::abs(longitude_from_ddmm("-17030.000").value().degrees() + 170.5) < 1e-13);
  CHECK(ddmm(longitude_from_ddmm("-17030.2607").value()) == "-17030.2607");
  CHECK_FALSE(latitude_from_ddmm("11730.0"));
  CHECK_FALSE(longitude_from_ddmm("x"));
}
