#include "core/planning/astar.hpp"

#include <catch2/catch.hpp>

#include "core/planning/lattice_search.hpp"
#include "tests/contract/planner_contract.hpp"

using namespace glidehelm;
using planning::AStar;
using planning::GridKind;
using planning::LatticeChoice;

namespace {

planning::LatticeWay found(const planning::Problem& p, ocean::FieldRef field, double spacing_m = 3000) {
  return planning::search_lattice(p, {field, field}, chart::Chart{}, {},
                                  {.grid = p.lattice, .spacing = Metres{spacing_m}});
}

/// How much longer the shortest way over directions at most `apart` degrees from each other is than the straight one.
double worst_factor(double apart) { return 1 / std::cos(0.5 * apart * kPi / 180); }

}  // namespace

TEST_CASE("astar keeps the planner contract but for still water over a lattice") {
  // Not the thousandth in still water: directions between those of the lattice cost its geometry factor (below).
  const AStar planner;
  SECTION("on every analytic sea the plan flies as it says, and is the same again") {
    test::fly_analytic_seas(planner);
  }
  SECTION("land and areas are never crossed") { test::never_cross_land(planner); }
  SECTION("work limits hold, and a cut can be repeated by its count") { test::respect_the_budget(planner); }
  SECTION("what cannot be planned is said with its reason") { test::explain_failures(planner); }
  SECTION("a start inside the goal has arrived") { test::arrive_where_they_are(planner); }
}

TEST_CASE("in still water the way over the lattice is longer by the geometry factor of its neighbours") {
  // Over 8 neighbours a way of x along the rows and y < x across them is x − y + √2·y long; over 16 the steps nearest in direction
  // are (1, 0) and (2, 1): x − 2y + √5·y for y < x/2; over 6 triangles x + y/√3. Only the last segment leaves
  // the lattice, straight on to the goal from at most 1.5 steps and the radius away, where it saves its share of the excess. Lengths
  // change by 1 − cos over the 0.3° of the way: nothing.
  struct Row {
    LatticeChoice choice;
    double length;  ///< for x = 60 km, y = 24 km
    double reach;   ///< of the last segment, in spacings
  };
  const double x = 60e3, y = 24e3, straight = std::hypot(x, y);
  for (const auto& row : {Row{{8, 1, GridKind::regular}, x - y + std::sqrt(2.0) * y, 1.5 * std::sqrt(2.0)},
                          {{16, 1, GridKind::regular}, x - 2 * y + std::sqrt(5.0) * y, 1.5 * std::sqrt(5.0)},
                          {{8, 2, GridKind::regular}, x - 2 * y + std::sqrt(5.0) * y, 1.5 * std::sqrt(5.0)},
                          {{24, 1, GridKind::regular}, x - 2 * y + std::sqrt(5.0) * y, 1.5 * std::sqrt(8.0)},
                          {{8, 1, GridKind::triangular}, x + y / std::sqrt(3.0), 1.5}}) {
    const auto start = geo_point(0, 20);
    const auto metric = LocalMetric::at(0);
    const auto goal = GeoPoint::from_kernel(y / metric.meridian_radius, 20 * kPi / 180 + x / metric.parallel_radius);
    const test::Uniform still = test::still_water();
    auto p = test::problem_between(start, goal, 500);
    p.schedule.time_to_dive = Seconds{0};
    p.lattice = row.choice;
    p.horizon_s = test::kT0 + 20 * 86400;
    const auto way = found(p, still, 1000);
    INFO(row.choice.neighbours << ", radius " << row.choice.radius << ", kind " << static_cast<int>(row.choice.grid));
    REQUIRE(way.arrives);
    const double under = p.schedule.stint / (p.schedule.stint + p.schedule.surface);
    const double flown = (way.arrival_s - test::kT0) * 0.3 * under + 500;
    // Two spacings of the triangles' rows do not meet the goal, which costs less than one of them.
    const double odd = row.choice.grid == GridKind::triangular ? 1000 : 0;
    CHECK(flown <= row.length + 5 + odd);
    CHECK(flown >= row.length - (row.length / straight) * (row.reach * 1000 + 500) - 5);
    CHECK(flown >= straight - 5);
  }
}

TEST_CASE("a way along a direction of the lattice is straight, and in a current takes its closed form") {
  const test::Uniform current{0.05, 0.12};
  auto p = test::problem_between(geo_point(0, 0), geo_point(0, 0.5), 500);
  p.schedule.time_to_dive = Seconds{0};
  const double under = p.schedule.stint / (p.schedule.stint + p.schedule.surface);
  const double way = distance(geo_point(0, 0), geo_point(0, 0.5)).si() - 500, speed = 0.3 * under;
  const double t = way / (std::sqrt(speed * speed - 0.12 * 0.12) + 0.05);
  // The lengths of segments are good to 1e-4.
  CHECK(found(p, current).arrival_s - test::kT0 == Approx(t).epsilon(1e-4));
}

TEST_CASE("plans in still water lie between the straight way and the worst of their lattice") {
  const auto still = test::still_water();
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{still, still}};
  struct Row {
    LatticeChoice choice;
    double apart;  ///< degrees between directions: 45, 26.6, 60, 30; irregular cells may be 1:4
  };
  for (const auto& row : {Row{{8, 1, GridKind::regular}, 45},
                          {{16, 1, GridKind::regular}, 26.6},
                          {{24, 1, GridKind::regular}, 26.6},
                          {{8, 1, GridKind::triangular}, 60},
                          {{16, 1, GridKind::triangular}, 30},
                          {{8, 1, GridKind::irregular}, 76}})
    for (const double bearing : {0.0, 22.5, 75.0, 190.0, 300.0}) {
      auto p = test::problem_between(geo_point(45, 179.7),
                                     destination(geo_point(45, 179.7), Bearing{degrees(bearing)}, Metres{70e3}), 1000);
      p.lattice = row.choice;
      const auto plan = AStar{}.plan(p, members, chart::Chart{}, {}, {});
      INFO(row.choice.neighbours << ", kind " << static_cast<int>(row.choice.grid) << ", bearing " << bearing);
      REQUIRE(plan);
      REQUIRE(plan->reaches_goal());
      CHECK(plan->method == "astar");
      test::check_plan(*plan, p, {still, still}, chart::Chart{});
      const double straight = planning::still_water_time(p).count(), took = plan->arrival_s - test::kT0;
      CHECK(took >= straight - 60);
      CHECK(took <= worst_factor(row.apart) * straight + p.schedule.surface.count());
    }
}

TEST_CASE("a current beyond the cone of eight directions needs more of them: Thesis Figure 4.5") {
  // The current is three times as strong as the glider and runs between two of the eight directions: its cone of ±19.5° holds none of
  // them (22.5° away), but one of the sixteen (26.57°, 4° away). So eight find no segment at all.
  const double speed = 0.9, towards = 22.5 * kPi / 180;
  const test::Uniform strong{speed * std::sin(towards), speed * std::cos(towards)};
  const auto from = geo_point(0, 0);
  auto p = test::problem_between(from, destination(from, Bearing{Radians{std::atan(0.5)}}, Metres{60e3}), 500);
  p.horizon_s = test::kT0 + 5 * 86400;
  p.schedule.time_to_dive = Seconds{0};
  p.lattice = {8, 1, GridKind::regular};
  const auto none = found(p, strong);
  CHECK_FALSE(none.arrives);
  CHECK(none.stopped.too_strong);
  CHECK(none.statistics.expansions == 1);
  for (const auto& choice : {LatticeChoice{16, 1, GridKind::regular}, LatticeChoice{8, 2, GridKind::regular}}) {
    p.lattice = choice;
    CHECK(found(p, strong).arrives);
  }
  // The plan of eight is a closest approach with that reason, or says that there is none.
  p.lattice = {8, 1, GridKind::regular};
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{strong, strong}};
  const auto plan = AStar{}.plan(p, members, chart::Chart{}, {}, {});
  REQUIRE_FALSE(plan);
  CHECK(plan.error().what == planning::NoPlan::boxed_in);
  CHECK(plan.error().message.find("no course of the lattice") != std::string::npos);
}

TEST_CASE("the heuristic is admissible: an earlier way is not missed for want of expansions") {
  // The same search without a bound on currents worth the name: `fastest` ten times too high lets h fall to a fraction, and everything
  // is expanded. Both must find the same arrival.
  auto sea = test::analytic_seas().at(5);
  const auto& field = sea.field;
  const test::FromFunction wary{
      [&](double lat, double lon, double t) {
        const auto s = field.sample(GeoPoint::from_kernel(lat, lon), Depth{}, t);
        return s ? std::pair{s->current.east.si(), s->current.north.si()} : std::pair{0.0, 0.0};
      },
      10 * field.fastest().si(), field.coverage()};
  const auto usual = found(sea.problem, field), all = found(sea.problem, wary);
  REQUIRE(usual.arrives);
  CHECK(usual.arrival_s == Approx(all.arrival_s).epsilon(1e-12));
  CHECK(usual.statistics.expansions < all.statistics.expansions);
}
