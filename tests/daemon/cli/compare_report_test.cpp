#include "daemon/cli/compare_report.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

using namespace glidehelm;

namespace {

planning::Plan plan(const char* method, double arrival_h, double remaining_m, double t0) {
  planning::Plan p;
  p.method = method;
  p.status = arrival_h > 0 ? planning::PlanStatus::reaches_goal : planning::PlanStatus::closest_approach;
  p.arrival_s = arrival_h > 0 ? t0 + arrival_h * 3600 : std::nan("");
  p.remaining = Metres{remaining_m};
  if (arrival_h <= 0) p.reason = "too far <away>";
  p.stints.push_back(
      {geo_point(28.0, -15.0), geo_point(28.2, -14.8), t0, t0 + 8 * 3600, Heading{degrees(45)}, {}, false, Metres{}});
  p.statistics = {12, 345, 67'890};
  return p;
}

/// Five answers: two that arrive, two that come near, one that has nothing to say.
cli::Comparison comparison() {
  const double t0 = 1.7e9;
  cli::Comparison c{
      "leg <2>", "analytic jet", geo_point(28, -15), geo_point(28.5, -14.5), Metres{2000}, t0, std::nullopt, {}};
  c.answers = {{"direct", plan("direct", 0, 9'000, t0), "", 0.01},
               {"cts-astar", plan("cts-astar", 110, 0, t0), "", 0.2},
               {"rrt", std::nullopt, "the field changes with time", 0},
               {"best", plan("cts-astar-refined", 100, 0, t0), "", 0.3},
               {"astar", plan("astar", 0, 5'000, t0), "", 0.1}};
  planning::Bound bound;
  bound.kind = planning::Bound::Kind::arrival;
  bound.travel_s = 99.5 * 3600;
  bound.error_s = 0.25 * 3600;
  c.bound = bound;
  return c;
}

}  // namespace

TEST_CASE("the earliest arrival comes first, then the nearest, then those without a plan") {
  const auto rows = cli::comparison_rows(comparison());
  std::vector<std::string> order;
  for (const auto& row : rows) {
    order.push_back(row.front());
    CHECK(row.size() == cli::comparison_columns().size());
  }
  CHECK(order == std::vector<std::string>{"best", "cts-astar", "astar", "direct", "rrt"});
  CHECK(rows[0][1] == "cts-astar-refined");
  CHECK(rows[0][2] == "100.00");
  CHECK(rows[0][4] == "0.50");   // 100 h over 99.5 h
  CHECK(rows[1][4] == "10.55");  // 110 h
  CHECK(rows[2][5] == "5.0");
  CHECK(rows[4].back() == "the field changes with time");
}

TEST_CASE("the table says what was compared and what nobody can beat") {
  const auto text = cli::comparison_text(comparison());
  CHECK(text.find("leg <2>: 74 km, analytic jet\n") == 0);
  CHECK(text.find("No vehicle arrives earlier than 99.50 h after the fix (error bar of 0.25 h subtracted).") !=
        std::string::npos);
  for (std::size_t i = 0, next = 0; (next = text.find('\n', i)) != std::string::npos; i = next + 1)
    CHECK(text[next - 1] != ' ');
}

TEST_CASE("the document keeps the order that was asked, with null for what there is not") {
  const std::vector<cli::Comparison> all{comparison()};
  const auto j = nlohmann::json::parse(cli::comparison_json(all));
  CHECK(j["schema"] == "glidehelm/comparison/v1");
  const auto& m = j["missions"][0];
  CHECK(m["lower_bound_s"] == 99.5 * 3600);
  CHECK(m["lower_bound_error_s"] == 900);
  const auto& plans = m["plans"];
  REQUIRE(plans.size() == 5);
  CHECK(plans[0]["asked"] == "direct");
  CHECK(plans[0]["status"] == "closest_approach");
  CHECK(plans[0]["travel_time_s"].is_null());
  CHECK(plans[0]["gap"].is_null());
  CHECK(plans[0]["remaining_distance_m"] == 9000);
  CHECK(plans[2]["status"] == "no_plan");
  CHECK(plans[2]["method"].is_null());
  CHECK(plans[2]["reason"] == "the field changes with time");
  CHECK(plans[3]["gap"].get<double>() == Approx(100 / 99.5 - 1));
  CHECK(plans[3]["effective_speed_km_per_day"].get<double>() == Approx(comparison().way_m() / 1000 / (100.0 / 24)));
  CHECK(plans[3]["current_evaluations"] == 67'890);
}

TEST_CASE("what is proven unreachable is said of every plan that does not arrive") {
  auto c = comparison();
  c.answers = {c.answers[0]};
  c.bound->kind = planning::Bound::Kind::unreachable;
  c.bound->reason = "the current is stronger";
  const std::vector<cli::Comparison> all{c};
  const auto j = nlohmann::json::parse(cli::comparison_json(all));
  CHECK(j["missions"][0]["plans"][0]["status"] == "proven_unreachable");
  CHECK(j["missions"][0]["lower_bound_s"].is_null());
  CHECK(cli::bound_text(c) == "Proven unreachable: the current is stronger.");
}

TEST_CASE("the page draws every plan and lets no text of a mission through as markup") {
  const std::vector<cli::Comparison> all{comparison()};
  const chart::Chart open;
  const std::vector<const chart::Chart*> charts{&open};
  const auto page = cli::comparison_page(all, charts);
  CHECK(page.find("leg <2>") == std::string::npos);
  CHECK(page.find("leg &lt;2&gt;") != std::string::npos);
  CHECK(page.find("too far <away>") == std::string::npos);
  std::size_t ways = 0;
  for (auto at = page.find("<polyline"); at != std::string::npos; at = page.find("<polyline", at + 1)) ++ways;
  CHECK(ways == 4);
  CHECK(page.find("http") == std::string::npos);
}
