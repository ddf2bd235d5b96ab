#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <iostream>

#include "core/base/utc.hpp"
#include "core/mission/estimate.hpp"
#include "tests/support/flown_mission.hpp"
#include "tests/support/random_sea.hpp"

using namespace glidehelm;
using test::FlownMission;

namespace {

FlownMission::Setup setup(GeoPoint from, GeoPoint goal, int correction) {
  return test::leg_setup(from, goal, correction, test::kSeaStart);
}

struct DacError {
  double degrees{}, percent{};
};

/// The current that each plan used against the one that the dive before it met, from the third surfacing on: the worst.
DacError worst_dac(const FlownMission& flown) {
  std::map<std::string, Current> used;  // by key of the surfacing, which holds its time
  for (const auto& effects : flown.effects())
    for (const auto& effect : effects)
      if (const auto* begin = std::get_if<mission::BeginPlanning>(&effect))
        if (begin->request.problem.believed_current)
          used[begin->request.surfacing] = *begin->request.problem.believed_current;
  const auto& records = flown.simulation().surfacings(0);
  const auto& dives = flown.simulation().dives(0);
  DacError worst;
  int compared = 0;
  for (std::size_t j = 2; j < records.size(); ++j) {
    const auto key = "sim01/" + utc_text(instant_at(records[j].fix_s));
    for (const auto& [surfacing, dac] : used) {
      const auto at = utc_from_text(std::string_view{surfacing}.substr(6));
      if (!at || std::abs(epoch_seconds(*at) - records[j].fix_s) > 5) continue;
      const auto truth = dives.at(j - 1).truth.water;
      const Radians turn = Course::of(dac.east.si(), dac.north.si()) - Course::of(truth.east.si(), truth.north.si());
      worst.degrees = std::max(worst.degrees, std::abs(in_degrees(turn)));
      worst.percent = std::max(worst.percent, 100 * std::abs(dac.speed() / truth.speed() - 1));
      ++compared;
    }
  }
  REQUIRE(compared >= 4);
  return worst;
}

/// How often the pilot said a text with these words.
int said(const FlownMission& flown, const std::string& words) {
  int count = 0;
  for (const auto& effects : flown.effects())
    for (const auto& effect : effects)
      if (const auto* say = std::get_if<mission::Say>(&effect))
        count += say->text.find(words) != std::string::npos ? 1 : 0;
  return count;
}

}  // namespace

TEST_CASE(
    "in a frame turned by 10 degrees the current that the daemon uses is right to 1 degree and 2 % at the third "
    "surfacing, however it learns the frame, untreated it is wrong by all of it") {
  struct Way {
    const char* what;
    simulator::Telling tells;
    bool configured{};
    std::optional<Radians> as_if{};  ///< the switch: what the daemon is told whatever is true
    mission::FrameRotation::From from{};
  };
  using From = mission::FrameRotation::From;
  const std::vector<std::string> silent{"m_gps_mag_var"};
  // The floor of a printed bearing costs up to 0.5°, the median of several less; the variation itself is exact here.
  const std::array<Way, 6> ways{
      Way{"configured", {silent, {}, false, false}, true, {}, From::configured},
      {"m_gps_mag_var", {{}, {}, false, false}, false, {}, From::magnetic_variation},
      {"Waypoint: lines", {silent, {}, false, true}, false, {}, From::waypoint_lines},
      {"lines against m_gps_mag_var off by 6 deg", {{}, degrees(6), false, true}, false, {}, From::waypoint_lines},
      {"none of them", {silent, {}, false, false}, false, {}, From::assumed_zero},
      {"untreated (configured as 0)", {}, false, Radians{0}, From::configured}};
  const auto from = geo_point(40.4, 4.1), goal = geo_point(41.3, 5.2);
  const auto forecast = test::gridded_forecast(test::random_sea({17}, geo_point(40.8, 4.6), 0.05, 0.16, -0.11), from,
                                               goal, test::kSeaStart);
  const chart::Chart open_ocean;
  std::cout << "frame turned by    learned from                                worst direction   worst size\n";
  for (const double rotation : {10.0, -10.0})
    for (const auto& way : ways) {
      auto s = setup(from, goal, 1);
      s.mission.frame_rotation = way.configured ? std::optional{degrees(rotation)} : way.as_if;
      s.glider.setup.frame.rotation = degrees(rotation);
      s.glider.call.tells = way.tells;
      s.end.surfacings = 7;
      FlownMission flown{s, forecast, forecast->forecast.ocean(), open_ocean};
      flown.fly();
      const auto error = worst_dac(flown);
      std::cout << fmt::format("{:+8.0f} deg       {:42}  {:9.2f} deg  {:9.2f} %\n", rotation, way.what, error.degrees,
                               error.percent);
      CAPTURE(rotation, way.what);
      CHECK(flown.pilot().learned().rotation.from == way.from);
      CHECK(error.percent < 2.0);
      const bool known = way.from != From::assumed_zero && !way.as_if;
      if (known)
        CHECK(error.degrees < 1.0);
      else
        CHECK(error.degrees == Approx(10.0).margin(0.5));
      // Who knows nothing says so, once.
      CHECK(said(flown, "nothing tells how the glider's frame is turned") == (way.from == From::assumed_zero ? 1 : 0));
      // Who is told something that the lines deny says that.
      CHECK(said(flown, "the Waypoint: lines say that the frame is turned") == (way.as_if ? 1 : 0));
    }
}

TEST_CASE("a current of which only the initial or only the final value is told is used within the same limits") {
  struct Way {
    const char* what;
    simulator::Telling tells;
    bool final_value{}, told{true};
  };
  const std::array<Way, 5> ways{
      Way{"the final one awaited", {{}, {}, true}, false},
      {"m_initial_water alone",
       {{"m_water_vx", "m_water_vy", "m_final_water_vx", "m_final_water_vy"}, {}, false},
       false},
      {"m_final_water alone",
       {{"m_water_vx", "m_water_vy", "m_initial_water_vx", "m_initial_water_vy"}, {}, false},
       true},
      {"m_water alone",
       {{"m_initial_water_vx", "m_initial_water_vy", "m_final_water_vx", "m_final_water_vy"}, {}, false},
       true},
      {"none",
       {{"m_water_vx", "m_water_vy", "m_initial_water_vx", "m_initial_water_vy", "m_final_water_vx",
         "m_final_water_vy"},
        {},
        false},
       false,
       false}};
  const auto from = geo_point(40.4, 4.1), goal = geo_point(41.3, 5.2);
  const auto forecast = test::gridded_forecast(test::random_sea({17}, geo_point(40.8, 4.6), 0.05, 0.16, -0.11), from,
                                               goal, test::kSeaStart);
  const chart::Chart open_ocean;
  for (const auto& way : ways) {
    auto s = setup(from, goal, 1);
    s.glider.setup.frame.rotation = degrees(10);
    s.glider.call.tells = way.tells;
    s.end.surfacings = 7;
    FlownMission flown{s, forecast, forecast->forecast.ocean(), open_ocean};
    flown.fly();
    CAPTURE(way.what);
    CHECK(flown.refusals().empty());
    const auto& water = flown.pilot().learned().water;
    CHECK(water.has_value() == way.told);
    if (!way.told) {
      // Six surfacings have dived before; each says what is missing and what follows.
      CHECK(said(flown, "no measured current in the dialog (aimed as for still water)") == 6);
      continue;
    }
    CHECK(water->final_value == way.final_value);
    CHECK(said(flown, "(initial)") >= (way.final_value ? 0 : 5));
    // The initial one takes the first fix, 25 s after the surfacing, for the surfacing: with 0.2 m/s 5 m in four hours.
    const auto error = worst_dac(flown);
    std::cout << way.what << ": " << error.degrees << " deg, " << error.percent << " %\n";
    CHECK(error.degrees < 1.0);
    CHECK(error.percent < 2.0);
  }
}

TEST_CASE(
    "a glider that is slower than configured and steers 6 degrees off is foreseen better from surfacing to surfacing") {
  // Correction 1: what it believes of the current holds its own errors, so the first plans are wrong by a tenth of the way.
  const auto from = geo_point(40.3, 4.0), goal = geo_point(41.5, 5.6);
  const auto forecast = test::gridded_forecast(test::random_sea({5}, geo_point(40.8, 4.6), 0.08, 0.03, 0.05), from,
                                               goal, test::kSeaStart);
  const chart::Chart open_ocean;
  auto s = setup(from, goal, 1);
  s.mission.frame_rotation = Radians{0};
  s.glider.setup.hull.speed = MetresPerSecond{0.26};
  s.glider.setup.hull.heading_bias = degrees(6);
  s.end.surfacings = 22;
  FlownMission flown{s, forecast, forecast->forecast.ocean(), open_ocean};
  flown.fly();
  std::vector<double> early, late;
  for (std::size_t j = 1; j < flown.surfacings().size(); ++j) {
    const auto& at = flown.surfacings()[j];
    if (!at.promised) continue;
    (j <= 2 ? early : late).push_back(distance(at.fix, *at.promised).si());
  }
  const auto known = flown.pilot().learned();
  std::cout << "slow and crooked: first two surfacings off by " << mission::median_of(early) << " m, the later ones by "
            << mission::median_of(late) << " m; learned " << known.speed.si() << " m/s (to within "
            << known.speed_spread.si() << "), heading off by " << in_degrees(known.heading_bias) << " deg (to within "
            << in_degrees(known.heading_bias_spread) << ")\n";
  CHECK(flown.refusals().empty());
  REQUIRE(late.size() >= 15);
  CHECK(mission::median_of(late) < 0.5 * mission::median_of(early));
  // On a way without turns most of it is taken for water; the spreads say so.
  CHECK(known.speed.si() < 0.30);
  CHECK(known.heading_bias.si() > 0);
  CHECK(std::abs(known.speed.si() - 0.26) < 2 * known.speed_spread.si());
  CHECK(std::abs(in_degrees(known.heading_bias) - 6) < 2 * in_degrees(known.heading_bias_spread));
}
