#include "core/planning/front_loops.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/base/units.hpp"
#include "core/planning/lower_bound.hpp"
#include "core/planning/registry.hpp"
#include "tests/bench/case_suite.hpp"
#include "tests/support/isochrones.hpp"

using namespace glidehelm;
using planning::Marker;

namespace {

constexpr double kCell = 1e-4;  // radians

/// Markers on an arc about (0, 0) of which the first is at angle `from`, clockwise from north for `sweep` > 0; normals away from the middle,
/// or to it. `radius` in cells.
std::vector<Marker> arc(double radius, double from, double sweep, bool outwards, int count) {
  std::vector<Marker> out;
  for (int i = 0; i < count; ++i) {
    const double a = from + sweep * i / (count - 1), e = std::sin(a), n = std::cos(a), sign = outwards ? 1 : -1;
    out.push_back({kCell * radius * n, kCell * radius * e, sign * e, sign * n});
  }
  out.back().cut();
  return out;
}
std::vector<Marker> all_of(const std::vector<std::vector<Marker>>& pieces) {
  std::vector<Marker> out;
  for (const auto& piece : pieces) out.insert(out.end(), piece.begin(), piece.end());
  return out;
}
/// Clockwise turns about a place, in cells to the east and north: the sum of the angles under which it sees the edges.
int turns_about(const std::vector<Marker>& front, double x, double y) {
  double sum = 0;
  planning::for_each_edge(front, [&](const Marker& from, const Marker& to) {
    const double ax = from.lon / kCell - x, ay = from.lat / kCell - y, bx = to.lon / kCell - x, by = to.lat / kCell - y;
    sum += std::atan2(bx * ay - by * ax, ax * bx + ay * by);
  });
  return static_cast<int>(std::lround(sum / (2 * kPi)));
}

}  // namespace

TEST_CASE("pieces of a front are closed with those that they meet, whatever their order") {
  // A reached ring of 10 to 20 cells: its outline in three pieces and the hole in two, which overlap a little where they meet. In the given
  // order the joins would run across the ring.
  const double third = 2 * kPi / 3;
  std::vector<std::vector<Marker>> pieces{arc(20, 0, third + 0.02, true, 40), arc(20, third, third + 0.02, true, 40),
                                          arc(20, 2 * third, third + 0.02, true, 40),
                                          arc(10, 1, -kPi - 0.02, false, 30), arc(10, 1 - kPi, -kPi - 0.02, false, 30)};
  std::vector<std::size_t> order{0, 1, 2, 3, 4};
  do {
    std::vector<std::vector<Marker>> shuffled;
    for (const auto k : order) shuffled.push_back(pieces[k]);
    const auto loops = planning::closed_loops(all_of(shuffled));
    REQUIRE(loops.size() == 180);
    CHECK(std::count_if(loops.begin(), loops.end(), [](const Marker& m) { return m.closes; }) == 2);
    for (double a = 0.05; a < 2 * kPi; a += 0.1) {
      CHECK(turns_about(loops, 5 * std::sin(a), 5 * std::cos(a)) == 0);
      CHECK(turns_about(loops, 15 * std::sin(a), 15 * std::cos(a)) == 1);
      CHECK(turns_about(loops, 25 * std::sin(a), 25 * std::cos(a)) == 0);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("a front in which nothing joins is one loop") {
  auto circle = arc(20, 0, 2 * kPi * 59 / 60, true, 60);
  circle.back().unjoin();
  const auto loops = planning::closed_loops(circle);
  REQUIRE(loops.size() == circle.size());
  CHECK(std::none_of(loops.begin(), loops.end(), [](const Marker& m) { return m.joins || m.closes; }));
}

TEST_CASE("a sheet close behind another is inside from its cut end on, and the one before it is not") {
  // 0.1 cells behind the outline: nearer than the quarter of a cell at which places round a marker are looked at.
  const auto outline = arc(20, 0, 2 * kPi * 119 / 120, true, 120);
  const auto behind = arc(19.9, 1, 1, true, 21), ahead = arc(20.1, 3, 1, true, 21);
  const auto front = all_of({outline, behind, ahead});
  const planning::Surroundings open_water{[](auto, auto) { return false; }, [](const Marker&) { return false; },
                                          [](const Marker&, double, double) { return true; }};
  const planning::Squares lattice{-0.003, -0.003, 1 / kCell, 1 / kCell};
  const auto inside = planning::deep_inside(front, lattice, open_water, std::vector<bool>(front.size(), true));
  for (std::size_t i = 0; i < front.size(); ++i) {
    INFO("marker " << i);
    if (i < 120)
      CHECK_FALSE(inside[i]);  // cut nowhere but at its own end, where no other sheet is near
    else
      CHECK(inside[i] == (i < 141));
  }
}

TEST_CASE("a front finds the same way whatever its spacing, where currents outrun the glider among islands") {
  // Many sheets come round six islands side by side and close behind them. With long joins the way was lost at 2.5 km: 871 h. Both ways
  // are of the same valley: fronts of second order are late by less than the shortest edge at coasts, 0.15 spacings of the coarser
  // front through still water (lower_bound.hpp); twice that for one beyond the other.
  const auto sea = suite::static_cases(MetresPerSecond{0.2}, 16).back();
  const auto arrival = [&](double spacing) {
    return planning::front_arrival(sea.problem, sea.ocean(), sea.chart(), Metres{spacing}, Seconds{3600});
  };
  const double coarse = arrival(5000), fine = arrival(2500);
  INFO(coarse / 3600 << " h and " << fine / 3600 << " h");
  CHECK(std::abs(coarse - fine) < 2 * 0.15 * 5000 / 0.2);
}

TEST_CASE("at every surfacing of a plan the front is there") {
  // The front is late by no more than its error, which the bar holds, and goes ahead through the water with U: as far may a surfacing lie
  // outside it.
  auto seas = suite::jet_cases();
  for (auto& sea : suite::static_cases(MetresPerSecond{0.4}, 2)) seas.push_back(std::move(sea));
  for (const auto& sea : seas) {
    const std::array<ocean::Ocean, 1> members{sea.ocean()};
    const auto plan = planning::planner_named("cts-astar")->plan(sea.problem, members, sea.chart(), {}, {});
    REQUIRE(plan);
    REQUIRE(plan->reaches_goal());
    planning::BoundSettings settings;
    settings.surfacings_per_isochrone = 1;
    settings.earlier_than_s = plan->arrival_s;
    const auto bound = planning::lower_bound(sea.problem, sea.ocean(), sea.chart(), {}, settings);
    REQUIRE(bound);
    REQUIRE_FALSE(bound->isochrones.empty());
    for (std::size_t k = 0; k < std::min(bound->isochrones.size(), plan->stints.size()); ++k) {
      const auto& isochrone = bound->isochrones[k];
      const auto at = plan->stints[k].surface;
      REQUIRE(isochrone.t_s == Approx(plan->stints[k].surface_s).margin(1));
      INFO(sea.name << ", surfacing " << k << ", " << test::distance_to(isochrone, at) << " m from the front");
      CHECK((test::encloses(isochrone, at) ||
             test::distance_to(isochrone, at) <= bound->error_s * sea.problem.glider.horizontal_speed.si()));
    }
  }
}
