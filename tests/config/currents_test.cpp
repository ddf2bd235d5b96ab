#include "config/currents.hpp"

#include <catch2/catch.hpp>

#include "config/mission.hpp"
#include "config/paths.hpp"
#include "core/base/utc.hpp"
#include "core/ocean/analytic.hpp"
#include "tests/support/config.hpp"

using namespace glidehelm;
using test::no_files;
using Lines = std::vector<std::string>;

namespace {

/// A mission whose line 5 and following are `currents`.
std::string with(const std::string& currents) {
  return "schema: glidehelm/mission/v1\nname: a1\nglider: b1\ngoal: {lat_deg: 29, lon_deg: -15}\n" + currents;
}
Lines current_errors(const std::string& currents) {
  return test::errors_of(config::read_mission(with(currents), "m.yaml", no_files()));
}
mission::Currents read_currents(const std::string& currents) {
  const auto file = config::read_mission_file(with(currents), "m.yaml", no_files());
  if (!file)
    for (const auto& error : file.error()) UNSCOPED_INFO(error.message());
  REQUIRE(file);
  // Whatever the test looks at, the printed form means the same.
  const auto again = config::read_mission(file->effective, "m.yaml", no_files());
  CAPTURE(file->effective);
  REQUIRE(again);
  CHECK(*again == file->mission);
  return file->mission.currents;
}
const std::string kScales = "origin: {lat_deg: 28, lon_deg: -16}, length_scale_m: 50000, speed_scale_m_per_s: 0.5";
std::string analytic(const std::string& rest) { return "currents: {analytic: {" + kScales + ", " + rest + "}}\n"; }

}  // namespace

TEST_CASE("an analytic field has its scales and the parameters of its kind, those left out with their defaults") {
  const auto c = read_currents(analytic("kind: jet, t0: 2026-11-25T00:00Z, south: true, params: {epsilon: 0.1}"));
  REQUIRE(c.files.empty());
  REQUIRE(c.analytic.size() == 1);
  const auto& jet = c.analytic[0];
  CHECK(jet.kind == "jet");
  CHECK(jet.origin == geo_point(28, -16));
  CHECK(jet.length_scale == Metres{50000});
  CHECK(jet.speed_scale == MetresPerSecond{0.5});
  CHECK_FALSE(jet.time_scale);
  CHECK(jet.t0 == utc_from_text("2026-11-25"));
  CHECK(jet.south);
  CHECK(jet.params == std::vector<std::pair<std::string, double>>{
                          {"B0", 1.2}, {"epsilon", 0.1}, {"omega", 0.4}, {"theta", kPi / 2}, {"k", 0.84}, {"c", 0.12}});
}

TEST_CASE("every analytic kind is read with its parameters") {
  using Params = std::vector<std::pair<std::string, double>>;
  struct Row {
    const char* kind;
    Params params;
  };
  const auto row = GENERATE(values<Row>({
      {"kind: constant, params: {u: 1, v: -0.5}", {{"u", 1}, {"v", -0.5}}},
      {"kind: source", {}},
      {"kind: sink, params: {}", {}},
      {"kind: solid-body", {{"omega", 1}}},
      {"kind: solid-body, params: {omega: -2}", {{"omega", -2}}},
      {"kind: shear, params: {rate: 0.3}", {{"rate", 0.3}}},
      {"kind: double-eddy, time_scale_s: 864000", {{"A", 0.1}, {"epsilon", 0.25}, {"omega", 2 * kPi}}},
      {"kind: stuart", {}},
      {"kind: tiled", {{"dynamic", 0}}},
      {"kind: tiled, params: {dynamic: true}", {{"dynamic", 1}}},
  }));
  CAPTURE(row.kind);
  const auto c = read_currents(analytic(row.kind));
  REQUIRE(c.analytic.size() == 1);
  CHECK(c.analytic[0].params == row.params);
}

TEST_CASE("core/ocean makes a field of every kind that is read, with the same defaults") {
  for (const char* kind : {"constant, params: {u: 0, v: 0}", "source", "sink", "solid-body", "shear", "double-eddy",
                           "stuart", "tiled", "jet", "gaussians, params: {list: [[1, 0, 0, 1, 0, 1, 0, 0]]}"}) {
    CAPTURE(kind);
    const auto c = read_currents(analytic(std::string{"kind: "} + kind));
    ocean::AnalyticSpec spec;
    spec.kind = c.analytic[0].kind;
    spec.origin = c.analytic[0].origin;
    spec.length_scale = c.analytic[0].length_scale;
    spec.speed_scale = c.analytic[0].speed_scale;
    spec.gaussians = c.analytic[0].gaussians;
    const auto by_its_own_defaults = ocean::AnalyticField::make(spec, Instant{});
    spec.params = c.analytic[0].params;
    const auto by_ours = ocean::AnalyticField::make(spec, Instant{});
    REQUIRE(by_ours);
    REQUIRE(by_its_own_defaults);
    const auto place = geo_point(28.3, -15.4);
    CHECK(by_ours->sample(place, Depth{}, 1000.0)->current ==
          by_its_own_defaults->sample(place, Depth{}, 1000.0)->current);
  }
}

TEST_CASE("gaussians are rows of eight numbers with a covariance that is one") {
  const auto c = read_currents(
      analytic("kind: gaussians, params: {list: [[1, 0, 0, 2, 0.5, 1, 0.1, 0], [0.5, 3, -1, 1, 0, 1, 0, -0.2]]}"));
  CHECK(c.analytic[0].gaussians ==
        std::vector<std::vector<double>>{{1, 0, 0, 2, 0.5, 1, 0.1, 0}, {0.5, 3, -1, 1, 0, 1, 0, -0.2}});
  CHECK(current_errors(
            "currents:\n  analytic:\n    kind: gaussians\n    " +
            std::string{"origin: {lat_deg: 28, lon_deg: -16}\n    length_scale_m: 1\n    speed_scale_m_per_s: 1\n"} +
            "    params:\n      list:\n        - [1, 0, 0, 1, 2, 1, 0, 0]\n        - [1, 2]\n") ==
        Lines{"13:11 currents.analytic.params.list[0]: sxx, sxy, syy are no covariance; allowed: sxx > 0, syy > 0, "
              "sxx·syy > sxy²",
              "14:11 currents.analytic.params.list[1]: a list of another length; found 2; allowed: a list of 8"});
  CHECK(current_errors(analytic("kind: gaussians")) ==
        Lines{"5:22 currents.analytic.params.list: missing; the kind gaussians requires it"});
}

TEST_CASE("a list under currents adds fields, which share one way of reading files") {
  const auto c =
      read_currents("currents:\n  - {files: [a.nc], outside_time: forbid}\n  - analytic: {" + kScales +
                    ", kind: constant, params: {u: 0, v: 0.1}}\n" + "  - analytic: {" + kScales + ", kind: stuart}\n");
  CHECK(c.files == std::vector<std::string>{"a.nc"});
  CHECK(c.outside_time == mission::OutsideTime::forbid);
  REQUIRE(c.analytic.size() == 2);
  CHECK(c.analytic[1].kind == "stuart");
  CHECK(read_currents("currents: [{files: [a.nc]}]\n").files.size() == 1);
}

TEST_CASE("heights and gaps are read as the mission says, and as the files say where it does not") {
  const auto c = read_currents("currents: {files: [a.nc], heights: always, equator_band_deg: 2.5, fill_gaps_km: 12}\n");
  CHECK(c.heights == mission::Currents::Heights::always);
  CHECK(c.equator_band.si() == Approx(2.5 * kPi / 180).epsilon(1e-15));
  REQUIRE(c.fill_gaps);
  CHECK(c.fill_gaps->si() == 12'000);
  const auto plain = read_currents("currents: {files: [a.nc]}\n");
  CHECK(plain.heights == mission::Currents::Heights::when_needed);
  CHECK(plain.equator_band == mission::Currents{}.equator_band);
  CHECK_FALSE(plain.fill_gaps);
}

TEST_CASE(
    "a model's grid, rotation and s-levels are read, the grid beside the mission, the levels whole or not at all") {
  const auto c = read_currents(
      "currents: {files: [a.nc], grid_file: /grids/g.nc, rotation: grid, s_levels: {vtransform: 2, vstretching: 4, "
      "theta_s: 5, theta_b: 0.4, hc_m: 50}}\n");
  CHECK(c.grid_file == "/grids/g.nc");
  CHECK(c.rotation == mission::Currents::Rotation::grid);
  REQUIRE(c.s_levels);
  CHECK(*c.s_levels == mission::Currents::SLevels{2, 4, 5, 0.4, Metres{50}});
  const auto plain = read_currents("currents: {files: [a.nc]}\n");
  CHECK(plain.grid_file.empty());
  CHECK(plain.rotation == mission::Currents::Rotation::recognised);
  CHECK_FALSE(plain.s_levels);
}

TEST_CASE("an address under currents is no name of a file beside the mission") {
  CHECK(config::path_beside("/etc/glidehelm/leg.yaml", "http://server/sea") == "http://server/sea");
  CHECK(config::path_beside("/etc/glidehelm/leg.yaml", "currents/a.nc") == "/etc/glidehelm/currents/a.nc");
}

TEST_CASE("mistakes under currents are named with their place") {
  struct Row {
    std::string currents;
    Lines errors;
  };
  const auto row = GENERATE(values<Row>({
      {"currents: {}\n", {"5:11 currents: no field; allowed: files: [PATTERN, …], sources: [{…}, …] or analytic: {…}"}},
      {"currents: {files: []}\n",
       {"5:19 currents.files: a list of another length; found 0; allowed: a list of at least 1"}},
      {"currents: {files: a.nc}\n", {"5:19 currents.files: not a list; found a.nc; allowed: a list of at least 1"}},
      {"currents: a.nc\n",
       {"5:11 currents: not a map of keys; found a.nc; allowed: KEY: VALUE lines, or {KEY: VALUE, …}"}},
      {"currents: []\n", {"5:11 currents: a list of another length; found 0; allowed: a list of 1 to 16"}},
      {"currents: [{files: [a.nc]}, {files: [b.nc]}]\n",
       {"5:29 currents[1]: a second set of files; allowed: all files in one list, the newest cycle wins where they "
        "overlap; or sources: [{…}, …]"}},
      {"currents: {files: [a.nc], outside_time: freeze}\n",
       {"5:41 currents.outside_time: not one of the words; found freeze; allowed: hold, cycle, forbid"}},
      {"currents: {files: [a.nc], interpolation: bilinear}\n",
       {"5:42 currents.interpolation: not one of the words; found bilinear; allowed: nearest, linear, cubic, akima; "
        "did you mean linear?"}},
      {"currents: {analytic: {kind: eddy}}\n",
       {"5:22 currents.analytic.origin: missing; the key is required",
        "5:22 currents.analytic.length_scale_m: missing; the key is required",
        "5:22 currents.analytic.speed_scale_m_per_s: missing; the key is required",
        "5:29 currents.analytic.kind: not one of the words; found eddy; allowed: constant, source, sink, solid-body, "
        "shear, double-eddy, "
        "stuart, tiled, jet, gaussians"}},
  }));
  CAPTURE(row.currents);
  CHECK(current_errors(row.currents) == row.errors);
}

TEST_CASE("a parameter of another kind, a missing one and two meanings at once are mistakes") {
  CHECK(current_errors("currents:\n  analytic: {" + kScales + ", kind: shear,\n    params: {rate: 1, omega: 2}}\n") ==
        Lines{"7:30 currents.analytic.params.omega: no parameter of the kind shear; allowed: rate"});
  CHECK(current_errors("currents:\n  analytic: {" + kScales + ", kind: source,\n    params: {rate: 1}}\n") ==
        Lines{"7:20 currents.analytic.params.rate: no parameter of the kind source; allowed: none"});
  CHECK(current_errors("currents:\n  analytic: {" + kScales + ", kind: constant,\n    params: {u: 1, w: 1}}\n") ==
        Lines{"7:13 currents.analytic.params.v: missing; the kind constant requires it",
              "7:20 currents.analytic.params.w: unknown key; did you mean u?"});
  CHECK(current_errors("currents: {files: [a.nc], analytic: {" + kScales + ", kind: stuart}}\n") ==
        Lines{"5:11 currents: both files and analytic; allowed: a list of maps, one field each, to add fields"});
  CHECK(
      current_errors("currents:\n  - {files: [a.nc], outside_time: hold}\n  - {outside_time: cycle,\n     analytic: {" +
                     kScales + ", kind: stuart}}\n") ==
      Lines{"7:20 currents[1].outside_time: the fields of a list share one outside_time; currents[0] says otherwise"});
}

TEST_CASE("sources stand in order of trust, each with its files, its way of reading, its region and its lead times") {
  const auto c = read_currents(
      "currents:\n"
      "  blend_km: 30\n"
      "  join_h: 12\n"
      "  sources:\n"
      "    - name: bay\n"
      "      files: [/data/bay/*.nc]\n"
      "      region: [{lat_deg: 28, lon_deg: -16}, {lat_deg: 28, lon_deg: -14}, {lat_deg: 30, lon_deg: -15}]\n"
      "      to_h: 48\n"
      "      interpolation: akima\n"
      "    - {name: globe, files: [/data/globe.nc], outside_time: cycle, from_h: -24}\n");
  CHECK(c.files.empty());
  CHECK(c.has_files());
  CHECK(c.blend == Metres{30'000});
  CHECK(c.join == Seconds{12 * 3600.0});
  REQUIRE(c.sources.size() == 2);
  CHECK(c.sources[0].name == "bay");
  CHECK(c.sources[0].files == Lines{"/data/bay/*.nc"});
  CHECK(c.sources[0].region.size() == 3);
  CHECK(c.sources[0].region[2] == geo_point(30, -15));
  CHECK(c.sources[0].to == Seconds{48 * 3600.0});
  CHECK_FALSE(c.sources[0].from);
  CHECK(c.sources[0].interpolation == mission::Interpolation::akima);
  CHECK(c.sources[1].outside_time == mission::OutsideTime::cycle);
  CHECK(c.sources[1].from == Seconds{-24 * 3600.0});
  CHECK(c.sources[1].interpolation == mission::Interpolation::linear);
}

TEST_CASE("sources that cannot be meant are reported where they stand") {
  const auto said = [](const std::string& currents, const std::string& words) {
    for (const auto& error : current_errors(currents))
      if (error.find(words) != std::string::npos) return true;
    for (const auto& error : current_errors(currents)) UNSCOPED_INFO(error);
    return false;
  };
  const std::string a = "{name: a, files: [a.nc]", b = "{name: b, files: [b.nc]}";
  CHECK(said("currents: {sources: []}\n", "5:21 currents.sources: a list of another length"));
  CHECK(said("currents: {sources: [{files: [a.nc]}]}\n", "currents.sources[0].name: missing"));
  CHECK(said("currents: {sources: [{name: a}]}\n", "currents.sources[0].files: missing"));
  CHECK(said("currents: {sources: [" + a + "}, {name: a, files: [b.nc]}]}\n", "a second source of this name"));
  CHECK(said("currents: {sources: [" + a + "}], files: [c.nc]}\n", "both sources and files"));
  CHECK(said("currents: {interpolation: cubic, sources: [" + a + "}]}\n",
             "currents.interpolation: stands beside sources; allowed is interpolation in each source"));
  CHECK(
      said("currents: {sources: [" + a + ", from_h: 10, to_h: 10}]}\n", "currents.sources[0].to_h: not after from_h"));
  CHECK(said("currents: {sources: [" + a + ", region: [{lat_deg: 1, lon_deg: 1}, {lat_deg: 2, lon_deg: 2}]}]}\n",
             "currents.sources[0].region: a list of another length"));
  CHECK(said("currents: {sources: [" + a +
                 ", region: [{lat_deg: 1, lon_deg: 1}, {lat_deg: 2, lon_deg: 2}, {lat_deg: 1, lon_deg: 2}, "
                 "{lat_deg: 2, lon_deg: 1}]}]}\n",
             "cross"));
  CHECK(said("currents: {join_h: 0.1, sources: [" + a + "}, " + b + "]}\n", "currents.join_h: "));
  CHECK(said("currents: [{files: [c.nc]}, {sources: [" + b + "]}]\n", "a second set of files"));
  CHECK(said("currents: {sources: [{name: a, file: [a.nc]}]}\n", "files"));  // the nearest key
}

TEST_CASE("an ensemble with a file to a member is read by the files of its control") {
  const auto c =
      read_currents("currents: {files: ['a_{member:2}.nc', 'b/{member}/*.nc'], ensemble: {members: 20, first: 1}}\n");
  REQUIRE(c.ensemble);
  CHECK(c.ensemble->members == 20);
  CHECK(c.ensemble->first == 1);
  CHECK(c.ensemble->files == Lines{"a_{member:2}.nc", "b/{member}/*.nc"});
  CHECK(c.files == Lines{"a_01.nc", "b/1/*.nc"});
  CHECK(c.ensemble->files_of(19) == Lines{"a_20.nc", "b/20/*.nc"});
}

TEST_CASE("an ensemble along a dimension of its files keeps their names") {
  const auto c = read_currents("currents: {files: [a.nc], ensemble: {members: 5}}\n");
  REQUIRE(c.ensemble);
  CHECK(*c.ensemble == mission::Ensemble{5, 0, {}});
  CHECK(c.files == Lines{"a.nc"});
  CHECK_FALSE(read_currents("currents: {files: [a.nc]}\n").ensemble);
}

TEST_CASE("an ensemble in a list of fields is that of the files") {
  const auto c = read_currents("currents: [{files: ['m{member}.nc'], ensemble: {members: 3}}, {analytic: {" + kScales +
                               ", kind: stuart}}]\n");
  REQUIRE(c.ensemble);
  CHECK(c.files == Lines{"m0.nc"});
  CHECK(c.analytic.size() == 1);
}

TEST_CASE("an ensemble that cannot be meant is reported where it stands") {
  const auto only = [](const std::string& currents) {
    const auto said = current_errors(currents);
    REQUIRE(said.size() == 1);
    return said.front();
  };
  CHECK(only("currents: {files: ['a_{member}.nc']}\n") ==
        "5:19 currents.files: {member} without an ensemble; allowed: ensemble: {members: N}");
  CHECK(only("currents:\n  files: ['a_{member}.nc', b.nc]\n  ensemble: {members: 4}\n") ==
        "6:28 currents.files[1]: no {member} in 'b.nc', others have one; allowed: {member} in each, or in none");
  CHECK(only("currents:\n  files: ['a{member}*.nc']\n  ensemble: {members: 4}\n")
            .find("6:11 currents.files[0]: {member} "
                  "stands beside a wildcard") == 0);
  CHECK(only("currents: {files: [a.nc], ensemble: {members: 4, first: 1}}\n").find("no {member} in files") !=
        std::string::npos);
  CHECK(only("currents: {files: [a.nc], ensemble: {first: 1}}\n").find("there is no ensemble; allowed: members") !=
        std::string::npos);
  CHECK(only("currents: {files: [a.nc], ensemble: {members: 0}}\n").find("currents.ensemble.members") !=
        std::string::npos);
  CHECK(only("currents: {sources: [{name: a, files: [a.nc]}], ensemble: {members: 2}}\n")
            .find("currents.ensemble: there are no files") != std::string::npos);
  CHECK(only("currents: {sources: [{name: a, files: ['a{member}.nc']}]}\n")
            .find("currents.sources[0].files: {member} in a source") != std::string::npos);
}
