#include "simulator/glider/navigation.hpp"
#include "tests/simulator/support.hpp"
#include "tests/support/fields.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::Belief;
using simulator::GotoList;
using simulator::Navigator;

namespace {

GotoList list_of(std::vector<GeoPoint> points, double radius) {
  GotoList list;
  list.waypoints = std::move(points);
  list.radius = Metres{radius};
  list.initial = 0;
  return list;
}

/// Flies `seconds` of dead reckoning; the headings are returned.
std::vector<double> fly(Navigator& nav, double seconds, double dt) {
  std::vector<double> headings;
  for (double t = 0; t < seconds - 1e-9; t += dt) headings.push_back(nav.cycle(t, dt).degrees());
  return headings;
}

}  // namespace

TEST_CASE("the aim law crabs against the believed cross current") {
  // Course due north, 0.15 m/s from the west: sin = 0.15/0.30, 30° to the left (slocum.md 4.4 gives 30.0°).
  CHECK(simulator::aim(Bearing{}, current(0.15, 0), MetresPerSecond{0.30}).degrees() == Approx(330).epsilon(1e-12));
  // 0.15/0.25: 36.87°.
  CHECK(simulator::aim(Bearing{}, current(0.15, 0), MetresPerSecond{0.25}).degrees() ==
        Approx(360 - 36.8698976).epsilon(1e-9));
  // A current along the bearing does not turn the heading.
  CHECK(simulator::aim(Bearing{degrees(123)}, current(std::sin(degrees(123).si()), std::cos(degrees(123).si())),
                       MetresPerSecond{0.3})
            .degrees() == Approx(123).epsilon(1e-12));
}

TEST_CASE("a cross current of Û or more leaves the glider pointing square against it") {
  CHECK(simulator::aim(Bearing{}, current(0.30, 0), MetresPerSecond{0.30}).degrees() == Approx(270));
  CHECK(simulator::aim(Bearing{}, current(0.9, 0), MetresPerSecond{0.30}).degrees() == Approx(270));
  CHECK(simulator::aim(Bearing{}, current(-0.9, 0.2), MetresPerSecond{0.30}).degrees() == Approx(90));
}

TEST_CASE("in still water the heading towards a far waypoint is the bearing, and reckoning follows the geodesic") {
  Navigator nav{Belief{MetresPerSecond{0.3}, 1}};
  const auto goal = destination(kHome, Bearing{degrees(57)}, Metres{20'000});
  nav.read(list_of({goal}, 100), kHome, 0);
  nav.dive(kHome, 0, current(0, 0));
  fly(nav, 14'400, 4);
  // 4320 m towards the waypoint. Euler steps of 1.2 m with the metric at their start err by a step's change of metric,
  // far below a millimetre each; the bearing is renewed each cycle, so errors across the track do not add up.
  CHECK(distance(nav.reckoned(), destination(kHome, Bearing{degrees(57)}, Metres{4320})).si() < 0.5);
}

TEST_CASE("with correction 1 the reckoned track is straight and one heading is held in a uniform current") {
  Navigator nav{Belief{MetresPerSecond{0.3}, 1}};
  const auto believed = current(0.12, -0.10);
  nav.read(list_of({destination(kHome, Bearing{degrees(20)}, Metres{30'000})}, 100), kHome, 0);
  nav.dive(kHome, 0, believed);
  const auto headings = fly(nav, 14'400, 4);
  const double wanted = simulator::aim(Bearing{degrees(20)}, believed, MetresPerSecond{0.3}).degrees();
  // The geodesic's own bearing turns by Δλ·sin φ ≈ 0.009° over the 1.2 km of easting flown here; nothing else does.
  for (const double h : headings) REQUIRE(std::fabs(h - wanted) < 0.05);
}

TEST_CASE("with correction 0 the measured current is ignored in aim and reckoning") {
  Navigator nav{Belief{MetresPerSecond{0.3}, 0}};
  nav.read(list_of({destination(kHome, Bearing{degrees(90)}, Metres{30'000})}, 100), kHome, 0);
  nav.dive(kHome, 0, current(0.5, 0.5));
  CHECK(nav.used() == current(0, 0));
  const auto headings = fly(nav, 3600, 4);
  CHECK(headings.front() == Approx(90).margin(1e-9));
  CHECK(distance(nav.reckoned(), kHome).si() == Approx(1080).epsilon(1e-4));
}

TEST_CASE("a waypoint is hit on reckoned distance below the radius, and the next one is steered to") {
  Navigator nav{Belief{MetresPerSecond{0.5}, 0}};
  const auto first = destination(kHome, Bearing{}, Metres{1000}),
             second = destination(first, Bearing{degrees(90)}, Metres{5000});
  nav.read(list_of({first, second}, 200), kHome, 0);
  nav.dive(kHome, 0, {});
  // The ring is crossed after 800 m = 1600 s; the test stands at the start of a cycle.
  fly(nav, 1600, 4);
  CHECK(nav.target() == 0);
  nav.cycle(1600, 4);
  const auto heading = nav.cycle(1604, 4);
  CHECK(nav.target() == 1);
  CHECK(nav.hits() == 1);
  CHECK(nav.last_achieved() == first);
  CHECK(nav.waypoint_since_s() >= 1600);
  CHECK(heading.degrees() == Approx(geodesic(nav.reckoned(), second).departing.degrees()).margin(0.1));
}

TEST_CASE("a loop goes on with the first waypoint, and a list inside one radius does not spin") {
  Navigator nav{Belief{MetresPerSecond{0.5}, 0}};
  const auto near = destination(kHome, Bearing{}, Metres{50});
  nav.read(list_of({near, kHome, near}, 500), kHome, 0);
  nav.dive(kHome, 0, {});
  nav.cycle(0, 4);
  CHECK(nav.hits() == 3);
  CHECK(nav.target() == 0);
  CHECK_FALSE(nav.ended());
}

TEST_CASE("a list flown once ends at its last waypoint, end_action says whether the mission ends with it") {
  const auto first = destination(kHome, Bearing{}, Metres{500});
  for (const int end_action : {0, 6}) {
    Navigator nav{Belief{MetresPerSecond{0.5}, 0}};
    auto list = list_of({first, destination(first, Bearing{}, Metres{500})}, 100);
    list.legs = -2;
    list.end_action = end_action;
    nav.read(list, kHome, 0);
    nav.dive(kHome, 0, {});
    const auto headings = fly(nav, 2400, 4);
    CHECK(nav.hits() == 2);
    CHECK(nav.ended());
    CHECK(nav.quit() == (end_action == 0));
    CHECK(headings.back() == Approx(headings[headings.size() - 10]).margin(1e-9));  // the last heading is held
  }
}

TEST_CASE("N legs end after exactly N waypoints, going round when N exceeds the list") {
  Navigator nav{Belief{MetresPerSecond{0.5}, 0}};
  const auto first = destination(kHome, Bearing{}, Metres{500});
  auto list = list_of({first, kHome}, 100);
  list.legs = 3;
  nav.read(list, kHome, 0);
  nav.dive(kHome, 0, {});
  fly(nav, 7200, 4);
  CHECK(nav.hits() == 3);
  CHECK(nav.last_achieved() == first);
  CHECK(nav.ended());
}

TEST_CASE("initial_wpt chooses the closest, the one after the last achieved, or an index") {
  const auto a = destination(kHome, Bearing{}, Metres{5000}), b = destination(kHome, Bearing{degrees(90)}, Metres{800}),
             c = destination(kHome, Bearing{degrees(180)}, Metres{9000});
  auto list = list_of({a, b, c}, 100);
  Navigator nav{Belief{MetresPerSecond{0.5}, 0}};
  list.initial = -2;
  nav.read(list, kHome, 0);
  CHECK(nav.target() == 1);
  nav.dive(kHome, 0, {});
  fly(nav, 1600, 4);  // b is achieved
  REQUIRE(nav.last_achieved() == b);
  list.initial = -1;
  nav.read(list, kHome, 0);
  CHECK(nav.target() == 2);
  list.initial = 0;
  nav.read(list, kHome, 0);
  CHECK(nav.target() == 0);
}

TEST_CASE("a re-read list starts again at its initial waypoint, though that was passed") {
  Navigator nav{Belief{MetresPerSecond{0.5}, 0}};
  const auto first = destination(kHome, Bearing{}, Metres{1000});
  nav.read(list_of({first, destination(first, Bearing{}, Metres{9000})}, 100), kHome, 0);
  nav.dive(kHome, 0, {});
  fly(nav, 4000, 4);
  REQUIRE(nav.target() == 1);
  nav.read(nav.list(), nav.reckoned(), 4000);
  nav.dive(nav.reckoned(), 4000, {});
  CHECK(std::fabs(nav.cycle(4000, 4).degrees() - 180) < 0.1);
}

TEST_CASE("with list_stop_when 5 no waypoint is ever hit") {
  Navigator nav{Belief{MetresPerSecond{0.5}, 0}};
  auto list = list_of({destination(kHome, Bearing{}, Metres{200})}, 100);
  list.stop_when = 5;
  nav.read(list, kHome, 0);
  nav.dive(kHome, 0, {});
  fly(nav, 1000, 4);
  CHECK(nav.hits() == 0);
}

TEST_CASE(
    "the last achieved waypoint is known again from a file's rounding, and the last of a list leads to the first") {
  const auto a = destination(kHome, Bearing{}, Metres{900}), b = destination(kHome, Bearing{}, Metres{5000});
  Navigator nav{Belief{MetresPerSecond{0.5}, 0}};
  nav.read(list_of({a, b}, 100), kHome, 0);
  nav.dive(kHome, 0, {});
  fly(nav, 2000, 4);
  REQUIRE(nav.last_achieved() == a);
  // 1e-4 minute is 0.19 m: half of that in each direction is what rounding does.
  auto list = list_of({destination(a, Bearing{degrees(45)}, Metres{0.13}), b}, 100);
  list.initial = -1;
  nav.read(list, kHome, 2000);
  CHECK(nav.target() == 1);
  list.waypoints = {b, a};
  nav.read(list, kHome, 2000);
  CHECK(nav.target() == 0);
  list.waypoints = {b, destination(a, Bearing{}, Metres{50})};  // another place: from the beginning
  nav.read(list, kHome, 2000);
  CHECK(nav.target() == 0);
}

TEST_CASE("with list_stop_when 15 a waypoint is left behind beyond its distance") {
  // Inside 500 m of the first point the glider steers to it, over it and back. A current of twice its
  // speed carries it from 10 m to 500 m in 490/(1.0 - 0.5) = 980 s; the cycle after that ends the list.
  auto list = list_of({kHome}, 500);
  list.stop_when = 15;
  list.legs = -2;
  list.end_action = 6;
  Navigator still{Belief{MetresPerSecond{0.5}, 1}};
  still.read(list, kHome, 0);
  still.dive(destination(kHome, Bearing{}, Metres{400}), 0, {});
  fly(still, 6000, 4);
  CHECK(still.hits() == 0);
  CHECK(distance(still.reckoned(), kHome).si() < 5);
  Navigator carried{Belief{MetresPerSecond{0.5}, 1}};
  carried.read(list, kHome, 0);
  carried.dive(destination(kHome, Bearing{}, Metres{10}), 0, current(0, 1.0));
  fly(carried, 976, 4);
  CHECK(carried.hits() == 0);
  fly(carried, 16, 4);
  CHECK(carried.hits() == 1);
  CHECK(carried.ended());
}

TEST_CASE("reckoning takes a speed measured now, the aim the believed one") {
  Navigator nav{Belief{MetresPerSecond{0.3}, 1}};
  nav.read(list_of({destination(kHome, Bearing{}, Metres{50'000})}, 100), kHome, 0);
  nav.dive(kHome, 0, current(0.15, 0));
  const auto heading = nav.cycle(0, 1000, MetresPerSecond{0.2});
  CHECK(heading.degrees() == Approx(330).margin(1e-6));  // asin(0.15/0.3)
  // North 0.2·cos 30° for 1000 s, one Euler step: exact in the metric of its start.
  CHECK(distance(kHome, GeoPoint{nav.reckoned().lat, kHome.lon}).si() ==
        Approx(1000 * 0.2 * std::cos(degrees(30).si())).epsilon(1e-4));
}
