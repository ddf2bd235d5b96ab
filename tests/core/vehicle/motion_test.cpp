#include "core/vehicle/motion.hpp"

#include <catch2/catch.hpp>

#include "core/ocean/analytic.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;
using vehicle::Lost;
using vehicle::WaterVelocity;

namespace {

constexpr double kEightHours = 8 * 3600.0;

/// Open water with one field for dives and drifts.
struct Open {
  chart::Chart chart;
  vehicle::Waters waters;
  explicit Open(ocean::FieldRef field) : waters{{field, field}, chart, Metres{0}} {}
};

double metres(const vehicle::State& a, GeoPoint b) { return distance(a.at(), b).si(); }

chart::Chart forbidding(GeoPoint centre, double half_m) {
  chart::ChartSources sources;
  chart::Area square;
  square.name = "forbidden";
  for (const double bearing : {45.0, 135.0, 225.0, 315.0})
    square.vertices.push_back(destination(centre, Bearing{degrees(bearing)}, Metres{half_m * std::sqrt(2.0)}));
  sources.keep_out = {square};
  return chart::Chart{std::move(sources)};
}

}  // namespace

TEST_CASE("a stint through still water is as long as its speed says, at any latitude and across 180 degrees") {
  const auto field = test::still_water();
  const Open sea{field};
  for (const auto& from : {geo_point(0, 10), geo_point(28, -16), geo_point(60, 2), geo_point(-75, 100),
                           geo_point(80, 0), geo_point(52, 179.95), geo_point(-17, -179.95)})
    for (const double heading : {0.0, 77.0, 135.0, 270.0}) {
      const auto m = move(sea.waters, field, state_at(from, test::kT0, sea.waters), kEightHours,
                          WaterVelocity::of(Heading{degrees(heading)}, MetresPerSecond{0.3}), nullptr);
      INFO(from.lat.degrees() << " " << heading);
      // A constant heading is a rhumb line: at 80° it differs from a geodesic of 8.6 km by (8640/6.4e6·tan 80°)²/24 = 2e-6.
      CHECK(metres(m.end, from) == Approx(0.3 * kEightHours).epsilon(1e-4));
      CHECK(m.end.t_s == Approx(test::kT0 + kEightHours).margin(1e-5));
      CHECK_FALSE(m.lost);
    }
}

TEST_CASE("a uniform current adds its way to the stint's, and a drift is that way alone") {
  const test::Uniform field{0.2, -0.1};
  const Open sea{field};
  const auto from = geo_point(0, 0);  // on the equator north and east keep their scales
  const auto start = state_at(from, test::kT0, sea.waters);
  const auto through = WaterVelocity::of(Heading{degrees(30)}, MetresPerSecond{0.3});
  const auto flown = move(sea.waters, field, start, kEightHours, through, nullptr);
  const double east = (0.3 * 0.5 + 0.2) * kEightHours, north = (0.3 * std::sqrt(0.75) - 0.1) * kEightHours;
  const auto there = destination(from, Bearing::of(east, north), Metres{std::hypot(east, north)});
  // The radii of the ellipsoid change by (y/R)² ≈ 2e-6 over 10 km from the equator: centimetres.
  CHECK(metres(flown.end, there) < 0.5);
  CHECK(flown.mean.east.si() == Approx(0.2).margin(1e-5));
  CHECK(flown.mean.north.si() == Approx(-0.1).margin(1e-5));
  const auto drifted = move(sea.waters, field, start, 900, {}, nullptr);
  CHECK(metres(drifted.end, from) == Approx(std::hypot(0.2, 0.1) * 900).epsilon(1e-4));
}

TEST_CASE("a drift in solid-body rotation comes back after a turn, a stint ends where the closed form says") {
  // In the plane of longitude and latitude the water turns at ω around the origin: an exact closed form on the ellipsoid.
  const double omega = 2 * kPi / (3 * 86400.0), lat0 = 0.5;
  const test::FromFunction field{
      [&](double lat, double lon, double) {
        const auto m = LocalMetric::at(lat);
        return std::pair{-omega * (lat - lat0) * m.parallel_radius, omega * lon * m.meridian_radius};
      },
      1.0};
  const Open sea{field};
  const double x = 0.004;  // 22 km
  const auto from = GeoPoint::from_kernel(lat0, x);
  const auto turn = move(sea.waters, field, state_at(from, test::kT0, sea.waters), 3 * 86400.0, {}, nullptr);
  // 216 or more steps that differ by at most 0.02 m from their halves; the halves are 15 times better (order 4): 0.3 m.
  CHECK(metres(turn.end, from) < 0.5);
  const double hours = 5;
  const auto part = move(sea.waters, field, state_at(from, test::kT0, sea.waters), hours * 3600, {}, nullptr);
  const double angle = omega * hours * 3600;
  CHECK(metres(part.end, GeoPoint::from_kernel(lat0 + x * std::sin(angle), x * std::cos(angle))) < 0.2);
}

TEST_CASE("in a shear a stint across it is carried along by half the rate times the square of its time") {
  ocean::AnalyticSpec spec;
  spec.kind = "shear";
  spec.origin = geo_point(0, 0);
  spec.length_scale = Metres{10e3};
  spec.speed_scale = MetresPerSecond{0.1};
  const auto field = *ocean::AnalyticField::make(spec, instant_at(test::kT0), test::box_around(spec.origin, 2));
  const Open sea{field};
  const auto m = move(sea.waters, field, state_at(spec.origin, test::kT0, sea.waters), kEightHours,
                      WaterVelocity::of(Heading{degrees(0)}, MetresPerSecond{0.3}), nullptr);
  const double north = 0.3 * kEightHours, east = 0.5 * (0.1 / 10e3) * 0.3 * kEightHours * kEightHours;
  const auto [x, y] = field.plane(m.end.at());
  // cos φ at 8.6 km from the equator is 1 − 1e-6; a fourth-order method is exact on a parabola.
  CHECK(x * 10e3 == Approx(east).epsilon(1e-4));
  CHECK(y * 10e3 == Approx(north).epsilon(1e-4));
}

TEST_CASE("the goal radius is crossed at distance less radius over speed, to a second") {
  const auto field = test::still_water();
  const Open sea{field};
  for (const double lat : {0.0, 28.0, 60.0, -75.0}) {
    const auto from = geo_point(lat, 179.98);
    for (const double way : {1200.0, 5000.0, 8000.0})
      for (const double radius : {100.0, 1000.0}) {
        const auto to = destination(from, Bearing{degrees(60)}, Metres{way});
        const vehicle::Disc goal{to, Metres{radius}};
        const auto heading = Heading{geodesic(from, to).departing.from_north()};
        const auto m = move(sea.waters, field, state_at(from, test::kT0, sea.waters), kEightHours,
                            WaterVelocity::of(heading, MetresPerSecond{0.3}), &goal);
        REQUIRE(m.arrival_s);
        // A constant heading is a rhumb line, which ends L²·tan φ·sin(heading)/(2R) beside the geodesic (19 m after 8 km
        // at 75°) and so comes to the disc's edge later by r − √(r² − beside²). The rest is 0.05 s of bisection and the
        // metric, 1e-5 of the way.
        const double beside = way * way * std::tan(std::abs(from.lat.radians())) * std::sin(kPi / 3) / (2 * 6.37e6);
        const double later = (radius - std::sqrt(radius * radius - beside * beside)) / 0.3;
        CHECK(*m.arrival_s - test::kT0 >= (way - radius) / 0.3 - 1.0);
        CHECK(*m.arrival_s - test::kT0 <= (way - radius) / 0.3 + 1.1 * later + 1.0);
        CHECK(m.end.t_s == Approx(test::kT0 + kEightHours));  // the stint is flown to its end
      }
  }
}

TEST_CASE("a track that cuts the disc within one long step arrives, one that passes by does not") {
  const auto field = test::still_water();
  const Open sea{field};
  const auto from = geo_point(28, -16);
  const auto abeam = destination(from, Bearing{degrees(90)}, Metres{4000});
  for (const double offset : {10.0, 45.0, 55.0}) {
    const vehicle::Disc goal{destination(abeam, Bearing{degrees(0)}, Metres{offset}), Metres{50}};
    const auto m = move(sea.waters, field, state_at(from, test::kT0, sea.waters), kEightHours,
                        WaterVelocity::of(Heading{degrees(90)}, MetresPerSecond{0.3}), &goal);
    INFO(offset);
    // East along the parallel of 28° bends off the geodesic by 4000²·tan 28°/(2·6.4e6) = 0.7 m.
    CHECK(m.arrival_s.has_value() == (offset < 50));
  }
}

TEST_CASE("a start inside the disc has arrived at once") {
  const auto field = test::still_water();
  const Open sea{field};
  const vehicle::Disc goal{geo_point(28, -16), Metres{100}};
  const auto m = move(sea.waters, field, state_at(goal.centre, 5.0, sea.waters), 10, {}, &goal);
  CHECK(m.arrival_s == 5.0);
}

TEST_CASE("leaving the area, the forecast and the water are results that say so") {
  auto box = test::box_around(geo_point(28, -16), 0.05);
  const test::FromFunction small{[](double, double, double) { return std::pair{0.0, 0.0}; }, 0, box};
  const Open sea{small};
  const auto start = state_at(geo_point(28, -16), test::kT0, sea.waters);
  const auto north = WaterVelocity::of(Heading{degrees(0)}, MetresPerSecond{0.3});
  const auto out = move(sea.waters, small, start, kEightHours, north, nullptr);
  REQUIRE(out.lost == Lost::left_area);
  // Stops at the last position whose step stayed inside: within a shortest step (10 s, 3 m) of the edge, 5.55 km away.
  const double edge = (box.north - start.lat) * LocalMetric::at(start.lat).meridian_radius;
  CHECK(metres(out.end, start.at()) == Approx(edge).margin(4.0));
  CHECK(metres(out.end, start.at()) <= edge);

  CHECK(vehicle::lost_by(ocean::NoCurrent::outside_time) == Lost::left_forecast);
  CHECK(vehicle::lost_by(ocean::NoCurrent::land) == Lost::aground);
  CHECK(vehicle::lost_by(ocean::NoCurrent::no_data) == Lost::no_data);
  CHECK(vehicle::word(Lost::left_area) == "left the area of the forecast");
}

TEST_CASE("a motion stops before the margin, a start inside the margin may only move outwards") {
  const auto field = test::still_water();
  const auto rock = geo_point(28, -16);
  const auto chart = forbidding(rock, 2000);
  const vehicle::Waters waters{{field, field}, chart, Metres{1000}};
  const auto fly = [&](double from_rock, double heading) {
    const auto from = destination(rock, Bearing{degrees(180)}, Metres{2000 + from_rock});
    return move(waters, field, vehicle::state_at(from, test::kT0, waters), 3 * 3600.0,
                WaterVelocity::of(Heading{degrees(heading)}, MetresPerSecond{0.3}), nullptr);
  };
  const auto towards = fly(3000, 0);
  CHECK(towards.lost == Lost::aground);
  // The shortest step is 10 s = 3 m; the chart's distances are good to 0.2 m.
  CHECK(chart.clearance(towards.end.at()).si() == Approx(1000).margin(4));
  CHECK_FALSE(fly(3000, 180).lost);
  const auto outwards = fly(400, 180);
  CHECK_FALSE(outwards.lost);
  CHECK(outwards.end.margin == Approx(1000));  // outside again: the whole margin is in force
  CHECK(fly(400, 0).lost == Lost::aground);
}

TEST_CASE("where a straight step enters a disc is the chord's crossing") {
  const vehicle::Disc disc{geo_point(0, 0), Metres{1000}};
  const auto at = [](double east, double north) {
    const auto p = destination(geo_point(0, 0), Bearing::of(east, north), Metres{std::hypot(east, north)});
    return std::pair{p.lat.radians(), p.lon.radians()};
  };
  const auto entry = [&](std::pair<double, double> a, std::pair<double, double> b) {
    return vehicle::entry_into(disc, a.first, a.second, b.first, b.second);
  };
  // Line y = 600: enters at x = −800.
  CHECK(entry(at(-2000, 600), at(2000, 600)).value() == Approx(1200.0 / 4000).margin(1e-4));
  CHECK(entry(at(-2000, 600), at(-900, 600)) == std::nullopt);
  CHECK(entry(at(-2000, 1001), at(2000, 1001)) == std::nullopt);
  CHECK(entry(at(2000, 0), at(3000, 0)) == std::nullopt);
  CHECK(entry(at(0, 500), at(0, 2000)) == 0.0);
}

TEST_CASE("a very large disc is entered where the geodesic says") {
  const vehicle::Disc disc{geo_point(28, -16), Metres{200e3}};
  const auto just_in = destination(disc.centre, Bearing{degrees(90)}, Metres{199'990});
  const auto just_out = destination(disc.centre, Bearing{degrees(90)}, Metres{200'010});
  CHECK(distance_near(just_in.lat.radians(), just_in.lon.radians(), disc) <= 200e3);
  CHECK(distance_near(just_out.lat.radians(), just_out.lon.radians(), disc) > 200e3);
}

TEST_CASE("the lane step is an hour in eddies that a forecast can hold and shorter in sharper ones") {
  const auto step_in = [](double eddy_m) {
    ocean::AnalyticSpec spec;
    spec.kind = "tiled";
    spec.origin = geo_point(28, -16);
    spec.length_scale = Metres{eddy_m};
    spec.speed_scale = MetresPerSecond{0.4};
    const auto field = *ocean::AnalyticField::make(spec, instant_at(test::kT0));
    const auto to = destination(spec.origin, Bearing{degrees(50)}, Metres{300e3});
    return vehicle::lane_step({field, field}, spec.origin, to, test::kT0, kEightHours, MetresPerSecond{0.3});
  };
  CHECK(step_in(30e3) == 3600.0);
  CHECK(4 * kEightHours / step_in(30e3) <= 34);
  CHECK(step_in(1e3) < 1800.0);
  CHECK(step_in(1e3) == step_in(1e3));
  const auto still = test::still_water();
  CHECK(vehicle::lane_step({still, still}, geo_point(0, 0), geo_point(1, 1), 0, 1000.0, MetresPerSecond{0.3}) ==
        1000.0);
}
