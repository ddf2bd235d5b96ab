#include "simulator/glider/flight.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace glidehelm;
using namespace glidehelm::simulator;

namespace {

Body incompressible() {
  Body b;
  b.compressibility_per_pa = 0;
  return b;
}

Body pitched(double deg) {
  Body b = incompressible();
  b.pitch_dive = b.pitch_climb = degrees(deg);
  return b;
}

}  // namespace

TEST_CASE("the lift slope of endless straight wings is that of a thin plate, sweep takes from it") {
  Body b;
  b.sweep = Radians{0};
  b.aspect_ratio = 1e6;
  // 2πA/(2 + √(A² + 4)) = 2π(1 − 2/A + …): 1.3e-5 at A = 1e6.
  CHECK(wing_lift_slope(b) == Approx(2 * kPi).margin(2e-5));
  b.aspect_ratio = 7;
  const double straight = wing_lift_slope(b);
  CHECK(straight == Approx(14 * kPi / (2 + std::sqrt(53.0))).epsilon(1e-14));
  b.sweep = degrees(43);
  CHECK(wing_lift_slope(b) < straight);
}

TEST_CASE("the angle of attack solves the implicit equation and gives the pitch back") {
  for (double theta = 5; theta < 89.5; theta += 0.5) {
    const Body b = pitched(theta);
    const double a = angle_of_attack(b, degrees(theta)).si();
    REQUIRE(a > 0);
    const double drag = b.parasite_drag + induced_drag(b) * a * a;
    // Thesis 2.49. α is known to 1e-13; the quotient magnifies that by at most 1/α² ≈ 3e6 near 90°.
    CHECK(std::atan(drag / (a * lift_slope(b))) - a == Approx(degrees(theta).si()).margin(1e-6));
  }
}

TEST_CASE("straight down there is no angle of attack and the speed is that of a falling body") {
  const Body b = pitched(90);
  const auto f = steady_flight(b, true, Metres{0});
  REQUIRE(f);
  CHECK(f->attack.si() == Approx(0).margin(1e-12));
  // ½ρ C_D0 S U² = g ρ |ΔV|
  const double u = std::sqrt(2 * 9.81 * 200e-6 / (0.06 * 0.1));
  CHECK(f->vertical.si() == Approx(u).epsilon(1e-9));
  CHECK(f->horizontal.si() == Approx(0).margin(1e-9));
  // Thesis under Figure 2.12: about 0.8 m/s for ±200 cm³; one digit is given.
  CHECK(f->vertical.si() == Approx(0.8).margin(0.05));
}

TEST_CASE("the greatest forward speed lies where the thesis says, and where the limit without induced drag does") {
  double best = 0, at = 0, attack = 0;
  for (double theta = 10; theta < 70; theta += 0.05) {
    const auto f = steady_flight(pitched(theta), true, Metres{0});
    REQUIRE(f);
    if (f->horizontal.si() > best) {
      best = f->horizontal.si();
      at = theta;
      attack = in_degrees(f->attack);
    }
  }
  // Thesis, caption of Figure 2.11: θ ≈ 35°, U_g ≈ 0.5 m/s, α ≈ 1°: as many digits as given.
  CHECK(at == Approx(35).margin(1));
  CHECK(best == Approx(0.5).margin(0.05));
  CHECK(attack == Approx(1).margin(0.5));
  // With constant drag U_g² ∝ sin γ cos² γ, greatest at tan²γ = ½, γ = 35.26°. The induced drag is 1 % of the whole there
  // and falls with γ, which moves a maximum as flat as this by less than 1°.
  CHECK(at + attack == Approx(in_degrees(Radians{std::atan(std::sqrt(0.5))})).margin(1));
}

TEST_CASE("speed, angle and their components belong together, up and down alike in even water") {
  for (const double theta : {12.0, 20.0, 26.0, 35.0, 60.0}) {
    const Body b = pitched(theta);
    const auto down = steady_flight(b, true, Metres{50}), up = steady_flight(b, false, Metres{50});
    REQUIRE(down);
    REQUIRE(up);
    CHECK(down->path.si() == Approx(b.pitch_dive.si() + down->attack.si()).epsilon(1e-14));
    CHECK(std::hypot(down->horizontal.si(), down->vertical.si()) == Approx(down->along.si()).epsilon(1e-14));
    CHECK(down->vertical.si() == Approx(down->horizontal.si() * std::tan(down->path.si())).epsilon(1e-12));
    // ballast = density, no compression: F = ±gρ|ΔV|; the difference of two products of 7e2 N leaves 1e-12 of 2 N.
    CHECK(up->along.si() == Approx(down->along.si()).epsilon(1e-9));
  }
}

TEST_CASE("the balance of forces holds") {
  const Body b = pitched(26);
  const auto f = steady_flight(b, false, Metres{0});
  REQUIRE(f);
  const double q = 0.5 * b.surface_density * b.wing_area_m2 * f->along.si() * f->along.si();
  const double lift = q * lift_slope(b) * f->attack.si();
  const double drag = q * (b.parasite_drag + induced_drag(b) * f->attack.si() * f->attack.si());
  const double c = std::cos(f->path.si()), s = std::sin(f->path.si());
  CHECK(s * lift - c * drag == Approx(0).margin(1e-9));                                      // Thesis 2.29
  CHECK(net_buoyancy(b, false, Metres{0}) - c * lift - s * drag == Approx(0).margin(1e-9));  // 2.28
}

TEST_CASE("four times the buoyancy doubles the speed at the same angle") {
  Body b = pitched(26);
  const auto one = steady_flight(b, true, Metres{0});
  b.pump_dive_m3 *= 4;
  const auto four = steady_flight(b, true, Metres{0});
  REQUIRE(one);
  REQUIRE(four);
  CHECK(four->along.si() == Approx(2 * one->along.si()).epsilon(1e-9));
  CHECK(four->path == one->path);
}

TEST_CASE("a hull that gives way sinks faster and climbs slower in the depth") {
  const Body b;
  const auto speed = [&](bool down, double z) { return steady_flight(b, down, Metres{z})->along.si(); };
  CHECK(speed(true, 200) > speed(true, 0));
  CHECK(speed(false, 200) < speed(false, 0));
  // ε P V = 5e-10 · 2.01e6 · 0.07 = 70 cm³ of 200 at 200 m: the square root of (200 + 70)/200.
  CHECK(speed(true, 200) / speed(true, 0) == Approx(std::sqrt(270.4 / 200)).epsilon(1e-3));
}

TEST_CASE("water that grows denser stops a dive where the buoyancy is gone") {
  Body b = incompressible();
  b.density_per_m = 0.02;
  CHECK_FALSE(cannot_reach(b, Metres{100}));
  const auto why = cannot_reach(b, Metres{200});
  REQUIRE(why);
  CHECK(why->down);
  // (ρ0 + k z)(V + ΔV) = ρ0 V: z = ρ0/k·(V/(V + ΔV) − 1) = 146.8 m; the look is at every 3.1 m.
  const double z = 1025 / 0.02 * (0.07 / (0.07 - 200e-6) - 1);
  CHECK(why->depth.si() >= z);
  CHECK(why->depth.si() < z + 200.0 / 64);
  CHECK(why->message().find("floats while diving at 1") == 0);
  CHECK_FALSE(steady_flight(b, true, Metres{150}));
  CHECK(steady_flight(b, false, Metres{150}));
}
