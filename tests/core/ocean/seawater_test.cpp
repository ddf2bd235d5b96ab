#include "core/ocean/seawater.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;
using namespace glidehelm::ocean;

TEST_CASE("the density of sea water is that of the tables of UNESCO 1981") {
  // Check values of the international equation of state, printed to 1e-5 kg/m³.
  CHECK(sea_water_density(0, 5, 0) == Approx(999.96675).margin(6e-6));
  CHECK(sea_water_density(0, 5, 1000e5) == Approx(1044.12802).margin(6e-6));
  CHECK(sea_water_density(0, 25, 0) == Approx(997.04796).margin(6e-6));
  CHECK(sea_water_density(35, 5, 0) == Approx(1027.67547).margin(6e-6));
  CHECK(sea_water_density(35, 25, 0) == Approx(1023.34306).margin(6e-6));
  CHECK(sea_water_density(35, 5, 1000e5) == Approx(1069.48914).margin(6e-6));
  CHECK(sea_water_density(35, 25, 1000e5) == Approx(1062.53817).margin(6e-6));
}

TEST_CASE("pressure follows the standard ocean to 0.3 percent down to 2000 m") {
  // Saunders & Fofonoff (1976) as in UNESCO (1983): depth in m from pressure in dbar at 45°, whose gravity at the surface is 9.80617.
  for (const double p : {10.0, 100.0, 500.0, 1000.0, 1500.0, 2020.0}) {
    const double depth = p * (9.72659 + p * (-2.2512e-5 + p * (2.279e-10 - p * 1.82e-15))) / (9.80617 + 1.092e-6 * p);
    CHECK(pressure_at(Metres{depth}) == Approx(p * 1e4).epsilon(3e-3));
  }
}

TEST_CASE("a water column is linear between its layers and held beyond them") {
  const WaterColumn water{{{Metres{10}, 20, 36}, {Metres{110}, 10, 35}}};
  CHECK(water.at(Metres{0}).temperature_c == 20);
  CHECK(water.at(Metres{60}).temperature_c == Approx(15));
  CHECK(water.at(Metres{60}).salinity == Approx(35.5));
  CHECK(water.at(Metres{500}).temperature_c == 10);
  CHECK(water.density(Metres{500}) == sea_water_density(35, 10, pressure_at(Metres{500})));
}

TEST_CASE("the adiabatic lapse rate and the potential temperature are those of the tables of UNESCO 1983") {
  // Printed check value: 3.255976e-4 °C/dbar at salinity 40, 40 °C and 10000 dbar.
  CHECK(adiabatic_lapse_rate(40, 40, 1e8) * 1e4 == Approx(3.255976e-4).margin(5e-11));
  // And 40 °C there are 36.89073 °C at the surface, printed to 1e-5 °C, half of which is 5e-6; one step over a pressure five times that of
  // 2000 m errs by some 3e-5 °C itself (against ten steps).
  CHECK(in_situ_temperature(40, 36.89073, 1e8) == Approx(40).margin(5e-5));
  CHECK(in_situ_temperature(35, 10, 0) == 10);
}

TEST_CASE("down to 2000 m one step of the lapse rate is as good as a hundred") {
  const double deep = pressure_at(Metres{2000});
  for (const double salinity : {30.0, 35.0, 39.0})
    for (const double theta : {0.0, 4.0, 13.0, 25.0}) {
      double fine = theta;
      for (int k = 0; k < 100; ++k) {  // the midpoint rule: its error is of the order of (1/100)² of the change, 0.3 °C
        const double dp = deep / 100, half = fine + 0.5 * dp * adiabatic_lapse_rate(salinity, fine, k * dp);
        fine += dp * adiabatic_lapse_rate(salinity, half, (k + 0.5) * dp);
      }
      CHECK(in_situ_temperature(salinity, theta, deep) == Approx(fine).margin(3e-5));
      CHECK(fine > theta);
    }
}

TEST_CASE("standard sea water of the reference composition has a practical salinity of 35") {
  CHECK(practical_salinity(35.16504) == Approx(35).epsilon(1e-15));
}
