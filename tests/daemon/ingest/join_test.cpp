#include "daemon/ingest/join.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

constexpr double kUnnamed = std::numeric_limits<double>::quiet_NaN();

/// A part whose current is `mark` everywhere, at the given hours.
Part part(const std::string& file, std::vector<double> hours, double mark, double reference_h = kUnnamed) {
  for (double& h : hours) h *= 3600;
  Part p{file,
         test::make_grid({std::move(hours), {0.0}, {0, 1}, {0, 1}, true, false}, [&](double, double, double, double) {
           return std::pair{mark, 0.0};
         })};
  p.grid.facts.reference_s = reference_h * 3600;
  p.grid.facts.cycle = file;
  p.grid.facts.sources = {{file, Sha256::of(file)}};
  return p;
}
/// "hour:mark" of every time, in order.
std::string story(const Result<ocean::Grid>& grid) {
  REQUIRE(grid);
  std::string text;
  for (std::size_t t = 0; t < grid->axes.times_s.size(); ++t)
    text += (t > 0 ? " " : "") + std::to_string(static_cast<int>(grid->axes.times_s[t] / 3600)) + ":" +
            std::to_string(static_cast<int>(std::lround(10 * grid->values[8 * t])));
  return text;
}

}  // namespace

TEST_CASE("files that follow each other are joined in time, whatever their order") {
  CHECK(story(join({part("b", {24, 48}, 0.2), part("a", {0, 12}, 0.1), part("c", {72}, 0.3)})) ==
        "0:1 12:1 24:2 48:2 72:3");
}

TEST_CASE("the newest cycle wins where cycles overlap, by its reference time") {
  // b is the newer run although it begins later only by its named reference time; of a no time stays between its ends, where b begins
  // and ends with a's current.
  CHECK(story(join({part("b", {0, 6, 12}, 0.2, 3), part("a", {-3, 3, 9, 15, 21}, 0.1, 1)})) ==
        "-3:1 0:1 6:2 12:1 15:1 21:1");
}

TEST_CASE("without reference times the later first time is newer, then the later argument") {
  CHECK(story(join({part("b", {6, 12, 18}, 0.2), part("a", {0, 6, 12, 24}, 0.1)})) == "0:1 6:1 12:2 18:1 24:1");
  CHECK(story(join({part("a", {0, 6}, 0.1), part("b", {0, 6}, 0.2)})) == "0:2 6:2");
  CHECK(story(join({part("b", {0, 6}, 0.2), part("a", {0, 6}, 0.1)})) == "0:1 6:1");
  // One file that names no reference time makes those of the others count for nothing.
  CHECK(story(join({part("a", {0, 6}, 0.1, 99), part("b", {3, 9}, 0.2)})) == "0:1 3:1 9:2");
}

TEST_CASE("a newer cycle takes over without a jump, and gives back without one") {
  // Three cycles of hourly fields, the second and third not a multiple of six hours after the one before, so that joints lie in joints. Each
  // is 0.3 m/s away from the one before: between two hours the joint adds at most 1.5·0.3/6 h for each of the two cycles that may be
  // fading at once.
  const auto hours = [](double first, std::size_t count) { return test::steps(first, 1, count); };
  const auto grid =
      join({part("c", hours(12, 30), 0.3, 12), part("a", hours(0, 60), 0.3, 0), part("b", hours(9, 40), 0.6, 9)});
  REQUIRE(grid);
  REQUIRE(grid->axes.times_s.size() == 60);
  const double most = 2 * 1.5 * 0.3 / 6 + 1e-6;
  double highest = 0;
  for (std::size_t t = 0; t + 1 < 60; ++t) {
    CHECK(std::abs(static_cast<double>(grid->values[8 * (t + 1)]) - static_cast<double>(grid->values[8 * t])) <= most);
    highest = std::max(highest, static_cast<double>(grid->values[8 * t]));
  }
  CHECK(grid->values[8 * 20] == 0.3F);  // the newest alone
  CHECK(highest > 0.4);                 // the middle one was heard
  // Halfway through the joint of two cycles is halfway between them.
  const auto two = join({part("a", hours(0, 20), 0.2, 0), part("b", hours(10, 20), 0.4, 10)});
  REQUIRE(two);
  CHECK(two->values[8 * 13] == Approx(0.3).margin(1e-7));
  CHECK(two->values[8 * 16] == 0.4F);
}

TEST_CASE(
    "a current that two cycles agree on is left bit by bit, and a node that one of them has not is the newest one's") {
  auto older = part("a", test::steps(0, 1, 20), 0.1F, 0), newer = part("b", test::steps(10, 1, 20), 0.1F, 10);
  for (std::size_t t = 0; t < 20; ++t) {
    older.grid.values[8 * t + 2] = older.grid.values[8 * t + 3] =
        std::numeric_limits<float>::quiet_NaN();  // node 1: only the newer has it
    newer.grid.values[8 * t + 4] = newer.grid.values[8 * t + 5] =
        std::numeric_limits<float>::quiet_NaN();  // node 2: only the older
  }
  const auto grid = join({older, newer});
  REQUIRE(grid);
  for (std::size_t t = 0; t < 30; ++t) CHECK(grid->values[8 * t] == 0.1F);
  CHECK(grid->values[8 * 12 + 2] == 0.1F);
  CHECK(std::isnan(grid->values[8 * 12 + 4]));
}

TEST_CASE("files of one cycle interleave, and equal times go to the later argument") {
  // 0.02 m/s apart, as rounding may be; story() rounds 0.14 down and 0.16 up.
  CHECK(story(join({part("a", {0, 6, 12}, 0.14, 0), part("b", {0, 3, 9}, 0.16, 0)})) == "0:2 3:2 6:1 9:2 12:1");
}

TEST_CASE("files of one named cycle that say another current for the same time contradict each other") {
  const auto grid = join({part("a", {0, 6, 12}, 0.1, 0), part("b", {3, 6}, 0.2, 0)});
  REQUIRE_FALSE(grid);
  CHECK(
      grid.error().what ==
      "a and b contradict each other: they are of one model run and differ by up to 0.10 m/s at 1970-01-01T06:00:00Z");
  CHECK(join({part("a", {0, 6, 12}, 0.1, 0), part("b", {3, 9}, 0.2, 0)}));  // no time in common
  CHECK(join({part("a", {0, 6, 12}, 0.1, 0), part("b", {3, 6}, 0.2, 1)}));  // two runs may disagree
}

TEST_CASE("the facts are those of the newest, the sources those of all in order of the arguments") {
  auto a = part("x/a.nc", {0}, 0.1), b = part("x/b.nc", {6}, 0.2), c = part("x/c.nc", {12}, 0.3);
  a.grid.facts.warnings = {"u has no unit; taken as m/s"};
  b.grid.facts.warnings = {"u has no unit; taken as m/s", "only here"};
  const auto grid = join({c, a, b});
  REQUIRE(grid);
  CHECK(grid->facts.cycle == "x/c.nc");
  CHECK(grid->facts.warnings == std::vector<std::string>{"2 files: u has no unit; taken as m/s", "b.nc: only here"});
  REQUIRE(grid->facts.sources.size() == 3);
  CHECK(grid->facts.sources[0].name == "x/c.nc");
  CHECK(grid->facts.sources[2].name == "x/b.nc");
}

TEST_CASE("files on different grids are refused with the first difference") {
  auto other = part("b", {6}, 0.2);
  other.grid.axes.lons_deg[1] = 1.001;
  CHECK(join({part("a", {0}, 0.1), other}).error().what ==
        "b: its longitudes differ from those of a (index 1: 1.001 against 1); files that are joined lie on the same "
        "grid");
  other.grid.axes.lats_deg = {0, 1, 2};
  CHECK(join({part("a", {0}, 0.1), other}).error().what ==
        "b: its latitudes differ from those of a (3 against 2); files that are joined lie on the same grid");
  auto timeless = part("c", {0}, 0.2);
  timeless.grid.axes.has_time = false;
  CHECK(join({part("a", {0}, 0.1), timeless}).error().what ==
        "c: it has no time axis; several files are joined by their times");
  // The rounding of a stored axis is no difference.
  auto near = part("b", {6}, 0.2);
  near.grid.axes.lats_deg[1] += 1e-6;
  CHECK(join({part("a", {0}, 0.1), near}));
}
