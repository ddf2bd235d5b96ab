#include "core/mission/learning.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>

#include "core/base/local_metric.hpp"
#include "core/base/utc.hpp"
#include "tests/support/data.hpp"

using namespace glidehelm;
using namespace glidehelm::mission;

TEST_CASE("a current along the local frame's y axis flows where that axis points") {
  // The frame's y axis points r clockwise from north, so a unit vector along y is (sin r, cos r) in east, north.
  const auto r = degrees(9.4);
  const auto along_y = true_current({MetresPerSecond{0}, MetresPerSecond{1}}, r);
  CHECK(along_y.east.si() == Approx(std::sin(r.si())));
  CHECK(along_y.north.si() == Approx(std::cos(r.si())));
  const auto along_x = true_current({MetresPerSecond{1}, MetresPerSecond{0}}, r);
  CHECK(Course::of(along_x.east.si(), along_x.north.si()).degrees() == Approx(90 + 9.4));
}

TEST_CASE("turning a current into the local frame and back gives it again") {
  for (double r = -30; r <= 30; r += 7) {
    const Current c{MetresPerSecond{0.31}, MetresPerSecond{-0.12}};
    const auto back = true_current(local_velocity(c, degrees(r)), degrees(r));
    CHECK(back.east.si() == Approx(c.east.si()));
    CHECK(back.north.si() == Approx(c.north.si()));
  }
}

TEST_CASE("grid convergence is zero on the central meridian, positive east of it in the north") {
  CHECK(utm_convergence(geo_point(60, 21)).si() == Approx(0).margin(1e-12));
  // γ = atan(tan Δλ · sin φ): at 59.82°N, 2.3° east of 21°E, atan(tan 2.3° · sin 59.82°) = 1.988°.
  CHECK(in_degrees(utm_convergence(geo_point(59.82, 23.3))) == Approx(1.988).margin(0.001));
  CHECK(utm_convergence(geo_point(-59.82, 23.3)).si() < 0);
}

TEST_CASE("the rotation comes from the configuration, then from the magnetic variation, then is zero") {
  const auto p = geo_point(59.82, 23.3);
  const auto configured = frame_rotation(degrees(5), degrees(-7.5), p);
  CHECK(configured.from == FrameRotation::From::configured);
  CHECK(in_degrees(configured.clockwise) == Approx(5));
  // 7.5° east is −7.5° in the firmware's convention (positive west); with 1.99° of convergence that makes 9.49°, the
  // upper end of what was measured in the Gulf of Finland (slocum.md 4.2: 9.43–9.49°).
  const auto printed = frame_rotation(std::nullopt, degrees(-7.5), p);
  CHECK(printed.from == FrameRotation::From::magnetic_variation);
  CHECK(in_degrees(printed.clockwise) == Approx(9.49).margin(0.01));
  CHECK(frame_rotation(std::nullopt, std::nullopt, p).from == FrameRotation::From::assumed_zero);
  const Radians not_a_number{std::numeric_limits<double>::quiet_NaN()};
  CHECK(frame_rotation(std::nullopt, not_a_number, p).from == FrameRotation::From::assumed_zero);
}

TEST_CASE("a water velocity faster than the firmware lets through is not believed") {
  model::Surfacing s;
  CHECK_FALSE(believed_current(s, Radians{}));
  s.water = model::LocalVelocity{MetresPerSecond{2.9}, MetresPerSecond{0}};
  CHECK_FALSE(believed_current(s, Radians{}));
  s.water = model::LocalVelocity{MetresPerSecond{std::numeric_limits<double>::quiet_NaN()}, MetresPerSecond{0}};
  CHECK_FALSE(believed_current(s, Radians{}));
  s.water = model::LocalVelocity{MetresPerSecond{0.2}, MetresPerSecond{0}};
  CHECK(believed_current(s, Radians{})->east.si() == Approx(0.2));
}

TEST_CASE(
    "the Waypoint: lines decide only when three of them disagree with the magnetic variation by more than 3 degrees") {
  const auto p = geo_point(59.82, 23.3);  // variation −7.5° and convergence 1.99° make 9.49°
  const std::vector<Radians> near{degrees(7.0), degrees(7.2), degrees(6.9)},
      far{degrees(0.2), degrees(0.4), degrees(0.1)};
  using From = FrameRotation::From;
  CHECK(frame_rotation(std::nullopt, degrees(-7.5), p, near).from == From::magnetic_variation);
  const auto decided = frame_rotation(std::nullopt, degrees(-7.5), p, far);
  CHECK(decided.from == From::waypoint_lines);
  CHECK(in_degrees(decided.clockwise) == Approx(0.2));
  CHECK(frame_rotation(std::nullopt, degrees(-7.5), p, std::span{far}.first(2)).from == From::magnetic_variation);
  CHECK(frame_rotation(std::nullopt, std::nullopt, p, std::span{far}.first(1)).from == From::waypoint_lines);
  CHECK(frame_rotation(degrees(5), degrees(-7.5), p, far).from == From::configured);
}

TEST_CASE("one Waypoint: line in error does not turn the frame, nor does the cut of the circle") {
  const std::vector<Radians> lines{degrees(179.8), degrees(-179.9), degrees(90), degrees(-179.7), degrees(179.9)};
  const auto r = frame_rotation(std::nullopt, std::nullopt, geo_point(0, 3), lines);
  CHECK(std::abs(in_degrees(wrapped(r.clockwise - degrees(180)))) < 0.3);
}

TEST_CASE("a Waypoint: line tells the rotation to half a degree, and nothing within a kilometre") {
  const auto fix = geo_point(40, 5);
  for (const double bearing : {12.3, 200.9, 359.2}) {
    for (const double r : {-10.0, 10.0}) {
      const auto at = destination(fix, Bearing{degrees(bearing)}, Metres{8000});
      double printed = std::floor(std::fmod(bearing - r + 720, 360));
      const auto by = rotation_by(fix, {at, Metres{8000}, printed});
      REQUIRE(by);
      CHECK(in_degrees(*by) == Approx(r).margin(0.51));  // the floor, and the geodesic's own rounding
    }
  }
  CHECK_FALSE(rotation_by(fix, {destination(fix, Bearing{}, Metres{900}), Metres{900}, 0}));
}

TEST_CASE("an initial current is known five times worse than a final one, an uncertain frame adds its share") {
  model::Surfacing s;
  s.water = model::LocalVelocity{MetresPerSecond{0.3}, MetresPerSecond{0.4}};
  const auto initial = measured_current(s, {degrees(0), FrameRotation::From::configured, degrees(0)});
  CHECK(initial->spread.si() == Approx(0.05));
  CHECK_FALSE(initial->final_value);
  s.water_is_final = true;
  CHECK(measured_current(s, {degrees(0), FrameRotation::From::configured, degrees(0)})->spread.si() == Approx(0.01));
  const auto turned = measured_current(s, {degrees(0), FrameRotation::From::assumed_zero, degrees(15)});
  CHECK(turned->spread.si() == Approx(std::hypot(0.01, 0.5 * degrees(15).si())));
}

namespace {

/// A glider that swims straight on at 0.30 m/s towards `heading_deg` in water of which the forecast says nothing, and its
/// surfacings as the shore hears them.
struct Swimmer {
  Mission mission;
  Learning learning;
  GeoPoint at = geo_point(40, 5);
  Instant now = *utc_from_text("2026-03-01T00:00:00Z");
  std::optional<model::Surfacing> before;
  std::optional<Instant> resumed;
  int segment{};
  double surface_s{900}, stint_s{14400};
  Current water{MetresPerSecond{0.1}, MetresPerSecond{-0.05}};
  std::optional<Dive> dive;
  std::vector<SourceShare> shares{{"", 1}};

  Swimmer() {
    mission.frame_rotation = Radians{0};
    learning.configure(mission);
  }
  void surface(double heading_deg = 30, bool final_value = true, std::string mission_number = "0007") {
    const double h = degrees(heading_deg).si(), u = 0.3;
    if (before) {
      const Current v{MetresPerSecond{u * std::sin(h)} + water.east, MetresPerSecond{u * std::cos(h)} + water.north};
      dive = Dive{at, epoch_seconds(now) + surface_s, true};
      resumed = after(now, Seconds{surface_s - 60});
      at = destination(at, Course::of(v.east.si(), v.north.si()), v.speed() * Seconds{stint_s + 60});
      now = after(now, Seconds{surface_s + stint_s + 60});
    }
    SurfacingSeen seen;
    seen.at.fix = at;
    seen.at.fix_taken = now;
    seen.at.mission = "glide.mi";
    seen.at.segment = mission_number + "." + std::string{segment < 10 ? "000" : "00"} + std::to_string(segment);
    seen.at.water = model::LocalVelocity{water.east, water.north};
    seen.at.water_is_final = final_value;
    seen.at.believed_speed = MetresPerSecond{u};
    seen.before = before;
    seen.dive_said = resumed;
    seen.dive = dive;
    seen.forecast = Current{};
    seen.shares = shares;
    learning.see(seen);
    before = seen.at;
    ++segment;
    water.east += MetresPerSecond{1e-4};  // a glider measures anew
  }
};

}  // namespace

TEST_CASE("stint and surface interval are learned from what the dialog says of dive and fix") {
  Swimmer s;
  s.stint_s = 5 * 3600;  // configured are 4 h
  s.surface_s = 1200;    // and 15 min
  for (int i = 0; i < 6; ++i) s.surface();
  const auto known = s.learning.learned();
  CHECK(known.stint.count() == Approx(18'000).margin(1));
  CHECK(known.surface.count() == Approx(1200).margin(1));
  CHECK(known.stint_spread.count() == Approx(60));  // what the dialog does not show
}

TEST_CASE("one dive that was cut short does not move the stint") {
  Swimmer s;
  for (int i = 0; i < 5; ++i) s.surface();
  s.stint_s = 3000;
  s.surface();
  s.stint_s = 14400;
  s.surface();
  CHECK(s.learning.learned().stint.count() == Approx(14400).margin(1));
}

TEST_CASE("a segment that nobody heard teaches no times") {
  Swimmer s;
  for (int i = 0; i < 3; ++i) s.surface();
  const auto before = s.learning.learned();
  ++s.segment;
  s.stint_s = 2 * 14400 + 900;
  s.surface();
  CHECK(s.learning.learned().stint == before.stint);
}

TEST_CASE("the first current of a mission is not learned from, in a new mission neither") {
  Swimmer s;
  s.water = {MetresPerSecond{-1.27}, MetresPerSecond{-0.23}};  // nonsense after a deployment
  s.surface();
  CHECK_FALSE(s.learning.learned().water);
  CHECK_FALSE(s.learning.learned().correction);
  s.water = {MetresPerSecond{0.1}, MetresPerSecond{0.02}};
  s.surface();
  REQUIRE(s.learning.learned().water);
  const auto correction = s.learning.learned().correction;
  REQUIRE(correction);
  s.segment = 0;
  s.surface(30, true, "0008");
  CHECK_FALSE(s.learning.learned().water);
  CHECK(s.learning.learned().correction == correction);
}

TEST_CASE("what was measured less what was forecast becomes the correction near the glider") {
  Swimmer s;
  s.surface();
  s.surface();
  const auto c = s.learning.learned().correction;
  REQUIRE(c);
  // Variance 0.01 of the forecast against 0.0005 of the measurement: 95 % of the residual, less what speed and bias take.
  CHECK(c->added.east.si() == Approx(0.1).margin(0.02));
  CHECK(c->added.north.si() == Approx(-0.05).margin(0.02));
  CHECK(c->plausible());
  CHECK(distance(c->at, s.at).si() < 4000);  // the middle of the dive
  Swimmer off;
  off.mission.currents.local_correction = false;
  off.learning.configure(off.mission);
  off.surface();
  off.surface();
  CHECK_FALSE(off.learning.learned().correction);
}

TEST_CASE(
    "how far off a source is comes from the dives in its water, and what counts is the source that the glider is in") {
  Swimmer s;
  s.surface();
  CHECK(s.learning.learned().forecast_spread.si() == SourceErrors::kPrior);
  const auto fly = [&](const std::string& source, double error, int dives) {
    s.shares = {{source, 1}};
    for (int k = 0; k < dives; ++k) {
      // Round the compass, so that no speed error of the glider explains it.
      s.water = {MetresPerSecond{error * std::sin(2.0 * k)}, MetresPerSecond{error * std::cos(2.0 * k)}};
      s.surface(30 + 20 * k);
    }
  };
  fly("bay", 0.05, 20);
  const auto in_the_bay = s.learning.learned();
  fly("globe", 0.35, 20);
  const auto outside = s.learning.learned();
  CHECK(in_the_bay.source_errors.spread("bay").si() < SourceErrors::kPrior);
  CHECK(in_the_bay.source_errors.spread("globe").si() == SourceErrors::kPrior);
  CHECK(in_the_bay.forecast_spread == in_the_bay.source_errors.spread("bay"));
  CHECK(outside.source_errors.spread("globe").si() > 1.5 * SourceErrors::kPrior);
  CHECK(outside.source_errors.spread("bay").si() < SourceErrors::kPrior);
  CHECK(outside.forecast_spread == outside.source_errors.spread("globe"));
  CHECK(outside.source_errors.sources() == std::vector<std::string>{"bay", "globe"});
}

TEST_CASE("a current printed twice to the bit was not measured anew") {
  Swimmer s;
  s.surface();
  s.surface();
  const auto first = s.learning.learned().correction;
  s.water.east -= MetresPerSecond{1e-4};
  s.water = {MetresPerSecond{s.before->water->x.si()}, MetresPerSecond{s.before->water->y.si()}};
  s.surface();
  CHECK(s.learning.learned().correction == first);
}

TEST_CASE("a mission with other first guesses starts anew only with those") {
  Swimmer s;
  s.stint_s = 18'000;
  for (int i = 0; i < 5; ++i) s.surface();
  auto other = s.mission;
  other.surface = Seconds{1800};
  s.learning.configure(other);
  CHECK(s.learning.learned().stint.count() == Approx(18'000).margin(1));
  CHECK(s.learning.learned().surface.count() == Approx(1800));
}

namespace {

struct SeagliderDive {
  std::string name;
  int quality{};
  double seconds{};
  GeoPoint from, to;
  double dac_east{}, dac_north{}, water_east{}, water_north{};
};

std::vector<SeagliderDive> seaglider_dives(const std::string& file) {
  std::ifstream in{file};
  REQUIRE(in);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> all;
    std::istringstream text{line};
    for (std::string cell; std::getline(text, cell, ',');) all.push_back(cell);
    return all;
  };
  std::string line;
  std::getline(in, line);
  const auto header = cells(line);
  std::vector<SeagliderDive> dives;
  while (std::getline(in, line)) {
    const auto row = cells(line);
    const auto text = [&](const char* name) {
      return row.at(static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin()));
    };
    const auto number = [&](const char* name) { return std::stod(text(name)); };
    SeagliderDive d;
    d.name = text("dive_file");
    d.quality = std::stoi(text("dac_qc"));
    d.seconds = between(*utc_from_text(text("gps2_utc")), *utc_from_text(text("gpse_utc"))).count();
    d.from = geo_point(number("gps2_lat_deg"), number("gps2_lon_deg"));
    d.to = geo_point(number("gpse_lat_deg"), number("gpse_lon_deg"));
    d.dac_east = number("dac_east_m_s");
    d.dac_north = number("dac_north_m_s");
    d.water_east = number("mean_through_water_east_m_s");
    d.water_north = number("mean_through_water_north_m_s");
    dives.push_back(d);
  }
  return dives;
}

}  // namespace

TEST_CASE("real data: dead reckoning plus the depth-averaged current gives the displacement of 19 Seaglider dives") {
  GLIDEHELM_NEEDS_DATA(folder);
  std::vector<double> errors, without;
  int dives = 0;
  for (const char* file : {"seaglider_sg236_2023_washington_dives.csv", "seaglider_sg249_2024_washington_dives.csv",
                           "seaglider_sg561_2016_lofoten_dives.csv"}) {
    for (const auto& d : seaglider_dives(folder + "/gliders/" + file)) {
      ++dives;
      const auto moved =
          local_offset(d.from.lat.radians(), d.from.lon.radians(), d.to.lat.radians(), d.to.lon.radians());
      const double error = std::hypot(moved.east - (d.water_east + d.dac_east) * d.seconds,
                                      moved.north - (d.water_north + d.dac_north) * d.seconds);
      const double reckoned =
          std::hypot(moved.east - d.water_east * d.seconds, moved.north - d.water_north * d.seconds);
      std::cout << d.name << ": " << moved.length() << " m in " << d.seconds << " s, error " << error
                << " m, without DAC " << reckoned << " m\n";
      CAPTURE(d.name, d.quality, error);
      // One dive contradicts itself: its basestation marks its DAC as probably bad (3), and v − DAC there is another
      // velocity than its flight model's. All others close.
      if (d.name == "p2360004.nc") {
        CHECK(d.quality == 3);
        CHECK(error > 2000);
        continue;
      }
      // Two fixes of some 5–10 m each, and velocities printed to 1e-4 m/s: ±0.5e-4 · √2 · 19 500 s = 1.4 m.
      CHECK(error < 15);
      errors.push_back(error);
      without.push_back(reckoned);
    }
  }
  CHECK(dives == 19);
  CHECK(median_of(errors) < 10);
  CHECK(median_of(without) > 50 * median_of(errors));  // what the current is worth
  std::cout << "median error " << median_of(errors) << " m, worst " << *std::max_element(errors.begin(), errors.end())
            << " m; without DAC median " << median_of(without) << " m\n";
}
