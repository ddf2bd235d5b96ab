#include "daemon/cli/rehearsal_report.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/daemon/cli/rehearsal_sample.hpp"

using namespace glidehelm;
using namespace glidehelm::cli;
using glidehelm::test::rehearsal;

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

TEST_CASE("the table has a line per method and departure") {
  const auto text = table_text(rehearsal());
  CHECK(text.find("best          0   2 of 2     110.0  102.0 - 118.0     +15.6") != std::string::npos);
  CHECK(text.find("direct        0   1 of 2     150.0") != std::string::npos);
  CHECK(progress_bar(3, 6) == "[###############               ] 3 of 6 flights");
}

TEST_CASE("departures are told apart in table, document and verdict") {
  auto all = rehearsal();
  for (auto run : rehearsal().runs) {
    run.delay_h = 6.5;
    if (run.travel_s) *run.travel_s -= 36'000;
    all.runs.push_back(run);
  }
  const auto text = table_text(all);
  CHECK(text.find("best        6.5   2 of 2     100.0") != std::string::npos);
  CHECK(text.find("Departure 2026-03-01T00:00:00Z: best arrives in 2 of 2 oceans, after 110.0 h (median); direct in 1, "
                  "after 150.0 h.\n"
                  "Departure 2026-03-01T06:30:00Z: best arrives in 2 of 2 oceans, after 100.0 h (median); direct in 1, "
                  "after 140.0 h.\n") != std::string::npos);
  const auto document = nlohmann::json::parse(json_text(all));
  CHECK(document["summary"].size() == 4);
  CHECK(document["summary"][2]["delay_h"] == 6.5);
  CHECK(document["runs"][4]["delay_h"] == 6.5);
}

TEST_CASE("energy, closest coast and rules stand in table and document, the worst and the middle of all flights") {
  auto all = rehearsal();
  all.runs[0].energy_wh = 300;
  all.runs[2].energy_wh = 340;
  all.runs[0].closest_coast = 4321;
  all.runs[2].closest_coast = 12'000;
  all.runs[1].closest_coast = all.runs[3].closest_coast = chart::Chart::kHorizon;
  const auto text = table_text(all);
  CHECK(text.find("4.3      320.0\n") != std::string::npos);
  CHECK(text.find(">60          -\n") != std::string::npos);  // nothing within the range of a chart; no energy known
  CHECK(text.find("Files refused by the verifier, best, delay 0 h: 3 x 2 land.\n") != std::string::npos);
  CHECK(text.find("Not arrived: direct, seed 1, delay 0 h: ran out of time, 12.0 km from the goal at best.\n") !=
        std::string::npos);
  const auto document = nlohmann::json::parse(json_text(all));
  CHECK(document["runs"][0]["energy_wh"] == 300);
  CHECK(document["summary"][0]["median_energy_wh"] == 320);
  CHECK(document["summary"][0]["closest_coast_m"] == 4321);
  CHECK(document["summary"][0]["rules"]["2 land"] == 3);
}
