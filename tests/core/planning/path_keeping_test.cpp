#include "core/planning/path_keeping.hpp"

#include <catch2/catch.hpp>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

/// Where the headings come up when they are held.
std::vector<vehicle::State> held(std::span<const Heading> headings, const planning::Problem& p,
                                 const vehicle::Waters& waters) {
  std::vector<vehicle::State> surfacings;
  auto at = vehicle::state_at(p.start.fix, p.start.fix_s, waters);
  for (std::size_t k = 0; k < headings.size(); ++k) {
    const auto n = static_cast<int>(k);
    at = vehicle::move(waters, waters.ocean.surface, at, p.schedule.drift_before(n).count(), {}, nullptr).end;
    at = vehicle::move(waters, waters.ocean.dive, at, p.schedule.stint_length(n).count(),
                       vehicle::WaterVelocity::of(headings[k], p.glider.horizontal_speed), nullptr)
             .end;
    surfacings.push_back(at);
  }
  return surfacings;
}

}  // namespace

TEST_CASE("in still water, straight at the goal, no heading is turned") {
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  const auto p = test::problem_between(geo_point(0, 0), geo_point(0, 0.5));
  const std::vector<Heading> headings(7, Heading{degrees(90)});
  const auto flown = fly_path(headings, p, ocean, chart::Chart{});
  REQUIRE(flown.arrival_s);
  for (const auto& s : flown.stints) CHECK(s.heading.degrees() == Approx(90).margin(1e-6));
}

TEST_CASE("the flight stays beside the path of the held headings, where uncorrected ones wander off") {
  for (const int correction : {0, 1}) {
    auto sea = test::analytic_seas().back();
    sea.problem.glider.current_correction = correction;
    sea.problem.goal = planning::PointGoal{geo_point(40, -16), Metres{500}};  // far: nobody arrives
    sea.problem.horizon_s = test::kT0 + 60 * 86400;
    const ocean::Ocean ocean{sea.field, sea.field};
    const chart::Chart open;
    const auto waters = planning::waters_of(sea.problem, ocean, open);
    std::vector<Heading> headings;
    for (int k = 0; k < 6; ++k) headings.push_back(Heading{degrees(k % 2 == 0 ? 40 : 130)});
    const auto ideal = held(headings, sea.problem, waters);
    const double until = ideal.back().t_s + 1;
    auto flight = planning::flight_of(sea.problem);
    flight.horizon_s = until;
    const auto kept = fly_path(headings, sea.problem, ocean, open, until);
    const auto plain = vehicle::fly_headings(headings, flight, waters);
    REQUIRE(kept.stints.size() == headings.size());
    REQUIRE(plain.stints.size() == headings.size());
    double worst_kept = 0, worst_plain = 0;
    for (std::size_t k = 0; k < headings.size(); ++k) {
      worst_kept = std::max(worst_kept, distance(kept.stints[k].surface, ideal[k].at()).si());
      worst_plain = std::max(worst_plain, distance(plain.stints[k].surface, ideal[k].at()).si());
      CHECK(std::abs((kept.stints[k].heading - headings[k]).si()) <= kPi / 12 + 1e-9);
    }
    INFO("correction " << correction << ": kept " << worst_kept << " m, plain " << worst_plain << " m");
    CHECK(worst_kept < worst_plain);
    // What is left: the steering of one stint, 2·m of its way across, and what could not be made good along the track.
    CHECK(worst_kept < (correction == 1 ? 400 : 1500));
  }
}

TEST_CASE("nothing is flown after the given time") {
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  const auto p = test::problem_between(geo_point(0, 0), geo_point(0, 0.5));
  const std::vector<Heading> headings(7, Heading{degrees(90)});
  const double until = test::kT0 + p.schedule.surfacing_time(2).count() + 1;
  CHECK(fly_path(headings, p, ocean, chart::Chart{}, until).stints.size() == 3);
}

TEST_CASE("a flight that is off its path, or beyond its last heading, asks for the rest anew") {
  // Against a current that it has not measured the glider turns back in the last minutes of its first stint and surfaces 864 m
  // short (5 % of 8 h flown away instead of on, decision 016): more than half a kilometre off. One that has measured it is not.
  const test::Uniform current{-0.2, 0.0};
  const ocean::Ocean ocean{current, current};
  const auto from = geo_point(0.0, 10.0);
  auto problem = test::problem_between(from, destination(from, Bearing{degrees(90)}, Metres{100e3}));
  problem.horizon_s = test::kT0 + 5.3 * 8 * 3600;
  const std::vector<Heading> east(4, Heading{degrees(90)});
  std::vector<std::pair<int, std::size_t>> asked;
  const auto note = [&](int k, GeoPoint, double, std::span<const Heading> rest) {
    if (asked.empty() || asked.back().first != k) asked.emplace_back(k, rest.size());
    return std::vector<Heading>(rest.begin(), rest.end());
  };
  const auto plain = planning::fly_path(east, problem, ocean, chart::Chart{});
  const auto flown = planning::fly_path(east, problem, ocean, chart::Chart{}, 1e18, note);
  REQUIRE_FALSE(asked.empty());
  // Once where it is off, for the new path begins there; then for each stint after the last heading (the fifth, and the one ahead).
  using Asked = std::vector<std::pair<int, std::size_t>>;
  CHECK(asked == Asked{{1, 3}, {4, 0}, {5, 0}});
  REQUIRE(flown.stints.size() == plain.stints.size());

  asked.clear();
  problem.believed_current = Current{MetresPerSecond{-0.2}, MetresPerSecond{0}};
  planning::fly_path(east, problem, ocean, chart::Chart{}, 1e18, note);
  CHECK(asked == Asked{{4, 0}, {5, 0}});

  // What is answered is flown.
  const auto south = [](int, GeoPoint, double, std::span<const Heading>) {
    return std::vector<Heading>(2, Heading{degrees(180)});
  };
  const auto turned = planning::fly_path(std::span{east}.first(1), problem, ocean, chart::Chart{}, 1e18, south);
  REQUIRE(turned.stints.size() >= 3);
  CHECK(turned.stints[1].heading.degrees() == Approx(180).margin(15.01));  // turned by 15° at most to keep to the path
  CHECK(turned.stints[2].surface.lat < turned.stints[0].surface.lat);
}
