#include "daemon/cli/rehearsal_page.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "tests/daemon/cli/rehearsal_sample.hpp"

using namespace glidehelm;
using namespace glidehelm::cli;
using glidehelm::test::rehearsal;

namespace {

bool has(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

int count(const std::string& page, const std::string& text) {
  int times = 0;
  for (auto at = page.find(text); at != std::string::npos; at = page.find(text, at + 1)) ++times;
  return times;
}

}  // namespace

TEST_CASE("names are no markup in the page") {
  const auto page = html_text(rehearsal(), chart::Chart{});
  CHECK(has(page, "leg &lt;2&gt;"));
  CHECK_FALSE(has(page, "leg <2>"));
  CHECK(has(page, "seed 1, direct: not arrived"));
}

TEST_CASE("the page needs nothing from outside") {
  const auto page = html_text(rehearsal(), chart::Chart{});
  for (const char* outside : {"http:", "https:", "src=", "href=", "@import", "url(", "<script", "<link"})
    CHECK_FALSE(has(page, outside));
}

TEST_CASE("the page tells every flight: on the map, among the travel times and in a row") {
  auto all = rehearsal();
  all.runs[2].energy_wh = 340;
  all.runs[2].closest_coast = 4321;
  all.runs[3].delay_h = 6;
  const auto page = html_text(all, chart::Chart{});
  CHECK(count(page, "<polyline class=\"ours\"") == 2);
  CHECK(count(page, "<polyline class=\"other\"") == 2);
  CHECK(count(page, "<circle class=\"dot-ours\"") == 2);
  CHECK(count(page, "<circle class=\"dot-other\"") == 1);  // one did not arrive
  CHECK(has(page,
            "<td>best</td><td>2</td><td>0</td><td>120.0</td><td>+20.0</td><td>20</td><td>0</td><td>1</td>"
            "<td>4.3</td><td>340.0</td><td class=\"words\">arrived</td><td class=\"words\">2 x 2 land</td>"));
  CHECK(has(page, "ran out of time, 12.0 km from the goal at best"));
  CHECK(has(page, "direct, +6 h"));
  CHECK(has(page, "<td>direct</td><td>6</td><td>1 of 1</td>"));
  CHECK(has(page, "best arrives in 2 of 2 oceans, after 110.0 h (median)"));
}

TEST_CASE("the map has a scale and round degrees") {
  const auto page = html_text(rehearsal(), chart::Chart{});
  // 0.5 degrees on a side and a tenth of that around: lines every 0.2 degrees, and a quarter of some 60 km is 10 km at most.
  for (const char* label : {"28\u00b0N", "28.2\u00b0N", "28.4\u00b0N", "15\u00b0W", "14.6\u00b0W", ">10 km<"})
    CHECK(has(page, label));
}

TEST_CASE("a map across the antimeridian stays in one piece") {
  auto all = rehearsal();
  all.start = geo_point(0, 179.8);
  all.goal = geo_point(0.2, -179.8);
  for (auto& run : all.runs) run.track = {all.start, all.goal};
  const auto page = html_text(all, chart::Chart{});
  CHECK(has(page, "180\u00b0"));
  CHECK(has(page, "179.8\u00b0E"));
  CHECK(has(page, "179.8\u00b0W"));
  CHECK(count(page, "class=\"grid\"") < 30);
}
