#include "protocol/goto_list.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <sstream>

#include "core/base/utc.hpp"
#include "core/safety/list_reader.hpp"

using namespace glidehelm;
using namespace glidehelm::protocol;

namespace {

const GotoListComment kComment{utc_from_text("2026-05-03T04:10:25Z").value(), "alba-0112.0003-1", "cts-astar"};

model::WaypointList list_of(std::vector<GeoPoint> points, double radius = 700,
                            model::AtEnd at_end = model::AtEnd::loop) {
  model::WaypointList list;
  for (const auto& at : points) list.points.push_back(model::Waypoint{at, model::WaypointRole::aim});
  list.radius = Metres{radius};
  list.at_end = at_end;
  return list;
}

/// A second reader that knows only slocum.md 2.5: the numbers between the waypoint tags, longitude first, each
/// sign · (100·degrees + minutes).
std::vector<std::pair<double, double>> second_reader(const std::string& bytes) {
  std::istringstream in{bytes};
  std::vector<std::pair<double, double>> lat_lon;
  const auto degrees = [](double value) {
    const double size = std::fabs(value), whole = std::floor(size / 100);
    return std::copysign(whole + (size - 100 * whole) / 60, value);
  };
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line == "<end:waypoints>") inside = false;
    if (inside) {
      std::istringstream numbers{line.substr(0, line.find('#'))};
      double lon{}, lat{};
      if (numbers >> lon >> lat) lat_lon.emplace_back(degrees(lat), degrees(lon));
    }
    if (line == "<start:waypoints>") inside = true;
  }
  return lat_lon;
}

double minutes_apart(double a_deg, double b_deg) { return std::fabs(a_deg - b_deg) * 60; }

// Rounding to whole units of 1e-4 minute moves a coordinate by half a unit at most; the readers add rounding of doubles
// near 180, which is below 1e-11 minute.
constexpr double kHalfUnit = 0.5e-4 + 1e-10;

}  // namespace

TEST_CASE("the name has two digits and is in lower case") {
  CHECK(goto_list_name(7) == "goto_l07.ma");
  CHECK(goto_list_name(0) == "goto_l00.ma");
  CHECK(goto_list_name(99) == "goto_l99.ma");
}

TEST_CASE("a list is written as SFMC writes it, with every b_arg") {
  CHECK(write_goto_list(list_of({geo_point(29.175, -15.5), geo_point(-0.5083333333333333, 0.0)}), kComment) ==
        "behavior_name=goto_list\n"
        "# Written by Glidehelm on UTC: 2026-05-03T04:10:25Z\n"
        "# plan: alba-0112.0003-1\n"
        "# method: cts-astar\n"
        "\n"
        "<start:b_arg>\n"
        "\tb_arg: num_legs_to_run(nodim) -1 # loop for ever\n"
        "\tb_arg: start_when(enum) 0 # BAW_IMMEDIATELY\n"
        "\tb_arg: list_stop_when(enum) 7 # BAW_WHEN_WPT_DIST\n"
        "\tb_arg: list_when_wpt_dist(m) 700.0\n"
        "\tb_arg: initial_wpt(enum) 0 # the first of the list\n"
        "\tb_arg: num_waypoints(nodim) 2\n"
        "\tb_arg: end_action(enum) 0 # never reached\n"
        "<end:b_arg>\n"
        "<start:waypoints>\n"
        "-1530.0000\t2910.5000\n"
        "0.0000\t-30.5000\n"
        "<end:waypoints>\n");
  const auto wait = write_goto_list(list_of({geo_point(29.175, -15.5)}, 50, model::AtEnd::wait), kComment);
  CHECK(wait.find("num_legs_to_run(nodim) -2") != std::string::npos);
  CHECK(wait.find("end_action(enum) 6") != std::string::npos);
}

TEST_CASE("outside text cannot leave its comment") {
  GotoListComment comment = kComment;
  comment.plan_id = "x\n<end:b_arg>\r\0\x1b[31m#k\xc3\xb6ln";
  comment.method = std::string(500, 'm');
  const auto text = write_goto_list(list_of({geo_point(29.175, -15.5)}), comment);
  CHECK(text.find("# plan: x__end:b_arg_") != std::string::npos);
  CHECK(read_goto_list(text).has_value());
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);) {
    CHECK(line.size() <= 100);
    for (const char c : line) CHECK(((c >= ' ' && c <= '~') || c == '\t'));
  }
}

TEST_CASE("a written list is read back within 1e-4 minute by three readers that share no code") {
  std::mt19937 rng{3};
  std::uniform_real_distribution<double> latitude{-90, 90}, longitude{-180, 180};
  for (int round = 0; round < 500; ++round) {
    std::vector<GeoPoint> points;
    for (unsigned n = 1 + static_cast<unsigned>(round) % 8; n > 0; --n)
      points.push_back(geo_point(latitude(rng), longitude(rng)));
    // The hard ones: just below a whole degree, near zero, at the poles and the antimeridian.
    points.front() = geo_point(-0.99999999, 59 + 59.99996 / 60);
    if (round % 4 == 1) points.front() = geo_point(-1e-4 / 60, 1e-4 / 60);
    if (round % 4 == 2) points.front() = geo_point(-90, -180);
    if (round % 4 == 3) points.front() = geo_point(90, 179.9999999);
    const auto list = list_of(points, 10 + round, round % 2 == 0 ? model::AtEnd::loop : model::AtEnd::wait);
    const auto bytes = write_goto_list(list, kComment);
    CHECK(bytes.size() <= kLargestGotoList);

    const auto ours = read_goto_list(bytes);
    REQUIRE(ours);
    CHECK(ours->at_end == list.at_end);
    CHECK(ours->radius == list.radius);
    const auto second = second_reader(bytes);
    const auto verifier = safety::read_list(bytes, 8);
    REQUIRE(verifier);
    REQUIRE(ours->points.size() == points.size());
    REQUIRE(second.size() == points.size());
    REQUIRE(verifier->points.size() == points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double lat = points[i].lat.degrees(), lon = points[i].lon.degrees();
      // +180 and −180 are one meridian: our type keeps −180.
      const auto lon_apart = [&](double other) {
        return std::min(minutes_apart(lon, other), std::fabs(minutes_apart(lon, other) - 360 * 60));
      };
      CHECK(minutes_apart(lat, ours->points[i].at.lat.degrees()) <= kHalfUnit);
      CHECK(lon_apart(ours->points[i].at.lon.degrees()) <= kHalfUnit);
      CHECK(minutes_apart(lat, second[i].first) <= kHalfUnit);
      CHECK(lon_apart(second[i].second) <= kHalfUnit);
      CHECK(minutes_apart(lat, verifier->points[i].at.lat.degrees()) <= kHalfUnit);
      CHECK(lon_apart(verifier->points[i].at.lon.degrees()) <= kHalfUnit);
    }
    // V-3: what was read is written again as the same bytes.
    CHECK(write_goto_list(*ours, kComment) == bytes);
  }
}

TEST_CASE("the reader takes our lists only") {
  const auto good = write_goto_list(list_of({geo_point(29.175, -15.5)}), kComment);
  const auto changed = [&](const std::string& from, const std::string& to) {
    auto text = good;
    text.replace(text.find(from), from.size(), to);
    return read_goto_list(text);
  };
  CHECK(read_goto_list(good));
  CHECK(changed("initial_wpt(enum) 0", "initial_wpt(enum) -1").error() ==
        BadList{11, "initial_wpt is -1, ours is 0"});  // refused for its meaning, not for its range
  CHECK_FALSE(changed("num_legs_to_run(nodim) -1", "num_legs_to_run(nodim) -2"));
  CHECK_FALSE(changed("num_legs_to_run(nodim) -1", "num_legs_to_run(nodim) 3"));
  CHECK_FALSE(changed("start_when(enum) 0", "start_when(enum) 1"));
  CHECK_FALSE(changed("list_stop_when(enum) 7", "list_stop_when(enum) 5"));
  CHECK_FALSE(changed("700.0", "9.0"));
  CHECK_FALSE(changed("700.0", "100001"));
  CHECK_FALSE(changed("end_action(enum) 0", "end_action(enum) 6"));
  CHECK_FALSE(changed("num_waypoints(nodim) 1", "num_waypoints(nodim) 2"));
  CHECK_FALSE(changed("goto_list\n", "yo\n"));
  CHECK_FALSE(changed("-1530.0000", "-1560.0000"));
  CHECK_FALSE(changed("\tb_arg: end_action(enum) 0 # never reached\n", ""));
  CHECK_FALSE(changed("<end:b_arg>", "\tb_arg: args_from_file(enum) 3\n<end:b_arg>"));
  CHECK_FALSE(changed("\n# plan", "\r\n# plan"));
  CHECK_FALSE(read_goto_list(good + std::string(4096, '\n')));
  for (std::size_t size = 0; size < good.size(); ++size) CHECK_FALSE(read_goto_list(good.substr(0, size)));
}
