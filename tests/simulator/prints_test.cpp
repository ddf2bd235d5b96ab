#include "simulator/prints.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using namespace glidehelm::simulator;

namespace {

GliderPlan plan() {
  GliderPlan p;
  p.setup.start = geo_point(40, 5);
  p.setup.start_s = 1.7e9;
  p.setup.cycle_s = 20;
  p.goal = destination(p.setup.start, Bearing{}, Metres{6000});
  p.setup.list.waypoints = {p.goal};
  p.setup.list.initial = 0;
  return p;
}

}  // namespace

TEST_CASE("a surfacing is one line: time, glider, fix, current, file, distance") {
  SurfacingRecord r;
  r.number = 3;
  r.fix_s = 1.7e9;
  r.fix = geo_point(40.5, -5.25);
  r.to_goal = Metres{12'340};
  r.call.note = "to-glider was empty";
  CHECK(surfacing_line(r, plan()) ==
        "2023-11-14T22:13:20Z sim01 surfacing 3: fix 40.50000,-5.25000 DAC none file none (to-glider was empty) goal "
        "12.3 km");
  r.water = water(0.1, -0.25);
  r.call.list = OfferedFile{"goto_l10.ma", ""};
  r.call.reread = true;
  r.faults.redial = true;
  CHECK(surfacing_line(r, plan()) ==
        "2023-11-14T22:13:20Z sim01 surfacing 3: fix 40.50000,-5.25000 DAC +0.100,-0.250 m/s file goto_l10.ma taken, "
        "re-read goal "
        "12.3 km redialled");
}

TEST_CASE("a run's end is one line, and one JSON document with the seed") {
  MemoryToGlider folder;
  Simulation sim{{{plan(), &folder}}, {kUniform, kUniform}, kOpen, EndPlan{}, 9};
  while (sim.next_event()) sim.step();
  CHECK(result_line(sim.result(0), plan()).find("sim01: arrived at 2023-11-1") == 0);
  const auto json = nlohmann::json::parse(results_json(sim, 9));
  CHECK(json["schema"] == "glidehelm/glidersim/v1");
  CHECK(json["seed"] == 9);
  CHECK(json["gliders"][0]["arrived"] == true);
  CHECK(json["gliders"][0]["track"].size() == sim.surfacings(0).size());
  CHECK(json["gliders"][0]["travel_time_s"].get<double>() == Approx(*sim.result(0).arrived_s - 1.7e9));
}

TEST_CASE("a run that did not arrive says why and how near it came") {
  MemoryToGlider folder;
  Simulation sim{{{plan(), &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 1, std::nullopt}, 9};
  while (sim.next_event()) sim.step();
  CHECK(result_line(sim.result(0), plan()) ==
        "sim01: surfacings (the scenario's number of surfacings), closest to the goal 6.0 km, 1 surfacings, 0 goto "
        "lists taken");
  CHECK(nlohmann::json::parse(results_json(sim, 9))["gliders"][0]["arrival"].is_null());
}
