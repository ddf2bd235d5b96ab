#include "simulator/glider/energy.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;
using namespace glidehelm::simulator;

TEST_CASE("the pump works against the pressure of each lower inflection") {
  const EnergySpec spec;
  // (101 325 + 1025·9.81·200) Pa · 4e-4 m³ / 0.5 = 1690 J = 0.469 Wh.
  CHECK(pump_wh(spec, 1, Metres{200}) == Approx(0.4694).margin(1e-4));
  CHECK(pump_wh(spec, 3, Metres{600}) == Approx(3 * pump_wh(spec, 1, Metres{200})).epsilon(1e-12));
  CHECK(pump_wh(spec, 0, Metres{0}) == 0);
}

TEST_CASE("energies add up by their parts") {
  Energy e{1, 2, 3};
  e += {0.5, 0.25, 0.125};
  CHECK(e == Energy{1.5, 2.25, 3.125});
  CHECK(e.total_wh() == 6.875);
}
