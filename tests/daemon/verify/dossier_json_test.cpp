#include "daemon/verify/dossier_json.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace glidehelm;
using namespace glidehelm::verify;

namespace {

/// Numbers that a careless text loses: many digits, tiny, negative zero, not a number.
safety::Dossier awkward_dossier() {
  safety::Dossier d;
  d.file_name = "goto_l10.ma";
  d.file_bytes = std::string("behavior_name=goto_list\n\x01\xff\0 binary", 33);
  d.glider_expected = "sim01";
  d.at.glider = "sim01";
  d.at.heard = Instant{std::chrono::milliseconds{1'732'530'030'123}};
  d.at.fix = GeoPoint::from_kernel(0.1 + 1e-17 + 0.2, -kPi);
  d.at.fix_taken = Instant{std::chrono::milliseconds{-1}};
  d.at.fix_age = Seconds{45.682};
  d.at.curr_time = GliderTime{std::chrono::seconds{1'732'530'016}};
  d.at.lat_ddmm = "5949.127";
  d.at.lon_ddmm = "-2317.927";
  d.at.at_surface = true;
  d.at.mission = "caf\xe9.mi";
  d.at.segment = "0169.0002";
  d.at.because = model::SurfaceReason{"pitch not commanded", "surface_4", 2.0};
  d.at.until_diving = Seconds{235};
  d.at.water = model::LocalVelocity{MetresPerSecond{-0.0}, MetresPerSecond{1.0 / 3.0}};
  d.at.water_is_final = true;
  d.at.aim = model::AimLine{geo_point(-12.5, 179.999), Metres{86}, 324};
  d.at.believed_speed = MetresPerSecond{0.2871};
  d.at.current_correction = 1;
  d.at.magnetic_variation = Radians{-0.13};
  d.at.sensors = {{"m_battery", 14.1234567890123456}, {"odd\nname", std::numeric_limits<double>::denorm_min()}};
  d.current_surfacing = "sim01 0169.0002";
  d.answers_surfacing = "sim01 0169.0001";
  d.glider.name = "sim01";
  d.glider.horizontal_speed = MetresPerSecond{0.1 + 0.2};
  d.glider.current_correction = 0;
  d.believed_current = Current{MetresPerSecond{std::nextafter(0.1, 1.0)}, MetresPerSecond{-1e-300}};
  d.schedule = {Seconds{14'400.001}, Seconds{7200}, Seconds{899.5}, Seconds{235}};
  d.glider.heading_bias = Radians{-0.07};
  d.correction = ocean::LocalCorrection{
      geo_point(-12.5, 179.9), 1'732'520'000.0 / 3.0, {MetresPerSecond{0.1 / 3.0}, MetresPerSecond{-0.0}},
      MetresPerSecond{0.02},   Metres{30'000},        Seconds{86'400}};
  d.fix_s = 1'732'530'015.318;
  d.horizon_s = std::numeric_limits<double>::infinity();
  d.rules.max_wpt_distance = Metres{20'000};
  d.rules.slot = 99;
  d.promise.points = {{geo_point(40.123456789, -15.5), model::WaypointRole::aim},
                      {geo_point(41, -15), model::WaypointRole::goal}};
  d.promise.next_surfacing = geo_point(40.1, -15.4);
  d.promise.list_arrival_s = 1'732'600'000.0 / 3.0;
  d.promise.goal = geo_point(41, -15);
  d.promise.goal_radius = Metres{2000};
  d.promise.radius = Metres{432.1};
  d.promise.at_end = model::AtEnd::wait;
  d.judged_s = 1.7325300801e9;
  d.deadline_s = -std::numeric_limits<double>::infinity();
  return d;
}

VerifyRequest awkward_request() {
  VerifyRequest r;
  r.dossier = awkward_dossier();
  r.grid = InputFile{"/var/lib/glidehelm/currents/a grid\".grid", Sha256::of("grid")};
  r.grid_options.outside_time = ocean::OutsideTime::cycle;
  r.grid_options.interpolation = ocean::Interpolation::akima;
  r.grid_options.coastal_fill_cells = 2.25;
  r.grid_options.mask_is_land = true;
  ocean::AnalyticSpec jet;
  jet.kind = "jet";
  jet.origin = geo_point(29, -15);
  jet.length_scale = Metres{50'000};
  jet.speed_scale = MetresPerSecond{0.4};
  jet.time_scale = Seconds{86'400};
  jet.t0 = Instant{std::chrono::milliseconds{5}};
  jet.south = true;
  jet.params = {{"k", 0.84}, {"B0", 1.2}, {"c", 0.12}};
  jet.gaussians = {{1, 2, 3, 4, 5, 6, 7, 1e-7}, {}};
  r.analytic = {jet, ocean::AnalyticSpec{}};
  r.analytic_start = Instant{std::chrono::milliseconds{1'732'530'015'318}};
  r.analytic_box.west = 2.9;
  r.analytic_box.east = 3.3;
  r.analytic_box.holds_outside = false;
  r.sources.push_back(
      {"bay", InputFile{"a.grid", Sha256::of("a")}, r.grid_options, {geo_point(1, 2), geo_point(3, 4)}, -1e18, 1.5e9});
  r.seams = {Metres{12'345.6}, Seconds{7200.5}};
  r.coast = InputFile{"x.coast", Sha256::of("coast")};
  r.keep_in = {{"box", {geo_point(1, 1), geo_point(1, 2), geo_point(2, 2)}}};
  r.keep_out = {{"", {geo_point(-1, 179.5), geo_point(-1, -179.5), geo_point(-2, 180)}}, {"second", {}}};
  return r;
}

}  // namespace

TEST_CASE("a dossier comes back from its JSON bit by bit") {
  const auto d = awkward_dossier();
  const auto text = to_json(d);
  CHECK(text.find('\n') == std::string::npos);
  const auto back = dossier_from_json(text);
  REQUIRE(back.has_value());
  CHECK(*back == d);
  CHECK(std::signbit(back->at.water->x.si()));
  CHECK(back->file_bytes == d.file_bytes);
  CHECK(to_json(*back) == text);
  const auto plain = dossier_from_json(to_json(safety::Dossier{}));
  REQUIRE(plain.has_value());
  CHECK(*plain == safety::Dossier{});
}

TEST_CASE("a number that is none survives as none") {
  safety::Dossier d;
  d.fix_s = std::numeric_limits<double>::quiet_NaN();
  const auto back = dossier_from_json(to_json(d));
  REQUIRE(back.has_value());
  CHECK(std::isnan(back->fix_s));
}

TEST_CASE("a verdict comes back from its JSON, absent numbers included") {
  safety::Verdict v;
  v.of = Sha256::of("bytes");
  v.accepted = true;
  v.file_name = "goto_l10.ma";
  v.margins = {{"2 land", true, 2345.678901234567, 2000, "m", "2346 m from the coast"},
               {"5 glider", false, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                "", "heard '\x80'"}};
  const auto back = verdict_from_json(to_json(v));
  REQUIRE(back.has_value());
  CHECK(*back == v);
}

TEST_CASE("a request comes back from its JSON") {
  const auto r = awkward_request();
  const auto back = request_from_json(to_json(r));
  REQUIRE(back.has_value());
  CHECK(*back == r);
  const auto bare = request_from_json(to_json(VerifyRequest{}));
  REQUIRE(bare.has_value());
  CHECK(*bare == VerifyRequest{});
}

TEST_CASE("a document that is cut, of another kind or of other types is a problem, never an exception") {
  const auto text = to_json(awkward_request());
  for (std::size_t n = 0; n < text.size(); n += 7) CHECK_FALSE(request_from_json(text.substr(0, n)).has_value());
  CHECK(dossier_from_json(text).error().message().find("glidehelm/dossier/v1") != std::string::npos);
  const auto edited = [&](const std::string& from, const std::string& to) {
    auto changed = text;
    const auto at = changed.find(from);
    REQUIRE(at != std::string::npos);
    changed.replace(at, from.size(), to);
    const auto back = request_from_json(changed);
    return back ? std::string{"read"} : back.error().message();
  };
  CHECK(edited("\"deadline_s\"", "\"deadline\"") == "dossier: deadline_s is missing");
  CHECK(edited("\"slot\":99", "\"slot\":99.5") == "dossier: rules: slot: not a whole number");
  CHECK(edited("\"slot\":99", "\"slot\":99000000000") == "dossier: rules: slot: whole number out of range");
  CHECK(edited("\"at_end\":1", "\"at_end\":2") == "dossier: promise: at_end: unknown choice");
  CHECK(edited("\"horizon_s\":\"inf\"", "\"horizon_s\":\"soon\"") == "dossier: horizon_s: 'soon' is not a number");
  CHECK(edited("\"lon_rad\":-3.141592653589793", "\"lon_rad\":-3.2") == "dossier: at: fix: position out of range");
  CHECK(edited("\"hex\":\"", "\"hex\":\"0").find("odd number") != std::string::npos);
  CHECK(edited("\"hex\":\"6", "\"hex\":\"g").find("hexadecimal") != std::string::npos);
  CHECK(edited("\"hash\":\"", "\"hash\":\"0").find("not a SHA-256") != std::string::npos);
  CHECK(edited("\"keep_in\":[{", "\"keep_in\":{\"a\":{").find("parse error") != std::string::npos);
}

TEST_CASE("a grid is named by its first 96 bytes") {
  const std::string head(96, 'x');
  CHECK(grid_identity(head) == Sha256::of(head));
  CHECK(grid_identity(head + "more") == Sha256::of(head));
  CHECK_FALSE(grid_identity(head.substr(1)).has_value());
}
