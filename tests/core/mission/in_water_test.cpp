#include "core/mission/in_water.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;
using namespace glidehelm::mission;

namespace {

const std::vector<ocean::WaterLayer> kGulfStream{{Metres{0}, 26, 36}, {Metres{100}, 22, 36.4}, {Metres{1000}, 6, 35}};

Mission with_body() {
  Mission m;
  m.flight_model.emplace();
  return m;
}

vehicle::YoMeans means_in(const Mission& m, const ocean::WaterColumn& water) {
  return vehicle::yo_means(m.flight_model->hull, m.flight_model->trim, water, m.climb_to, m.dive_depth).value();
}

}  // namespace

TEST_CASE("a body in the forecast's water makes what it makes in the same water of the mission, bit for bit") {
  const auto there = in_water(with_body(), kGulfStream);
  CHECK(there.from == WaterFrom::forecast);
  CHECK(there.refused.empty());
  Mission own = with_body();
  own.flight_model->water = kGulfStream;
  const auto means = means_in(own, own.flight_model->column());
  CHECK(there.mission.horizontal_speed == means.horizontal);
  CHECK(there.mission.glide_angle == means.glide_angle);
  CHECK(there.mission.flight_model == with_body().flight_model);  // the next forecast finds it without water again
}

TEST_CASE("without a forecast's water it is the climatological profile, whatever was set before") {
  const Mission before = in_water(with_body(), kGulfStream).mission;
  const auto there = in_water(before, {});
  CHECK(there.from == WaterFrom::climatology);
  const auto means = means_in(before, ocean::WaterColumn::climatological());
  CHECK(there.mission.horizontal_speed == means.horizontal);
  CHECK(there.mission.horizontal_speed != before.horizontal_speed);
  CHECK(in_water(there.mission, kGulfStream).mission == before);
  CHECK(in_water(before, kGulfStream).mission == before);
}

TEST_CASE("a mission with water of its own, or without a body, stays as it is") {
  Mission own = with_body();
  own.flight_model->water = {{Metres{0}, 10, 35}};
  CHECK_FALSE(takes_forecast_water(own));
  CHECK(in_water(own, kGulfStream).mission == own);
  CHECK(in_water(own, kGulfStream).from == WaterFrom::mission);
  CHECK(in_water(Mission{}, kGulfStream).mission == Mission{});
  CHECK(in_water(Mission{}, kGulfStream).from == WaterFrom::none);
  CHECK(word(WaterFrom::forecast) == "forecast");
}

TEST_CASE(
    "half cycles take as long as the vertical speed in that water says, and a first stint of the same length with "
    "them") {
  Mission m = with_body();
  m.half_cycles = 6;
  const auto there = in_water(m, kGulfStream).mission;
  CHECK(there.stint == stint_of_half_cycles(6, there));
  CHECK(there.first_stint == there.stint);
  m.first_stint = Seconds{3600};
  CHECK(in_water(m, kGulfStream).mission.first_stint == Seconds{3600});
  Mission by_time = with_body();
  CHECK(in_water(by_time, kGulfStream).mission.stint == by_time.stint);
}

TEST_CASE("a body that does not fly in the forecast's water is told, and gets the climatological one") {
  Mission m = with_body();
  // Neutral at 100 m of the climatological profile with the pump in its middle; the pump's 230 cm³ carry 0.24 kg. Fresh water is lighter by 26 kg/m³,
  // which is 1.8 kg for 70 litres: there it only sinks.
  const auto climate = ocean::WaterColumn::climatological();
  m.flight_model->hull.mass_kg = climate.density(Metres{100}) * m.flight_model->hull.volume_m3;
  const std::vector<ocean::WaterLayer> river{{Metres{0}, 10, 0}, {Metres{300}, 8, 0}};
  const auto there = in_water(m, river);
  CHECK(there.from == WaterFrom::climatology);
  CHECK(there.refused.find("does not climb") != std::string::npos);
  CHECK(there.mission.horizontal_speed == in_water(m, {}).mission.horizontal_speed);

  Mission slow = with_body();
  slow.half_cycles = 1000;
  slow.dive_depth = Metres{1000};
  CHECK(in_water(slow, kGulfStream).refused.find("1000 half cycles take") == 0);
}

TEST_CASE("two missions dive alike when one water gives them one profile") {
  const Mission body = with_body();
  CHECK(dive_alike(body, in_water(body, kGulfStream).mission));
  Mission steeper = body;
  steeper.flight_model->trim.pitch_down = degrees(30);
  CHECK_FALSE(dive_alike(body, steeper));
  Mission own = in_water(body, kGulfStream).mission;
  own.flight_model->water = kGulfStream;
  CHECK_FALSE(dive_alike(body, own));
  CHECK_FALSE(dive_alike(own, in_water(body, kGulfStream).mission));  // only in that water
  CHECK(dive_alike(own, own));
  Mission faster;
  faster.horizontal_speed = MetresPerSecond{0.4};
  CHECK_FALSE(dive_alike(Mission{}, faster));
  CHECK(dive_alike(Mission{}, Mission{}));
  Mission counted = body;
  counted.half_cycles = 4;
  CHECK_FALSE(dive_alike(body, counted));
  CHECK(dive_alike(counted, in_water(counted, kGulfStream).mission));
}
