#include "core/ocean/metric_table.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;
using namespace glidehelm::ocean;

TEST_CASE("the tabulated metric agrees with the exact one to the stated error at every latitude") {
  const MetricTable globe{-kPi / 2, kPi / 2};
  for (double deg = -89.9; deg < 89.95; deg += 0.0137) {
    const double lat = deg * kPi / 180;
    const auto table = globe.at(lat), exact = MetricTable::exact(lat);
    // h²/8·(1 + 2 tan² 80°) = 2.5e-4² / 8 · 65.3 = 5.1e-7; beyond 80° the formula itself is used.
    CHECK(std::abs(table[0] / exact[0] - 1) < 5.2e-7);
    CHECK(std::abs(table[1] / exact[1] - 1) < 5.2e-7);
  }
}

TEST_CASE("a table of a narrow or polar band covers its own edges") {
  for (const auto& [south, north] : {std::pair{0.1, 0.1001}, std::pair{1.45, 1.55}, std::pair{-1.56, -1.39}}) {
    const MetricTable band{south, north};
    for (const double lat : {south, 0.5 * (south + north), north})
      CHECK(band.at(lat)[0] == Approx(MetricTable::exact(lat)[0]).epsilon(5.2e-7));
  }
}

TEST_CASE("the inverse radii are those of WGS84 on the equator") {
  const auto inverse = MetricTable::exact(0);
  CHECK(1 / inverse[0] == Approx(6378137.0).epsilon(1e-15));
  CHECK(1 / inverse[1] == Approx(6335439.3273).epsilon(1e-11));
}
