#include "core/safety/rules.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "core/chart/coast.hpp"
#include "tests/core/safety/sample_dossier.hpp"

// Every rule is broken alone, on both sides of its limit.

using namespace glidehelm;
using namespace glidehelm::safety;
using test::Answer;
using test::Case;
using test::current;
using test::good_case;
using test::margin;

namespace {

const Bearing kNorthEast{degrees(45)};

std::vector<GeoPoint> along(const Case& c, const std::vector<double>& kilometres) {
  std::vector<GeoPoint> points;
  for (const double km : kilometres) points.push_back(destination(c.dossier.at.fix, kNorthEast, Metres{1000 * km}));
  return points;
}

/// A square keep-out area of half-width `half` metres.
chart::Area square(const GeoPoint& centre, double half) {
  chart::Area area{"square", {}};
  for (const double corner : {45.0, 135.0, 225.0, 315.0})
    area.vertices.push_back(destination(centre, Bearing{degrees(corner)}, Metres{half * std::sqrt(2.0)}));
  return area;
}

/// The horizon just after the surfacing of stint k (0-based).
void fly_until(Case& c, int k) {
  c.dossier.horizon_s = c.dossier.fix_s + c.dossier.schedule.surfacing_time(k).count() + 1;
  c.promise_as_flown();
}

}  // namespace

TEST_CASE("rule 0 dossier: a number that cannot be flown refuses, and nothing is flown") {
  const auto breaks = [](const std::function<void(Dossier&)>& change) {
    auto c = good_case();
    change(c.dossier);
    const auto verdict = c.judged();
    CHECK_FALSE(verdict.accepted);
    CHECK_FALSE(margin(verdict, "2 land").holds);
    return !margin(verdict, "0 dossier").holds;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, 0.0, -0.3, 5.1}) {
    CHECK(breaks([&](Dossier& d) { d.glider.horizontal_speed = MetresPerSecond{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.glider.believed_speed = MetresPerSecond{bad}; }));
  }
  for (const double bad : {nan, inf, -1.0, 0.0}) {
    CHECK(breaks([&](Dossier& d) { d.schedule.stint = Seconds{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.schedule.first_stint = Seconds{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.glider.dive_depth = Metres{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.glider.glide_angle = Radians{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.promise.goal_radius = Metres{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.horizon_s = bad; }));
  }
  for (const double bad : {nan, inf, -1.0}) {
    CHECK(breaks([&](Dossier& d) { d.schedule.surface = Seconds{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.schedule.time_to_dive = Seconds{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.rules.coast_margin = Metres{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.rules.refused_speed = MetresPerSecond{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.rules.max_wpt_distance = Metres{bad}; }));
    CHECK(breaks([&](Dossier& d) { d.rules.arrival_tolerance = bad; }));
    CHECK(breaks([&](Dossier& d) { d.rules.surfacing_tolerance = bad; }));
    CHECK(breaks([&](Dossier& d) { d.believed_current = current(bad, bad == -1 ? 20 : 0); }));
    CHECK(breaks([&](Dossier& d) { d.fix_s = bad; }));
    CHECK(breaks([&](Dossier& d) { d.judged_s = bad; }));
    CHECK(breaks([&](Dossier& d) { d.deadline_s = bad; }));
    CHECK(breaks([&](Dossier& d) { d.promise.list_arrival_s = bad; }));
  }
  CHECK(breaks([](Dossier& d) { d.glider.current_correction = 2; }));
  CHECK(breaks([](Dossier& d) { d.rules.max_waypoints = 0; }));
}

TEST_CASE("rule 4 name: only the name of the slot") {
  auto c = good_case();
  for (const char* name : {"goto_l11.ma", "GOTO_L10.MA", "goto_l10.ma.tmp", "goto_l1.ma", "", "../goto_l10.ma"}) {
    c.dossier.file_name = name;
    CHECK(c.failing() == "4 name");
  }
  c.dossier.rules.slot = 7;
  c.dossier.file_name = "goto_l07.ma";
  CHECK(c.failing() == "");
  c.dossier.rules.slot = 100;
  CHECK(c.failing() == "4 name");
}

TEST_CASE("rule 4 size: 4096 bytes are taken, 4097 and none are not") {
  auto c = good_case();
  const std::string good = c.dossier.file_bytes;
  std::string padding;
  while (good.size() + padding.size() + 100 <= 4096) padding += "#" + std::string(98, 'y') + "\n";
  padding += "#" + std::string(4096 - good.size() - padding.size() - 2, 'z') + "\n";
  c.dossier.file_bytes.insert(good.find("<start:b_arg>"), padding);
  REQUIRE(c.dossier.file_bytes.size() == 4096);
  CHECK(c.failing() == "");
  c.dossier.file_bytes.insert(good.find("<start:b_arg>"), "\n");
  CHECK(margin(c.judged(), "4 size").found == 4097);
  CHECK_FALSE(margin(c.judged(), "4 size").holds);
  c.dossier.file_bytes.clear();
  CHECK_FALSE(margin(c.judged(), "4 size").holds);
}

TEST_CASE("rule 4 format: what the reader refuses is refused with line and column") {
  auto c = good_case();
  c.dossier.file_bytes.replace(c.dossier.file_bytes.find("initial_wpt(enum) 0"), 19, "initial_wpt(enum) 1");
  const auto verdict = c.judged();
  CHECK_FALSE(verdict.accepted);
  const auto& m = margin(verdict, "4 format");
  CHECK_FALSE(m.holds);
  CHECK(m.found == 8);
  CHECK(m.message == "line 8, column 28: initial_wpt is 1, allowed is 0");
  for (const char* rule :
       {"4 points", "1 waypoints", "1 legs", "1 first leg", "1 neighbours", "1 reach", "2 flight", "2 land", "2 depth",
        "2 areas", "2 tail", "promise surfacing", "promise arrival", "forecast speed", "forecast values"})
    CHECK_FALSE(margin(verdict, rule).holds);
}

TEST_CASE("rule 4 points: half a unit of the last digit is rounding, more is another waypoint") {
  const double unit = 1.0 / test::kUnits;
  for (const double sign : {-1.0, 1.0}) {
    auto c = good_case();
    const auto meant = c.dossier.promise.points[1].at;
    const auto shift = [&](double lat_units, double lon_units) {
      c.dossier.promise.points[1].at =
          geo_point(meant.lat.degrees() + sign * lat_units * unit, meant.lon.degrees() + sign * lon_units * unit);
      return c.failing();
    };
    CHECK(shift(0.49, -0.49) == "");
    CHECK(shift(0.51, 0) == "4 points");
    CHECK(shift(0, 0.51) == "4 points");
  }
  auto fewer = good_case();
  fewer.dossier.promise.points.erase(fewer.dossier.promise.points.begin());
  CHECK(fewer.failing() == "4 points");
  auto swapped = good_case();
  std::swap(swapped.dossier.promise.points[0], swapped.dossier.promise.points[1]);
  CHECK(swapped.failing() == "4 points");
  auto radius = good_case();
  radius.dossier.promise.radius = Metres{400.04};  // the file has one decimal
  CHECK(radius.failing() == "");
  radius.dossier.promise.radius = Metres{400.1};
  CHECK(radius.failing() == "4 points");
  auto end = good_case();
  end.dossier.promise.at_end = model::AtEnd::loop;
  CHECK(end.failing() == "");
  end.dossier.promise.at_end = model::AtEnd::wait;
  CHECK(end.failing() == "4 points");
}

TEST_CASE("rule 4 points: 180 degrees east and west are the same meridian") {
  auto c = good_case();
  c.dossier.at.fix = geo_point(10, 179.9);
  c.dossier.promise.goal = geo_point(10, -180.0);
  c.write({c.dossier.promise.goal}, 300);
  for (const char* text : {"18000.0000 1000.0000", "-18000.0000 1000.0000"}) {
    const auto from = c.dossier.file_bytes.find("<start:waypoints>\n") + 18;
    c.dossier.file_bytes.replace(from, c.dossier.file_bytes.find('\n', from) - from, text);
    CHECK(c.failing() == "");
  }
}

TEST_CASE("rule 1 waypoints: each lies inside keep-in, outside keep-out and inside the forecast's area") {
  auto c = good_case();
  fly_until(c, 0);  // the goal is not reached, so only the waypoint itself can offend
  const auto goal = c.dossier.promise.goal;
  c.sources.keep_out = {square(destination(goal, Bearing{degrees(90)}, Metres{1100}), 1000)};
  CHECK(c.failing() == "");
  CHECK(margin(c.judged(), "1 waypoints").found == Approx(100).margin(1));
  c.sources.keep_out = {square(destination(goal, Bearing{degrees(90)}, Metres{950}), 1000)};
  CHECK(c.failing() == "1 waypoints");
  c.sources.keep_out.clear();
  c.sources.keep_in = {square(c.dossier.at.fix, 14'300)};  // the goal is 14 142 m east and north
  CHECK(c.failing() == "");
  c.sources.keep_in = {square(c.dossier.at.fix, 14'000)};
  CHECK(c.failing() == "1 waypoints");
  c.sources.keep_in.clear();
  c.field.box.east = goal.lon.radians() + 1e-6;
  CHECK(c.failing() == "");
  c.field.box.east = goal.lon.radians() - 1e-6;
  CHECK(c.failing() == "1 waypoints");
}

TEST_CASE("rule 1 waypoints: none lies on land or outside the coast file") {
  auto c = good_case();
  fly_until(c, 0);
  const auto coast = [&](double half_deg, double east_m) {
    // an island 2 km wide whose western shore lies `east_m` east of the goal
    const auto units = [](double deg) { return static_cast<std::int64_t>(std::llround(deg * 1e7)); };
    const double lat = c.dossier.at.fix.lat.degrees(), lon = c.dossier.at.fix.lon.degrees();
    const chart::CoastArea area{units(lon - half_deg), units(lon + half_deg), units(lat - half_deg),
                                units(lat + half_deg)};
    chart::CoastRing ring{{}, std::vector<bool>(4, false)};
    const auto goal = c.dossier.promise.goal;
    for (const auto& [e, n] :
         std::vector<std::pair<double, double>>{{0, -1000}, {2000, -1000}, {2000, 1000}, {0, 1000}}) {
      const auto p = destination(goal, Bearing{Radians{std::atan2(east_m + e, n)}}, Metres{std::hypot(east_m + e, n)});
      ring.points.push_back({static_cast<std::int32_t>(units(p.lon.degrees()) - area.west),
                             static_cast<std::int32_t>(units(p.lat.degrees()))});
    }
    auto made = chart::Coast::make(area, "a test", {ring});
    REQUIRE(made.has_value());
    c.sources.coast = *made;
  };
  coast(0.5, 50);
  CHECK(c.failing() == "");
  CHECK(margin(c.judged(), "1 waypoints").found == Approx(50).margin(1));
  coast(0.5, -50);
  CHECK(c.failing() == "1 waypoints");
  CHECK(margin(c.judged(), "1 waypoints").message.find("lies on land") != std::string::npos);
  // the goal lies 0.127 degrees north of the fix
  c.sources.coast = *chart::Coast::make({-305'000'000, -295'000'000, 395'000'000, 401'260'000}, "a test", {});
  CHECK(c.failing() == "1 waypoints");
  CHECK(margin(c.judged(), "1 waypoints").message.find("outside the coast file") != std::string::npos);
}

TEST_CASE("rule 1 waypoints: without a coastline the forecast's land is land") {
  auto c = good_case();
  fly_until(c, 0);
  const auto goal = c.dossier.promise.goal;
  const double shore = goal.lat.degrees();
  const auto land_from = [&](double lat) {
    return test::FormulaField{[=](GeoPoint p, double, double) -> Answer {
                                if (p.lat.degrees() > lat) return unexpected(ocean::NoCurrent::land);
                                return ocean::Sample{current(0.05, 0.02), false};
                              },
                              {}};
  };
  c.field = land_from(shore + 1e-4);
  CHECK(c.failing() == "");
  c.field = land_from(shore - 1e-4);
  CHECK(c.failing() == "1 waypoints");
}

TEST_CASE("rule 1 legs: fix to first and every leg but the last is at most 1.1 stints long") {
  // 1.1 · (0.3 + |0.05, 0.02|) m/s · 14 400 s
  const double limit = 1.1 * (0.3 + std::hypot(0.05, 0.02)) * 14'400;
  REQUIRE(limit == Approx(5605).margin(1));
  auto c = good_case();
  const auto goal = c.dossier.promise.goal;
  const auto with = [&](std::vector<double> km) {
    auto points = along(c, km);
    points.push_back(goal);
    c.write(points, 400);
    return c.failing();
  };
  CHECK(with({5.600}) == "");
  CHECK(margin(c.judged(), "1 legs").limit == Approx(limit).margin(0.1));
  CHECK(with({5.610}) == "1 legs");
  CHECK(with({4.5, 10.1}) == "");
  CHECK(with({4.5, 10.11}) == "1 legs");
  // Another believed current moves the limit, a shorter first stint that of the first leg only.
  c.dossier.schedule.first_stint = Seconds{7200};
  CHECK(with({2.800, 8.400}) == "");
  CHECK(with({2.810, 8.300}) == "1 legs");
}

TEST_CASE("rule 1 legs: a last leg that does not lead to the goal has a limit too") {
  auto c = good_case();
  c.write(along(c, {4.5, 10.1}), 400);
  CHECK(c.failing() == "");
  c.write(along(c, {4.5, 10.11}), 400);
  CHECK(c.failing() == "1 legs");
  c.write(along(c, {5.61}), 400);
  CHECK(c.failing() == "1 legs");
}

TEST_CASE("rule 1 legs: with correction 0 the forecast's current counts though the glider believes none") {
  auto c = good_case();
  c.dossier.glider.current_correction = 0;
  c.dossier.believed_current.reset();
  auto points = along(c, {5.600});
  points.push_back(c.dossier.promise.goal);
  c.write(points, 400);
  CHECK(c.failing() == "");
}

TEST_CASE("rule 1 first leg: the first waypoint lies outside its own radius") {
  auto c = good_case();
  auto points = along(c, {0.401, 5.0});
  points.push_back(c.dossier.promise.goal);
  c.write(points, 400);
  CHECK(c.failing() == "");
  points[0] = along(c, {0.399})[0];
  c.write(points, 400);
  CHECK(c.failing() == "1 first leg");
  // a single point that is not the goal has no excuse
  c.write(along(c, {0.399}), 400);
  CHECK(c.failing() == "1 first leg");
}

TEST_CASE("rule 1 neighbours: successive waypoints are farther apart than the radius") {
  auto c = good_case();
  for (const auto& [second, expected] :
       std::vector<std::pair<double, std::string>>{{4.901, ""}, {4.899, "1 neighbours"}}) {
    auto points = along(c, {4.5, second});
    points.push_back(c.dossier.promise.goal);
    c.write(points, 400);
    CHECK(c.failing() == expected);
  }
}

TEST_CASE("rule 1 reach: no waypoint is steered to beyond 0.9 of max_wpt_distance") {
  auto c = good_case();
  const double found = margin(c.judged(), "1 reach").found;
  // the longest way is the closing leg: from the ring of the goal back to w_1, 15.5 km less 400 m
  CHECK(found == Approx(15'100).margin(30));
  c.dossier.rules.max_wpt_distance = Metres{found / 0.9 + 1};
  CHECK(c.failing() == "");
  c.dossier.rules.max_wpt_distance = Metres{found / 0.9 - 1};
  CHECK(c.failing() == "1 reach");
}

TEST_CASE("rule 5 surfacing: the file answers the surfacing that is current, from its fix") {
  auto c = good_case();
  c.dossier.answers_surfacing = "sim01 0012.0002";
  CHECK(c.failing() == "5 surfacing");
  c.dossier.answers_surfacing = c.dossier.current_surfacing = "";
  CHECK(c.failing() == "5 surfacing");
  auto stale = good_case();
  stale.dossier.at.fix_taken = instant_at(stale.dossier.fix_s - 0.9);
  CHECK(stale.failing() == "");
  stale.dossier.at.fix_taken = instant_at(stale.dossier.fix_s - 1.1);
  CHECK(stale.failing() == "5 surfacing");
}

TEST_CASE("rule 5 glider: only the configured glider, whatever the case of its name") {
  auto c = good_case();
  c.dossier.at.glider = "SIM01";
  CHECK(c.failing() == "");
  c.dossier.at.glider = "sim02";
  CHECK(c.failing() == "5 glider");
  c = good_case();
  c.dossier.glider.name = "sim02";
  CHECK(c.failing() == "5 glider");
  c = good_case();
  c.dossier.glider_expected = c.dossier.at.glider = c.dossier.glider.name = "";
  CHECK(c.failing() == "5 glider");
}

TEST_CASE("rule 5 deadline: judged before it, not at it") {
  auto c = good_case();
  c.dossier.deadline_s = c.dossier.judged_s + 0.001;
  CHECK(c.failing() == "");
  c.dossier.deadline_s = c.dossier.judged_s;
  CHECK(c.failing() == "5 deadline");
}

TEST_CASE("rule promise surfacing: within 3 percent of the stint's way") {
  // 0.03 · 0.3 m/s · 14 400 s = 129.6 m
  auto c = good_case();
  const auto flown = c.dossier.promise.next_surfacing;
  c.dossier.promise.next_surfacing = destination(flown, kNorthEast, Metres{129.5});
  CHECK(c.failing() == "");
  c.dossier.promise.next_surfacing = destination(flown, kNorthEast, Metres{129.7});
  CHECK(c.failing() == "promise surfacing");
}

TEST_CASE("rule promise arrival: within 2 percent of the travel time, and it must arrive") {
  auto c = good_case();
  REQUIRE(c.dossier.promise.list_arrival_s.has_value());
  const double travel = *c.dossier.promise.list_arrival_s - c.dossier.fix_s;
  for (const double sign : {-1.0, 1.0}) {
    // |flown − promised| / promised = 0.02 at promised = flown / (1 ± 0.02)
    c.dossier.promise.list_arrival_s = c.dossier.fix_s + travel / (1 + sign * 0.0199);
    CHECK(c.failing() == "");
    c.dossier.promise.list_arrival_s = c.dossier.fix_s + travel / (1 + sign * 0.0201);
    CHECK(c.failing() == "promise arrival");
  }
  c.dossier.promise.list_arrival_s.reset();
  CHECK(c.failing() == "");
  c.dossier.promise.list_arrival_s = c.dossier.fix_s + travel;
  c.dossier.horizon_s = c.dossier.fix_s + travel - 1;
  CHECK(c.failing() == "promise arrival");
  c.dossier.horizon_s = c.dossier.fix_s + travel + 1;
  CHECK(c.failing() == "");
}

TEST_CASE("rule forecast cover: the forecast reaches the second next surfacing and begins before the fix") {
  auto c = good_case();
  const double second = c.dossier.fix_s + c.dossier.schedule.surfacing_time(1).count();
  c.field.box.last_s = second + 1;
  CHECK(c.failing() == "");
  c.field.box.last_s = second - 1;
  CHECK(c.failing() == "forecast cover");
  c.field.box.last_s = 1e18;
  c.field.box.first_s = c.dossier.fix_s + 1;
  CHECK(c.failing() == "forecast cover");
}

TEST_CASE("rule forecast age: 72 hours are allowed and not more, currents of no one time do not age") {
  auto c = good_case();
  const auto aged = [&](double hours) {
    return margin(judge(c.dossier, c.field, chart::Chart{c.sources}, c.dossier.judged_s - 3600 * hours),
                  "forecast age");
  };
  CHECK(aged(71.99).holds);
  CHECK(aged(71.99).found == Approx(71.99));
  CHECK_FALSE(aged(72.01).holds);
  CHECK(aged(72.01).message == "the forecast is 72.0 h old, allowed are 72 h");
  CHECK(aged(-5).holds);  // issued after this instant: a rehearsal in the past
  CHECK_FALSE(judge(c.dossier, c.field, chart::Chart{c.sources}, c.dossier.judged_s - 3600 * 73.0).accepted);
  CHECK(margin(c.judged(), "forecast age").holds);
}

TEST_CASE("rule forecast speed: no current met is faster than refused") {
  auto c = good_case();
  const double late = *c.dossier.promise.list_arrival_s + 3600;
  const auto fast = [&](double speed) {
    return test::FormulaField{
        [=](GeoPoint, double, double t) -> Answer {
          return ocean::Sample{t > late && t < late + 300 ? current(speed, 0) : current(0.05, 0.02), false};
        },
        {}};
  };
  c.field = fast(5.0);
  CHECK(c.failing() == "");
  c.field = fast(5.001);
  CHECK(c.failing() == "forecast speed");
  CHECK(margin(c.judged(), "forecast speed").found == Approx(5.001));
}

TEST_CASE("rule forecast values: a current that is not a number refuses") {
  auto c = good_case();
  const double late = *c.dossier.promise.list_arrival_s + 3600;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    c.field = {[=](GeoPoint, double, double t) -> Answer {
                 return ocean::Sample{t > late ? current(0.05, bad) : current(0.05, 0.02), false};
               },
               {}};
    CHECK(c.failing() == "2 flight, forecast values");
  }
}
