#include "config/flight_model.hpp"

#include <catch2/catch.hpp>

#include "config/mission.hpp"
#include "core/mission/in_water.hpp"
#include "tests/support/config.hpp"

using namespace glidehelm;
using namespace glidehelm::config;

namespace {

auto read(const std::string& more) { return read_mission(test::six_lines(more), "m.yaml", test::no_files()); }

}  // namespace

TEST_CASE("with a force balance the speed and the glide angle of a mission are those of the body") {
  const auto mission =
      read("vehicle: {climb_to_m: 10, dive_depth_m: 150, force_balance: {pitch_down_deg: 24, pumped_up_cm3: 200}}\n");
  REQUIRE(mission);
  REQUIRE(mission->flight_model);
  vehicle::FlightModel model;
  model.trim.pitch_down = degrees(24);
  model.trim.pumped_up_m3 = 200e-6;
  CHECK(mission->flight_model->trim.pitch_down.si() == Approx(model.trim.pitch_down.si()));
  CHECK(mission->flight_model->trim.pumped_up_m3 == Approx(200e-6));
  const auto means =
      yo_means(mission->flight_model->hull, mission->flight_model->trim, model.column(), Metres{10}, Metres{150});
  REQUIRE(means);
  CHECK(mission->horizontal_speed == means->horizontal);
  CHECK(mission->glide_angle == means->glide_angle);
}

TEST_CASE("water is read by layers, and half cycles take as long as the body's speed says") {
  const auto mission = read(
      "vehicle: {force_balance: {water: [{depth_m: 0, temperature_c: 20}, {depth_m: 300, temperature_c: 8, salinity: "
      "34.5}]}}\n"
      "schedule: {half_cycles: 6}\n");
  REQUIRE(mission);
  const auto& water = mission->flight_model->water;
  REQUIRE(water.size() == 2);
  CHECK(water[0] == vehicle::WaterLayer{Metres{0}, 20, 35});
  CHECK(water[1] == vehicle::WaterLayer{Metres{300}, 8, 34.5});
  CHECK(mission->stint.count() == stint_of_half_cycles(6, *mission).count());
}

TEST_CASE("what is wrong with a force balance is said at its place") {
  const auto errors = [](const std::string& more) { return test::errors_of(read(more)); };
  CHECK(errors("vehicle: {horizontal_speed_m_per_s: 0.3, force_balance: {}}\n") ==
        std::vector<std::string>{"7:37 vehicle.horizontal_speed_m_per_s: both horizontal_speed_m_per_s and "
                                 "force_balance; allowed: one of the two"});
  CHECK(errors("vehicle: {force_balance: {mass_kg: 71.85, neutral_at_m: 50}}\n").size() == 1);
  CHECK(
      errors("vehicle: {force_balance: {water: [{depth_m: 10, temperature_c: 4}, {depth_m: 10, temperature_c: 3}]}}\n")
          .size() == 1);
  const auto heavy = errors("vehicle: {force_balance: {mass_kg: 75}}\n");  // 70 l of sea water weigh 72 kg
  REQUIRE(heavy.size() == 1);
  CHECK(heavy.front().find("vehicle.force_balance: the glider does not climb at") != std::string::npos);
  CHECK(errors("vehicle: {force_balance: {pitch_up_deg: 1}}\n").front().find("too flat") != std::string::npos);
}

TEST_CASE("what is in force of a force balance reads back to the same mission") {
  for (const std::string more :
       {"vehicle: {motion: yo-yo, force_balance: {drag: 0.12, water: [{depth_m: 0, temperature_c: 20}]}}\n",
        "vehicle: {force_balance: {}}\n", "vehicle: {motion: yo-yo}\n"}) {
    const auto file = read_mission_file(test::six_lines(more), "m.yaml", test::no_files());
    REQUIRE(file);
    const auto again = read_mission(file->effective, "m.yaml", test::no_files());
    INFO(file->effective);
    REQUIRE(again);
    CHECK(again->flight_model == file->mission.flight_model);
    CHECK(again->motion == file->mission.motion);
    CHECK(again->horizontal_speed == file->mission.horizontal_speed);
  }
}
