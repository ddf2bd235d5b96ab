#include "core/safety/reflight.hpp"

#include <catch2/catch.hpp>

#include "core/base/local_metric.hpp"
#include "tests/core/safety/sample_dossier.hpp"

using namespace glidehelm;
using namespace glidehelm::safety;
using test::Answer;
using test::current;
using test::FormulaField;
using test::uniform;

namespace {

FlightOrder order(const GeoPoint& fix, const std::vector<GeoPoint>& points, double radius = 100) {
  FlightOrder o;
  o.points = points;
  o.radius = Metres{radius};
  o.fix = fix;
  o.fix_s = 1.7e9;
  o.horizon_s = 1.7e9 + 90 * 86'400.0;
  o.goal = points.back();
  o.goal_radius = Metres{2000};
  return o;
}

Offset offset(const GeoPoint& a, const GeoPoint& b) {
  return local_offset(a.lat.radians(), a.lon.radians(), b.lat.radians(), b.lon.radians());
}

GeoPoint at_offset(const GeoPoint& from, double east, double north) {
  return destination(from, Bearing{Radians{std::atan2(east, north)}}, Metres{std::hypot(east, north)});
}

}  // namespace

TEST_CASE("in still water the arrival is the geodesic's, at every latitude and across the antimeridian") {
  struct Way {
    double lat, lon, bearing;
  };
  for (const auto& way : {Way{0, 0, 0}, Way{0, 0, 90}, Way{28, -16, 210}, Way{60, 5, 100}, Way{-75, -40, 180},
                          Way{75, 20, 80}, Way{-75, 179.8, 95}, Way{5, 179.9, 60}, Way{5, -179.9, 270}}) {
    CAPTURE(way.lat, way.lon, way.bearing);
    const auto fix = geo_point(way.lat, way.lon);
    const double length = 60'000;
    auto o = order(fix, {destination(fix, Bearing{degrees(way.bearing)}, Metres{length})});
    const auto flight = fly(o, uniform(0, 0));
    const double expected = o.fix_s + o.schedule.travel_time(Seconds{(length - 2000) / 0.3}).count();
    REQUIRE(flight.arrival_s.has_value());
    // 193 000 s under way; the midpoint step with the metric at its middle errs below 1e-5 even at 75°.
    CHECK(*flight.arrival_s == Approx(expected).margin(2.0));
    CHECK(flight.arrival_index < flight.track.size());
    CHECK(flight.track[flight.arrival_index].t_s >= *flight.arrival_s);
    CHECK(flight.track[flight.arrival_index - 1].t_s < *flight.arrival_s);
    CHECK(flight.end == FlightEnd::stints);
    CHECK(flight.stints.size() == static_cast<std::size_t>(kMostStints));
  }
}

TEST_CASE("track points are at most a minute and 250 m apart and the longitude runs on") {
  const auto fix = geo_point(40, 179.97);
  const auto flight = fly(order(fix, {geo_point(40, -179.5)}), uniform(1.5, 0.5));
  for (std::size_t i = 1; i < flight.track.size(); ++i) {
    const auto &a = flight.track[i - 1], &b = flight.track[i];
    REQUIRE(b.t_s > a.t_s);
    REQUIRE(b.t_s - a.t_s <= kStep + 1e-9);
    REQUIRE(std::abs(b.lon - a.lon) < 1e-3);
    REQUIRE(distance(a.at(), b.at()).si() < 250);
  }
}

TEST_CASE("a glider that knows a uniform current surfaces at dive + (U·h + c)·t") {
  for (const double lat : {0.0, 45.0, -60.0}) {
    const auto fix = geo_point(lat, 10);
    const double c_east = 0.12, c_north = -0.07, heading = 0.7, t = 14'400;
    const double g_east = 0.3 * std::sin(heading) + c_east, g_north = 0.3 * std::cos(heading) + c_north;
    const auto dive = at_offset(fix, 900 * c_east, 900 * c_north);
    // product.md 6 with m = 0.01 and r = 200 m
    const double g = std::hypot(g_east, g_north), reach = 0.99 * g * t + 200;
    auto o = order(fix, {at_offset(dive, g_east / g * reach, g_north / g * reach)}, 200);
    o.believed_current = current(c_east, c_north);
    const auto flight = fly(o, uniform(c_east, c_north));
    REQUIRE_FALSE(flight.stints.empty());
    const auto& stint = flight.stints.front();
    CHECK(distance(stint.dived, dive).si() < 0.1);
    const auto way = offset(stint.dived, stint.surfaced);
    // A geodesic's bearing turns by the convergence of the meridians, Δeast/R·tan φ; half of it acts on the whole way.
    const double bent = 0.5 * g_east * t / 6.36e6 * std::tan(std::abs(degrees(lat).si())) * g * t;
    CHECK(way.east == Approx(g_east * t).margin(0.2 + bent));
    CHECK(way.north == Approx(g_north * t).margin(0.2 + bent));
    CHECK(stint.met.east.si() == Approx(c_east).margin(1e-9));
    CHECK(stint.drift.north.si() == Approx(c_north).margin(1e-9));
    CHECK(stint.surfaced_s - stint.dived_s == Approx(t).margin(2e-3));
  }
}

TEST_CASE("with correction 0 the glider drifts with the current that it ignores") {
  const auto fix = geo_point(-30, 100);
  auto o = order(fix, {destination(fix, Bearing{degrees(0)}, Metres{80'000})});
  o.glider.current_correction = 0;
  o.believed_current = current(0.1, 0.1);  // measured, but not used
  const auto flight = fly(o, uniform(0.1, 0.05));
  const auto way = offset(flight.stints[0].dived, flight.stints[0].surfaced);
  // The bearing at the dive point is off north by the initial drift: 90 m in 80 km, 1.1e-3 · 4320 m = 5 m of east.
  CHECK(way.east == Approx(0.1 * 14'400 - 4320 * 90.0 / 80'000).margin(1.0));
  CHECK(way.north == Approx((0.3 + 0.05) * 14'400).margin(1.0));
  CHECK(flight.stints[0].believed == Current{});
  CHECK(flight.stints[1].believed == Current{});
}

TEST_CASE("a true speed that the glider does not believe moves the truth, not the reckoning") {
  const auto fix = geo_point(10, 10);
  auto o = order(fix, {at_offset(fix, 0, 3000), at_offset(fix, 9000, 3000)}, 100);
  o.glider.horizontal_speed = MetresPerSecond{0.27};
  o.schedule.time_to_dive = Seconds{0};
  const auto flight = fly(o, uniform(0, 0));
  // Reckoned: 2900 m at 0.30 m/s, then eastwards; true: the same seconds at 0.27 m/s.
  const double first = 2900 / 0.30, second = 14'400 - first, leg = std::hypot(9000, 100);
  const auto way = offset(flight.stints[0].dived, flight.stints[0].surfaced);
  CHECK(way.north == Approx(0.27 * (first + second * 100 / leg)).margin(0.5));
  CHECK(way.east == Approx(0.27 * second * 9000 / leg).margin(0.5));
}

TEST_CASE("heading is bearing less asin(cross/Û), clamped where the cross current is stronger") {
  const double north = 0;
  CHECK(steered_heading(north, Current{}, 0.3) == 0);
  // slocum.md 4.4: cross 0.15 m/s gives 36.9° at 0.25 m/s and 30.0° at 0.30 m/s
  CHECK(in_degrees(Radians{steered_heading(north, current(0.15, 0.3), 0.25)}) == Approx(-36.87).margin(0.01));
  CHECK(in_degrees(Radians{steered_heading(north, current(-0.15, 0), 0.30)}) == Approx(30.0).margin(0.01));
  // eastwards the right-hand side is south
  CHECK(in_degrees(Radians{steered_heading(kPi / 2, current(0, -0.15), 0.30)}) == Approx(60.0).margin(0.01));
  CHECK(steered_heading(north, current(0.31, 0), 0.30) == -kPi / 2);
  CHECK(steered_heading(north, current(-3, 0), 0.30) == kPi / 2);
}

TEST_CASE("a cross current beyond the believed speed is met square and carries the glider off") {
  const auto fix = geo_point(0, 0);
  auto o = order(fix, {at_offset(fix, 0, 50'000)});
  o.believed_current = current(0.5, 0);
  o.schedule = {Seconds{3600}, Seconds{3600}, Seconds{0}, Seconds{0}};
  const auto flight = fly(o, uniform(0.5, 0));
  const auto way = offset(flight.stints[0].dived, flight.stints[0].surfaced);
  // Heading west: 0.2 m/s of east remain. The bearing turns by −x/L, the heading behind it: north = −∫0.3·x/L dt.
  CHECK(way.east == Approx(0.2 * 3600).margin(0.5));
  CHECK(way.north == Approx(-0.3 * 0.2 * 3600 * 3600 / 2 / 50'000).margin(0.2));
}

TEST_CASE("a hit turns the glider to the next waypoint, the last hit of a loop back to the first") {
  const auto fix = geo_point(0, 0);
  auto o = order(fix, {at_offset(fix, 0, 2000), at_offset(fix, 2000, 2000)}, 200);
  o.schedule = {Seconds{14'400}, Seconds{14'400}, Seconds{0}, Seconds{0}};
  o.goal = geo_point(1, 1);
  const auto flight = fly(o, uniform(0, 0));
  // In the plane: north to the ring of w_1, straight to the ring of w_2, straight back towards w_1.
  const double leg = std::hypot(2000, 200), to_second = leg - 200;
  const double x = to_second * 2000 / leg, y = 1800 + to_second * 200 / leg;
  const double back = 0.3 * 14'400 - 1800 - to_second, home = std::hypot(x, 2000 - y);
  const auto at = offset(fix, flight.stints[0].surfaced);
  // a ring is entered by 0.1 s · 0.3 m/s; the plane agrees with the ellipsoid to 1e-5 here
  CHECK(at.east == Approx(x - back * x / home).margin(0.2));
  CHECK(at.north == Approx(y + back * (2000 - y) / home).margin(0.2));
}

TEST_CASE("rings larger than a leg are passed at once, a small ring is not jumped over") {
  const auto fix = geo_point(0, 0);
  auto o = order(fix, {at_offset(fix, 0, 150), at_offset(fix, 0, 190), at_offset(fix, 6000, 0)}, 200);
  o.schedule = {Seconds{14'400}, Seconds{14'400}, Seconds{0}, Seconds{0}};
  const auto east = offset(fix, fly(o, uniform(0, 0)).stints[0].surfaced);
  CHECK(east.east == Approx(4320).margin(0.1));
  CHECK(east.north == Approx(0).margin(0.1));
  // a step is 18 m long: a ring of 10 m lies between two steps, its crossing does not
  o.points = {at_offset(fix, 0, 1007), at_offset(fix, 6000, 1007)};
  o.radius = Metres{10};
  const auto turned = offset(fix, fly(o, uniform(0, 0)).stints[0].surfaced);
  CHECK(turned.east == Approx(4320 - 997).margin(1.0));
  CHECK(turned.north == Approx(1007 - 10 * (1 - 3323.0 / 6000)).margin(1.0));
}

TEST_CASE("the target outlives a surfacing and dead reckoning starts at the true dive point") {
  const auto fix = geo_point(20, -60);
  auto o = order(
      fix,
      {destination(fix, Bearing{degrees(90)}, Metres{6000}), destination(fix, Bearing{degrees(90)}, Metres{40'000})},
      100);
  o.glider.current_correction = 0;
  o.goal_radius = Metres{500};
  const auto flight = fly(o, uniform(-0.05, 0.10));
  // w_1 is not reached in the first stint, so the second one aims at it again from where it truly is.
  const auto& s = flight.stints[1];
  const double bearing = geodesic(s.dived, o.points[0]).departing.from_north().si();
  const auto& next = *std::find_if(flight.track.begin(), flight.track.end(),
                                   [&](const TrackPoint& p) { return p.stint == 1 && !p.drifting; });
  const auto step = offset(s.dived, next.at());
  const double dt = next.t_s - s.dived_s;
  CHECK(step.east == Approx((0.3 * std::sin(bearing) - 0.05) * dt).margin(0.05));
  CHECK(step.north == Approx((0.3 * std::cos(bearing) + 0.10) * dt).margin(0.05));
}

TEST_CASE("a waiting list ends with its last hit, a list of one point keeps steering to it") {
  const auto fix = geo_point(50, -20);
  auto o = order(fix, {destination(fix, Bearing{degrees(30)}, Metres{3000})}, 200);
  o.at_end = model::AtEnd::wait;
  const auto waited = fly(o, uniform(0, 0));
  CHECK(waited.end == FlightEnd::list_finished);
  CHECK(waited.track.back().t_s == Approx(o.fix_s + 900 + 2800 / 0.3).margin(0.5));
  o.at_end = model::AtEnd::loop;
  const auto stays = fly(o, uniform(0, 0));
  CHECK(stays.end == FlightEnd::stints);
  for (const auto& s : stays.stints) CHECK(distance(s.surfaced, o.points[0]).si() < 27);  // a step and a half
}

TEST_CASE("correction 1 believes the measured current first and then the mean met in the stint before") {
  const auto fix = geo_point(0, 0);
  auto o = order(fix, {geo_point(1, 0)});
  o.believed_current = current(0.02, 0.03);
  const double start = o.fix_s;
  const FormulaField rising{[=](GeoPoint, double, double t) -> Answer {
                              return ocean::Sample{current((t - start) * 1e-6, 0), false};
                            },
                            {}};
  const auto flight = fly(o, rising);
  CHECK(flight.stints[0].believed == current(0.02, 0.03));
  // linear in time: the mean is the value in the middle of the stint
  CHECK(flight.stints[0].met.east.si() == Approx((900 + 7200) * 1e-6).margin(1e-10));
  CHECK(flight.stints[1].believed == flight.stints[0].met);
  o.believed_current.reset();
  CHECK(fly(o, rising).stints[0].believed == Current{});
}

TEST_CASE("the yo goes down, turns between its depths and comes up at the end of the stint") {
  model::Glider g;
  g.glide_angle = Radians{std::atan(0.5)};  // 0.15 m/s of depth
  g.dive_depth = Metres{150};
  g.climb_to = Metres{30};
  const double length = 10'000;
  for (const auto& [t, depth] : std::vector<std::pair<double, double>>{{0, 0},
                                                                       {500, 75},
                                                                       {1000, 150},
                                                                       {1400, 90},
                                                                       {1800, 30},
                                                                       {2200, 90},
                                                                       {2600, 150},
                                                                       {9000, 150},
                                                                       {9500, 75},
                                                                       {10'000, 0}})
    CHECK(yo_depth(g, t, length) == Approx(depth).margin(1e-9));
  g.climb_to = Metres{400};  // above nothing: it stays at its depth
  CHECK(yo_depth(g, 5000, length) == 150);
  CHECK(yo_depth(g, 300, 600) == Approx(45));  // a stint too short to get down
}

TEST_CASE("the current is sampled at the depth of the yo, the drift at the surface") {
  const auto fix = geo_point(0, 0);
  auto o = order(fix, {geo_point(1, 0)});
  o.glider.glide_angle = Radians{std::atan(0.5)};
  o.glider.dive_depth = Metres{150};
  o.glider.climb_to = Metres{30};
  o.schedule.first_stint = Seconds{10'000};
  const FormulaField sheared{[](GeoPoint, double z, double) -> Answer {
                               return ocean::Sample{current(0.002 * z, 0.01), false};
                             },
                             {}};
  const auto s = fly(o, sheared).stints[0];
  // Mean depth: two straight ways of 1000 s (mean 75 m), five yos of 1600 s between 30 and 150 m (mean 90 m). Each of
  // the eleven turns inside a 60 s step costs at most 0.15·60²/8 m·s: below 0.1 m of the mean.
  CHECK(s.met.east.si() == Approx(0.002 * (2000 * 75 + 8000 * 90) / 10'000).margin(2e-4));
  CHECK(s.drift.east.si() == 0);
  CHECK(s.drift.north.si() == Approx(0.01).epsilon(1e-12));
}

TEST_CASE("below the bottom the deepest value above it counts") {
  const auto fix = geo_point(0, 0);
  auto o = order(fix, {geo_point(1, 0)});
  o.glider.glide_angle = Radians{std::atan(0.5)};
  o.glider.dive_depth = Metres{150};
  o.glider.climb_to = Metres{30};
  o.schedule.first_stint = Seconds{10'000};
  const FormulaField shelf{[](GeoPoint, double z, double) -> Answer {
                             if (z > 60) return unexpected(ocean::NoCurrent::below_bottom);
                             return ocean::Sample{current(0.002 * z, 0), false};
                           },
                           {}};
  const auto s = fly(o, shelf).stints[0];
  // Mean of min(depth, 60): straight ways 400 s to 60 m (mean 30), 600 s at 60; a yo of 1600 s has 400 s below 60 m of
  // the way between 30 and 60 (mean 45) and 1200 s at 60.
  const double mean = (2 * (400 * 30 + 600 * 60) + 5 * (400 * 45 + 1200 * 60)) / 10'000.0;
  CHECK(s.met.east.si() == Approx(0.002 * mean).margin(0.002 * 0.6));  // half a metre by halving, 0.1 m by steps
  const FormulaField dry{[](GeoPoint, double, double) -> Answer { return unexpected(ocean::NoCurrent::below_bottom); },
                         {}};
  CHECK(fly(o, dry).end == FlightEnd::no_data);
}

TEST_CASE("a drift around an eddy comes back to where it began") {
  // Solid-body rotation of 6 h at 3 km from the centre: 0.87 m/s. The midpoint rule lags by (ω·dt)²/6 of the way,
  // 2π·3000 m · 5e-5 = 1 m, and spirals outwards by far less.
  const double omega = 2 * kPi / 21'600;
  const FormulaField eddy{[=](GeoPoint p, double, double) -> Answer {
                            const auto x = local_offset(0, 0, p.lat.radians(), p.lon.radians());
                            return ocean::Sample{current(-omega * x.north, omega * x.east), false};
                          },
                          {}};
  const auto fix = at_offset(geo_point(0, 0), 3000, 0);
  auto o = order(fix, {geo_point(1, 0)});
  o.schedule.time_to_dive = Seconds{21'600};
  const auto flight = fly(o, eddy);
  CHECK(distance(flight.stints[0].dived, fix).si() < 1.2);
}

TEST_CASE("the goal may be entered in a drift, and is entered at once by a fix inside it") {
  const auto fix = geo_point(0, 0);
  auto o = order(fix, {at_offset(fix, 2100, 0)});
  const auto drifted = fly(o, uniform(0.5, 0));
  REQUIRE(drifted.arrival_s.has_value());
  CHECK(*drifted.arrival_s == Approx(o.fix_s + 200).margin(0.1));
  CHECK(drifted.track[drifted.arrival_index].drifting);
  o.points = {at_offset(fix, 1900, 0)};
  o.goal = o.points[0];
  const auto inside = fly(o, uniform(0, 0));
  CHECK(inside.arrival_s == o.fix_s);
  CHECK(inside.arrival_index == 0);
}

TEST_CASE("a flight ends where there is no current and says why") {
  const auto fix = geo_point(0, 0);
  const auto o = order(fix, {at_offset(fix, 0, 40'000)});
  const auto stop = [&](ocean::NoCurrent reason) {
    return FormulaField{[=](GeoPoint p, double, double) -> Answer {
                          if (p.lat.degrees() > 0.05) return unexpected(reason);
                          return ocean::Sample{Current{}, false};
                        },
                        {}};
  };
  for (const auto& [reason, end] :
       std::vector<std::pair<ocean::NoCurrent, FlightEnd>>{{ocean::NoCurrent::land, FlightEnd::land},
                                                           {ocean::NoCurrent::no_data, FlightEnd::no_data},
                                                           {ocean::NoCurrent::outside_area, FlightEnd::outside_area},
                                                           {ocean::NoCurrent::outside_time, FlightEnd::outside_time}}) {
    const auto flight = fly(o, stop(reason));
    CHECK(flight.end == end);
    CHECK_FALSE(flight.arrival_s.has_value());
    CHECK(flight.arrival_index == flight.track.size());
    CHECK(flight.track.back().at().lat.degrees() == Approx(0.05).margin(18.0 / 111'000));
  }
  const FormulaField broken{[](GeoPoint, double, double) -> Answer {
                              return ocean::Sample{current(NAN, 0), false};
                            },
                            {}};
  CHECK(fly(o, broken).end == FlightEnd::not_finite);
  auto brief = o;
  brief.horizon_s = o.fix_s + 30'000;
  const auto horizon = fly(brief, uniform(0, 0));
  CHECK(horizon.end == FlightEnd::horizon);
  CHECK(horizon.track.back().t_s == Approx(brief.horizon_s));
  CHECK(horizon.stints.size() == 1);
}
