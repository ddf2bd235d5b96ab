#include "core/planning/link_chain.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/planning.hpp"

using namespace glidehelm;

TEST_CASE("a link in still water answers as plane geometry says") {
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  const auto p = test::problem_between(geo_point(0, 0), geo_point(0, 1));
  const chart::Chart open;
  planning::HeldFlight flight{p, ocean, open, Metres{0}};
  const double psi = 0.7, way = p.glider.horizontal_speed.si() * p.schedule.stint_length(1).count();
  const planning::Steps steps{200, 200 / way};
  const auto m = planning::measure_link(flight, 1, 0, 0, psi, 1e18, steps);
  REQUIRE(m);
  // The end is x + way·(sin ψ, cos ψ). Central differences of a sine with step h are short by h²/6 of it, second ones by h²/12; the metres of a
  // degree change by less than 1e-5 along the 10 km.
  const double h = steps.turn, share = h * h / 6 + 1e-5;
  const auto &east = m->link.east, &north = m->link.north;
  CHECK(east.by_place[0] == Approx(1).epsilon(1e-4));
  CHECK(std::abs(east.by_place[1]) < 1e-4);
  CHECK(north.by_place[1] == Approx(1).epsilon(1e-4));
  CHECK(std::abs(north.by_place[0]) < 1e-4);
  CHECK(east.by_turn == Approx(way * std::cos(psi)).epsilon(share));
  CHECK(north.by_turn == Approx(-way * std::sin(psi)).epsilon(share));
  // 13 lanes whose places are good to a micrometre, divided by h²: 1e-6/(200/way)² = 2 mm of 7 km.
  CHECK(east.by_turns == Approx(-way * std::sin(psi)).epsilon(share + 1e-4));
  CHECK(north.by_turns == Approx(-way * std::cos(psi)).epsilon(share + 1e-4));
  CHECK(m->link.toll.by_place.norm() == 0);
  CHECK(m->end_lat > 0);
}

TEST_CASE("one link in still water is turned at the goal by Newton's step") {
  // The end is off by an angle a seen from the dive; the distance to a goal beyond, r from the end when aimed at, is least at turn −a. With f(u)
  // the distance after a turn u, Newton's step is −f'/f'' and that is what the chain must give: both are written here in closed form.
  const double way = 8000, beyond = 4000, a = 0.05;
  const double goal_e = 0, goal_n = way + beyond;  // north of the dive; the heading is a to the right of it
  planning::ChainLink link;
  link.east.by_turn = way * std::cos(a);
  link.north.by_turn = -way * std::sin(a);
  link.east.by_turns = -way * std::sin(a);
  link.north.by_turns = -way * std::cos(a);
  link.east.by_place = {1, 0};
  link.north.by_place = {0, 1};
  const Eigen::Vector2d to_end{way * std::sin(a) - goal_e, way * std::cos(a) - goal_n};
  const auto f = [&](double u) { return std::hypot(way * std::sin(a + u) - goal_e, way * std::cos(a + u) - goal_n); };
  const double h = 1e-4, slope = (f(h) - f(-h)) / (2 * h), curve = (f(h) - 2 * f(0) + f(-h)) / (h * h);
  const auto step = planning::step_along({link}, to_end, {});
  REQUIRE(step.gains.size() == 1);
  // Differences of f with h = 1e-4: rounding 1e-12·1e4/h² = 1e-4 of the curve.
  CHECK(step.gains[0].turn == Approx(-slope / curve).epsilon(1e-3));
  // It promises what Newton's step wins on a parabola; the distance itself, which also bends otherwise, gives that to a turn's size: 0.15.
  CHECK(step.promises == Approx(0.5 * slope * slope / curve).epsilon(1e-3));
  CHECK(step.promises == Approx(f(0) - f(step.gains[0].turn)).epsilon(0.15));
  // A price on turning makes the step smaller, never turns it round.
  const auto damped = planning::step_along({link}, to_end, {4, 0});
  CHECK(damped.gains[0].turn / step.gains[0].turn > 0);
  CHECK(std::abs(damped.gains[0].turn) < 0.5 * std::abs(step.gains[0].turn));
  CHECK(damped.promises > 0);
  CHECK(damped.promises < step.promises);
}

TEST_CASE("no turn is longer than the longest") {
  planning::ChainLink link;
  link.east.by_turn = 8000;
  link.east.by_place = {1, 0};
  link.north.by_place = {0, 1};
  const auto step = planning::step_along({link}, {-50e3, 1e3}, {});
  CHECK(step.gains[0].turn == Approx(planning::kLongestTurn));
}

TEST_CASE("a link at the edge of the field is none") {
  const auto sea = test::analytic_seas().front();
  const ocean::Ocean ocean{sea.field, sea.field};
  const chart::Chart open;
  planning::HeldFlight flight{sea.problem, ocean, open, Metres{0}};
  const auto box = ocean.dive.coverage();
  const double lon = 0.5 * (box.west + box.east);
  CHECK(planning::measure_link(flight, 1, 0.5 * (box.south + box.north), lon, 0, 1e18, {200, 0.02}));
  CHECK_FALSE(planning::measure_link(flight, 1, box.north - 1e-6, lon, 0, 1e18, {200, 0.02}));
}
