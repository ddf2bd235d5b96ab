#include "daemon/cli/plan_each.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/plan.hpp"
#include "daemon/cli/plan_case.hpp"
#include "tests/daemon/cli/field_verb.hpp"
#include "tests/support/four_oceans.hpp"

using namespace glidehelm;

namespace {

struct EachDesk {
  test::ScratchFolder folder;
  cli::PlanOptions options;
  EachDesk() {
    const auto file = test::make_netcdf(folder, "e.nc", test::four_oceans("0.05"));
    test::write_bytes(folder / "m.yaml",
                      "schema: glidehelm/mission/v1\nname: east\nglider: sim01\n"
                      "goal: {lat_deg: 0.0, lon_deg: 3.4, radius_m: 1000}\n"
                      "start: {lat_deg: 0.0, lon_deg: 3.0, time: 2026-03-01T00:00:00Z}\n"
                      "currents: {files: [" +
                          file + "]}\napproval: {mode: manual}\nschedule: {stint_h: 6}\n");
    options.mission = folder / "m.yaml";
    options.json = true;
    options.members = 4;
    options.each = true;
  }
  [[nodiscard]] test::Ran plan() const { return test::run_verb(cli::run_plan, options); }
};

}  // namespace

TEST_CASE("the plan of each member is the one that is made when that member is the forecast") {
  EachDesk desk;
  const auto said = desk.plan();
  INFO(said.err);
  REQUIRE(said.code == 0);
  const auto document = nlohmann::json::parse(said.out);
  const auto& all = document["ensemble_plans"];
  REQUIRE(all["plans"].size() == 4);
  CHECK(all["members"] == 4);
  CHECK(all["arrived"] == 3);
  for (std::uint32_t k = 0; k < 4; ++k) {
    INFO(k);
    auto alone = desk.options;
    alone.members = 0;
    alone.each = false;
    alone.member = k;
    const auto plan = nlohmann::json::parse(test::run_verb(cli::run_plan, alone).out);
    const auto& here = all["plans"][k];
    CHECK(here["member"] == k);
    CHECK(here["method"] == plan["method"]);
    CHECK(here["travel_time_s"] == plan["travel_time_s"]);
    CHECK(here["remaining_distance_m"] == plan["remaining_distance_m"]);
    CHECK(here["first_heading_deg"] == plan["stints"][0]["heading_deg"]);
  }
  CHECK(all["plans"][0]["first_turn_deg"] == 0);
  CHECK(all["plans"][0]["apart_m"] == 0);
  // With water that runs north the glider heads south of east: to the right.
  CHECK(all["plans"][2]["first_turn_deg"] > 3);
  CHECK(all["plans"][3]["travel_time_s"].is_null());
  // Three arrive: with the current sooner than the control, against it later.
  CHECK(all["travel_time_s"]["median"] == all["plans"][0]["travel_time_s"]);
  CHECK(all["travel_time_s"]["p90"] > all["plans"][0]["travel_time_s"]);
}

TEST_CASE("plans of the members are the same bytes on one thread and on two") {
  EachDesk desk;
  auto world = test::field_world();
  std::ostringstream err;
  const auto c = cli::prepare_case(desk.options, world, err);
  INFO(err.str());
  REQUIRE(c);
  const auto on = [&](unsigned threads) {
    const auto plans = cli::plan_in_members(*c, std::nullopt, desk.options.members, false, world, err, threads);
    REQUIRE(plans);
    return cli::each_json(*plans).dump();
  };
  const auto once = on(1);
  CHECK(once.find("\"arrived\":2") != std::string::npos);  // of the three without the control
  CHECK(on(1) == once);
  CHECK(on(2) == once);
  CHECK(on(4) == once);
}

TEST_CASE("two runs of plan say the same bytes but for the time they took") {
  EachDesk desk;
  const auto say = [&] {
    auto document = nlohmann::ordered_json::parse(desk.plan().out);
    REQUIRE(document["statistics"].erase("wall_s") == 1);
    return document.dump();
  };
  const auto once = say();
  CHECK(once.size() > 1000);
  CHECK(say() == once);
}

TEST_CASE("the sentences say how the plans of the members spread and which do not arrive") {
  EachDesk desk;
  desk.options.json = false;
  const auto out = desk.plan().out;
  CHECK(out.find("planned in each of 4 members: 3 of the plans arrive, after ") != std::string::npos);
  CHECK(out.find("first heading from ") != std::string::npos);
  CHECK(out.find("the ways stray ") != std::string::npos);
  CHECK(out.find("member   3: its plan comes within ") != std::string::npos);
}

TEST_CASE("plans for each member need an ensemble and name the member that is not there") {
  EachDesk desk;
  desk.options.members = 0;
  CHECK(desk.plan().code == 2);
  CHECK(desk.plan().err.find("--each: there is no ensemble") != std::string::npos);
  desk.options.members = 6;
  const auto said = desk.plan();
  CHECK(said.code == 1);
  CHECK(said.err.find("member 4: ") != std::string::npos);
}
