#include "core/vehicle/dive_by_law.hpp"

#include <catch2/catch.hpp>

#include "core/base/local_metric.hpp"
#include "core/ocean/analytic.hpp"
#include "core/safety/reflight.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;
using test::current;

namespace {

constexpr double kStint = 4 * 3600.0;

struct UniformSea {
  test::Uniform field;
  chart::Chart chart;
  vehicle::Waters waters{{field, field}, chart, Metres{0}};
  vehicle::Flight flight;
  explicit UniformSea(double east = 0, double north = 0) : field{east, north} {
    flight.fix = geo_point(28, -16);
    flight.fix_s = test::kT0;
    flight.goal = {geo_point(40, -16), Metres{1000}};
    flight.horizon_s = test::kT0 + 1e7;
  }
  [[nodiscard]] vehicle::State start() const { return vehicle::state_at(flight.fix, test::kT0, waters); }
};

GeoPoint off(GeoPoint from, double east, double north) {
  return destination(from, Bearing::of(east, north), Metres{std::hypot(east, north)});
}

}  // namespace

TEST_CASE("the heading leans into the believed current by the arc sine of its share across") {
  const MetresPerSecond u{0.25};
  // slocum.md 4.4: 0.15 m/s across at 0.25 m/s are 36.9 degrees.
  const auto steered = [&](double bearing, Current believed) {
    const auto h = vehicle::steered_heading(SineCosine::of(bearing), believed, u);
    CHECK(std::hypot(h.sine, h.cosine) == Approx(1).epsilon(1e-14));
    return std::atan2(h.sine, h.cosine);
  };
  CHECK(steered(0, current(0.15, 0)) == Approx(-36.87 * kPi / 180).margin(1e-4));
  CHECK(steered(kPi / 2, current(0, -0.15)) == Approx(kPi / 2 - 36.87 * kPi / 180).margin(1e-4));
  CHECK(steered(1.0, current(0, 0)) == Approx(1.0).epsilon(1e-14));
  CHECK(steered(0, current(0.4, 0)) == Approx(-kPi / 2));  // no more than square to the bearing
}

TEST_CASE("a believed current that is true is compensated: the track leads straight to the waypoint") {
  const UniformSea s{0.1, 0.05};
  const auto to = off(s.flight.fix, 3000, 9000);
  const std::vector<GeoPoint> points{to};
  std::size_t target = 0;
  const auto flown =
      dive_by_law(s.flight, s.waters, s.start(), kStint, points, target, Metres{100}, false, current(0.1, 0.05));
  const auto to_point = geodesic(s.flight.fix, to), gone = geodesic(s.flight.fix, flown.motion.end.at());
  // Dead reckoning is right, so only rounding and the midpoint rule are left: 1e-4 rad of bearing (dive_by_law.hpp).
  CHECK(std::abs((to_point.departing - gone.departing).si()) < 2e-4);
  CHECK(flown.motion.mean.east.si() == Approx(0.1).margin(1e-6));
}

TEST_CASE("an ignored current carries the glider off by its whole way") {
  const UniformSea s{0.2, 0};
  const std::vector<GeoPoint> points{off(s.flight.fix, 0, 20e3)};
  std::size_t target = 0;
  const auto flown = dive_by_law(s.flight, s.waters, s.start(), kStint, points, target, Metres{100}, false, {});
  const auto there = off(s.flight.fix, 0.2 * kStint, 0.3 * kStint);
  // Metric of 28° at the start against the way's: 4320 m · tan 28°/R = 3.6e-4 of 2880 m, 1 m.
  CHECK(distance(flown.motion.end.at(), there).si() < 2);
  CHECK(flown.first_heading.degrees() == Approx(0).margin(0.01));
}

TEST_CASE("in a turning current a dive ends where the closed form says, to what the midpoint rule turns too far") {
  // On the equator, heading held north through water that turns with ω: the track is an arc of radius U/ω round a point to the west, flown
  // with speed U. The midpoint rule turns (ω·5 min)²/6 = 1.4e-5 of the arc too far: 6 cm of 4320 m.
  ocean::AnalyticSpec spec;
  spec.kind = "solid-body";
  spec.origin = geo_point(0, 0);
  const double omega = 3e-5;
  spec.length_scale = Metres{1 / omega};  // with a speed scale of 1 m/s
  const auto field = ocean::AnalyticField::make(spec, instant_at(test::kT0)).value();
  const chart::Chart open;
  const vehicle::Waters waters{{field, field}, open, Metres{0}};
  vehicle::Flight flight;
  flight.fix = spec.origin;
  flight.goal = {geo_point(20, 0), Metres{1000}};
  flight.horizon_s = test::kT0 + 1e7;
  const std::vector<GeoPoint> points{geo_point(3, 0)};
  std::size_t target = 0;
  const auto flown = dive_by_law(flight, waters, vehicle::state_at(flight.fix, test::kT0, waters), kStint, points,
                                 target, Metres{100}, false, {});
  const double angle = omega * kStint, radius = flight.glider.horizontal_speed.si() / omega;
  const auto end = local_offset(0, 0, flown.motion.end.lat, flown.motion.end.lon);
  CHECK(end.east == Approx(radius * (std::cos(angle) - 1)).margin(0.1));
  CHECK(end.north == Approx(radius * std::sin(angle)).margin(0.1));
}

TEST_CASE("a ring is crossed on the dead-reckoned way, and the next waypoint follows under water") {
  const UniformSea s;
  const auto first = off(s.flight.fix, 0, 2300);
  const std::vector<GeoPoint> points{first, off(first, 20e3, 0)};
  std::size_t target = 0;
  const auto flown = dive_by_law(s.flight, s.waters, s.start(), kStint, points, target, Metres{300}, false, {});
  CHECK(target == 1);
  // 2000 m north to the ring, the remaining 2320 m towards the second point, seen from 300 m south of the first.
  const double east = 20e3, north = 300, length = std::hypot(east, north), rest = 0.3 * kStint - 2000;
  CHECK(distance(flown.motion.end.at(), off(s.flight.fix, rest * east / length, 2000 + rest * north / length)).si() <
        2);
}

TEST_CASE("after the last waypoint the list begins again when it loops, a single one stays the target") {
  const UniformSea s;
  const std::vector<GeoPoint> points{off(s.flight.fix, 0, 1500), off(s.flight.fix, 0, -1500)};
  std::size_t target = 0;
  dive_by_law(s.flight, s.waters, s.start(), kStint, points, target, Metres{200}, true, {});
  // 1300 m to the first ring, 2600 m to the second, 420 m on the way back to the first.
  CHECK(target == 0);
  target = 0;
  dive_by_law(s.flight, s.waters, s.start(), kStint, points, target, Metres{200}, false, {});
  CHECK(target == 1);
  const std::vector<GeoPoint> one{points[0]};
  target = 0;
  const auto flown = dive_by_law(s.flight, s.waters, s.start(), kStint, one, target, Metres{200}, true, {});
  CHECK(target == 0);
  CHECK(distance(flown.motion.end.at(), points[0]).si() < 40);  // to and fro within two steps of a minute (18 m)
}

TEST_CASE("a current stronger than the glider against its heading is held towards a waypoint up-current") {
  // Wanted heading north, current 0.5 m/s south: the waypoint lies north, the glider points at it and moves away from it.
  const UniformSea s{0, -0.5};
  const std::vector<GeoPoint> points{off(s.flight.fix, 0, 3000), off(s.flight.fix, 9000, 0)};
  std::size_t target = 0;
  const auto flown =
      dive_by_law(s.flight, s.waters, s.start(), kStint, points, target, Metres{200}, false, current(0, -0.5));
  CHECK(target == 0);
  CHECK(flown.first_heading.degrees() == Approx(0).margin(0.01));
  CHECK(distance(flown.motion.end.at(), off(s.flight.fix, 0, -0.2 * kStint)).si() < 1);
}

TEST_CASE(
    "a heading bias turns the true way, an aim point that knows it turns it back, and the verifier flies the same") {
  for (const double bias : {-8.0, 8.0}) {
    UniformSea s{0.05, 0.02};
    s.flight.glider.current_correction = 1;
    s.flight.glider.heading_bias = degrees(bias);
    const Current known = current(0.05, 0.02);
    const Heading wanted{degrees(70)};
    const auto aim = vehicle::aim_point(s.flight.fix, wanted, s.flight.glider, known, kStint, Metres{400});
    const std::vector<GeoPoint> points{aim.at};
    std::size_t target = 0;
    const auto flown = dive_by_law(s.flight, s.waters, s.start(), kStint, points, target, Metres{400}, true, known);
    // Û·h + ĉ along the leg, U·h' + c truly: the true heading is the wanted one all the way.
    const auto there = off(s.flight.fix, (0.3 * wanted.east() + 0.05) * kStint, (0.3 * wanted.north() + 0.02) * kStint);
    CHECK(distance(flown.motion.end.at(), there).si() < 3);
    CHECK(std::abs(in_degrees(flown.first_heading - wanted)) < 0.02);
    safety::FlightOrder order;
    order.points = points;
    order.radius = Metres{400};
    order.glider = s.flight.glider;
    order.schedule.stint = order.schedule.first_stint = Seconds{kStint};
    order.schedule.time_to_dive = Seconds{0};
    order.believed_current = known;
    order.fix = s.flight.fix;
    order.fix_s = test::kT0;
    order.horizon_s = test::kT0 + kStint + 60;
    order.goal = s.flight.goal.centre;
    order.goal_radius = s.flight.goal.radius;
    const auto again = safety::fly(order, s.field);
    REQUIRE(again.stints.size() == 1);
    CHECK(distance(again.stints[0].surfaced, flown.motion.end.at()).si() < 3);
  }
}
