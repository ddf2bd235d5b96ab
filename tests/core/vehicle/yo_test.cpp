#include "core/vehicle/yo.hpp"

#include <catch2/catch.hpp>

#include "core/safety/reflight.hpp"
#include "core/vehicle/dive_by_law.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

/// Eastward, falling in a straight line from `top` at the surface to 0 at 400 m, over a bottom that is 150 m deep north of
/// 28.05 degrees.
struct Fading {
  double top{0.2};
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double) const {
    const double metres = z.below_surface.si();
    if (p.lat.degrees() > 28.05 && metres > 150) return unexpected(ocean::NoCurrent::below_bottom);
    return ocean::Sample{{MetresPerSecond{top * (1 - metres / 400)}, MetresPerSecond{0}}, false};
  }
  [[nodiscard]] ocean::Coverage coverage() const { return {}; }
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{top}; }
};

}  // namespace

TEST_CASE("a yo-yo goes down to its depth, turns between its two depths, and ends at the surface") {
  model::Glider g;
  g.horizontal_speed = MetresPerSecond{0.3};
  g.glide_angle = Radians{std::atan(0.5)};  // 0.15 m/s down
  g.dive_depth = Metres{150};
  g.climb_to = Metres{30};
  const double length = 10'000;
  CHECK(vehicle::yo_depth(g, 0, length) == 0);
  CHECK(vehicle::yo_depth(g, 500, length) == Approx(75));
  CHECK(vehicle::yo_depth(g, 1000, length) == Approx(150));
  CHECK(vehicle::yo_depth(g, 1400, length) == Approx(90));   // 60 m up
  CHECK(vehicle::yo_depth(g, 1800, length) == Approx(30));   // the upper turn
  CHECK(vehicle::yo_depth(g, 2600, length) == Approx(150));  // and down again
  CHECK(vehicle::yo_depth(g, length - 100, length) == Approx(15).margin(1e-9));
  CHECK(vehicle::yo_depth(g, length, length) == 0);
}

TEST_CASE("the yo-yo of the planner is the verifier's, though neither knows the other") {
  model::Glider g;
  for (const double lower : {15.0, 200.0, 1000.0}) {
    g.dive_depth = Metres{lower};
    for (double t = 0; t <= 14'400; t += 7.3)
      REQUIRE(vehicle::yo_depth(g, t, 14'400) == Approx(safety::yo_depth(g, t, 14'400)).margin(1e-9));
  }
}

TEST_CASE("below the bottom the deepest current above it counts, to half a metre") {
  const Fading field;
  const auto deep = geo_point(28, -16), shallow = geo_point(28.1, -16);
  CHECK(vehicle::current_above_bottom(field, deep, 300, 0)->current.east.si() == Approx(0.05));
  // The current changes by 0.2/400 per metre, so half a metre is 2.5e-4 m/s.
  CHECK(vehicle::current_above_bottom(field, shallow, 300, 0)->current.east.si() == Approx(0.125).margin(2.5e-4));
  CHECK(vehicle::current_above_bottom(field, shallow, 100, 0)->current.east.si() == Approx(0.15));
  CHECK(vehicle::reached_above_bottom(field, shallow, 300, 0)->depth_m == Approx(149.75).margin(0.25));
  CHECK(vehicle::reached_above_bottom(field, shallow, 100, 0)->depth_m == 100);
}

TEST_CASE("a dive in a current that fades with depth meets the mean over its yo-yo, not the surface's") {
  const Fading field;
  const chart::Chart chart;
  vehicle::Flight flight;
  flight.fix = geo_point(28, -16);
  flight.fix_s = test::kT0;
  flight.goal = {geo_point(20, -16), Metres{1000}};
  flight.horizon_s = test::kT0 + 1e7;
  const double stint = 4 * 3600.0;
  // Southward, over deep water.
  const std::vector<GeoPoint> points{geo_point(27, -16)};
  const vehicle::Waters flat{{field, field}, chart, Metres{0}},
      deep{{field, field}, chart, Metres{0}, ocean::FieldRef{field}};
  std::size_t target = 0;
  const auto in_flat = dive_by_law(flight, flat, vehicle::state_at(flight.fix, test::kT0, flat), stint, points, target,
                                   Metres{100}, true, {});
  const auto in_deep = dive_by_law(flight, deep, vehicle::state_at(flight.fix, test::kT0, deep), stint, points, target,
                                   Metres{100}, true, {});
  CHECK(in_flat.motion.mean.east.si() == Approx(0.2));
  double mean_depth = 0;
  for (int i = 0; i < 14'400; ++i) mean_depth += vehicle::yo_depth(flight.glider, i + 0.5, stint) / 14'400;
  // The current is linear in depth, so its mean is that at the mean depth. The midpoint rule is wrong only in the steps
  // that hold a turn: by at most 4 m of depth in one of 60 s, some twelve of them in 240, so 0.2 m, 1e-4 m/s.
  CHECK(in_deep.motion.mean.east.si() == Approx(0.2 * (1 - mean_depth / 400)).margin(1e-4));
}

TEST_CASE("a list flown in all depths arrives when the verifier's flight of it does") {
  const Fading field;
  const chart::Chart chart;
  vehicle::Flight flight;
  flight.fix = geo_point(28, -16);
  flight.fix_s = test::kT0;
  flight.goal = {destination(flight.fix, Bearing{degrees(150)}, Metres{40'000}), Metres{2000}};
  flight.horizon_s = test::kT0 + 1e6;
  model::WaypointList list;
  list.points = {{destination(flight.fix, Bearing{degrees(120)}, Metres{6000}), model::WaypointRole::aim},
                 {flight.goal.centre, model::WaypointRole::goal}};
  list.radius = Metres{300};
  const auto flown = fly_list(list, flight, {{field, field}, chart, Metres{0}, ocean::FieldRef{field}});
  safety::FlightOrder order;
  for (const auto& w : list.points) order.points.push_back(w.at);
  order.radius = list.radius;
  order.glider = flight.glider;
  order.schedule = flight.schedule;
  order.fix = flight.fix;
  order.fix_s = flight.fix_s;
  order.horizon_s = flight.horizon_s;
  order.goal = flight.goal.centre;
  order.goal_radius = flight.goal.radius;
  const auto verified = safety::fly(order, field);
  REQUIRE(flown.arrival_s);
  REQUIRE(verified.arrival_s);
  // Both take steps of a minute by the midpoint rule, begun at different instants after a ring. A step that holds a turn
  // of the yo-yo is wrong by at most 4 m of depth, 0.002 m/s for a minute, 0.12 m; thirteen turns a stint and ten stints
  // at random signs make some 2 m, 10 s at 0.2 m/s.
  CHECK(*flown.arrival_s == Approx(*verified.arrival_s).margin(10));
  for (std::size_t k = 0; k < flown.stints.size(); ++k)
    CHECK(distance(flown.stints[k].surface, verified.stints[k].surfaced).si() < 4);
}
