#include "daemon/cli/replay.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/daemon/cli/dialog_files.hpp"
#include "tests/protocol/dialog_text.hpp"

using namespace glidehelm;
using Json = nlohmann::ordered_json;

namespace {

struct Run {
  int code{};
  std::string out, err;
};

Run run(const std::map<std::string, std::string>& files, cli::ReplayOptions options) {
  test::ReadableFiles readable;
  readable.files = files;
  std::ostringstream out, err;
  const int code = cli::run_replay(options, readable, out, err);
  return {code, out.str(), err.str()};
}

cli::ReplayOptions of(std::vector<std::string> logs, bool json = true, std::string glider = "") {
  cli::ReplayOptions options;
  options.logs = std::move(logs);
  options.json = json;
  options.glider = std::move(glider);
  return options;
}

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> all;
  for (const auto& [key, value] : object.items()) all.push_back(key);
  return all;
}

const std::vector<std::string> kFixKeys{"file",
                                        "line",
                                        "glider",
                                        "mission",
                                        "segment",
                                        "fix_time",
                                        "heard_time",
                                        "lat_ddmm",
                                        "lon_ddmm",
                                        "lat_deg",
                                        "lon_deg",
                                        "fix_age_s",
                                        "because",
                                        "at_surface",
                                        "time_until_diving_s",
                                        "waypoint",
                                        "water_vx_m_per_s",
                                        "water_vy_m_per_s",
                                        "water_is_final",
                                        "sensors"};

}  // namespace

TEST_CASE("replay prints the contract of product.md 9: every key, in its order, one entry per fix") {
  const auto r = run({{"a.log", test::connection_block() + test::at_surface_block()}}, of({"a.log"}));
  CHECK(r.code == 0);
  CHECK(r.err.empty());
  const auto j = Json::parse(r.out);
  CHECK(keys(j) == std::vector<std::string>{"files", "surfacings", "refused"});
  REQUIRE(j["files"].size() == 1);
  CHECK(j["files"][0] == Json{{"file", "a.log"},
                              {"glider", "alba"},
                              {"connections", 1},
                              {"at_surface_blocks", 1},
                              {"gps_lines", 2},
                              {"distinct_fixes", 1},
                              {"repeated_fixes", 1},
                              {"sensor_lines", 3},
                              {"damaged_lines", 0},
                              {"dockserver_blocks", 0}});
  REQUIRE(j["surfacings"].size() == 1);
  const auto& s = j["surfacings"][0];
  CHECK(keys(s) == kFixKeys);
  CHECK(s["line"] == 7);
  CHECK(s["glider"] == "alba");
  CHECK(s["mission"] == "canary.mi");
  CHECK(s["segment"] == "0112.0003");
  CHECK(s["fix_time"] == "2026-05-03T04:09:31.750Z");
  CHECK(s["heard_time"] == "2026-05-03T04:10:20.000Z");
  CHECK(s["lat_ddmm"] == "2901.250");
  CHECK(s["lon_ddmm"] == "-1528.400");
  CHECK(s["lat_deg"].get<double>() == Approx(29 + 1.25 / 60).epsilon(1e-14));
  CHECK(s["lon_deg"].get<double>() == Approx(-15 - 28.4 / 60).epsilon(1e-14));
  CHECK(s["fix_age_s"] == 48.25);
  CHECK(s["because"] == "pitch not commanded");
  CHECK(s["at_surface"] == true);
  CHECK(s["time_until_diving_s"] == 236);
  CHECK(keys(s["waypoint"]) == std::vector<std::string>{"lat_deg", "lon_deg", "range_m", "bearing_deg"});
  CHECK(s["waypoint"]["range_m"] == 17321);
  CHECK(s["water_vx_m_per_s"] == -0.0415);
  CHECK(s["water_vy_m_per_s"] == 0.1172);
  CHECK(s["water_is_final"] == true);
  CHECK(s["sensors"]["m_battery"] == 14.9021);
  CHECK(j["refused"].empty());
}

TEST_CASE("a refused fix has the same keys, its rule and its reason, what is unknown is null") {
  const auto r =
      run({{"a.log", test::connection_block()}, {"b.log", test::connection_block()}}, of({"a.log", "b.log"}));
  CHECK(r.code == 0);
  const auto j = Json::parse(r.out);
  CHECK(j["surfacings"].size() == 1);
  REQUIRE(j["refused"].size() == 1);
  auto expected = kFixKeys;
  expected.insert(expected.end(), {"rule", "reason"});
  const auto& refused = j["refused"][0];
  CHECK(keys(refused) == expected);
  CHECK(refused["file"] == "b.log");
  CHECK(refused["rule"] == "S6");
  for (const char* key : {"mission", "segment", "because", "time_until_diving_s", "waypoint", "water_vx_m_per_s"})
    CHECK(refused[key].is_null());
}

TEST_CASE("another glider's fixes are refused when one is named") {
  const auto j = Json::parse(run({{"a.log", test::connection_block()}}, of({"a.log"}, true, "brisa")).out);
  REQUIRE(j["refused"].size() == 1);
  CHECK(j["refused"][0]["rule"] == "S2");
}

TEST_CASE("a log that cannot be read is said, the others are replayed, and the exit code tells") {
  const auto r = run({{"a.log", test::connection_block()}}, of({"missing.log", "a.log"}));
  CHECK(r.code == 1);
  CHECK(r.err.find("missing.log: cannot be read: ") == 0);
  CHECK(Json::parse(r.out)["files"].size() == 1);
  CHECK(run({}, of({})).code == 2);
}

TEST_CASE("the table for people says each fix and why one is refused") {
  auto stale = test::connection_block();
  const auto gps = test::gps_line(2901.25, -1528.4, 48.25);
  stale.replace(stale.find(gps), gps.size(), test::gps_line(2901.25, -1528.4, 1500));
  const auto r = run({{"a.log", test::connection_block() + test::at_surface_block()}, {"b.log", stale}},
                     of({"a.log", "b.log"}, false));
  CHECK(r.out ==
        "a.log: alba, 1 connection, 1 at-surface block, 2 GPS lines, 1 fix (1 repeated), 3 sensor lines, 0 damaged, 0 "
        "dockserver blocks\n"
        "  2026-05-03T04:09:31Z  2901.250 N -1528.400 E, age 48 s, line 7, canary.mi 0112.0003, pitch not commanded, "
        "dives "
        "in 236 s\n"
        "b.log: alba, 1 connection, 0 at-surface blocks, 1 GPS line, 1 fix (0 repeated), 1 sensor line, 0 damaged, 0 "
        "dockserver blocks\n"
        "  2026-05-03T03:45:20Z  2901.250 N -1528.400 E, age 1500 s, line 7\n"
        "    refused by S3: the fix is 1500 s old, allowed are 1200 s\n");
}

TEST_CASE("a file name that is not UTF-8 does not end the document") {
  const auto r = run({{"\xff.log", test::connection_block()}}, of({"\xff.log"}));
  CHECK(Json::accept(r.out));
}
