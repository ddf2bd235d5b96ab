#include "protocol/mafile.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "tests/support/data.hpp"

using namespace glidehelm;
using namespace glidehelm::protocol;

namespace {

/// A list of three legal waypoints; arguments are replaced or added by name, an empty value removes one.
std::string list(const std::map<std::string, std::string>& changes = {},
                 const std::string& waypoints = "-1530.0000 2910.5000\n-1531.2500 2908.7500\n-1540.0000 2900.0000\n") {
  std::vector<std::pair<std::string, std::string>> args{
      {"num_legs_to_run(nodim)", "-1"}, {"start_when(enum)", "0"},  {"list_stop_when(enum)", "7"},
      {"list_when_wpt_dist(m)", "700"}, {"initial_wpt(enum)", "0"}, {"num_waypoints(nodim)", "3"},
      {"end_action(enum)", "0"}};
  for (const auto& [name, value] : changes) {
    const auto found = std::find_if(args.begin(), args.end(), [&, &n = name](const auto& a) { return a.first == n; });
    if (found == args.end())
      args.emplace_back(name, value);
    else
      found->second = value;
  }
  std::string text = "behavior_name=goto_list\n# made up\n<start:b_arg>\n";
  for (const auto& [name, value] : args)
    if (!value.empty()) text += "b_arg: " + name + " " + value + "\n";
  return text + "<end:b_arg>\n<start:waypoints>\n" + waypoints + "<end:waypoints>\n";
}

Mafile lenient(const std::string& text) { return read_mafile(text, MafileOptions{}); }
Mafile strict(const std::string& text) {
  MafileOptions options;
  options.mode = MafileOptions::Mode::strict;
  return read_mafile(text, options);
}
Mafile near(const std::string& text, double lat, double lon) {
  MafileOptions options;
  options.near = geo_point(lat, lon);
  return read_mafile(text, options);
}

/// `code:line:column` of each problem; a warning ends with '?'.
std::vector<std::string> said(const Mafile& file) {
  std::vector<std::string> all;
  for (const auto& p : file.problems)
    all.push_back(p.code + ":" + std::to_string(p.line) + ":" + std::to_string(p.column) +
                  (p.severity == Severity::warning ? "?" : ""));
  return all;
}
using Said = std::vector<std::string>;

std::string file_bytes(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  REQUIRE(file);
  return {std::istreambuf_iterator<char>{file}, {}};
}

}  // namespace

TEST_CASE("a list of ours is read without a problem, strictly too") {
  const auto file = strict(list());
  CHECK(said(file).empty());
  CHECK(file.valid());
  CHECK(file.behavior == "goto_list");
  CHECK(file.b_args.size() == 7);
  CHECK(file.b_arg("list_when_wpt_dist")->value == 700);
  REQUIRE(file.waypoints.size() == 3);
  CHECK(std::abs(file.waypoints[0].at->lon.degrees() + 15.5) < 1e-12);
  CHECK(std::abs(file.waypoints[0].at->lat.degrees() - (29 + 10.5 / 60)) < 1e-12);
  CHECK(file.waypoints[2].line == 15);
}

TEST_CASE("what pilots write is read leniently: signs, leading zeros, glued comments, CR LF, no last line end") {
  const auto file = lenient(
      "# first a comment\r\nbehavior_name=Goto_list \t\r\n<start:b_arg>\r\n\tb_arg: num_legs_to_run(nodim) -1#loop\r\n"
      "b_arg: start_when(enum) +0\r\nb_arg: list_stop_when(nodim) 007\r\nb_arg: list_when_wpt_dist(m) 50.0\r\n"
      "b_arg: initial_wpt(nodim) -2 # closest\r\nb_arg: num_waypoints(nodim) 2\r\n<end:b_arg>\r\n<start:waypoints>\r\n"
      "801 5400\r\n-07300.0\t0054.00 # west\r\n<end:waypoints>");
  CHECK(said(file).empty());
  CHECK(file.behavior == "goto_list");
  CHECK(file.b_arg("list_stop_when")->value == 7);
  CHECK(std::abs(file.waypoints[0].at->lon.degrees() - (8 + 1.0 / 60)) < 1e-12);
  CHECK(std::abs(file.waypoints[1].at->lat.degrees() - 0.9) < 1e-12);
}

TEST_CASE("what is only lax is an error in strict mode") {
  CHECK(said(strict("behavior_name=goto_list\r\n")).front() == "section:0:0");
  CHECK(said(strict(list({{"list_stop_when(enum)", ""}, {"list_stop_when(nodim)", "7"}}))) == Said{"unit:10:30"});
  CHECK(said(strict(list({{"end_action(enum)", ""}}))) == Said{"missing-b-arg:0:0"});
  auto no_end = list();
  no_end.pop_back();
  CHECK(said(strict(no_end)) == Said{"line-ends:16:1"});
  CHECK(said(lenient(no_end)).empty());
  CHECK(said(strict(list({{"num_waypoints(nodim)", "4"}}))) == Said{"count-mismatch:9:29"});
}

TEST_CASE("values outside masterdata are said with their place") {
  CHECK(said(lenient(list({{"num_legs_to_run(nodim)", "0"}}))) == Said{"range:4:31"});
  CHECK(said(lenient(list({{"num_legs_to_run(nodim)", "-3"}}))) == Said{"range:4:31"});
  CHECK(said(lenient(list({{"start_when(enum)", "3"}}))) == Said{"range:5:25?"});
  CHECK(said(lenient(list({{"list_stop_when(enum)", "12"}}))) == Said{"range:6:29?"});
  CHECK(said(lenient(list({{"list_when_wpt_dist(m)", "9.9"}}))) == Said{"range:7:30?"});
  CHECK(said(lenient(list({{"initial_wpt(enum)", "8"}}))) == Said{"range:8:26?"});
  CHECK(said(lenient(list({{"initial_wpt(enum)", "3"}}))) == Said{"range:8:26?"});
  CHECK(said(lenient(list({{"initial_wpt(enum)", "0.5"}}))) == Said{"not-whole:8:26?"});
  CHECK(said(lenient(list({{"end_action(enum)", "2"}}))) == Said{"range:10:25?"});
  CHECK(said(lenient(list({{"list_when_wpt_dist(m)", "1000000"}}))).empty());  // u_mission_param_a
  CHECK(lenient(list({{"start_when(enum)", "3"}})).problems.front().message ==
        "start_when is 3, allowed is 0, 1, 2, 4");
}

TEST_CASE("missing, repeated and unknown b_args are said") {
  CHECK(said(lenient(list({{"list_when_wpt_dist(m)", ""}}))) == Said{"missing-b-arg:0:0?"});
  CHECK(said(lenient(list({{"initial_wpt(X)", "1"}}))) == Said{"duplicate-b-arg:11:23?"});
  CHECK(lenient(list({{"initial_wpt(X)", "1"}})).b_arg("initial_wpt")->value == 1);
  CHECK(said(lenient(list({{"colour(nodim)", "1"}}))) == Said{"unknown-b-arg:11:22?"});
  CHECK(said(strict(list({{"colour(nodim)", "1"}}))) == Said{"unknown-b-arg:11:22"});
}

TEST_CASE("a list that ends without waiting ends the behaviour") {
  CHECK(said(lenient(list({{"num_legs_to_run(nodim)", "-2"}}))) == Said{"quits-at-end:4:31?"});
  CHECK(said(lenient(list({{"num_legs_to_run(nodim)", "-2"}, {"end_action(enum)", "6"}}))).empty());
}

TEST_CASE("values that are no numbers are said") {
  CHECK(said(lenient(list({{"initial_wpt(enum)", "??"}}))) == Said{"bad-number:8:26"});
  CHECK(said(lenient(list({{"initial_wpt(enum)", "# 0"}}))) == Said{"bad-number:8:20"});
  CHECK(said(lenient(list({{"initial_wpt(enum)", "nan"}}))) == Said{"bad-number:8:26"});
  CHECK(said(lenient(list({{"initial_wpt(enum)", "0 first"}}))) == Said{"text-after-value:8:28?"});
  CHECK(said(lenient(list({{"initial_wpt(enum)", "0 3850.2"}}))) == Said{"bad-number:8:28"});
}

TEST_CASE("waypoints are two numbers in degrees and minutes, longitude first") {
  const auto points = [](const std::string& text) {
    return said(lenient(list({{"num_waypoints(nodim)", "1"}}, text)));
  };
  CHECK(points("-1530.0 2910.5 # goal\n").empty());
  CHECK(points("-1530.0 2910.5 | goal\n") == Said{"text-after-value:13:16?"});
  CHECK(points("-1530.0 2910.5 3.0\n") == Said{"third-number:13:16"});
  CHECK(points("-1560.0 2910.5\n") == Said{"coordinate:13:1"});
  CHECK(points("-1530.0 9000.1\n") == Said{"coordinate:13:9"});
  CHECK(points("-18000.1 2910.5\n") == Said{"coordinate:13:1"});
  CHECK(points("69696969 69696969\n") == Said{"coordinate:13:1", "coordinate:13:10"});
  CHECK(points("0 0\n") == Said{"null-position:13:1"});
  CHECK(points("-1530.0\n") == Said{"no-waypoints:0:0", "count-mismatch:9:29?", "coordinate:13:1"});
  CHECK(said(lenient(list({{"num_waypoints(nodim)", "0"}}, ""))) == Said{"no-waypoints:0:0", "range:9:29?"});
}

TEST_CASE("counts: the listed waypoints win") {
  const auto few = lenient(list({{"num_waypoints(nodim)", "15"}}));
  CHECK(said(few) == Said{"count-mismatch:9:29?"});
  CHECK(few.waypoints.size() == 3);
  std::string nine;
  for (int i = 0; i < 9; ++i) nine += "-1530.0 29" + std::to_string(10 + i) + ".5\n";
  CHECK(said(lenient(list({{"num_waypoints(nodim)", "9"}}, nine))) == Said{"too-many-waypoints:21:1?"});
}

TEST_CASE("decimal degrees and swapped numbers show only beside the glider") {
  const std::string degrees = "-118.5321 33.4210\n", swapped = "2910.5000 -1530.0000\n", far = "-1530.0 6010.5\n";
  const std::map<std::string, std::string> one{{"num_waypoints(nodim)", "1"}};
  CHECK(said(lenient(list(one, degrees))).empty());
  CHECK(said(near(list(one, degrees), 33.4, -118.6)) == Said{"decimal-degrees:13:1"});
  CHECK(said(near(list(one, swapped), 29.0, -15.4)) == Said{"swapped:13:1"});
  CHECK(said(near(list(one, far), 29.0, -15.4)) == Said{"far-away:13:1?"});
  CHECK(said(near(list(), 29.0, -15.4)).empty());
  // Degrees with more than 60 in the decimals are no position at all as they stand, and are told all the same.
  CHECK(said(near(list(one, "-118.9 33.75\n"), 33.4, -118.6)) == Said{"decimal-degrees:13:1"});
  CHECK(said(near(list(one, "-165.5 33.75\n"), 33.4, -165.6)) == Said{"coordinate:13:1", "decimal-degrees:13:1"});
}

TEST_CASE("the frame of a file is checked") {
  CHECK(said(lenient("")) == Said{"behavior-name:0:0"});
  CHECK(said(lenient("hello\n")) == Said{"section:0:0", "behavior-name:1:1", "stray-text:1:1"});
  auto cut = list();
  cut.resize(cut.find("<end:waypoints>"));
  CHECK(said(lenient(cut)) == Said{"section:15:1"});
  CHECK(said(lenient("behavior_name=yo\n<start:b_arg>\n<start:b_arg>\n<end:b_arg>\n<end:b_arg>\n")) ==
        Said{"section:3:1", "section:3:1", "section:5:1"});
  CHECK(said(lenient("behavior_name=yo\nbehavior_name=yo\n<start:b_arg>\n<end:b_arg>\n")) ==
        Said{"behavior-name:2:15"});
  CHECK(said(lenient("behavior_name=dance\n<start:b_arg>\n<end:b_arg>\n")) == Said{"unknown-behavior:1:15?"});
  CHECK(said(lenient("behavior_name=yo\nb_arg: d_target_depth(m) 50\n<start:b_arg>\n<end:b_arg>\n<middle>\n")) ==
        Said{"section:2:8", "section:5:1"});
}

TEST_CASE("bytes beyond ASCII are doubtful in comments and wrong elsewhere") {
  CHECK(said(lenient("behavior_name=yo # k\xc3\xb6ln\n<start:b_arg>\n<end:b_arg>\n")) == Said{"encoding:1:21?"});
  CHECK(said(lenient("behavior_name=yo\n<start:b_arg>\n\x01\n<end:b_arg>\n")) ==
        Said{"encoding:3:1", "stray-text:3:1"});
}

TEST_CASE("sizes are bounded") {
  CHECK(said(lenient(list() + "#" + std::string(2000, 'x') + "\n")) == Said{"size:17:1"});
  CHECK_FALSE(lenient(list() + std::string(kLargestMafile, '\n')).valid());
}

TEST_CASE("messages carry no raw bytes of the file") {
  const auto file =
      lenient("behavior_name=yo\n<start:b_arg>\nb_arg: x(m) \x1b[31m" + std::string(200, 'y') + "\n<end:b_arg>\n");
  for (const auto& p : file.problems) {
    CHECK(p.message.size() < 120);
    CHECK(p.message.find('\x1b') == std::string::npos);
  }
}

TEST_CASE("other behaviours are read generally, their known ranges are checked") {
  const auto file = lenient(
      "behavior_name=surface\n<start:b_arg>\nb_arg: start_when(enum) 12\nb_arg: when_secs(sec) 60\n"
      "b_arg: keystroke_wait_time(sec) 901\nb_arg: strobe_on(bool) 1\n<end:b_arg>\n");
  CHECK(said(file) == Said{"range:4:23?", "range:5:33?"});
  CHECK(file.b_args.size() == 4);
  CHECK(file.b_arg("strobe_on")->unit == "bool");
}

namespace {

std::string behavior_file(const std::string& behavior, const std::string& args) {
  return "behavior_name=" + behavior + "\n<start:b_arg>\n" + args + "<end:b_arg>\n";
}
std::string yo(const std::string& args) { return behavior_file("yo", args); }

}  // namespace

TEST_CASE("surface, yo and sample have their ranges and names, in both modes") {
  for (const auto& [text, problem] : std::vector<std::pair<std::string, std::string>>{
           {behavior_file("surface", "b_arg: start_when(enum) 5\n"), "range:3:25"},
           {behavior_file("surface", "b_arg: when_wpt_dist(m) 4\n"), "range:3:25"},
           {behavior_file("surface", "b_arg: end_action(enum) 6\n"), "range:3:25"},
           {behavior_file("surface", "b_arg: gps_wait_time(sec) 119\n"), "range:3:27"},
           {behavior_file("surface", "b_arg: gps_postfix_wait_time(sec) -1\n"), "range:3:35"},
           {behavior_file("surface", "b_arg: c_bpump_value(X) 1001\n"), "range:3:25"},
           {behavior_file("surface", "b_arg: keystroke_wait(sec) 900\n"), "unknown-b-arg:3:28"},
           {yo("b_arg: start_when(enum) 19\n"), "range:3:25"},
           {yo("b_arg: d_target_depth(m) 2\n"), "range:3:26"},
           {yo("b_arg: d_target_depth(m) 1001\n"), "range:3:26"},
           {yo("b_arg: num_half_cycles_to_do(nodim) 1.5\n"), "not-whole:3:37"},
           {yo("b_arg: d_bpump_value(X) -1001\n"), "range:3:25"},
           {behavior_file("sample", "b_arg: state_to_sample(enum) 16\n"), "range:3:30"},
           {behavior_file("sample", "b_arg: depth(m) 1\n"), "unknown-b-arg:3:17"},
       }) {
    INFO(text);
    CHECK(said(lenient(text)) == Said{problem + "?"});
    CHECK(said(strict(text)) == Said{problem});
  }
  CHECK(said(lenient(yo("b_arg: when_secs(s) 10\n"))).empty());  // a unit is decoration
  CHECK(said(strict(yo("b_arg: when_secs(s) 10\n"))) == Said{"unit:3:21"});
  CHECK(lenient(yo("b_arg: target_depth(m) 100\n")).problems.front().message ==
        "no b_arg target_depth of yo is known; drift_at_depth has one");
  CHECK(lenient(list({{"wpt_x_0(X)", "-1530"}})).problems.front().message ==
        "no b_arg wpt_x_0 of goto_list is known; it counts inside a mission only");
}

TEST_CASE("pitches are radians with the sign of their phase") {
  CHECK(said(lenient(yo("b_arg: d_pitch_value(X) -0.4538\nb_arg: c_pitch_value(X) 0.4538\n"))).empty());
  CHECK(said(lenient(yo("b_arg: d_pitch_value(X) 0.4538\n"))) == Said{"range:3:25?"});
  CHECK(said(lenient(yo("b_arg: c_pitch_value(X) 26\n"))) == Said{"range:3:25?"});
  CHECK(said(lenient(yo("b_arg: c_use_pitch(enum) 1\nb_arg: c_pitch_value(X) 26\n"))).empty());  // inches
  CHECK(said(lenient(behavior_file("surface", "b_arg: c_use_pitch(enum) 3\nb_arg: c_pitch_value(X) -0.4\n"))) ==
        Said{"range:4:25?"});
}

TEST_CASE("a yo climbs to above where it dives to, by default 12 m") {
  CHECK(said(lenient(yo("b_arg: c_target_depth(m) 20\nb_arg: d_target_depth(m) 200\n"))).empty());
  CHECK(said(lenient(yo("b_arg: c_target_depth(m) 20\n"))) == Said{"range:3:26?"});
  CHECK(said(lenient(yo("b_arg: c_target_depth(m) 1000000\n"))).empty());  // a mission parameter
}

TEST_CASE("the value in force is the last given, else masterdata's default") {
  const auto file = lenient(list({{"list_when_wpt_dist(m)", ""}, {"initial_wpt(X)", "1"}, {"end_action(enum)", "x"}}));
  CHECK(file.in_force("list_when_wpt_dist") == 10.0);
  CHECK(file.in_force("initial_wpt") == 1.0);
  CHECK_FALSE(file.in_force("end_action"));
  CHECK_FALSE(file.in_force("colour"));
  CHECK(file.problems.front().message ==
        "list_when_wpt_dist is not given: the glider takes masterdata's default, 10, not the mission's value");
  CHECK(lenient(behavior_file("surface", "")).in_force("when_secs") == 1200.0);
}

TEST_CASE("a first waypoint within the radius counts as reached at once") {
  // 2910.5000 N 1530.0000 W; a minute of latitude is 1.85 km, the radius 700 m.
  CHECK(said(near(list(), 29 + 10.8 / 60, -15.5)) == Said{"inside-radius:13:1?"});
  CHECK(said(near(list(), 29 + 10.9 / 60, -15.5)).empty());
  CHECK(said(near(list({{"list_when_wpt_dist(m)", "1000000"}}), 29 + 10.5 / 60, -15.5)).empty());
}

TEST_CASE("a problem prints its place, its severity and its code") {
  CHECK(lenient(list({{"num_waypoints(nodim)", "4"}})).problems.front().text() ==
        "line 9, column 29: warning: num_waypoints is 4, listed are 3; the listed ones count [count-mismatch]");
}

TEST_CASE("real data: all 37 mafiles are read and their problems are the known ones") {
  GLIDEHELM_NEEDS_DATA(folder);
  // By file: behaviour, b_args, waypoints, and the problems by code and line (0: the file as a whole).
  struct Known {
    std::string behavior;
    std::size_t b_args, waypoints;
    std::vector<std::string> problems;
  };
  const std::string radius = "missing-b-arg:0?", once6 = "quits-at-end:6?";
  const std::map<std::string, Known> known{
      {"bsd_ch5_surfac10.ma", {"surface", 15, 0, {}}},
      {"bsd_ch6_surfac42.ma", {"surface", 16, 0, {}}},
      {"bsd_goto_l97.ma", {"goto_list", 7, 1, {"duplicate-b-arg:15?", "text-after-value:22?"}}},
      {"bsd_opencpn_goto_l10.ma", {"goto_list", 6, 5, {"range:17?", "bad-number:17", "encoding:22?"}}},
      {"bsd_set_he95.ma", {"set_heading", 2, 0, {}}},
      {"fmi_20231110T135149_goto_l15.ma", {"goto_list", 5, 1, {radius, "quits-at-end:14?"}}},
      {"glidersim_goto_l50.ma", {"goto_list", 6, 3, {}}},
      {"glidersim_nsb3_surfac10.ma", {"surface", 9, 0, {}}},
      {"glidersim_surfac50.ma", {"surface", 7, 0, {}}},
      {"glidersim_yo50.ma", {"yo", 17, 0, {}}},
      {"glyder_goto_l00_good.ma", {"goto_list", 6, 6, {}}},
      {"glyder_goto_l00_short.ma", {"goto_list", 6, 4, {"count-mismatch:11?"}}},
      {"gpplib_GOTO_L30.MA", {"goto_list", 5, 1, {radius, once6}}},
      {"gpplib_GOTO_L31.MA", {"goto_list", 5, 4, {radius}}},
      {"gpplib_GOTO_L80.MA", {"goto_list", 5, 1, {radius, once6}}},
      {"gpplib_GOTO_L82.MA", {"goto_list", 5, 1, {radius, once6}}},
      {"gpplib_SURFAC10.MA", {"surface", 4, 0, {}}},
      {"gpplib_YO11.MA", {"yo", 12, 0, {}}},
      {"gpplib_gpp_GOTO_L25.MA", {"goto_list", 5, 3, {radius, once6}}},
      {"gpplib_gpp_GOTO_L27.MA", {"goto_list", 5, 7, {radius, once6}}},
      {"gpplib_mafiles_GOTO_L15.MA", {"goto_list", 5, 5, {radius}}},
      {"gpplib_mafiles_GOTO_L20.MA", {"goto_list", 5, 1, {radius, once6}}},
      {"gpplib_mafiles_GOTO_L25.MA", {"goto_list", 5, 1, {radius, once6}}},
      {"gpplib_mafiles_GOTO_L30.MA", {"goto_list", 5, 4, {radius}}},
      {"idx_12924110461_GOTO_L10.MA",
       {"goto_list",
        5,
        6,
        {radius, "encoding:3?", "quits-at-end:8?", "encoding:14?", "encoding:15?", "encoding:16?", "encoding:17?",
         "encoding:18?", "encoding:19?"}}},
      {"idx_2992769570_goto.ma", {"goto_list", 6, 1, {}}},
      {"idx_32387892485_goto_l77.ma", {"goto_list", 6, 2, {"quits-at-end:5?"}}},
      {"idx_5976854338_goto_l10.ma", {"goto_list", 6, 12, {"too-many-waypoints:46?"}}},
      {"idx_70364213980_goto_l10.ma", {"goto_list", 6, 2, {"count-mismatch:11?"}}},
      // A yo by its name, but with the b_args of drift_at_depth, and `??` for a value.
      {"sfmcapi_drift_at_depth_yo30.ma",
       {"yo",
        27,
        0,
        {"unknown-b-arg:12?", "unknown-b-arg:14?", "unknown-b-arg:16?", "unknown-b-arg:17?", "unknown-b-arg:18?",
         "unknown-b-arg:19?", "unknown-b-arg:20?", "bad-number:21", "unknown-b-arg:21?", "unknown-b-arg:25?",
         "unknown-b-arg:26?", "unknown-b-arg:27?"}}},
      {"sfmcapi_goto_l90.ma", {"goto_list", 5, 4, {radius}}},
      {"sfmcapi_surfac30.ma", {"surface", 8, 0, {}}},
      {"sfmcapi_yo30.ma", {"yo", 15, 0, {}}},
      {"swfsc_sample01.ma", {"sample", 7, 0, {}}},
      {"swfsc_surfac10.ma", {"surface", 9, 0, {}}},
      {"swfsc_surfac40.ma", {"surface", 11, 0, {}}},
      {"swfsc_yo20.ma", {"yo", 18, 0, {}}},
  };
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator{folder + "/slocum/ma"}) {
    const auto name = entry.path().filename().string();
    INFO(name);
    ++files;
    const auto file = lenient(file_bytes(entry.path().string()));
    Known found{file.behavior, file.b_args.size(), file.waypoints.size(), {}};
    for (const auto& p : file.problems)
      found.problems.push_back(p.code + ":" + std::to_string(p.line) + (p.severity == Severity::warning ? "?" : ""));
    REQUIRE(known.count(name) == 1);
    CHECK(found.behavior == known.at(name).behavior);
    CHECK(found.b_args == known.at(name).b_args);
    CHECK(found.waypoints == known.at(name).waypoints);
    CHECK(found.problems == known.at(name).problems);
    for (const auto& waypoint : file.waypoints) CHECK(waypoint.at);
  }
  CHECK(files == 37);
}

TEST_CASE("real data: the list in decimal degrees is found beside its glider, the lists around it are not") {
  GLIDEHELM_NEEDS_DATA(folder);
  // The glider flew off Los Angeles. GOTO_L31 was written in decimal degrees; the others of its pilots were not.
  for (const auto& entry : std::filesystem::directory_iterator{folder + "/slocum/ma"}) {
    const auto name = entry.path().filename().string();
    if (name.find("gpplib_") != 0 || name.find("GOTO") == std::string::npos) continue;
    const auto file = near(file_bytes(entry.path().string()), 33.4, -118.6);
    const auto degrees = std::count_if(file.problems.begin(), file.problems.end(),
                                       [](const auto& p) { return p.code == "decimal-degrees"; });
    INFO(name);
    CHECK(degrees == (name == "gpplib_GOTO_L31.MA" ? 4 : 0));
    CHECK(file.valid() == (name != "gpplib_GOTO_L31.MA"));
  }
}
