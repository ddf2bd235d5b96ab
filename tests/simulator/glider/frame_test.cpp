#include "simulator/glider/frame.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace glidehelm;
using namespace glidehelm::simulator;

TEST_CASE("grid convergence vanishes on the central meridian and grows with the sine of the latitude") {
  CHECK(grid_convergence(geo_point(50, 9)).si() == Approx(0).margin(1e-12));
  // 1° east of the meridian at 30°: atan(tan 1°·sin 30°).
  CHECK(in_degrees(grid_convergence(geo_point(30, 10))) == Approx(0.50003808).epsilon(1e-6));
  CHECK(in_degrees(grid_convergence(geo_point(-30, 10))) == Approx(-0.50003808).epsilon(1e-6));
  // slocum.md 4.2 states 1.99° for the Gulf of Finland (59.8° N 23.3° E, zone 34).
  CHECK(in_degrees(grid_convergence(geo_point(59.82, 23.3))) == Approx(1.99).margin(0.01));
}

TEST_CASE("the grid scale is 0.9996 on the central meridian and near 1 at 180 km from it") {
  CHECK(grid_scale(geo_point(50, 9)) == Approx(0.9996).epsilon(1e-12));
  // 180 km: x²/(2R²) = 4.0e-4.
  const auto p = destination(geo_point(0, 9), Bearing{degrees(90)}, Metres{180'000});
  CHECK(grid_scale(p) == Approx(1.0).margin(1e-5));
}

TEST_CASE("the frame of a mission follows from variation and convergence, and back") {
  const auto start = geo_point(59.82, 23.3);
  // West variation −7.5° (east declination of 7.5°) and convergence 1.99° make about 9.5° (slocum.md 4.2).
  const auto frame = LocalFrame::from_variation(degrees(-7.5), start);
  CHECK(in_degrees(frame.rotation) == Approx(9.49).margin(0.01));
  CHECK(in_degrees(frame.magnetic_variation(start)) == Approx(-7.5).epsilon(1e-12));
}

TEST_CASE("the printed current turns back into the true one by the formula of the dialog") {
  const LocalFrame frame{degrees(12.5)};
  const Current truth{MetresPerSecond{0.3}, MetresPerSecond{-0.1}};
  const auto v = frame.local(truth);
  const double s = std::sin(degrees(12.5).si()), c = std::cos(degrees(12.5).si());
  CHECK(v.x * c + v.y * s == Approx(0.3).epsilon(1e-14));
  CHECK(-v.x * s + v.y * c == Approx(-0.1).epsilon(1e-14));
}

TEST_CASE("a printed bearing is the true one less the rotation") {
  CHECK(LocalFrame{degrees(10)}.local_bearing_deg(Bearing{degrees(5)}) == Approx(355));
  CHECK(LocalFrame{degrees(-10)}.local_bearing_deg(Bearing{degrees(355)}) == Approx(5));
}
