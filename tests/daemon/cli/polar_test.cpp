#include "daemon/cli/polar.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/vehicle/force_balance.hpp"
#include "daemon/world/real.hpp"
#include "tests/simulator/temp_folder.hpp"
#include "tests/support/config.hpp"

using namespace glidehelm;

namespace {

struct Said {
  int code{};
  std::string out, err;
};
Said polar(const cli::PolarOptions& options) {
  world::RealWorld real;
  auto w = real.world();
  std::ostringstream out, err;
  const int code = cli::run_polar(options, w, out, err);
  return {code, out.str(), err.str()};
}
std::string text_of(const std::string& path) {
  std::ifstream file{path};
  return {std::istreambuf_iterator<char>{file}, {}};
}

}  // namespace

TEST_CASE("the polar is written as numbers and as a picture, and says what the trim comes to") {
  test::TempFolder folder;
  cli::PolarOptions options;
  options.csv = folder.path / "polar.csv";
  options.svg = folder.path / "polar.svg";
  const auto said = polar(options);
  CHECK(said.err.empty());
  REQUIRE(said.code == 0);
  const auto yo = vehicle::yo_means({}, {}, vehicle::WaterColumn::climatological(), Metres{20}, Metres{200});
  REQUIRE(yo);
  CHECK(said.out.find(std::to_string(yo->horizontal.si()).substr(0, 4)) != std::string::npos);
  const auto csv = text_of(options.csv);
  CHECK(csv.rfind("pumped_cm3,pitch_deg,angle_of_attack_deg,horizontal_m_per_s,vertical_m_per_s\n300,", 0) == 0);
  // Twelve volumes and every pitch from 3° (2.39° is the flattest, see the force balance's test) to 89°.
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 12 * 87);
  const auto svg = text_of(options.svg);
  CHECK(svg.find("</svg>") != std::string::npos);
  CHECK(svg.find("nan") == std::string::npos);
}

TEST_CASE("the polar of a mission is that of its body and without one a note says so") {
  test::TempFolder folder;
  const std::string path = folder.path / "m.yaml";
  std::ofstream{path} << test::six_lines("vehicle: {force_balance: {drag: 0.2}}\n");
  cli::PolarOptions options;
  options.mission = path;
  options.json = true;
  const auto said = polar(options);
  CHECK(said.err.empty());
  const auto j = nlohmann::json::parse(said.out);
  vehicle::Hull hull;
  hull.drag = 0.2;
  CHECK(j["yo"]["horizontal_speed_m_per_s"].get<double>() ==
        Approx(vehicle::yo_means(hull, {}, vehicle::WaterColumn::climatological(), Metres{20}, Metres{200})
                   ->horizontal.si()));
  CHECK(j["best"].size() == 12);

  std::ofstream{path} << test::six_lines("");
  CHECK(polar(options).err.find("has no vehicle.force_balance") != std::string::npos);
  options.mission = folder.path / "none.yaml";
  CHECK(polar(options).code == 2);
  options = {};
  options.csv = path;
  const auto refused = polar(options);
  CHECK(refused.code == 2);
  CHECK(refused.err.find("not overwritten") != std::string::npos);
}
