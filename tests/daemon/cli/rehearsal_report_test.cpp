#include "daemon/cli/rehearsal_report.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/base/geo.hpp"

using namespace glidehelm;
using namespace glidehelm::cli;

namespace {

Rehearsed run(int seed, const char* method, std::optional<double> travel_h, double hindcast_h) {
  Rehearsed r;
  r.seed = seed;
  r.method = method;
  if (travel_h) r.travel_s = *travel_h * 3600;
  r.hindcast_s = hindcast_h * 3600;
  r.surfacings = 10 * seed;
  r.missed = 1;
  r.rules = {{"2 land", seed}};
  r.track = {geo_point(28, -15), geo_point(28.5, -14.5)};
  return r;
}

Rehearsal rehearsal() {
  Rehearsal all;
  all.mission = "leg <2>";
  all.method = "best";
  all.start = geo_point(28, -15);
  all.goal = geo_point(28.5, -14.5);
  all.goal_radius = Metres{2000};
  all.runs = {run(1, "best", 100, 90), run(1, "direct", std::nullopt, 90), run(2, "best", 120, 100),
              run(2, "direct", 150, 100)};
  return all;
}

}  // namespace

TEST_CASE("quantiles of a few values are interpolated between them") {
  CHECK_FALSE(quantile({}, 0.5));
  CHECK(*quantile({7}, 0.9) == 7);
  CHECK(*quantile({3, 1, 2}, 0.5) == 2);
  CHECK(*quantile({0, 10}, 0.1) == Approx(1));
  CHECK(*quantile({0, 10, 20, 30}, 0.5) == Approx(15));
}

TEST_CASE("a summary counts arrivals, and takes times and regrets of those alone") {
  const auto all = summaries(rehearsal());
  REQUIRE(all.size() == 2);
  CHECK(all[0].method == "best");
  CHECK(all[0].arrived == 2);
  CHECK(*all[0].median_s == Approx(110 * 3600));
  CHECK(*all[0].median_regret == Approx(0.5 * (100.0 / 90 - 1 + 0.2)));
  CHECK(all[0].missed == 2);
  CHECK(all[0].refused == 3);
  CHECK(all[0].median_surfacings == Approx(15));
  CHECK(all[1].arrived == 1);
  CHECK(all[1].flights == 2);
  CHECK(*all[1].ninetieth_s == Approx(150 * 3600));
  CHECK(*all[1].median_regret == Approx(0.5));
}

TEST_CASE("the document has a run per flight with null where nothing is known") {
  const auto document = nlohmann::json::parse(json_text(rehearsal()));
  REQUIRE(document["runs"].size() == 4);
  CHECK(document["runs"][1]["travel_time_s"].is_null());
  CHECK(document["runs"][1]["regret_to_hindcast"].is_null());
  CHECK(document["runs"][0]["rules"]["2 land"] == 1);
  CHECK(document["runs"][0]["energy_wh"].is_null());
  CHECK(document["summary"][1]["arrived"] == 1);
}

TEST_CASE("names are no markup in the page") {
  const auto page = html_text(rehearsal(), chart::Chart{});
  CHECK(page.find("leg &lt;2&gt;") != std::string::npos);
  CHECK(page.find("leg <2>") == std::string::npos);
  CHECK(page.find("seed 1, direct: not arrived") != std::string::npos);
}

TEST_CASE("the table has a line per method and departure") {
  const auto text = table_text(rehearsal());
  CHECK(text.find("best          0   2 of 2     110.0  102.0 - 118.0     +15.6") != std::string::npos);
  CHECK(text.find("direct        0   1 of 2     150.0") != std::string::npos);
  CHECK(progress_bar(3, 6) == "[###############               ] 3 of 6 flights");
}
