#include "simulator/glider/list_reader.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/data.hpp"

using namespace glidehelm;
using simulator::read_goto_list;

namespace {

std::string file(const std::string& b_args, const std::string& waypoints) {
  return "behavior_name=goto_list\n# ours\n<start:b_arg>\n" + b_args + "<end:b_arg>\n<start:waypoints>\n" + waypoints +
         "<end:waypoints>\n";
}

std::string error_of(const std::string& bytes) {
  const auto list = read_goto_list(bytes);
  return list ? "read" : list.error().message();
}

}  // namespace

TEST_CASE("a goto list is read longitude first, with every b_arg") {
  const auto list = read_goto_list(
      file("\tb_arg: num_legs_to_run(nodim) -2\nb_arg: start_when(enum) 0 # BAW_IMMEDIATELY\n"
           "b_arg: list_stop_when(enum) 7\nb_arg: list_when_wpt_dist(m) 432.5\nb_arg: initial_wpt(enum) 1\n"
           "b_arg: num_waypoints(nodim) 2\nb_arg: end_action(enum) 6\n",
           "-1030.0000 0054.00\n+17959.9999\t-8000.5 # far\n"));
  REQUIRE(list);
  CHECK(list->legs == -2);
  CHECK(list->radius == Metres{432.5});
  CHECK(list->initial == 1);
  CHECK(list->end_action == 6);
  CHECK(list->declared == 2);
  REQUIRE(list->waypoints.size() == 2);
  CHECK(list->waypoints[0].lon.degrees() == Approx(-10.5).epsilon(1e-14));
  CHECK(list->waypoints[0].lat.degrees() == Approx(0.9).epsilon(1e-14));
  CHECK(list->waypoints[1].lon.degrees() == Approx(179 + 59.9999 / 60).epsilon(1e-14));
  CHECK(list->waypoints[1].lat.degrees() == Approx(-80 - 0.5 / 60).epsilon(1e-14));
}

TEST_CASE("a b_arg that is left out takes the masterdata default") {
  const auto list = read_goto_list(file("", "2317.89 5949.17\n"));
  REQUIRE(list);
  CHECK(list->legs == -1);
  CHECK(list->radius == Metres{10});
  CHECK(list->initial == -2);
  CHECK(list->stop_when == 7);
  CHECK(list->end_action == 0);
}

TEST_CASE("carriage returns, a missing last newline and glued comments are taken") {
  const auto list = read_goto_list("Behavior_name=x\n");  // the key itself is lower case: the wild has no other
  CHECK_FALSE(list);
  CHECK(read_goto_list(
      "behavior_name=Goto_list \r\n<start:b_arg>\r\n b_arg: num_legs_to_run(nodim) -1#loop\r\n<end:b_arg>"
      "\r\n<start:waypoints>\r\n801 4439.3\r\n<end:waypoints>"));
}

TEST_CASE("the sign of zero degrees survives") {
  const auto list = read_goto_list(file("", "-0030.5 -0000.25\n"));
  REQUIRE(list);
  CHECK(list->waypoints[0].lon.degrees() == Approx(-30.5 / 60).epsilon(1e-14));
  CHECK(list->waypoints[0].lat.degrees() == Approx(-0.25 / 60).epsilon(1e-14));
}

TEST_CASE("what the firmware would take for a bad b_arg is a behaviour error that names its line") {
  CHECK(error_of(file("b_arg: radius(m) 100\n", "1.0 2.0\n")) == "line 4, column 8: unknown b_arg radius");
  CHECK(error_of(file("b_arg: num_legs_to_run(nodim) 0\n", "1.0 2.0\n")) ==
        "line 4, column 31: b_arg num_legs_to_run is 0");
  CHECK(error_of(file("b_arg: num_legs_to_run(nodim) -3\n", "1.0 2.0\n")).find("line 4") == 0);
  CHECK(error_of(file("b_arg: list_when_wpt_dist(m) 9.9\n", "1.0 2.0\n")).find("below 10") != std::string::npos);
  CHECK(error_of(file("b_arg: end_action(enum) 3\n", "1.0 2.0\n")).find("end_action") != std::string::npos);
  CHECK(error_of(file("b_arg: initial_wpt(enum) 0\nb_arg: initial_wpt(enum) 0\n", "1.0 2.0\n")) ==
        "line 5, column 8: b_arg initial_wpt is given twice");
  CHECK(error_of(file("b_arg: initial_wpt(enum) 1\n", "1.0 2.0\n")).find("beyond the list") != std::string::npos);
  CHECK(error_of(file("b_arg: initial_wpt(enum) nan\n", "1.0 2.0\n")).find("no number") != std::string::npos);
}

TEST_CASE("enums take the values that the masterdata allow and no others") {
  for (const int flown : {5, 7, 15}) {
    const auto list = read_goto_list(file("b_arg: list_stop_when(enum) " + std::to_string(flown) + "\n", "1.0 2.0\n"));
    REQUIRE(list);
    CHECK(list->stop_when == flown);
  }
  CHECK(read_goto_list(file("b_arg: start_when(enum) 0\n", "1.0 2.0\n")));
  CHECK(error_of(file("b_arg: start_when(enum) 3\n", "1.0 2.0\n")) ==
        "line 4, column 25: b_arg start_when is none of 0, 1, 2, 4");
  CHECK(error_of(file("b_arg: list_stop_when(enum) 12\n", "1.0 2.0\n")) ==
        "line 4, column 29: b_arg list_stop_when is none of 1, 2, 5, 7, 15");
  CHECK(
      read_goto_list(file("b_arg: primary_wpt(enum) 0\nb_arg: primary_stop_when(enum) 15\n"
                          "b_arg: primary_when_wpt_dist(m) 10\n",
                          "1.0 2.0\n")));
}

TEST_CASE("what a glider may do and no source tells how is refused by its name, with line and column") {
  const auto refusal = [](const std::string& b_args) { return error_of(file(b_args, "1.0 2.0\n")); };
  CHECK(refusal("b_arg: start_when(enum) 1\n") == "line 4, column 25: start_when 1 (STK_IDLE) is not simulated");
  CHECK(refusal("b_arg: start_when(enum) 2\n") == "line 4, column 25: start_when 2 (PITCH_IDLE) is not simulated");
  CHECK(refusal("\tb_arg: start_when(enum)  4\n") == "line 4, column 27: start_when 4 (UPDWN_IDLE) is not simulated");
  CHECK(refusal("b_arg: list_stop_when(enum) 1\n") ==
        "line 4, column 29: list_stop_when 1 (STK_IDLE) is not simulated");
  CHECK(refusal("b_arg: list_stop_when(enum) 2 # idle\n") ==
        "line 4, column 29: list_stop_when 2 (PITCH_IDLE) is not simulated");
  CHECK(refusal("b_arg: primary_wpt(enum) 1\n") == "line 4, column 26: primary_wpt 1 is not simulated");
  CHECK(refusal("b_arg: primary_stop_when(enum) 17\n") ==
        "line 4, column 32: primary_stop_when 17 (PRIMARY_WPT within) is not simulated");
}

TEST_CASE("what is no list of at most eight positions is a behaviour error") {
  CHECK(error_of("") == "line 0: empty file");
  CHECK(error_of(file("", "")).find("no waypoint") != std::string::npos);
  std::string nine;
  for (int i = 0; i < 9; ++i) nine += "100.5 200.5\n";
  CHECK(error_of(file("", nine)) == "line 14, column 1: more than 8 waypoints");
  CHECK(error_of(file("", "1160.0 4439.3\n")).find("not a position") != std::string::npos);
  CHECK(error_of(file("", "1100.0 9000.1\n")).find("not a position") != std::string::npos);
  CHECK(error_of(file("", "1100.0\n")).find("two numbers") != std::string::npos);
  CHECK(error_of(file("", "1100.0 4439.3 5.0\n")).find("text after") != std::string::npos);
  CHECK(error_of(file("", "1100.0 4439.3 | Tofino\n")).find("text after") != std::string::npos);
  CHECK(error_of("behavior_name=yo\n<start:waypoints>\n1 2\n<end:waypoints>\n") ==
        "line 1, column 1: behavior_name is not goto_list");
  CHECK(error_of("behavior_name=goto_list\n<start:waypoints>\n1 2\n").find("ends inside") != std::string::npos);
}

TEST_CASE("real data: the goto lists of pilots that keep the firmware's rules are read") {
  GLIDEHELM_NEEDS_DATA(folder);
  const auto read = [&](const char* name) {
    std::ifstream in{std::filesystem::path{folder} / "slocum/ma" / name};
    REQUIRE(in);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return read_goto_list(bytes.str());
  };
  const auto sfmc = read("sfmcapi_goto_l90.ma");
  REQUIRE(sfmc);
  CHECK(sfmc->waypoints.size() == 4);
  CHECK(sfmc->initial == -1);
  const auto fmi = read("fmi_20231110T135149_goto_l15.ma");
  REQUIRE(fmi);
  CHECK(fmi->waypoints.size() == 1);
  CHECK(fmi->legs == -2);
  const auto surface = read("sfmcapi_surfac30.ma");
  REQUIRE_FALSE(surface);
  CHECK(surface.error().reason == "behavior_name is not goto_list");
}
