#include "daemon/places.hpp"

#include <catch2/catch.hpp>

#include "config/mission.hpp"
#include "tests/support/memory_files.hpp"

using namespace glidehelm;
using Lines = std::vector<std::string>;

namespace {

/// Water from 27 to 30 north and 17 to 14 west, with a square island of 0.2 degrees about 28.0, -15.6.
std::string coast_file() {
  const chart::CoastRing island{
      {{13'000'000, 279'000'000}, {15'000'000, 279'000'000}, {15'000'000, 281'000'000}, {13'000'000, 281'000'000}},
      {false, false, false, false}};
  return (*chart::Coast::make({-170'000'000, -140'000'000, 270'000'000, 300'000'000}, "a test", {island}))->text();
}

/// What is said of a mission with this goal line and these further lines, beside the coast file of the test.
Lines said_of(const std::string& goal, const std::string& more = "") {
  test::MemoryFiles files;
  files.make_folder_at("/m");
  auto folder = files.open_folder("/m").value();
  REQUIRE(folder->create("sea.coast", coast_file(), 0644));
  const std::string text = "schema: glidehelm/mission/v1\nname: leg\nglider: sim01\ngoal: " + goal +
                           "\ncurrents: {files: [c.nc]}\nsafety: {coast: sea.coast}\n" + more;
  const auto mission =
      config::read_mission(text, "/m/leg.yaml", [](const std::string&) -> Expected<std::string, config::Unreadable> {
        return unexpected(config::Unreadable{"no such file"});
      });
  REQUIRE(mission);
  Lines lines;
  for (const auto& error : daemon::Places{files}.errors_of(*mission, text, "/m/leg.yaml"))
    lines.push_back(error.message());
  return lines;
}

}  // namespace

TEST_CASE("a goal and a start in charted water are right") {
  CHECK(said_of("{lat_deg: 28.95, lon_deg: -14.6}", "start: {lat_deg: 28.5, lon_deg: -15}\n").empty());
}

TEST_CASE("a goal on land is named with its line and how far inland it lies") {
  // The island reaches 0.1 degrees north and south of the goal, 11.1 km, and east and west 0.1 degrees, 9.8 km.
  CHECK(said_of("{lat_deg: 28, lon_deg: -15.6}") ==
        Lines{"/m/leg.yaml:4:7: goal: 28.0000,-15.6000 is on land, 9.8 km inside the coast"});
}

TEST_CASE("latitude and longitude swapped are said to be so when that is a place in the water") {
  CHECK(said_of("{lat_deg: -14.6, lon_deg: 28.95}") ==
        Lines{"/m/leg.yaml:4:7: goal: -14.6000,28.9500 lies outside the coast file; swapped it would be "
              "28.9500,-14.6000, in the water: latitude comes first"});
  CHECK(said_of("{lat_deg: -15.6, lon_deg: 28}") ==
        Lines{"/m/leg.yaml:4:7: goal: -15.6000,28.0000 lies outside the coast file"});  // on the island
}

TEST_CASE("a start is judged like a goal, and both are told at once") {
  CHECK(said_of("{lat_deg: 35, lon_deg: -15}", "start: {lat_deg: -15, lon_deg: 28.5}\n") ==
        Lines{"/m/leg.yaml:4:7: goal: 35.0000,-15.0000 lies outside the coast file",
              "/m/leg.yaml:7:8: start: -15.0000,28.5000 lies outside the coast file; swapped it would be "
              "28.5000,-15.0000, in the water: latitude comes first"});
}

TEST_CASE("areas count as the coast does") {
  const std::string box =
      "[[{lat_deg: 28.9, lon_deg: -14.7}, {lat_deg: 28.9, lon_deg: -14.5}, {lat_deg: 29, lon_deg: -14.5}, {lat_deg: "
      "29, lon_deg: -14.7}]]";
  const auto with = [&](const std::string& key, const std::string& goal) {
    test::MemoryFiles files;
    const std::string text = "schema: glidehelm/mission/v1\nname: leg\nglider: sim01\ngoal: " + goal +
                             "\ncurrents: {files: [c.nc]}\nsafety: {" + key + ": " + box + "}\n";
    const auto mission = config::read_mission(text, "leg.yaml", {});
    REQUIRE(mission);
    const auto errors = daemon::Places{files}.errors_of(*mission, text, "leg.yaml");
    return errors.empty() ? std::string{} : errors.front().text();
  };
  CHECK(with("keep_out", "{lat_deg: 28.95, lon_deg: -14.6}") == "goal: 28.9500,-14.6000 lies in a keep_out area");
  CHECK(with("keep_out", "{lat_deg: 28.5, lon_deg: -14.6}").empty());
  CHECK(with("keep_in", "{lat_deg: 28.95, lon_deg: -14.6}").empty());
  CHECK(with("keep_in", "{lat_deg: 28.5, lon_deg: -14.6}") == "goal: 28.5000,-14.6000 lies outside the keep_in areas");
}

TEST_CASE("a coast file that cannot be read or is none is an error of its key") {
  test::MemoryFiles files;
  const std::string text =
      "schema: glidehelm/mission/v1\nname: leg\nglider: sim01\ngoal: {lat_deg: 28, lon_deg: -15}\n"
      "currents: {files: [c.nc]}\nsafety: {coast: /nowhere/sea.coast}\n";
  const auto mission = config::read_mission(text, "leg.yaml", {});
  REQUIRE(mission);
  const auto errors = daemon::Places{files}.errors_of(*mission, text, "leg.yaml");
  REQUIRE(errors.size() == 1);
  CHECK(errors[0].message().rfind("leg.yaml:6:17: safety.coast: ", 0) == 0);
  CHECK(errors[0].message().find("/nowhere/sea.coast") != std::string::npos);
}
