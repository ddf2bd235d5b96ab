#include "core/vehicle/steering.hpp"

#include <catch2/catch.hpp>

#include "core/safety/reflight.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;
using model::WaypointRole;
using test::current;
using vehicle::aim_point;
using vehicle::Stint;

namespace {

model::Glider glider(int correction, double believed = 0.3) {
  model::Glider g;
  g.current_correction = correction;
  g.believed_speed = MetresPerSecond{believed};
  return g;
}

/// Offset of `to` from `from` in metres of east and north.
std::pair<double, double> offset(GeoPoint from, GeoPoint to) {
  const auto line = geodesic(from, to);
  return {line.length.si() * line.departing.east(), line.length.si() * line.departing.north()};
}

struct Setting {
  ocean::FieldRef dive, surface;
  chart::Chart chart;
  vehicle::Waters waters;
  vehicle::Flight flight;
  Setting(ocean::FieldRef below, ocean::FieldRef above, int correction, chart::ChartSources sources = {})
      : dive{below}, surface{above}, chart{std::move(sources)}, waters{{dive, surface}, chart, Metres{500}} {
    flight.glider = glider(correction);
    flight.fix = geo_point(28, -16);
    flight.fix_s = test::kT0;
    flight.goal = {destination(flight.fix, Bearing{degrees(90)}, Metres{100e3}), Metres{2000}};
    flight.horizon_s = test::kT0 + 40 * 86400.0;
  }
  [[nodiscard]] std::vector<Stint> stints(double heading_deg, std::size_t count = 30) const {
    const std::vector<Heading> wanted(count, Heading{degrees(heading_deg)});
    return fly_headings(wanted, flight, waters).stints;
  }
};

/// The first surfacing of a list by the verifier's own flyer, which shares no code with the steering room.
safety::StintFlown independent(const model::WaypointList& list, const Setting& s) {
  safety::FlightOrder order;
  for (const auto& w : list.points) order.points.push_back(w.at);
  order.radius = list.radius;
  order.at_end = list.at_end;
  order.glider = s.flight.glider;
  order.schedule = s.flight.schedule;
  order.believed_current = s.flight.believed_current;
  order.fix = s.flight.fix;
  order.fix_s = s.flight.fix_s;
  order.horizon_s = s.flight.fix_s + s.flight.schedule.surfacing_time(0).count() + 1;
  order.goal = s.flight.goal.centre;
  order.goal_radius = s.flight.goal.radius;
  return safety::fly(order, s.dive).stints.at(0);
}

}  // namespace

TEST_CASE("an aim point lies along the believed course, one radius beyond the flown share of the stint") {
  const auto dive = geo_point(28, -16);
  const double t = 4 * 3600;
  {
    const auto aim = aim_point(dive, Heading{degrees(90)}, glider(0), current(9, 9), t, Metres{400});
    const auto [east, north] = offset(dive, aim.at);
    CHECK(east == Approx(0.95 * 0.3 * t + 400).margin(0.01));  // m = 5 %, and correction 0 believes in no current
    CHECK(north == Approx(0).margin(0.01));
    CHECK_FALSE(aim.ends_list);
  }
  {
    const auto aim = aim_point(dive, Heading{degrees(90)}, glider(1, 0.25), current(0.1, 0.2), t, Metres{400});
    const auto [east, north] = offset(dive, aim.at);
    const double g = std::hypot(0.35, 0.2), length = 0.99 * g * t + 400;
    CHECK(east == Approx(length * 0.35 / g).margin(0.01));
    CHECK(north == Approx(length * 0.2 / g).margin(0.01));
    CHECK(aim.length == Approx(length));
  }
}

TEST_CASE("before a glider has measured a current that is there, the ring comes earlier in the stint") {
  // A tenth of 0.3 m/s.
  CHECK(vehicle::early_share(glider(1), current(0, 0.029)) == 0.01);
  CHECK(vehicle::early_share(glider(1), current(0, 0.031)) == 0.05);
  CHECK(vehicle::early_share(glider(1), std::nullopt) == 0.01);
  CHECK(vehicle::early_share(glider(0), std::nullopt) == 0.05);
  const auto dive = geo_point(28, -16);
  const double t = 4 * 3600;
  CHECK(aim_point(dive, Heading{degrees(90)}, glider(1), current(0, 0), t, Metres{400}, Metres{0}, current(0.2, 0))
            .length == Approx(0.95 * 0.3 * t + 400));
}

TEST_CASE("against a believed current stronger than the glider the aim lies up-current and ends the list") {
  const auto dive = geo_point(28, -16);
  const auto aim = aim_point(dive, Heading{degrees(0)}, glider(1), current(0.1, -0.5), 14400, Metres{300});
  const auto [east, north] = offset(dive, aim.at);
  const double g = std::hypot(0.1, 0.2), length = 0.99 * g * 14400 + 300;
  CHECK(east == Approx(-length * 0.1 / g).margin(0.01));
  CHECK(north == Approx(length * 0.2 / g).margin(0.01));
  CHECK(aim.ends_list);
  // The law's heading towards it is the wanted one: bearing − asin(cross/Û).
  const double bearing = std::atan2(east, north);
  const double cross = 0.1 * std::cos(bearing) + 0.5 * std::sin(bearing);
  CHECK(bearing - std::asin(cross / 0.3) == Approx(0).margin(1e-6));
}

TEST_CASE("a leg that would be too short is lengthened and ends the list") {
  const auto dive = geo_point(28, -16);
  const auto nearly_held = aim_point(dive, Heading{degrees(0)}, glider(1), current(0, -0.295), 14400, Metres{300});
  CHECK(nearly_held.ends_list);  // 0.99·0.005·14400 + 300 = 371 m
  CHECK(nearly_held.length == Approx(600));
  CHECK(aim_point(dive, Heading{degrees(0)}, glider(1), current(0, -0.3), 14400, Metres{100}).length == Approx(500));
  // A glider that dives before it has drifted 336 m starts outside the ring too.
  const auto drifted =
      aim_point(dive, Heading{degrees(0)}, glider(1), current(0, -0.3), 14400, Metres{250}, Metres{336});
  CHECK(drifted.ends_list);
  CHECK(drifted.length == Approx(836));
}

TEST_CASE("with correction 1 a list is seven aim points and the goal, with correction 0 one and the goal") {
  const auto still = test::still_water();
  for (const int correction : {0, 1}) {
    const Setting s{still, still, correction};
    const auto list = list_for(s.stints(80), s.flight, s.waters, {});
    REQUIRE(list.points.size() == (correction == 1 ? 8 : 2));
    CHECK(list.points.back().at == s.flight.goal.centre);
    CHECK(list.points.back().role == WaypointRole::goal);
    CHECK(list.points.front().role == WaypointRole::aim);
    CHECK(list.at_end == model::AtEnd::loop);
    for (int most = 1; most <= 8; ++most)
      CHECK(list_for(s.stints(80), s.flight, s.waters, {most}).points.size() ==
            std::min<std::size_t>(correction == 1 ? 8 : 2, static_cast<std::size_t>(most)));
  }
}

TEST_CASE("the radius is a tenth of the median leg, at least 100 m and twice the drift, below the first leg") {
  const auto still = test::still_water();
  const double leg = 0.99 * 0.3 * 14400;
  const Setting calm{still, still, 1};
  CHECK(list_for(calm.stints(90), calm.flight, calm.waters, {}).radius.si() == std::ceil(0.1 * leg));
  CHECK(list_for(calm.stints(90), calm.flight, calm.waters, {8, Metres{150}}).radius.si() == 150);
  const test::Uniform fast{0.4, 0};  // drifts 360 m in a quarter of an hour
  const Setting windy{still, fast, 1};
  CHECK(list_for(windy.stints(90), windy.flight, windy.waters, {}).radius.si() == Approx(720).margin(1.5));
  Setting brief{still, still, 1};
  brief.flight.schedule.stint = brief.flight.schedule.first_stint = Seconds{1800};
  CHECK(list_for(brief.stints(90), brief.flight, brief.waters, {}).radius.si() == 100);
}

TEST_CASE("no leg of a list is longer than a stint can fly, and no aim lies in the ring before it") {
  // The current turns by 180 degrees from stint to stint: aim points of two stints lie up to 2·|ĉ|·t farther apart.
  struct Turning {
    [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint, Depth, double t) const {
      const double swing = std::sin(2 * kPi * (t - test::kT0) / 30600);  // two stints and drifts
      return ocean::Sample{{MetresPerSecond{0.28 * swing}, MetresPerSecond{0}}, false};
    }
    [[nodiscard]] ocean::Coverage coverage() const { return {}; }
    [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{0.28}; }
  };
  const Turning turning;
  Setting s{turning, turning, 1};
  for (const double heading : {20.0, 90.0, 200.0}) {
    const auto stints = s.stints(heading, 10);
    const auto list = list_for(stints, s.flight, s.waters, {});
    GeoPoint before = s.flight.fix;
    for (const auto& w : list.points) {
      if (w.role == WaypointRole::goal) break;
      const double leg = distance(before, w.at).si();
      CHECK(leg <= 1.1 * (0.3 + 0.28) * 14400);
      CHECK(leg > list.radius.si());
      before = w.at;
    }
  }
}

TEST_CASE("an aim that is never hit ends the list") {
  const test::Uniform strong{0, -0.5};
  Setting s{strong, strong, 1};
  s.flight.believed_current = current(0, -0.5);
  const auto list = list_for(s.stints(0, 5), s.flight, s.waters, {});
  REQUIRE(list.points.size() == 1);
  CHECK(offset(s.flight.fix, list.points[0].at).second > 0);  // up-current, though the glider is carried south
}

TEST_CASE("with correction 0 the tail goes around a forbidden area by surfacings of the plan, and no other points") {
  const auto still = test::still_water();
  const auto fix = geo_point(28, -16);
  const auto area_of = [&](double half_m) {
    chart::ChartSources sources;
    chart::Area wall;
    wall.name = "wall";
    const auto middle = destination(fix, Bearing{degrees(90)}, Metres{1.5 * half_m + 6e3});
    for (const double bearing : {45.0, 135.0, 225.0, 315.0})
      wall.vertices.push_back(destination(middle, Bearing{degrees(bearing)}, Metres{half_m * std::sqrt(2.0)}));
    sources.keep_out = {wall};
    return sources;
  };
  for (const double half : {3e3, 20e3}) {
    const Setting s{still, still, 0, area_of(half)};
    const auto stints_up = static_cast<std::size_t>(2.2 * half / 4320) + 2;
    std::vector<Heading> wanted(stints_up, Heading{degrees(45)});
    wanted.resize(60, Heading{degrees(95)});
    const auto stints = fly_headings(wanted, s.flight, s.waters).stints;
    const auto list = list_for(stints, s.flight, s.waters, {});
    INFO(half);
    REQUIRE(list.points.size() >= 3);
    CHECK(list.points.size() <= 8);
    // The small area is gone round within eight points; behind the large one the goal would be steered to through it, so
    // it is left out.
    CHECK((list.points.back().role == WaypointRole::goal) == (half < 10e3));
    for (std::size_t i = 1; i < list.points.size(); ++i) {
      if (list.points[i].role == WaypointRole::goal) break;
      CHECK(std::any_of(stints.begin(), stints.end(), [&](const Stint& t) { return t.surface == list.points[i].at; }));
      CHECK(s.chart.clearance(list.points[i].at).si() >= 500);
    }
    const auto flown = fly_list(list, s.flight, s.waters);
    CHECK_FALSE(flown.lost);
    CHECK(flown.arrival_s.has_value() == (half < 10e3));
  }
}

TEST_CASE("with correction 1 a goal behind land is left out of the list, not steered to through it") {
  const auto still = test::still_water();
  chart::ChartSources sources;
  chart::Area wall;
  wall.name = "wall";
  const auto middle = destination(geo_point(28, -16), Bearing{degrees(90)}, Metres{60e3});
  for (const double bearing : {20.0, 160.0, 200.0, 340.0})
    wall.vertices.push_back(destination(middle, Bearing{degrees(bearing)}, Metres{40e3}));
  sources.keep_out = {wall};
  const Setting s{still, still, 1, sources};
  const std::vector<Heading> wanted(20, Heading{degrees(60)});
  const auto list = list_for(fly_headings(wanted, s.flight, s.waters).stints, s.flight, s.waters, {});
  CHECK(list.points.back().role == WaypointRole::aim);
  CHECK(list.points.size() == 7);
  CHECK_FALSE(fly_list(list, s.flight, s.waters).lost);
}

TEST_CASE("without stints, and for a stint that arrives by steering at it, the list is the goal alone") {
  const auto still = test::still_water();
  Setting s{still, still, 1};
  CHECK(list_for({}, s.flight, s.waters, {}).points.size() == 1);
  s.flight.goal = {destination(s.flight.fix, Bearing{degrees(20)}, Metres{3000}), Metres{500}};
  const auto stints = s.stints(20, 1);
  REQUIRE(stints.size() == 1);
  CHECK(stints[0].arrives);
  const auto list = list_for(stints, s.flight, s.waters, {});
  REQUIRE(list.points.size() == 1);
  CHECK(list.points[0].at == s.flight.goal.centre);
  CHECK(list.radius.si() <= 250);
}

TEST_CASE("the list of an arriving stint arrives when the plan says") {
  // A cross current that correction 0 does not know of: steering at the goal misses it, a held heading does not.
  const test::Uniform across{0.2, 0};
  Setting s{across, across, 0};
  s.flight.goal = {destination(s.flight.fix, Bearing{degrees(0)}, Metres{2800}), Metres{200}};
  // 0.2 m/s against the current, 0.0144 m/s more make the first drift of 180 m good in the 12400 s to the disc.
  const std::vector<Heading> wanted{Heading{Radians{-std::asin(0.2144 / 0.3)}}};
  const auto flown = fly_headings(wanted, s.flight, s.waters);
  REQUIRE(flown.stints.size() == 1);
  REQUIRE(flown.arrival_s);
  const auto list = list_for(flown.stints, s.flight, s.waters, {});
  const auto alone = fly_list(list, s.flight, s.waters);
  REQUIRE(alone.arrival_s);
  CHECK(*alone.arrival_s == Approx(*flown.arrival_s).margin(1e-3));
}

TEST_CASE("the goal never lies in the ring of the aim that is held until the arrival") {
  // Headings that pass the goal at some distance, with a goal whose disc is wide enough to be entered on the way.
  const test::Uniform across{0.2, 0};
  int held = 0;
  for (const double away : {1500.0, 2500.0, 3500.0, 5000.0})
    for (const double off : {0.0, 10.0, 20.0, 30.0, 40.0}) {
      Setting s{across, across, 0};
      s.flight.goal = {destination(s.flight.fix, Bearing{degrees(0)}, Metres{away}), Metres{1400}};
      const std::vector<Heading> wanted{Heading{degrees(off - 60)}};
      const auto flown = fly_headings(wanted, s.flight, s.waters);
      if (flown.stints.size() != 1) continue;
      const auto list = list_for(flown.stints, s.flight, s.waters, {});
      if (list.points.size() < 2) continue;
      ++held;
      CHECK(distance(list.points[0].at, list.points[1].at) > list.radius);
    }
  CHECK(held >= 4);
}

TEST_CASE("a plan's next surfacing is that of its list flown by the verifier") {
  const auto seas = test::analytic_seas();
  for (const int correction : {0, 1})
    for (const auto& sea : seas) {
      Setting s{sea.field, sea.field, correction};
      s.flight = planning::flight_of(sea.problem);
      s.flight.glider = glider(correction, 0.28);
      if (correction == 1) s.flight.believed_current = current(0.05, -0.02);
      for (const double bearing : {20.0, 110.0, 250.0}) {
        const std::vector<Heading> wanted{Heading{degrees(bearing)}, Heading{degrees(bearing + 50)},
                                          Heading{degrees(bearing + 10)}};
        const auto plan = fly_headings(wanted, s.flight, s.waters);
        if (plan.stints.size() < 2) continue;
        const auto list = list_for(plan.stints, s.flight, s.waters, {});
        INFO(sea.name << " correction " << correction << " bearing " << bearing);
        const auto alone = fly_list(list, s.flight, s.waters);
        REQUIRE_FALSE(alone.stints.empty());
        // Both fly the same law, one with steps of 5 min, one of 1 min, through fields of at most 6e-5 1/s: (5 min · 6e-5)²/6 of 8 km, 0.4 m.
        CHECK(distance(independent(list, s).surfaced, alone.stints[0].surface).si() < 2.0);
        // The plan's w_2 stands in for the list's after the ring of w_1. Where 5 % of 8 km are left, 400 m: both are
        // dived for from ends that differ by what those 400 m are turned (50 degrees: 310 m), which is seen from the ring,
        // a leg of 4 to 8 km before w_2, as at most 310/4000 = 4.4 degrees, and twice that when w_2 is shortened:
        // 400·sin 8.8 degrees = 61 m. With 1 %, a fifth.
        const double share = vehicle::early_share(
            s.flight.glider, s.flight.believed_current ? std::nullopt : std::optional{plan.stints[0].dac});
        CHECK(distance(alone.stints[0].surface, plan.stints[0].surface).si() < 61.0 * share / 0.05);
      }
    }
}

TEST_CASE("a steering error is the way between the surfacing of the held heading and the one promised") {
  const auto still = test::still_water();
  const Setting s{still, still, 0};
  const std::vector<Heading> wanted{Heading{degrees(0)}, Heading{degrees(0)}};
  const auto stints = fly_headings(wanted, s.flight, s.waters).stints;
  REQUIRE(stints.size() >= 1);
  // The last 5 % (216 m) are flown towards the goal, 100 km to the east: an isosceles right triangle.
  CHECK(stints[0].steering_error.si() == Approx(216 * std::sqrt(2.0)).epsilon(0.05));
}

TEST_CASE("a new list at each surfacing keeps every surfacing where the list before promised it") {
  // Must show 6, first half: the ocean is the forecast, the surface current at least 0.3 m/s, twenty stints. The file of each
  // surfacing is flown by the verifier's flyer from the true fix; the promise is the plan made at that fix.
  struct Surface {
    const ocean::AnalyticField& below;
    [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double t) const {
      auto s = below.sample(p, z, t);
      if (!s) return s;
      return ocean::Sample{{s->current.east + MetresPerSecond{0.45}, s->current.north - MetresPerSecond{0.1}}, false};
    }
    [[nodiscard]] ocean::Coverage coverage() const { return below.coverage(); }
    [[nodiscard]] MetresPerSecond fastest() const { return below.fastest() + MetresPerSecond{0.47}; }
  };
  /// Both layers by depth, for the verifier: it drifts at depth 0 and dives below.
  struct Layers {
    const ocean::AnalyticField& below;
    const Surface& above;
    const double& dived;  ///< true while a dive is flown
    [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double t) const {
      return t < dived ? above.sample(p, z, t) : below.sample(p, z, t);
    }
    [[nodiscard]] ocean::Coverage coverage() const { return below.coverage(); }
    [[nodiscard]] MetresPerSecond fastest() const { return above.fastest(); }
  };
  ocean::AnalyticSpec spec;
  spec.kind = "tiled";
  spec.origin = geo_point(28, -16);
  spec.length_scale = Metres{12e3};
  spec.speed_scale = MetresPerSecond{0.15};
  const auto below = *ocean::AnalyticField::make(spec, instant_at(test::kT0), test::box_around(spec.origin, 3));
  const Surface above{below};
  double worst = 0;
  for (const int correction : {0, 1}) {
    Setting s{below, above, correction};
    s.flight.goal = {destination(s.flight.fix, Bearing{degrees(60)}, Metres{140e3}), Metres{1000}};
    Current measured;
    double dived = 0;
    const Layers layers{below, above, dived};
    for (int surfacing = 0; surfacing < 20; ++surfacing) {
      const double bearing = geodesic(s.flight.fix, s.flight.goal.centre).departing.degrees();
      std::vector<Heading> wanted;
      for (int k = 0; k < 6; ++k) wanted.push_back(Heading{degrees(bearing + 35 * std::sin(2.0 * (surfacing + k)))});
      if (correction == 1) s.flight.believed_current = measured;
      const auto plan = fly_headings(wanted, s.flight, s.waters);
      REQUIRE_FALSE(plan.stints.empty());
      const auto list = list_for(plan.stints, s.flight, s.waters, {});
      dived = s.flight.fix_s + s.flight.schedule.time_to_dive.count();
      Setting truth{layers, layers, correction};
      truth.flight = s.flight;
      const auto flown = independent(list, truth);
      const double off = distance(flown.surfaced, plan.stints[0].surface).si();
      worst = std::max(worst, off);
      INFO("correction " << correction << ", surfacing " << surfacing);
      CHECK(off < 200);
      s.flight.fix = flown.surfaced;
      s.flight.fix_s = flown.surfaced_s;
      measured = flown.met;
    }
  }
  INFO("worst " << worst << " m");
  CHECK(worst < 50);  // the layers meet at the dive: one step of 60 s through a jump of 0.46 m/s is 14 m
}

TEST_CASE("a current stronger than the glider against its heading is promised as it is flown") {
  const test::Uniform strong{0.1, -0.45};
  for (const int correction : {0, 1}) {
    Setting s{strong, strong, correction};
    if (correction == 1) s.flight.believed_current = current(0.1, -0.45);
    const std::vector<Heading> wanted(6, Heading{degrees(0)});
    for (int surfacing = 0; surfacing < 5; ++surfacing) {
      const auto plan = fly_headings(wanted, s.flight, s.waters);
      REQUIRE_FALSE(plan.stints.empty());
      const auto list = list_for(plan.stints, s.flight, s.waters, {});
      const auto flown = independent(list, s);
      INFO("correction " << correction << ", surfacing " << surfacing);
      CHECK(distance(flown.surfaced, plan.stints[0].surface).si() < 200);
      // With correction 1 the heading is held to the end; with 0 the last 5 % are steered to the goal in the east.
      CHECK(plan.stints[0].steering_error.si() < (correction == 1 ? 2.0 : 320.0));
      s.flight.fix = flown.surfaced;
      s.flight.fix_s = flown.surfaced_s;
    }
  }
}

TEST_CASE("a flight ends before the horizon unless it arrives first, and a grounded stint is no part of a plan") {
  const auto still = test::still_water();
  Setting s{still, still, 1};
  s.flight.horizon_s = test::kT0 + s.flight.schedule.surfacing_time(2).count() + 60;
  CHECK(s.stints(90).size() == 3);
  chart::ChartSources sources;
  chart::Area wall;
  wall.name = "wall";
  const auto middle = destination(s.flight.fix, Bearing{degrees(90)}, Metres{15e3});
  for (const double bearing : {45.0, 135.0, 225.0, 315.0})
    wall.vertices.push_back(destination(middle, Bearing{degrees(bearing)}, Metres{5e3}));
  sources.keep_out = {wall};
  const Setting walled{still, still, 1, sources};
  const std::vector<Heading> wanted(6, Heading{degrees(90)});
  const auto flown = fly_headings(wanted, walled.flight, walled.waters);
  CHECK(flown.lost == vehicle::Lost::aground);
  CHECK(flown.stints.size() == 2);  // the area's margin begins 11 km away, 2.5 stints of 4.3 km
  CHECK_FALSE(flown.arrival_s);
}
