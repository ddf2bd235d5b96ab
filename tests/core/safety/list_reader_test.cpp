#include "core/safety/list_reader.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "tests/core/safety/sample_dossier.hpp"

using namespace glidehelm;
using namespace glidehelm::safety;
using test::goto_list;

namespace {

const std::vector<GeoPoint> kPoints{geo_point(32.8436666, -117.5303333), geo_point(-0.5083333, 179.9999983)};

std::string good() { return goto_list(kPoints, 432.1); }

/// The file with the first `from` replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = good();
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

ListProblem problem(const std::string& bytes, int max_waypoints = 8) {
  const auto list = read_list(bytes, max_waypoints);
  REQUIRE_FALSE(list.has_value());
  return list.error();
}

}  // namespace

TEST_CASE("a list of ours is read to the unit of its last digit") {
  const auto list = read_list(good(), 8);
  REQUIRE(list.has_value());
  REQUIRE(list->points.size() == 2);
  // 117.5303333 deg = 117 deg 31.819998 min -> 31.8200; 32.8436666 deg = 50.619996 min -> 50.6200
  CHECK(list->points[0].lon_units == -(117 * 600'000 + 318'200));
  CHECK(list->points[0].lat_units == 32 * 600'000 + 506'200);
  CHECK(list->points[0].line == 13);
  // -0.5083333 deg keeps its sign though its degrees are 0; 179.9999983 deg = 59.999898 min
  CHECK(list->points[1].lat_units == -305'000);
  CHECK(list->points[1].lon_units == 179 * 600'000 + 599'999);
  CHECK(list->points[1].at.lat.degrees() == Approx(-30.5 / 60).epsilon(1e-12));
  CHECK(list->radius.si() == 432.1);
  CHECK(list->at_end == model::AtEnd::loop);
}

TEST_CASE("a waiting list needs end_action 6") {
  const auto list = read_list(goto_list(kPoints, 400, "-2", "6"), 8);
  REQUIRE(list.has_value());
  CHECK(list->at_end == model::AtEnd::wait);
  CHECK(problem(goto_list(kPoints, 400, "-2", "0")).message.find("end_action 6") != std::string::npos);
}

TEST_CASE("every b_arg has one unit and few values") {
  struct Row {
    const char *from, *to, *message;
    int line, column;
  };
  const Row rows[] = {
      {"num_legs_to_run(nodim) -1", "num_legs_to_run(nodim) 0", "num_legs_to_run is 0", 4, 33},
      {"num_legs_to_run(nodim) -1", "num_legs_to_run(nodim) -3", "num_legs_to_run is -3", 4, 33},
      {"start_when(enum) 0", "start_when(enum) 1", "start_when is 1, allowed is 0", 5, 27},
      {"list_stop_when(enum) 7", "list_stop_when(enum) 5", "list_stop_when is 5, allowed is 7", 6, 31},
      {"list_when_wpt_dist(m) 432.1", "list_when_wpt_dist(m) 9.9", "allowed is 10 to 100000", 7, 32},
      {"list_when_wpt_dist(m) 432.1", "list_when_wpt_dist(m) 100000.1", "allowed is 10 to 100000", 7, 32},
      {"initial_wpt(enum) 0", "initial_wpt(enum) -2", "initial_wpt is -2, allowed is 0", 8, 28},
      {"num_waypoints(nodim) 2", "num_waypoints(nodim) 3", "num_waypoints is 3 but 2 are listed", 0, 0},
      {"num_waypoints(nodim) 2", "num_waypoints(nodim) 9", "allowed is 1 to 8", 9, 31},
      {"num_waypoints(nodim) 2", "num_waypoints(nodim) 2.5", "allowed is 1 to 8", 9, 31},
      {"end_action(enum) 0", "end_action(enum) 1", "end_action is 1, allowed is 0 or 6", 10, 27},
      {"start_when(enum)", "start_when(nodim)", "must be (enum)", 5, 20},
      {"start_when", "Start_when", "unknown b_arg 'Start_when'", 5, 10},
      {"end_action(enum) 0", "initial_wpt(enum) 0", "given twice", 10, 10},
      {"list_when_wpt_dist(m) 432.1", "list_when_wpt_dist(m) 4e2", "not a plain decimal number", 7, 32},
      {"list_when_wpt_dist(m) 432.1", "list_when_wpt_dist(m) nan", "not a plain decimal number", 7, 32},
      {"list_when_wpt_dist(m) 432.1", "list_when_wpt_dist(m) +432.1", "not a plain decimal number", 7, 32},
      {"list_when_wpt_dist(m) 432.1", "list_when_wpt_dist(m) 432.1 7", "expected the end of the line", 7, 38},
      {"b_arg: initial", "b_arg initial", "expected b_arg:", 8, 3},
  };
  for (const auto& row : rows) {
    CAPTURE(row.to);
    const auto p = problem(with(row.from, row.to));
    CHECK(p.message.find(row.message) != std::string::npos);
    CHECK(p.line == row.line);
    CHECK(p.column == row.column);
  }
}

TEST_CASE("a b_arg left out would take the glider's own default and is refused") {
  for (const char* line : {"  b_arg: num_legs_to_run(nodim) -1\n", "  b_arg: start_when(enum) 0 # BAW_IMMEDIATELY\n",
                           "  b_arg: list_stop_when(enum) 7\n", "  b_arg: list_when_wpt_dist(m) 432.1\n",
                           "  b_arg: initial_wpt(enum) 0\n", "  b_arg: num_waypoints(nodim) 2\n"})
    CHECK(problem(with(line, "")).message.find("is missing") != std::string::npos);
  CHECK(read_list(with("  b_arg: end_action(enum) 0\n", ""), 8).has_value());
}

TEST_CASE("a waypoint is longitude then latitude in degrees and minutes with four decimals") {
  struct Row {
    const char *to, *message;
  };
  const Row rows[] = {
      {"-11760.0000 3250.6200", "has 60 minutes or more"},
      {"-11759.9999 3260.0000", "has 60 minutes or more"},
      {"-18000.0001 3250.6200", "beyond 180 degrees"},
      {"-11731.8200 9000.0001", "beyond 90 degrees"},
      {"0.0000 0.0000", "0/0 is no waypoint"},
      {"-0000.0000 0.0000", "0/0 is no waypoint"},
      {"69696969.0000 69696969.0000", "is not [-]DDMM.mmmm"},
      {"-11731.820 3250.6200", "is not [-]DDMM.mmmm"},
      {"-11731.82000 3250.6200", "is not [-]DDMM.mmmm"},
      {"-117.5303 32.8437x", "is not [-]DDMM.mmmm"},
      {"-11731.8200", "latitude '' is not"},
      {"-11731.8200 3250.6200 12.0000", "expected the end of the line"},
      {"-11731.8200 3250.6200 | note", "expected the end of the line"},
      {"--1731.8200 3250.6200", "is not [-]DDMM.mmmm"},
      {"+11731.8200 3250.6200", "is not [-]DDMM.mmmm"},
      {"-11731.8200,3250.6200", "is not [-]DDMM.mmmm"},
  };
  for (const auto& row : rows) {
    CAPTURE(row.to);
    const auto p = problem(with("-11731.8200 3250.6200", row.to));
    CHECK(p.message.find(row.message) != std::string::npos);
    CHECK(p.line == 13);
  }
  CHECK(read_list(with("-11731.8200 3250.6200", "18000.0000\t-9000.0000 # pole"), 8).has_value());
  CHECK(read_list(with("-11731.8200 3250.6200", "-11759.9999 3259.9999"), 8).has_value());
}

TEST_CASE("name line, sections and end tag stand where they belong") {
  CHECK(problem(with("behavior_name=goto_list", "behavior_name=yo")).line == 1);
  CHECK(problem(with("behavior_name=goto_list", " behavior_name=goto_list")).line == 1);
  CHECK(problem(with("<start:b_arg>", "<start:b_args>")).line == 3);
  CHECK(problem(with("<end:b_arg>\n", "")).line == 11);
  CHECK(problem(with("<start:waypoints>", "<start:b_arg>")).line == 12);
  CHECK(problem(good() + "\n").message.find("nothing may follow") != std::string::npos);
  CHECK(problem(good() + good()).message.find("nothing may follow") != std::string::npos);
  CHECK(problem("").message.find("cut") != std::string::npos);
}

TEST_CASE("bytes that are not plain text are refused with their place") {
  const auto crlf = problem(with("<start:b_arg>\n", "<start:b_arg>\r\n"));
  CHECK(crlf.line == 3);
  CHECK(crlf.column == 14);
  CHECK(problem(with("plan 7", "plan \xc3\xa9")).line == 2);
  CHECK(problem(with("plan 7", std::string("plan \0", 6))).line == 2);
  CHECK(problem(with("plan 7", "plan 7; rm")).message.find("a comment may hold") != std::string::npos);
  CHECK(problem(with("plan 7", "plan 7 # 8")).line == 2);
}

TEST_CASE("lines of 100 characters and files of 4096 bytes are the largest taken") {
  const std::string comment = "# Glidehelm 2026-11-25T10:20:30Z plan 7";
  CHECK(read_list(with(comment, "#" + std::string(99, 'x')), 8).has_value());
  const auto longer = problem(with(comment, "#" + std::string(100, 'x')));
  CHECK(longer.line == 2);
  CHECK(longer.column == 101);
  const std::size_t room = kLargestFile - good().size();
  std::string padding;
  while (padding.size() + 100 <= room) padding += "#" + std::string(98, 'y') + "\n";
  padding += "#" + std::string(room - padding.size() - 2, 'z') + "\n";
  const auto full = with("<start:b_arg>", padding + "<start:b_arg>");
  REQUIRE(full.size() == kLargestFile);
  CHECK(read_list(full, 8).has_value());
  CHECK(problem(with("<start:b_arg>", "\n" + padding + "<start:b_arg>")).message.find("4097 bytes") !=
        std::string::npos);
}

TEST_CASE("more waypoints than allowed are refused, as many as allowed are taken") {
  std::vector<GeoPoint> points;
  for (int i = 0; i < 9; ++i) points.push_back(geo_point(10 + 0.1 * i, 20));
  CHECK(problem(goto_list(points, 100), 8).message.find("allowed is 1 to 8") != std::string::npos);
  CHECK(read_list(goto_list(points, 100), 9).has_value());
  points.resize(8);
  CHECK(read_list(goto_list(points, 100), 8).has_value());
}

TEST_CASE("a list cut at any byte is refused") {
  const std::string whole = good();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    CAPTURE(n);
    CHECK_FALSE(read_list(std::string_view{whole}.substr(0, n), 8).has_value());
  }
}

TEST_CASE("random bytes and random edits never break the reader") {
  std::mt19937 random{20261125};
  const std::string whole = good();
  const std::string alphabet = "\n\n \t#<>:=().-+0123456789eab_argstwypoinlDM\r";
  int read = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string text = round % 2 == 0 ? whole : std::string{};
    if (text.empty())
      for (auto n = random() % 300; n > 0; --n) text += alphabet[random() % alphabet.size()];
    else
      for (auto n = 1 + random() % 6; n > 0; --n) text[random() % text.size()] = static_cast<char>(random() % 256);
    const auto list = read_list(text, 8);
    if (list) {
      ++read;
      CHECK(list->points.size() == 2);
      CHECK(list->radius.si() >= 10);
    } else {
      CHECK_FALSE(list.error().message.empty());
    }
  }
  CHECK(read < 2000);  // what remains are edits of digits and comments
}

TEST_CASE("the name of a slot has two digits") {
  CHECK(list_name(10) == "goto_l10.ma");
  CHECK(list_name(7) == "goto_l07.ma");
  CHECK(list_name(99) == "goto_l99.ma");
  CHECK(list_name(100).empty());
  CHECK(list_name(-1).empty());
}
