#include "core/planning/cts_astar.hpp"

#include <catch2/catch.hpp>

#include "core/planning/flight.hpp"
#include "core/planning/to_go.hpp"
#include "tests/core/planning/exhaustive.hpp"

using namespace glidehelm;
using planning::CtsAStar;

namespace {

Expected<planning::Plan, planning::PlanFailure> cts(const planning::Problem& p, ocean::FieldRef field,
                                                    const chart::Chart& chart = {},
                                                    const planning::Budget& budget = {}) {
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{field, field}};
  return CtsAStar{}.plan(p, members, chart, budget, {});
}

chart::Chart walls(std::vector<chart::Area> keep_out) {
  chart::ChartSources sources;
  sources.keep_out = std::move(keep_out);
  return chart::Chart{std::move(sources)};
}

chart::Area rectangle(GeoPoint south_west, double width_deg, double height_deg) {
  const double lat = south_west.lat.degrees(), lon = south_west.lon.degrees();
  return {"wall",
          {south_west, geo_point(lat, lon + width_deg), geo_point(lat + height_deg, lon + width_deg),
           geo_point(lat + height_deg, lon)}};
}

}  // namespace

TEST_CASE("on every analytic sea the plan is within 2 % of an exhaustive search") {
  // Must show 4. 24 headings, every sequence of up to six stints; the exhaustive search is this test's own, integrator
  // included. It looks only for what is earlier than the plan.
  for (const auto& sea : test::analytic_seas()) {
    INFO(sea.name);
    const auto plan = cts(sea.problem, sea.field);
    REQUIRE(plan);
    CHECK(plan->method == "cts-astar");
    REQUIRE(plan->reaches_goal());
    const double ours = plan->arrival_s - test::kT0;
    test::Exhaustive exhaustive{sea.problem, sea.field, 24, 6, ours};
    const double best = exhaustive.travel_time();
    INFO("plan " << ours / 3600 << " h, exhaustive " << best / 3600 << " h, " << exhaustive.stints_flown()
                 << " stints");
    CHECK(exhaustive.stints_flown() > 24);
    CHECK(ours <= 1.02 * best);
  }
}

TEST_CASE("the heuristic never exceeds what is left: no wider search finds an earlier arrival") {
  // An inadmissible bound would end the search early. With M = 1 no choice is left but the goal's direction, and the
  // arrival must be that of flying it.
  const test::Uniform field{0.25, 0};
  auto p = test::problem_between(geo_point(0, 0), geo_point(0, 1.0), 500);
  p.headings = 1;
  const auto found = planning::search(p, {field, field}, chart::Chart{}, {});
  const double way = distance(p.start.fix, planning::disc_of(p).centre).si() - 500, cycle = 28800 * 0.55 + 900 * 0.25;
  const double whole = std::floor((way - 225) / cycle);
  const double t = 900 + whole * 29700 + (way - 225 - whole * cycle) / 0.55;
  CHECK(found.arrival_s - test::kT0 == Approx(t).epsilon(1e-5));
  CHECK(found.statistics.expansions == static_cast<std::uint64_t>(whole) + 1);  // straight on, nothing expanded twice
}

TEST_CASE("a surface current makes the drift count, also when the goal is crossed in it") {
  // The water at the surface runs east at 0.6 m/s and is still below: the goal lies where a drift passes.
  const auto still = test::still_water();
  const test::Uniform wind{0.6, 0};
  auto p = test::problem_between(geo_point(0, 0), geo_point(0, 0.2), 500);
  const double way = distance(p.start.fix, planning::disc_of(p).centre).si();
  // First drift 540 m, stint 8640 m; the disc's edge 270 m into the drift that follows.
  p.goal = planning::PointGoal{planning::disc_of(p).centre, Metres{way - (540 + 8640 + 270)}};
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{still, wind}};
  const auto plan = CtsAStar{}.plan(p, members, chart::Chart{}, {}, {});
  REQUIRE(plan);
  REQUIRE(plan->reaches_goal());
  CHECK(plan->arrival_s - test::kT0 == Approx(900 + 28800 + 450).margin(5));
  REQUIRE(plan->stints.size() == 1);
  CHECK(plan->stints[0].arrives);
}

TEST_CASE("where one stint does not leave the cell the heading is held for several") {
  const auto still = test::still_water();
  auto p = test::problem_between(geo_point(0, 0), geo_point(0, 0.5), 500);
  p.cell = Metres{20e3};  // two and a half stints wide
  const auto found = planning::search(p, {still, still}, chart::Chart{}, {});
  const double underwater = (distance(p.start.fix, planning::disc_of(p).centre).si() - 500) / 0.3;
  CHECK(found.arrival_s - test::kT0 == Approx(p.schedule.travel_time(Seconds{underwater}).count()).epsilon(1e-3));
  CHECK(found.headings.size() == static_cast<std::size_t>(std::ceil(underwater / 28800)));
  // A cell that no permitted multiple leaves gives no way, and no endless loop.
  p.cell = Metres{2e6};
  const auto none = planning::search(p, {still, still}, chart::Chart{}, {});
  CHECK(none.exhausted);
}

TEST_CASE("a finer search is only done while it is cheap and no cell is named") {
  const auto sea = test::analytic_seas().back();
  auto p = sea.problem;
  const auto fine = cts(p, sea.field);
  p.cell = planning::cell_of(p);
  const auto coarse = cts(p, sea.field);
  REQUIRE(fine);
  REQUIRE(coarse);
  CHECK(fine->statistics.expansions > coarse->statistics.expansions);
  CHECK(fine->arrival_s <= coarse->arrival_s);
}

TEST_CASE("a first stint of its own length and a long wait before it are in the plan") {
  const auto still = test::still_water();
  auto p = test::problem_between(geo_point(28, -16), geo_point(28.4, -16), 500);
  p.schedule.first_stint = Seconds{2 * 3600.0};
  p.schedule.time_to_dive = Seconds{3000};
  const auto plan = cts(p, still);
  REQUIRE(plan);
  REQUIRE(plan->reaches_goal());
  const double underwater = (distance(p.start.fix, planning::disc_of(p).centre).si() - 500) / 0.3;
  CHECK(plan->arrival_s - test::kT0 == Approx(p.schedule.travel_time(Seconds{underwater}).count()).epsilon(1e-3));
  CHECK(plan->stints[0].surface_s - plan->stints[0].dive_s == Approx(7200));
}

TEST_CASE("a way between two walls is found although the margin leaves little of it") {
  const auto still = test::still_water();
  // A wall along 28.2° N with a gap of 6 km at 16° W: 2 km are left between the margins.
  const double half = 3000 / (111.3e3 * std::cos(28.2 * kPi / 180));
  const auto chart =
      walls({rectangle(geo_point(28.2, -17), 1 - half, 0.05), rectangle(geo_point(28.2, -16 + half), 1, 0.05)});
  auto p = test::problem_between(geo_point(28.0, -16.15), geo_point(28.45, -15.9));
  p.coast_margin = Metres{2000};
  p.schedule.stint = p.schedule.first_stint = Seconds{4 * 3600.0};
  const auto plan = cts(p, still, chart);
  REQUIRE(plan);
  REQUIRE(plan->reaches_goal());
  const auto waters = planning::waters_of(p, {still, still}, chart);
  CHECK_FALSE(fly_list(list_for(plan->stints, planning::flight_of(p), waters, {}), planning::flight_of(p), waters)
                  .stints.empty());
}

TEST_CASE("a start inside the margin leaves outwards") {
  const auto still = test::still_water();
  const auto chart = walls({rectangle(geo_point(27.8, -16.2), 0.4, 0.19)});
  auto p = test::problem_between(geo_point(28.0, -16.0), geo_point(28.3, -16.0));  // 1.1 km north of the wall
  p.coast_margin = Metres{2000};
  const auto plan = cts(p, still, chart);
  REQUIRE(plan);
  CHECK(plan->reaches_goal());
}

TEST_CASE("behind a closed wall the answer is a closest approach that says so") {
  const auto still = test::still_water();
  const auto chart = walls({rectangle(geo_point(28.2, -20), 8, 0.05)});
  auto p = test::problem_between(geo_point(28.0, -16), geo_point(28.4, -16));
  const auto plan = cts(p, still, chart);
  REQUIRE(plan);
  CHECK_FALSE(plan->reaches_goal());
  CHECK(plan->reason.find("margin") != std::string::npos);
  CHECK_FALSE(plan->stints.empty());
  // It comes to the wall, whose sides are geodesics that lie farthest north in the middle; a stint is 8.6 km long.
  const auto side = geodesic(geo_point(28.2, -20), geo_point(28.2, -12));
  const auto near_side = destination(geo_point(28.2, -20), side.departing, 0.5 * side.length);
  const double to_wall = distance(near_side, planning::disc_of(p).centre).si();
  CHECK(plan->remaining.si() >= to_wall - 10);
  CHECK(plan->remaining.si() < to_wall + 8.7e3);
}

TEST_CASE("a goal beyond the horizon, or beyond the end of the forecast, is said to be that") {
  const auto still = test::still_water();
  auto p = test::problem_between(geo_point(28, -16), geo_point(29, -16));
  p.horizon_s = test::kT0 + 3 * 86400;
  const auto late = cts(p, still);
  REQUIRE(late);
  CHECK_FALSE(late->reaches_goal());
  CHECK(late->reason.find("horizon of 72.0 h") != std::string::npos);
  // 8 stints of 8640 m come within three days, the ninth would end beyond.
  CHECK(late->remaining.si() ==
        Approx(distance(p.start.fix, planning::disc_of(p).centre).si() - 8 * 8640).epsilon(1e-3));

  struct Ends {
    [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint, Depth, double t) const {
      if (t > test::kT0 + 2 * 86400) return unexpected(ocean::NoCurrent::outside_time);
      return ocean::Sample{};
    }
    [[nodiscard]] ocean::Coverage coverage() const { return {}; }
    [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{0}; }
  };
  const Ends ends;
  p.horizon_s = test::kT0 + 30 * 86400;
  const auto cut = cts(p, ends);
  REQUIRE(cut);
  CHECK_FALSE(cut->reaches_goal());
  CHECK(cut->reason.find("forecast ends") != std::string::npos);
}

TEST_CASE("a current stronger than the glider carries it away: no nearer position, no plan") {
  const test::Uniform field{0, -0.8};
  const auto p = test::problem_between(geo_point(28, -16), geo_point(28.4, -16));
  const auto plan = cts(p, field);
  REQUIRE_FALSE(plan);
  CHECK(plan.error().what == planning::NoPlan::boxed_in);
  CHECK(plan.error().message.find("horizon") != std::string::npos);
}

TEST_CASE("across 180 degrees and far south the plan is the one of elsewhere") {
  ocean::AnalyticSpec spec;
  spec.kind = "solid-body";
  spec.length_scale = Metres{60e3};
  spec.speed_scale = MetresPerSecond{0.15};
  const auto time_at = [&](double lon) {
    spec.origin = geo_point(-60, lon);
    const auto field = *ocean::AnalyticField::make(spec, instant_at(test::kT0), test::box_around(spec.origin, 1.5));
    const auto from = destination(spec.origin, Bearing{degrees(200)}, Metres{40e3});
    const auto plan =
        cts(test::problem_between(from, destination(spec.origin, Bearing{degrees(80)}, Metres{30e3})), field);
    REQUIRE(plan);
    REQUIRE(plan->reaches_goal());
    return plan->arrival_s;
  };
  // Longitudes near 180° round differently, by 1e-14: the same labels, the same plan.
  CHECK(time_at(179.9) == Approx(time_at(20)).margin(0.1));
}

TEST_CASE("memory and work of a long way are bounded by the grid, 32 evaluations a stint and a little for the drifts") {
  ocean::AnalyticSpec spec;
  spec.kind = "tiled";
  spec.origin = geo_point(28, -16);
  spec.length_scale = Metres{15e3};
  spec.speed_scale = MetresPerSecond{0.2};
  const auto field = *ocean::AnalyticField::make(spec, instant_at(test::kT0), test::box_around(spec.origin, 4));
  auto p = test::problem_between(spec.origin, destination(spec.origin, Bearing{degrees(50)}, Metres{200e3}), 2000);
  p.headings = 18;
  // Made before, as a planner does: what it evaluates is not the stints'.
  const planning::ToGo to_go{p, {field, field}, chart::Chart{}};
  planning::CtsSettings settings;
  settings.to_go = &to_go;
  const auto found = planning::search(p, {field, field}, chart::Chart{}, {}, settings);
  CHECK(found.exhausted);
  CHECK_FALSE(std::isnan(found.arrival_s));
  CHECK(found.step_s == 3600);
  CHECK(found.statistics.expansions <= found.labels);
  CHECK(static_cast<double>(found.labels) <= 1.5 * static_cast<double>(found.cells));
  const double per_stint = static_cast<double>(found.statistics.current_evaluations) /
                           static_cast<double>(found.statistics.cost_evaluations);
  CHECK(per_stint >= 32);
  CHECK(per_stint <= 34);
}

TEST_CASE("an earlier arrival than the one in hand is found or none is reported") {
  const auto sea = test::analytic_seas().at(4);
  const ocean::Ocean ocean{sea.field, sea.field};
  const auto found = planning::search(sea.problem, ocean, chart::Chart{}, {});
  REQUIRE_FALSE(std::isnan(found.arrival_s));
  CHECK(std::isnan(planning::search(sea.problem, ocean, chart::Chart{}, {}, {{}, {}, found.arrival_s}).arrival_s));
  CHECK(planning::search(sea.problem, ocean, chart::Chart{}, {}, {{}, {}, found.arrival_s + 1}).arrival_s ==
        found.arrival_s);
}

TEST_CASE("where the goal is out of reach the search goes on to the end for the nearest place") {
  // Against a current of two thirds of U the bound still hopes (U + |c|) where the glider itself cannot arrive: after half of the
  // horizon the way left is more than hope can cover, and yet every further stint brings it nearer.
  const test::Uniform current{-0.2, 0.0};
  const ocean::Ocean ocean{current, current};
  const std::array<ocean::Ocean, 1> members{ocean};
  const auto from = geo_point(0.0, 10.0);
  auto problem = test::problem_between(from, destination(from, Bearing{degrees(90)}, Metres{100e3}));
  problem.believed_current = Current{MetresPerSecond{-0.2}, MetresPerSecond{0}};
  problem.horizon_s = test::kT0 + 8.3 * 8 * 3600;
  const auto plan = planning::CtsAStar{}.plan(problem, members, chart::Chart{}, {}, {});
  REQUIRE(plan);
  CHECK_FALSE(plan->reaches_goal());
  REQUIRE(plan->stints.size() == 8);
  // Eight stints at 0.1 m/s over ground, and a drift of 15 min against before each. The law of the last minutes costs up to 1 %.
  const double covered = 8 * 8 * 3600 * 0.1 - 8 * 900 * 0.2;
  CHECK(plan->remaining.si() == Approx(100e3 - covered).margin(0.02 * covered + 100));
}
