#include "protocol/accept_fix.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/utc.hpp"

using namespace glidehelm;
using namespace glidehelm::protocol;

namespace {

const Instant kHeard = utc_from_text("2026-05-03T04:10:25Z").value();

SurfaceBlock good() {
  SurfaceBlock block;
  block.vehicle = "alba";
  block.curr_time = GliderTime{std::chrono::seconds{1777781420}};  // 2026-05-03T04:10:20Z
  block.gps = Location{"2901.250", "-1528.400", 'N', 'E', 48.25};
  block.line = 7;
  block.heard = kHeard;
  block.at_surface = true;
  block.console = Console::mission;
  block.mission = MissionLine{"CANARY.MI", "alba-2026-122-4-3", "0112.0003"};
  block.because = BecauseLine{"pitch not commanded", "surface_4", 2.0};
  block.until_diving_s = 236;
  block.water = WaterState::complete;
  block.waypoint = WaypointLine{"2910.5000", "-1530.0000", 17321, 352};
  block.sensors = {{"m_water_vx", "m/s", -0.04, 50},
                   {"m_water_vy", "m/s", 0.12, 50},
                   {"m_avg_speed", "m/s", 0.28, 61},
                   {"m_gps_mag_var", "rad", 0.08, 44},
                   {"u_use_current_correction", "nodim", 1, 1e308}};
  return block;
}

std::string rule(const SurfaceBlock& block, const Limits& limits = {}) {
  const auto result = accept_fix(block, limits);
  return result ? "used" : result.error().rule;
}
std::string reason(const SurfaceBlock& block, const Limits& limits = {}) {
  return accept_fix(block, limits).error().reason;
}

template <class Change>
SurfaceBlock with(Change&& change) {
  auto block = good();
  change(block);
  return block;
}
SurfaceBlock at(std::string lat, std::string lon, char n = 'N', char e = 'E') {
  return with([&](SurfaceBlock& b) { b.gps = Location{std::move(lat), std::move(lon), n, e, 48.25}; });
}

}  // namespace

TEST_CASE("a whole block becomes a surfacing with everything in it") {
  const auto s = accept_fix(good(), Limits{});
  REQUIRE(s);
  CHECK(s->glider == "alba");
  CHECK(s->heard == kHeard);
  CHECK(s->fix_taken == utc_from_text("2026-05-03T04:09:36.75Z"));  // heard − age, not Curr Time − age
  CHECK(s->fix_age == Seconds{48.25});
  CHECK(std::abs(s->fix.lat.degrees() - (29 + 1.25 / 60)) < 1e-12);
  CHECK(std::abs(s->fix.lon.degrees() + (15 + 28.4 / 60)) < 1e-12);
  CHECK(s->lat_ddmm == "2901.250");
  CHECK(s->lon_ddmm == "-1528.400");
  CHECK(s->at_surface);
  CHECK(s->mission == "canary.mi");
  CHECK(s->segment == "0112.0003");
  CHECK(s->because == model::SurfaceReason{"pitch not commanded", "surface_4", 2.0});
  CHECK(s->until_diving == Seconds{236});
  CHECK(s->water == model::LocalVelocity{MetresPerSecond{-0.04}, MetresPerSecond{0.12}});
  CHECK(s->water_is_final);
  CHECK(std::abs(s->aim->at.lat.degrees() - (29 + 10.5 / 60)) < 1e-12);
  CHECK(s->aim->range == Metres{17321});
  CHECK(s->believed_speed == MetresPerSecond{0.28});
  CHECK(s->current_correction == 1);
  CHECK(s->magnetic_variation == Radians{0.08});
  CHECK(s->sensors.size() == 5);
}

TEST_CASE("S2: a block without a name or of another glider is refused") {
  CHECK(rule(with([](SurfaceBlock& b) { b.vehicle.clear(); })) == "S2");
  Limits limits;
  limits.glider = "ALBA";
  CHECK(rule(good(), limits) == "used");
  CHECK(accept_fix(good(), "Alba").has_value());
  limits.glider = "brisa";
  CHECK(reason(good(), limits) == "this is glider alba, expected is brisa");
}

TEST_CASE("S8: a position printed at a prompt is no surfacing") {
  CHECK(rule(with([](SurfaceBlock& b) { b.console = Console::gliderdos; })) == "S8");
  CHECK(rule(with([](SurfaceBlock& b) { b.console = Console::gliderlab; })) == "S8");
  CHECK(rule(with([](SurfaceBlock& b) { b.console = Console::unknown; })) == "used");
}

TEST_CASE("R7: a damaged fix line refuses the block, a missing one too") {
  CHECK(rule(with([](SurfaceBlock& b) {
          b.gps.reset();
          b.gps_damaged = true;
        })) == "R7");
  CHECK(rule(with([](SurfaceBlock& b) { b.gps.reset(); })) == "S3");
}

TEST_CASE("S3: sentinels are no fix") {
  CHECK(reason(at("69696969.000", "69696969.000")) == "the glider has had no GPS fix yet (69696969.000)");
  CHECK(rule(at("2901.250", "69696969.000")) == "S3");
  CHECK(rule(at("0.000", "0.000")) == "S3");
  CHECK(rule(at("-0.000", "0.000")) == "S3");
  CHECK(rule(at("0.001", "0.000")) == "used");
  CHECK(rule(with([](SurfaceBlock& b) { b.gps->age_s = 1e308; })) == "S3");
  CHECK(rule(with([](SurfaceBlock& b) { b.gps->age_s = 1e8; })) == "S3");
}

TEST_CASE("S3: a fix older than the limit is stale") {
  const auto aged = [](double age) { return with([&](SurfaceBlock& b) { b.gps->age_s = age; }); };
  CHECK(rule(aged(1200)) == "used");
  CHECK(rule(aged(1200.001)) == "S3");
  CHECK(reason(aged(1500)) == "the fix is 1500 s old, allowed are 1200 s");
  Limits limits;
  limits.max_age = Seconds{3600};
  CHECK(rule(aged(1500), limits) == "used");
  limits.max_age = Seconds{1e300};
  CHECK(rule(aged(1e299), limits) == "S3");  // the absolute cap
  CHECK(rule(aged(-4)) == "used");
  CHECK(rule(aged(-6)) == "S3");
}

TEST_CASE("S3: a fix without a readable time is refused") {
  CHECK(rule(with([](SurfaceBlock& b) { b.curr_time.reset(); })) == "S3");
}

TEST_CASE("S3: minutes, ranges and letters are checked") {
  CHECK(rule(at("2961.250", "-1528.400")) == "S3");
  CHECK(rule(at("2901.250", "-1560.000")) == "S3");
  CHECK(rule(at("9000.001", "-1528.400")) == "S3");
  CHECK(rule(at("2901.250", "18000.001")) == "S3");
  CHECK(rule(at("2901.250", "-1528.400", 'X')) == "S3");
  CHECK(rule(at("2901.250", "-1528.400", 'E', 'N')) == "S3");
  CHECK(rule(at("2901.250", "-1528.400", 'N', 'W')) == "S3");  // a sign and a letter
  const auto south_west = accept_fix(at("2901.250", "1528.400", 'S', 'W'), Limits{});
  REQUIRE(south_west);
  CHECK(south_west->fix.lat.degrees() < 0);
  CHECK(south_west->fix.lon.degrees() < 0);
}

TEST_CASE("a refusal carries what the pilot needs to find the line") {
  const auto refusal = accept_fix(at("2961.250", "-1528.400"), Limits{}).error();
  CHECK(refusal.glider == "alba");
  CHECK(refusal.heard == kHeard);
  CHECK(refusal.lat_ddmm == "2961.250");
  CHECK(refusal.lon_ddmm == "-1528.400");
}

TEST_CASE("S7: the water velocity is left out when it is old, incomplete or beyond what the glider clips") {
  const auto water = [](double x, double y, double age) {
    return accept_fix(with([&](SurfaceBlock& b) {
                        b.sensors = {{"m_water_vx", "m/s", x, age}, {"m_water_vy", "m/s", y, age}};
                      }),
                      Limits{})
        ->water;
  };
  CHECK(water(0.1, 0.1, 50));
  CHECK_FALSE(water(0.1, 0.1, 1e308));
  CHECK_FALSE(water(0.1, 0.1, 86'401));
  CHECK(water(2.8, 0, 50));
  CHECK_FALSE(water(2.0, 2.0, 50));
  CHECK_FALSE(accept_fix(with([](SurfaceBlock& b) { b.sensors.resize(1); }), Limits{})->water);
  CHECK_FALSE(accept_fix(with([](SurfaceBlock& b) { b.water = WaterState::waiting; }), Limits{})->water_is_final);
}

TEST_CASE("a block is at the surface of a mission only with its reason and its mission") {
  CHECK_FALSE(accept_fix(with([](SurfaceBlock& b) { b.because.reset(); }), Limits{})->at_surface);
  CHECK_FALSE(accept_fix(with([](SurfaceBlock& b) { b.mission.reset(); }), Limits{})->at_surface);
  CHECK_FALSE(accept_fix(with([](SurfaceBlock& b) { b.at_surface = false; }), Limits{})->at_surface);
}

TEST_CASE("values that were never updated are left out, constants are not") {
  const auto s = accept_fix(with([](SurfaceBlock& b) {
                              b.sensors = {{"x_last_wpt_lat", "lat", 6042.7, 1e308}, {"c_wpt_lat", "lat", 0, 1e308},
                                           {"c_dive_bpump", "X", -1000, 1e308},      {"u_alt_min_depth", "m", 2, 1e308},
                                           {"m_gps_mag_var", "rad", 0, 1e308},       {"m_avg_speed", "m/s", 0, 12},
                                           {"m_gps_lat", "lat", 69696969, 3},        {"m_battery", "volts", 14, 3}};
                            }),
                            Limits{});
  REQUIRE(s);
  CHECK(s->sensors == std::map<std::string, double>{
                          {"c_dive_bpump", -1000}, {"u_alt_min_depth", 2}, {"m_avg_speed", 0}, {"m_battery", 14}});
  CHECK_FALSE(s->magnetic_variation);
  CHECK_FALSE(s->believed_speed);
  CHECK_FALSE(s->current_correction);
}

TEST_CASE("of a waypoint line that is no position nothing is taken") {
  CHECK_FALSE(accept_fix(with([](SurfaceBlock& b) { b.waypoint->lat_text = "9960.0000"; }), Limits{})->aim);
}

TEST_CASE("same_fix compares texts and times by difference") {
  const auto print = [](int later, double age) {
    return accept_fix(with([&](SurfaceBlock& b) {
                        *b.curr_time += std::chrono::seconds{later};
                        b.gps->age_s = age;
                      }),
                      Limits{})
        .value();
  };
  CHECK(model::same_fix(print(0, 48.25), print(14, 62.31)));
  CHECK(model::same_fix(print(0, 48.25), print(61, 110.2)));  // 0.95 s apart
  CHECK_FALSE(model::same_fix(print(0, 48.25), print(60, 48.25)));
  CHECK_FALSE(model::same_fix(print(0, 48.25), accept_fix(at("2901.251", "-1528.400"), Limits{}).value()));
}

TEST_CASE("of a dialog without m_water the completed final current is taken, else the initial one") {
  const auto water = [](bool vx, bool final_printed, bool initial_printed, WaterState state) {
    const auto s = accept_fix(with([&](SurfaceBlock& b) {
                                b.water = state;
                                b.sensors.clear();
                                if (vx) b.sensors = {{"m_water_vx", "m/s", 0.3, 1e308}};
                                if (final_printed) {
                                  b.sensors.push_back({"m_final_water_vx", "m/s", -0.04, 50});
                                  b.sensors.push_back({"m_final_water_vy", "m/s", 0.12, 50});
                                }
                                if (initial_printed) {
                                  b.sensors.push_back({"m_initial_water_vx", "m/s", 0.01, 80});
                                  b.sensors.push_back({"m_initial_water_vy", "m/s", 0.02, 80});
                                }
                              }),
                              Limits{});
    REQUIRE(s);
    return std::pair{s->water ? s->water->x.si() : 0.0, s->water_is_final};
  };
  using Told = std::pair<double, bool>;
  CHECK(water(false, true, true, WaterState::complete) == Told{-0.04, true});
  CHECK(water(false, true, true, WaterState::unknown) == Told{0.01, false});  // the final one is of the dive before
  CHECK(water(false, true, false, WaterState::unknown) == Told{0.0, false});
  CHECK(water(false, false, true, WaterState::complete) == Told{0.01, false});
  CHECK(water(true, true, true, WaterState::complete) ==
        Told{0.0, false});  // m_water is printed, and was never measured
}
