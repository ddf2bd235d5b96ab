#include "daemon/cli/mafile.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/daemon/cli/dialog_files.hpp"

using namespace glidehelm;
using Json = nlohmann::ordered_json;

namespace {

const std::string kList =
    "behavior_name=goto_list\n<start:b_arg>\nb_arg: num_legs_to_run(nodim) -1\nb_arg: start_when(enum) 0\n"
    "b_arg: list_stop_when(enum) 7\nb_arg: list_when_wpt_dist(m) 500\nb_arg: initial_wpt(enum) 0\n"
    "b_arg: num_waypoints(nodim) 2\n<end:b_arg>\n<start:waypoints>\n-118.5 33.4\n-118.25 33.5\n<end:waypoints>\n";

struct Run {
  int code{};
  std::string out, err;
};

Run run(const std::string& text, bool json = true, std::optional<GeoPoint> near = {}, bool strict = false) {
  test::ReadableFiles readable;
  readable.files["goto_l10.ma"] = text;
  cli::MafileOptions options;
  options.file = "goto_l10.ma";
  options.json = json;
  options.near = near;
  options.strict = strict;
  std::ostringstream out, err;
  const int code = cli::run_mafile(options, readable, out, err);
  return {code, out.str(), err.str()};
}

}  // namespace

TEST_CASE("mafile prints the contract of product.md 9") {
  const auto r = run(kList);
  CHECK(r.code == 0);
  const auto j = Json::parse(r.out);
  std::vector<std::string> keys;
  for (const auto& [key, value] : j.items()) keys.push_back(key);
  CHECK(keys == std::vector<std::string>{"behavior", "b_args", "waypoints", "valid", "problems"});
  CHECK(j["behavior"] == "goto_list");
  CHECK(j["b_args"][3] == Json{{"name", "list_when_wpt_dist"}, {"value", 500.0}, {"unit", "m"}, {"line", 6}});
  REQUIRE(j["waypoints"].size() == 2);
  CHECK(j["waypoints"][0]["lon_deg"].get<double>() == Approx(-1 - 18.5 / 60).epsilon(1e-14));
  CHECK(j["waypoints"][0]["line"] == 11);
  CHECK(j["valid"] == true);
  CHECK(j["problems"].empty());
}

TEST_CASE("a glider's position finds decimal degrees, and the exit code says that the file is not valid") {
  const auto r = run(kList, true, geo_point(33.4, -118.6));
  CHECK(r.code == 1);
  const auto j = Json::parse(r.out);
  CHECK(j["valid"] == false);
  REQUIRE(j["problems"].size() == 2);
  const auto& p = j["problems"][0];
  CHECK(p["line"] == 11);
  CHECK(p["column"] == 1);
  CHECK(p["code"] == "decimal-degrees");
  CHECK(p["severity"] == "error");
  CHECK(p["message"].get<std::string>().find("looks like decimal degrees") != std::string::npos);
}

TEST_CASE("values and waypoints that are none are null") {
  auto text = kList;
  text.replace(text.find("500"), 3, "??");
  text.replace(text.find("-118.5 33.4"), 11, "-1860 33.4");
  const auto r = run(text);
  CHECK(r.code == 1);
  const auto j = Json::parse(r.out);
  CHECK(j["b_args"][3]["value"].is_null());
  CHECK(j["waypoints"][0]["lat_deg"].is_null());
}

TEST_CASE("strict judges the file as if it were ours") {
  CHECK(run(kList, true, {}, true).code == 1);  // end_action is left out
  CHECK(Json::parse(run(kList, true, {}, true).out)["problems"][0]["code"] == "missing-b-arg");
}

TEST_CASE("for people the problems go to standard error with file, line and column") {
  const auto r = run(kList, false, geo_point(33.4, -118.6));
  CHECK(r.out.find("goto_l10.ma: goto_list, 6 b_args, 2 waypoints, not valid\n  num_legs_to_run = -1 nodim\n") == 0);
  CHECK(r.out.find("  waypoint 1: 0.556667, -1.308333 (line 11)\n") != std::string::npos);
  CHECK(r.err.find("goto_l10.ma: line 11, column 1: error: -118.5 33.4 looks like decimal degrees") == 0);
}

TEST_CASE("for people the defaults that the glider takes stand beside what the file gives") {
  const auto r = run("behavior_name=surface\n<start:b_arg>\nb_arg: when_secs(sec) 7200\n<end:b_arg>\n", false);
  CHECK(r.code == 0);
  CHECK(r.out.find("  when_secs = 7200 sec\n") != std::string::npos);
  CHECK(r.out.find("  keystroke_wait_time = 300 sec (not given: masterdata's default)\n") != std::string::npos);
  CHECK(r.out.find("when_secs = 1200") == std::string::npos);
}

TEST_CASE("a file that cannot be read, that is too large or that is not named is said") {
  test::ReadableFiles none;
  std::ostringstream out, err;
  cli::MafileOptions options;
  CHECK(cli::run_mafile(options, none, out, err) == 2);
  options.file = "x.ma";
  CHECK(cli::run_mafile(options, none, out, err) == 1);
  CHECK(err.str().find("x.ma: cannot be read: ") != std::string::npos);
  CHECK(run(std::string(1U << 20, '\n')).code == 1);
  CHECK(out.str().empty());
}

TEST_CASE("a unit that is not UTF-8 does not end the document") {
  CHECK(Json::accept(run("behavior_name=yo\n<start:b_arg>\nb_arg: x(\xff) 1\n<end:b_arg>\n").out));
}
