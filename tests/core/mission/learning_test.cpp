#include "core/mission/learning.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace glidehelm;
using namespace glidehelm::mission;

TEST_CASE("a current along the local frame's y axis flows where that axis points") {
  // The frame's y axis points r clockwise from north, so a unit vector along y is (sin r, cos r) in east, north.
  const auto r = degrees(9.4);
  const auto along_y = true_current({MetresPerSecond{0}, MetresPerSecond{1}}, r);
  CHECK(along_y.east.si() == Approx(std::sin(r.si())));
  CHECK(along_y.north.si() == Approx(std::cos(r.si())));
  const auto along_x = true_current({MetresPerSecond{1}, MetresPerSecond{0}}, r);
  CHECK(Course::of(along_x.east.si(), along_x.north.si()).degrees() == Approx(90 + 9.4));
}

TEST_CASE("turning a current into the local frame and back gives it again") {
  for (double r = -30; r <= 30; r += 7) {
    const Current c{MetresPerSecond{0.31}, MetresPerSecond{-0.12}};
    const auto back = true_current(local_velocity(c, degrees(r)), degrees(r));
    CHECK(back.east.si() == Approx(c.east.si()));
    CHECK(back.north.si() == Approx(c.north.si()));
  }
}

TEST_CASE("grid convergence is zero on the central meridian, positive east of it in the north") {
  CHECK(utm_convergence(geo_point(60, 21)).si() == Approx(0).margin(1e-12));
  // γ = atan(tan Δλ · sin φ): at 59.82°N, 2.3° east of 21°E, atan(tan 2.3° · sin 59.82°) = 1.988°.
  CHECK(in_degrees(utm_convergence(geo_point(59.82, 23.3))) == Approx(1.988).margin(0.001));
  CHECK(utm_convergence(geo_point(-59.82, 23.3)).si() < 0);
}

TEST_CASE("the rotation comes from the configuration, then from the magnetic variation, then is zero") {
  const auto p = geo_point(59.82, 23.3);
  const auto configured = frame_rotation(degrees(5), degrees(-7.5), p);
  CHECK(configured.from == FrameRotation::From::configured);
  CHECK(in_degrees(configured.clockwise) == Approx(5));
  // 7.5° east is −7.5° in the firmware's convention (positive west); with 1.99° of convergence that makes 9.49°, the
  // upper end of what was measured in the Gulf of Finland (slocum.md 4.2: 9.43–9.49°).
  const auto printed = frame_rotation(std::nullopt, degrees(-7.5), p);
  CHECK(printed.from == FrameRotation::From::magnetic_variation);
  CHECK(in_degrees(printed.clockwise) == Approx(9.49).margin(0.01));
  CHECK(frame_rotation(std::nullopt, std::nullopt, p).from == FrameRotation::From::assumed_zero);
  const Radians not_a_number{std::numeric_limits<double>::quiet_NaN()};
  CHECK(frame_rotation(std::nullopt, not_a_number, p).from == FrameRotation::From::assumed_zero);
}

TEST_CASE("a water velocity faster than the firmware lets through is not believed") {
  model::Surfacing s;
  CHECK_FALSE(believed_current(s, Radians{}));
  s.water = model::LocalVelocity{MetresPerSecond{2.9}, MetresPerSecond{0}};
  CHECK_FALSE(believed_current(s, Radians{}));
  s.water = model::LocalVelocity{MetresPerSecond{std::numeric_limits<double>::quiet_NaN()}, MetresPerSecond{0}};
  CHECK_FALSE(believed_current(s, Radians{}));
  s.water = model::LocalVelocity{MetresPerSecond{0.2}, MetresPerSecond{0}};
  CHECK(believed_current(s, Radians{})->east.si() == Approx(0.2));
}
