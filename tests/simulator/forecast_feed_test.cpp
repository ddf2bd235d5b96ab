#include "simulator/forecast_feed.hpp"

#include <catch2/catch.hpp>

#include "core/base/utc.hpp"
#include "daemon/world/real_files.hpp"
#include "tests/simulator/support.hpp"
#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using namespace glidehelm::simulator;

namespace {

ForecastPlan plan_in(const std::string& folder) {
  ForecastPlan p;
  p.folder = folder;
  p.grid.west_deg = 4;
  p.grid.east_deg = 6;
  p.grid.south_deg = 39;
  p.grid.north_deg = 41;
  p.grid.step_deg = 0.5;
  p.hours = 48;
  p.time_step_h = 6;
  return p;
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator{folder}) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST_CASE("a cycle appears every day after its delay, whole, and old ones go") {
  TempFolder temp;
  world::RealFiles files;
  auto feed = ForecastFeed::make(files, plan_in((temp.path / "f").string()), kUniform);
  REQUIRE(feed);
  const auto at = [](const char* text) { return *utc_from_text(text); };
  // At three o'clock today's midnight run is not out yet: yesterday's is the newest.
  CHECK((*feed)->publish(at("2026-03-02T03:00:00Z")).value_or(-1) == 1);
  CHECK(files_in(temp.path / "f") == std::vector<std::string>{".glidersim", "cycle_20260301T000000.nc"});
  CHECK((*feed)->publish(at("2026-03-02T05:59:59Z")).value_or(-1) == 0);
  CHECK((*feed)->publish(at("2026-03-02T06:00:00Z")).value_or(-1) == 1);
  CHECK((*feed)->publish(at("2026-03-04T12:00:00Z")).value_or(-1) == 2);
  CHECK(files_in(temp.path / "f") ==
        std::vector<std::string>{".glidersim", "cycle_20260303T000000.nc", "cycle_20260304T000000.nc"});
  CHECK(temp.read("f/cycle_20260303T000000.nc") != temp.read("f/cycle_20260304T000000.nc"));
}

TEST_CASE("the same plan publishes the same bytes") {
  TempFolder one, two;
  world::RealFiles files;
  for (auto* temp : {&one, &two}) {
    auto feed = ForecastFeed::make(files, plan_in((temp->path / "f").string()), kUniform);
    REQUIRE(feed);
    REQUIRE((*feed)->publish(*utc_from_text("2026-03-02T07:00:00Z")));
  }
  CHECK(one.read("f/cycle_20260302T000000.nc") == two.read("f/cycle_20260302T000000.nc"));
}

TEST_CASE("a folder that belongs to somebody is refused") {
  TempFolder temp;
  std::filesystem::create_directory(temp.path / "f");
  temp.write("f/theirs.nc", "x");
  world::RealFiles files;
  const auto feed = ForecastFeed::make(files, plan_in((temp.path / "f").string()), kUniform);
  REQUIRE_FALSE(feed);
  CHECK(feed.error().find("was not made by glidersim") != std::string::npos);
}
