#include "core/model/dive_schedule.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;
using model::DiveSchedule;

TEST_CASE("dives and surfacings follow one another with a drift between") {
  const DiveSchedule schedule{Seconds{4000}, Seconds{3000}, Seconds{900}, Seconds{600}};
  CHECK(schedule.dive_time(0).count() == 600);
  CHECK(schedule.surfacing_time(0).count() == 3600);
  CHECK(schedule.dive_time(1).count() == 4500);
  CHECK(schedule.surfacing_time(1).count() == 8500);
  CHECK(schedule.dive_time(3).count() == 600 + 3000 + 900 + 2 * 4900);
}

TEST_CASE("travel time adds one surface interval per full stint before the arrival") {
  const DiveSchedule schedule{Seconds{4000}, Seconds{4000}, Seconds{900}, Seconds{900}};
  CHECK(schedule.travel_time(Seconds{1000}).count() == 1900);
  CHECK(schedule.travel_time(Seconds{4000}).count() == 4900);  // exactly at the first surfacing: no drift yet
  CHECK(schedule.travel_time(Seconds{4001}).count() == 900 + 4001 + 900);
  CHECK(schedule.travel_time(Seconds{10'000}).count() == 900 + 10'000 + 2 * 900);
  // product.md: T + ⌊T/t_s⌋·t_surface + time_to_dive away from the exact surfacings
  for (double t = 137; t < 40'000; t += 611)
    CHECK(schedule.travel_time(Seconds{t}).count() ==
          Approx(t + static_cast<double>(static_cast<long>(t / 4000)) * 900 + 900));
}
