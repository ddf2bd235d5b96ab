#include "core/safety/track_rules.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/chart/bathymetry.hpp"
#include "core/chart/coast.hpp"
#include "tests/core/safety/sample_dossier.hpp"

using namespace glidehelm;
using namespace glidehelm::safety;
using test::Answer;
using test::Case;
using test::current;
using test::good_case;
using test::margin;

namespace {

/// A rectangle from (east, north) to (east, north), metres from a point.
chart::Area box(const GeoPoint& from, double east0, double north0, double east1, double north1) {
  chart::Area area{"box", {}};
  for (const auto& [e, n] :
       std::vector<std::pair<double, double>>{{east0, north0}, {east1, north0}, {east1, north1}, {east0, north1}})
    area.vertices.push_back(destination(from, Bearing{Radians{std::atan2(e, n)}}, Metres{std::hypot(e, n)}));
  return area;
}

/// A coast over `half_deg` degrees around a point, with one rectangular island given in metres from it.
std::shared_ptr<const chart::Coast> island(const GeoPoint& around, double half_deg, const chart::Area& shore) {
  const auto units = [](double deg) {
    return static_cast<std::int64_t>(std::llround(deg * chart::kCoastUnitsPerDegree));
  };
  const double lat = around.lat.degrees(), lon = around.lon.degrees();
  chart::CoastArea area{units(lon - half_deg), units(lon + half_deg), units(lat - half_deg), units(lat + half_deg)};
  chart::CoastRing ring;
  for (const auto& p : shore.vertices) {
    ring.points.push_back({static_cast<std::int32_t>(units(p.lon.degrees()) - area.west),
                           static_cast<std::int32_t>(units(p.lat.degrees()))});
    ring.cut.push_back(false);
  }
  const auto coast = chart::Coast::make(area, "a test", {ring});
  if (!coast) throw std::runtime_error(coast.error().message());
  return *coast;
}

test::FormulaField stopping(const Case& c, ocean::NoCurrent reason, double when_s) {
  return {[=](GeoPoint, double, double t) -> Answer {
            if (t > when_s) return unexpected(reason);
            return ocean::Sample{current(0.05, 0.02), false};
          },
          c.field.box};
}

/// A straight track eastwards from `from`, a point every 100 m.
std::vector<TrackPoint> eastwards(const GeoPoint& from, double metres) {
  std::vector<TrackPoint> track;
  for (double x = 0; x <= metres; x += 100) {
    const auto p = destination(from, Bearing{degrees(90)}, Metres{x});
    track.push_back({p.lat.radians(), p.lon.radians(), x, 0, false});
  }
  return track;
}

}  // namespace

TEST_CASE("rule 2 flight: before the arrival only horizon, stints and the end of a waiting list end a flight well") {
  auto c = good_case();
  const double arrival = *c.dossier.promise.list_arrival_s;
  for (const auto reason :
       {ocean::NoCurrent::no_data, ocean::NoCurrent::outside_area, ocean::NoCurrent::below_bottom}) {
    c.field = stopping(c, reason, arrival + 100);
    CHECK(c.failing() == "");
    c.field = stopping(c, reason, arrival - 100);
    c.promise_as_flown();
    CHECK(c.failing() == "2 flight");
    c.dossier.promise.list_arrival_s = arrival;
  }
}

TEST_CASE("rule 2 flight: the forecast's own land refuses before and, without a coastline, after the arrival") {
  auto c = good_case();
  const double arrival = *c.dossier.promise.list_arrival_s;
  c.field = stopping(c, ocean::NoCurrent::land, arrival + 3600);
  CHECK(c.failing() == "2 flight, 2 tail");
  c.field = stopping(c, ocean::NoCurrent::land, arrival - 3600);
  c.promise_as_flown();
  CHECK(c.failing() == "2 flight, 2 tail");
}

TEST_CASE("rule 2 flight: the forecast may end after the second surfacing, not before") {
  auto c = good_case();
  const double second = c.dossier.fix_s + c.dossier.schedule.surfacing_time(1).count();
  c.field = stopping(c, ocean::NoCurrent::outside_time, second + 60);
  c.promise_as_flown();
  REQUIRE_FALSE(c.dossier.promise.list_arrival_s.has_value());
  CHECK(c.failing() == "");
  c.field = stopping(c, ocean::NoCurrent::outside_time, second - 60);
  CHECK(c.failing() == "2 flight");
}

TEST_CASE("rule 2 flight: with a coastline the forecast's land after the arrival is only a coarse mask") {
  auto c = good_case();
  const double arrival = *c.dossier.promise.list_arrival_s;
  c.sources.coast = island(c.dossier.at.fix, 1.0, box(c.dossier.at.fix, -30'000, -30'000, -20'000, -20'000));
  c.field = stopping(c, ocean::NoCurrent::land, arrival + 8 * 3600);  // after the slow variant's arrival too
  CHECK(c.failing() == "");
  c.field = stopping(c, ocean::NoCurrent::land, arrival - 3600);
  c.promise_as_flown();
  CHECK(c.failing() == "2 flight, 2 tail");
}

TEST_CASE("rule 2 land: the re-flown track keeps its margin from the shore, not only its waypoints") {
  auto c = good_case();
  const auto fix = c.dossier.at.fix;
  // At 5 km along its way the track is 3.54 km east and north. An island whose north-western corner lies 2.05 km, then
  // 1.95 km to the south-east of there; every waypoint is farther away than the corner's foot on the track.
  for (const auto& [off, expected] : std::vector<std::pair<double, std::string>>{{2050, ""}, {1950, "2 land"}}) {
    const double corner = off / std::sqrt(2.0);
    const double east = 4950 + corner, north = 4950 - corner;  // 7 km along the way, between w_1 and w_2
    c.sources.coast = island(fix, 1.0, box(fix, east, north - 4000, east + 4000, north));
    CHECK(c.failing() == expected);
    CHECK(margin(c.judged(), "2 land").found == Approx(off).margin(40));  // steering errors of the track itself
    CHECK(margin(c.judged(), "2 land").limit == 2000);
  }
  c.dossier.rules.coast_margin = Metres{1850};
  CHECK(c.failing() == "");
}

TEST_CASE("rule 2 land: an island on the way refuses though no waypoint lies near it") {
  auto c = good_case();
  const auto fix = c.dossier.at.fix;
  c.dossier.rules.coast_margin = Metres{0};
  // 60 m of rock on the way, 7 km from the fix: it lies between two track points of the flight
  c.sources.coast = island(fix, 1.0, box(fix, 4920, 4920, 4980, 4980));
  CHECK(c.failing() == "2 land, 2 areas, 2 tail");
}

TEST_CASE("rule 2 land: after the arrival in the goal radius only land itself counts") {
  auto c = good_case();
  const auto goal = c.dossier.promise.goal;
  // 1 km beside the last part of the way to the goal, which is within the margin but after the arrival
  c.sources.coast = island(c.dossier.at.fix, 1.0, box(goal, 800, -2500, 4000, -900));
  CHECK(c.failing() == "");
  c.dossier.promise.goal_radius = Metres{300};
  c.promise_as_flown();
  CHECK(c.failing() == "2 land");
  // the closing leg of the loop, flown back to w_1, runs into the island
  c = good_case();
  const auto turn = destination(goal, Bearing{degrees(225)}, Metres{1000});
  c.sources.coast = island(c.dossier.at.fix, 1.0, box(turn, -50, -50, 50, 50));
  c.dossier.rules.coast_margin = Metres{0};
  const auto verdict = c.judged();
  CHECK_FALSE(margin(verdict, "2 land").holds);
  CHECK(margin(verdict, "2 land").limit == 0);
}

TEST_CASE("rule 2 land: a start inside the margin may only increase its distance") {
  auto c = good_case();
  const auto fix = c.dossier.at.fix;
  c.sources.coast = island(fix, 1.0, box(fix, -5000, -5000, -300, -300));  // behind: the way leads off
  CHECK(c.failing() == "");
  c.sources.coast = island(fix, 1.0, box(fix, 1000, -5000, 5000, -300));  // beside: the way leads past it first
  CHECK(c.failing() == "2 land");
}

TEST_CASE("rule 2 land: what the coast file does not chart may be land") {
  auto c = good_case();
  const auto fix = c.dossier.at.fix;
  const auto far = box(fix, -9000, -9000, -8000, -8000);
  // 0.2 degrees of longitude are 17.1 km; the goal lies 14.1 km east, and the way ends 400 m short of it.
  c.sources.coast = island(fix, 0.20, far);
  c.dossier.promise.goal_radius = Metres{100};
  c.promise_as_flown();
  CHECK(c.failing() == "");
  c.dossier.rules.coast_margin = Metres{4000};
  CHECK(c.failing() == "2 land");
}

TEST_CASE("rule 2 areas: the re-flown track keeps out, not only its waypoints") {
  auto c = good_case();
  const auto fix = c.dossier.at.fix;
  // The way leads north-east; at 3 km east it is 3 km north. A strip 20 m thin lies across it, then ends before it.
  c.sources.keep_out = {box(fix, 2500, 2000, 2520, 4000)};
  CHECK(c.failing() == "2 areas, 2 tail");
  c.sources.keep_out = {box(fix, 2500, 2600, 2520, 4000)};
  CHECK(c.failing() == "");
  const auto m = margin(c.judged(), "2 areas");
  CHECK(m.found > 0);
  CHECK(m.found < 150);
}

TEST_CASE("rule 2 areas: after the arrival in the goal radius only land counts") {
  auto c = good_case();
  const auto goal = c.dossier.promise.goal;
  // 1000 m short of the goal: inside the radius of 2000 m
  c.sources.keep_out = {box(goal, -800, -900, -600, -500)};
  CHECK(c.failing() == "");
  c.dossier.promise.goal_radius = Metres{300};
  c.promise_as_flown();
  CHECK(c.failing() == "2 areas, 2 tail");
}

TEST_CASE("rule 2 areas: a start inside a forbidden area may only leave it") {
  auto c = good_case();
  const auto fix = c.dossier.at.fix;
  c.sources.keep_out = {box(fix, -3000, -3000, 500, 500)};
  CHECK(c.failing() == "");
  // inside it towards the middle first: deeper before it gets out
  c.sources.keep_out = {box(fix, -300, -300, 3000, 3000)};
  CHECK(c.failing() == "2 areas, 2 tail");
}

TEST_CASE("rule 2 tail: a track that keeps clear only at the planned speed is refused") {
  auto c = good_case();
  // Correction 0 and a cross current: the track bows to the south-east by what a stint drifts.
  c.dossier.glider.current_correction = 0;
  c.dossier.believed_current.reset();
  c.field = test::uniform(0.05, -0.05);
  c.write({c.dossier.promise.goal}, 400);
  REQUIRE(c.failing() == "");
  const auto list = read_list(c.dossier.file_bytes, 8);
  const auto surfaced = fly(order_for(c.dossier, *list), c.field).stints[0].surfaced;
  const auto across = [&](double off) {
    // a strip along the way up to 50 m before the first surfacing, `off` metres to the side that the current carries to
    const auto corner = destination(surfaced, Bearing{degrees(135)}, Metres{off});
    chart::Area strip{"strip", {}};
    for (const auto& [along, aside] :
         std::vector<std::pair<double, double>>{{-1500, 0}, {-50, 0}, {-50, 300}, {-1500, 300}})
      strip.vertices.push_back(
          destination(destination(corner, Bearing{degrees(45)}, Metres{along}), Bearing{degrees(135)}, Metres{aside}));
    return strip;
  };
  // The planned track passes on the near side: it comes up to the strip's level only 50 m after the strip's end. The
  // slow, long variant surfaces 240 m earlier, 51 m farther out (5 % of 1018 m), drifts 64 m more and goes on outwards
  // by 0.24 m per metre: 160 m at most along the strip.
  c.sources.keep_out = {across(250)};
  CHECK(c.failing() == "");
  c.sources.keep_out = {across(60)};
  CHECK(c.failing() == "2 tail");
}

TEST_CASE("a margin is kept from where the track leaves it, before, the distance may only grow") {
  const auto start = geo_point(20, 10);
  const auto track = eastwards(start, 5000);
  const auto keeps = [&](const chart::Area& out, double limit) {
    const chart::Chart chart{{nullptr, {}, {out}}};
    return keeps_margin(track, 0, track.size(), limit, Distance::clearance, chart);
  };
  // abeam of the track: 1000 m off at its nearest
  CHECK(keeps(box(start, 2000, 1000, 3000, 2000), 999).holds);
  CHECK(keeps(box(start, 2000, 1000, 3000, 2000), 999).found == Approx(1000).margin(3));
  const auto broken = keeps(box(start, 2000, 1000, 3000, 2000), 1005);
  CHECK_FALSE(broken.holds);
  CHECK(broken.where >= 19);
  CHECK(broken.where <= 31);
  // behind the start: 500 m and growing
  CHECK(keeps(box(start, -2000, -1000, -500, 1000), 1500).holds);
  // ahead of a start inside the margin: shrinking
  CHECK_FALSE(keeps(box(start, 1000, 500, 3000, 2000), 1500).holds);
  // never outside, but growing all the time
  CHECK(keeps(box(start, -2000, -1000, -500, 1000), 50'000).holds);
  // an empty range keeps everything
  const chart::Chart chart{{nullptr, {}, {box(start, -100, -100, 100, 100)}}};
  CHECK(keeps_margin(track, 3, 3, 100, Distance::clearance, chart).holds);
}

namespace {

/// Water around a point whose depth is `deep` but for a band of columns from `band0` to `band1` metres east of it.
std::shared_ptr<const chart::Bathymetry> bank(const GeoPoint& around, float deep, double band0, double band1,
                                              float top) {
  // 0.005 degrees are 556 m northwards; the grid reaches 2 degrees to every side.
  chart::DepthGrid grid{"test", "made", around.lon.degrees() - 2, around.lat.degrees() - 2, 0.005, 0.005, 801, 801, {}};
  const double metres = 111'320.0 * std::cos(around.lat.radians());
  for (std::size_t n = 0; n < 801 * 801; ++n) {
    const double east = (0.005 * static_cast<double>(n % 801) - 2) * metres;
    grid.depths_m.push_back(east >= band0 && east <= band1 ? top : deep);
  }
  auto made = chart::Bathymetry::make(std::move(grid));
  if (!made) throw std::runtime_error(made.error());
  return *made;
}

/// The good case over a bottom; `from` and `to` are shares of the way east from fix to goal.
Case over(float deep, double from, double to, float top) {
  auto c = good_case();
  const auto& fix = c.dossier.at.fix;
  const double east = std::remainder(c.dossier.promise.goal.lon.radians() - fix.lon.radians(), 2 * kPi) * 6.37e6 *
                      std::cos(fix.lat.radians());
  const double a = std::min(from * east, to * east), b = std::max(from * east, to * east);
  c.sources.bathymetry = bank(fix, deep, a, b, top);
  c.sources.least_depth = Metres{40};
  return c;
}

constexpr float kUnknownDepth = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TEST_CASE("rule 2 depth: without bathymetry it holds and says that nothing was judged") {
  auto c = good_case();
  const auto m = margin(c.judged(), "2 depth");
  CHECK(m.holds);
  CHECK(std::isnan(m.found));
  CHECK(m.message == "no bathymetry is given: the depth of the water is not judged");
}

TEST_CASE("rule 2 depth: a bank on the way refuses when it is shallower than the limit, by a metre") {
  CHECK(over(500, 0.4, 0.6, 41).failing() == "");
  CHECK(margin(over(500, 0.4, 0.6, 41).judged(), "2 depth").found == Approx(41));
  CHECK(margin(over(500, 0.4, 0.6, 41).judged(), "2 depth").limit == 40);
  auto shallow = over(500, 0.4, 0.6, 39);
  CHECK(shallow.failing() == "2 depth");
  CHECK(margin(shallow.judged(), "2 depth").found == Approx(39).margin(0.01));
}

TEST_CASE("rule 2 depth: unknown water and land refuse") {
  auto unknown = over(500, 0.4, 0.6, kUnknownDepth);
  CHECK_FALSE(margin(unknown.judged(), "2 depth").holds);
  CHECK(margin(unknown.judged(), "2 depth").message.find("not known") != std::string::npos);
  CHECK_FALSE(margin(over(500, 0.4, 0.6, -3).judged(), "2 depth").holds);
}

TEST_CASE("rule 2 tail: with a bathymetry the water must be known there too, but may be shallow") {
  CHECK(margin(over(500, 0.4, 0.6, 39).judged(), "2 tail").holds);
  const auto unknown = margin(over(500, 0.4, 0.6, kUnknownDepth).judged(), "2 tail");
  CHECK_FALSE(unknown.holds);
  CHECK(unknown.message.find("the depth is not known or there is no water with stint length -5 %") !=
        std::string::npos);
  CHECK_FALSE(margin(over(500, 0.4, 0.6, -3).judged(), "2 tail").holds);
}

TEST_CASE("rule 2 depth: a start in shallow water may leave it, not come into shallower water") {
  CHECK(over(500, -0.2, 0.2, 30).failing() == "");
  auto c = over(30, 0.1, 0.2, 20);
  CHECK_FALSE(margin(c.judged(), "2 depth").holds);
  CHECK(over(500, -0.2, 0.2, kUnknownDepth).failing() == "");
}
