#include "core/vehicle/constrained_motion.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;
using vehicle::crossing_time;
using vehicle::hold_course;

namespace {

constexpr double kU = 0.3;

Current flowing(double speed, double towards_deg) {
  const double a = towards_deg * kPi / 180;
  return {MetresPerSecond{speed * std::sin(a)}, MetresPerSecond{speed * std::cos(a)}};
}
Course course(double deg) { return Course{degrees(deg)}; }

}  // namespace

TEST_CASE("both forms of the constrained motion model agree with each other and with the vector sum") {
  // Speeds over ground are O(1) m/s and the forms differ by a handful of roundings (1e-15 each); near the edge of the cone a
  // root of a small difference magnifies them to 1e-8.
  const double way = 1000;
  for (const double strength : {0.0, 0.1, 0.29, 0.3, 0.31, 0.6, 2.0})
    for (double towards = 0; towards < 360; towards += 30)
      for (double deg = 3; deg < 360; deg += 7) {
        const auto c = flowing(strength, towards);
        const auto held = hold_course(course(deg), MetresPerSecond{kU}, c);
        const Offset d{way * course(deg).east(), way * course(deg).north()};
        const auto t = crossing_time(d, kU, c.east.si(), c.north.si());
        INFO(strength << " m/s towards " << towards << ", course " << deg);
        REQUIRE(held.has_value() == t.has_value());
        if (!held) continue;
        CHECK(held->ground_speed.si() == Approx(way / *t).epsilon(1e-8));
        CHECK(vehicle::speed_on_course(course(deg).east(), course(deg).north(), kU, c.east.si(), c.north.si()) ==
              Approx(way / *t).epsilon(1e-8));
        // Heading through water plus current is the way over ground: 2.22.
        CHECK((kU * held->heading.east() + c.east.si()) * *t == Approx(d.east).margin(1e-5));
        CHECK((kU * held->heading.north() + c.north.si()) * *t == Approx(d.north).margin(1e-5));
      }
}

TEST_CASE("the feasible courses are the cone around the current: 2.19 with its erratum") {
  // Half its arc is asin(U_g/U_c); a tenth of a degree inside is feasible and outside is not, on both sides.
  for (const double strength : {0.31, 0.45, 0.6, 3.0}) {
    const double half = std::asin(kU / strength) * 180 / kPi;
    for (const double side : {-1.0, 1.0}) {
      INFO(strength << " m/s, side " << side);
      CHECK(hold_course(course(120 + side * (half - 0.1)), MetresPerSecond{kU}, flowing(strength, 120)));
      CHECK_FALSE(hold_course(course(120 + side * (half + 0.1)), MetresPerSecond{kU}, flowing(strength, 120)));
    }
    // Against it: |s| ≤ 1 although the vehicle is driven back; 2.16 as printed gives a negative speed.
    CHECK_FALSE(hold_course(course(300), MetresPerSecond{kU}, flowing(strength, 120)));
  }
}

TEST_CASE("a current as strong as the vehicle gives 2.20 and 2.21: half a circle of courses") {
  const auto c = flowing(kU, 70);
  for (const double off : {-89.0, -30.0, 0.0, 45.0, 89.0}) {
    const auto held = hold_course(course(70 + off), MetresPerSecond{kU}, c);
    INFO(off);
    REQUIRE(held);
    CHECK(held->ground_speed.si() == Approx(2 * kU * std::cos(off * kPi / 180)).epsilon(1e-9));
    CHECK((held->heading - Heading{degrees(70 + 2 * off)}).si() == Approx(0).margin(1e-6));
  }
  for (const double off : {91.0, 180.0, -120.0}) CHECK_FALSE(hold_course(course(70 + off), MetresPerSecond{kU}, c));
}

TEST_CASE("no way takes no time and still water takes distance over speed") {
  CHECK(crossing_time({0, 0}, kU, 1, 1) == 0.0);
  CHECK(*crossing_time({300, 400}, kU, 0, 0) == Approx(500 / kU).epsilon(1e-12));
  CHECK(hold_course(course(33), MetresPerSecond{kU}, {})->heading.degrees() == Approx(33));
}
