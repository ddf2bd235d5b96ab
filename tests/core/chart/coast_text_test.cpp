#include <catch2/catch.hpp>

#include "core/base/hash.hpp"
#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

namespace {

std::shared_ptr<const Coast> islands() {
  const auto area = area_of(178, 182, -19, -15);
  auto corner = ring_of(area, {{178, -19}, {178.5, -19}, {178.5, -18.5}, {178, -18.5}});
  corner.cut = {true, false, false, true};
  return Coast::make(area, "drawn by a test", {ring_of(area, box_of(179.8, 180.3, -17.2, -16.8)), corner}).value();
}

/// The body with the right last line for the given counts.
std::string sealed(const std::string& body, std::size_t rings, std::size_t points) {
  char hex[12];
  std::snprintf(hex, sizeof hex, "%08x", static_cast<unsigned>(crc32c(body)));
  return body + "end " + std::to_string(rings) + " " + std::to_string(points) + " crc32c " + hex + "\n";
}

const std::string kHead =
    "# glidehelm coast v1\n"
    "area 178.0000000 182.0000000 -19.0000000 -15.0000000\n"
    "source drawn by a test\n";

CoastError error_of(const std::string& bytes) {
  const auto coast = Coast::parse(bytes);
  REQUIRE_FALSE(coast);
  return coast.error();
}

}  // namespace

TEST_CASE("a coast file reads as documented") {
  CHECK(islands()->text() == sealed(kHead + "ring 4\n"
                                            "179.8000000 -17.2000000\n"
                                            "180.3000000 -17.2000000\n"
                                            "180.3000000 -16.8000000\n"
                                            "179.8000000 -16.8000000\n"
                                            "ring 4\n"
                                            "178.0000000 -19.0000000 cut\n"
                                            "178.5000000 -19.0000000\n"
                                            "178.5000000 -18.5000000\n"
                                            "178.0000000 -18.5000000 cut\n",
                                    2, 8));
}

TEST_CASE("text and back is the same coast, byte for byte") {
  std::mt19937_64 random{3};
  const auto area = area_of(-0.5, 0.5, -0.5, 0.5);
  std::vector<LonLat> rings;
  for (int k = 0; k < 20; ++k) rings.push_back(star(0, 0, 0.02 * (k + 1), 50, random));
  for (const auto& coast : {islands(), coast_of(area, rings), Coast::make(area, "nothing but water", {}).value()}) {
    const auto text = coast->text();
    const auto again = Coast::parse(text);
    REQUIRE(again);
    CHECK((*again)->area() == coast->area());
    CHECK((*again)->source() == coast->source());
    CHECK((*again)->rings() == coast->rings());
    CHECK((*again)->text() == text);
  }
}

TEST_CASE("a file cut off anywhere is refused") {
  const auto text = islands()->text();
  for (std::size_t size = 0; size < text.size(); ++size) CHECK_FALSE(Coast::parse(text.substr(0, size)));
  const auto error = error_of(text.substr(0, text.size() - 40));
  CHECK(error.message() == "line 13: the last line does not begin with \"end\": the file is cut off");
}

TEST_CASE("a file with one byte changed is refused, wherever") {
  const auto text = islands()->text();
  for (std::size_t at = 0; at < text.size(); ++at)
    for (const char c : {'0', '9', '\n', ' ', 'x', '\0', '\xff'}) {
      if (text[at] == c) continue;
      auto changed = text;
      changed[at] = c;
      INFO("byte " << at << " to " << static_cast<int>(c));
      CHECK_FALSE(Coast::parse(changed));
    }
  CHECK_FALSE(Coast::parse(text + "\n"));
  CHECK_FALSE(Coast::parse(text + text));
}

TEST_CASE("what is no coast file is refused with place and reason") {
  struct Case {
    std::string body;
    std::size_t rings, points;
    std::string message;
  };
  const std::string three = "179.0000000 -17.0000000\n179.1000000 -17.0000000\n179.1000000 -16.0000000\n";
  for (const auto& c : std::vector<Case>{
           {kHead + "ring 2\n179.0000000 -17.0000000\n179.1000000 -17.0000000\n", 1, 2,
            "line 5: a ring has at least three points"},
           {kHead + "ring 0\n", 1, 0, "line 5: a ring has at least three points"},
           {kHead + "ring 4\n" + three, 1, 4, "line 4, column 7: more points than the file can hold"},
           {kHead + "ring 3\n" + three + "179.0000000 -17.0000000\n", 1, 3, "line 8, column 1: expected \"ring \""},
           {kHead + "ring 18446744073709551615\n" + three, 1, 3,
            "line 4, column 26: more points than the file can hold"},
           {kHead + "ring 99999999999999999999\n" + three, 1, 3, "line 4, column 6: expected a count"},
           {kHead + "ring -3\n" + three, 1, 3, "line 4, column 6: expected a count"},
           {kHead + "ring 3\n179.0000000 -17.0000000\n182.0000001 -17.0000000\n179.1000000 -16.0000000\n", 1, 3,
            "line 6, column 24: lies outside the area"},
           {kHead + "ring 3\n-180.0000000 -17.0000000\n179.1000000 -17.0000000\n179.1000000 -16.0000000\n", 1, 3,
            "line 5, column 25: lies outside the area"},
           {kHead + "ring 3\n179.0000000 -17.0000000 cut\n179.1000000 -17.0000000\n179.1000000 -16.0000000\n", 1, 3,
            "line 5: a cut edge does not run along the border of the area"},
           {kHead + "ring 3\n179.0000000  -17.0000000\n179.1000000 -17.0000000\n179.1000000 -16.0000000\n", 1, 3,
            "line 5, column 13: expected degrees with seven decimals"},
           {kHead + "ring 3\n179.000000 -17.0000000 \n179.1000000 -17.0000000\n179.1000000 -16.0000000\n", 1, 3,
            "line 5, column 1: expected degrees with seven decimals"},
           {kHead + "ring 3\n179.0000000 -17.0000000\r\n179.1000000 -17.0000000\n179.1000000 -16.0000000\n", 1, 3,
            "line 5, column 24: expected the end of the line"},
           {"# glidehelm coast v1\narea 178.0000000 178.0000000 -19.0000000 -15.0000000\nsource x\n", 0, 0,
            "line 2, column 53: east 178.0000000 is not between west and west + 180 degrees"},
           {"# glidehelm coast v1\narea 180.0000000 181.0000000 -19.0000000 -15.0000000\nsource x\n", 0, 0,
            "line 2, column 53: west 180.0000000 is not in [-180, 180)"},
           {"# glidehelm coast v1\narea 178.0000000 179.0000000 -15.0000000 -19.0000000\nsource x\n", 0, 0,
            "line 2, column 53: north -19.0000000 is not north of south"},
           {"# glidehelm coast v1\narea 178.0000000 179.0000000 -15.0000000 85.0000001\nsource x\n", 0, 0,
            "line 2, column 52: the area reaches beyond 85 degrees north or south"},
           {"# glidehelm coast v1\narea 178.0000000 179.0000000 -15.0000000 20.0000000\nsource \n", 0, 0,
            "line 3, column 8: the source is not 1 to 400 characters long"},
           {"# glidehelm coast v1\narea 178.0000000 179.0000000 -15.0000000 20.0000000\nsource \x01\n", 0, 0,
            "line 3, column 9: the source holds a character that is not printable ASCII"},
       }) {
    CHECK(error_of(sealed(c.body, c.rings, c.points)).message() == c.message);
  }
  CHECK(error_of("").message() == "line 1, column 1: no coast file: it does not begin with \"# glidehelm coast v1\"");
  CHECK(error_of("# glidehelm coast v2\n").line == 1);
  CHECK(error_of("# glidehelm coast v1\n").message() ==
        "line 1: the last line does not begin with \"end\": the file is cut off");
}

TEST_CASE("wrong counts and a wrong checksum are named beside the right ones") {
  const std::string body =
      kHead + "ring 3\n179.0000000 -17.0000000\n179.1000000 -17.0000000\n179.1000000 -16.0000000\n";
  const auto right = sealed(body, 1, 3);
  REQUIRE(Coast::parse(right));
  CHECK(error_of(body + "end\n").message() == "line 8: the last line does not begin with \"end\": the file is cut off");
  for (const auto& wrong :
       {sealed(body, 2, 3), sealed(body, 1, 4), body + "end 1 3 crc32c 00000000\n", body + "end 1 3 crc32c\n"}) {
    const auto error = error_of(wrong);
    CHECK(error.line == 8);
    CHECK(error.problem.find("\"" + right.substr(body.size(), right.size() - body.size() - 1) + "\"") !=
          std::string::npos);
  }
}

TEST_CASE("degrees are written exactly") {
  CHECK(coast_degrees(0) == "0.0000000");
  CHECK(coast_degrees(-1) == "-0.0000001");
  CHECK(coast_degrees(1'799'999'999) == "179.9999999");
  CHECK(coast_degrees(-1'234'500'000) == "-123.4500000");
}
