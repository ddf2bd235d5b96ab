#include "simulator/simulation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::EndPlan;
using simulator::GliderPlan;
using simulator::MemoryToGlider;
using simulator::RunEnd;
using simulator::Simulation;

namespace {

GliderPlan plan_to(double goal_km, const std::string& name = "sim01") {
  GliderPlan p;
  p.setup.name = name;
  p.setup.start = geo_point(40, 5);
  p.setup.start_s = 1.7e9;
  p.setup.cycle_s = 20;
  p.goal = destination(p.setup.start, Bearing{degrees(45)}, Metres{goal_km * 1e3});
  p.setup.list.waypoints = {p.goal};
  p.setup.list.radius = Metres{500};
  p.setup.list.initial = 0;
  return p;
}

std::string run(Simulation& sim) {
  std::string all;
  Instant last{};
  while (const auto next = sim.next_event()) {
    REQUIRE(*next >= last);
    last = *next;
    for (auto& o : sim.step()) all += std::to_string(o.glider) + o.event.bytes;
  }
  return all;
}

}  // namespace

TEST_CASE("a glider that is sent to its goal in still water arrives when speed and schedule say") {
  MemoryToGlider folder;
  Simulation sim{{{plan_to(20), &folder}}, {kStill, kStill}, kOpen, EndPlan{}, 1};
  run(sim);
  REQUIRE(sim.result(0).end == RunEnd::arrived);
  CHECK(sim.all_arrived());
  // 18 km to the radius at 0.3 m/s: 60 000 s of flight, 4.17 stints; before the first dive 60 + 900 s, and the same
  // before each of four more. Interpolation inside a cycle of 6 m: 20 s at most.
  CHECK(*sim.result(0).arrived_s - 1.7e9 == Approx(60'000 + 5 * 960).margin(20));
  CHECK(sim.result(0).surfacings == 6);
  CHECK(sim.dives(0).size() == 5);
  CHECK(sim.surfacings(0).size() == 6);
}

TEST_CASE("the same plans and seeds give the same bytes, another seed gives others") {
  const auto bytes = [](std::uint64_t seed) {
    MemoryToGlider a, b;
    auto one = plan_to(200, "one"), two = plan_to(14, "two");
    one.lost_calls.probability = 0.4;
    one.setup.stint_jitter = two.setup.stint_jitter = 0.05;
    two.setup.seed = 7;
    Simulation sim{{{one, &a}, {two, &b}}, {kUniform, kUniform}, kOpen, EndPlan{true, 12, std::nullopt}, seed};
    return run(sim);
  };
  const auto first = bytes(1);
  CHECK(first.size() > 10'000);
  CHECK((first == bytes(1)));  // in brackets: a failure must not print megabytes
  CHECK((first != bytes(2)));
}

TEST_CASE("a file offered during the call is flown in the next dive") {
  MemoryToGlider folder;
  Simulation sim{{{plan_to(60), &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 2, std::nullopt}, 1};
  bool offered = false;
  while (sim.next_event()) {
    for (const auto& o : sim.step())
      if (!offered && o.event.bytes.find("at surface.") != std::string::npos) {
        folder.offer("goto_l10.ma",
                     "behavior_name=goto_list\n<start:b_arg>\nb_arg: initial_wpt(enum) 0\n<end:b_arg>\n"
                     "<start:waypoints>\n400.0 4000.0\n<end:waypoints>\n");
        offered = true;
      }
  }
  REQUIRE(sim.dives(0).size() == 1);
  CHECK(sim.dives(0)[0].truth.heading.degrees() == Approx(270).margin(0.5));
  CHECK(sim.result(0).lists_taken == 1);
}

TEST_CASE("runs end after their surfacings or days, and say so") {
  MemoryToGlider folder;
  Simulation few{{{plan_to(600), &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 3, std::nullopt}, 1};
  run(few);
  CHECK(few.result(0).end == RunEnd::surfacings);
  CHECK(few.result(0).surfacings == 3);
  Simulation brief{{{plan_to(600), &folder}}, {kStill, kStill}, kOpen, EndPlan{true, std::nullopt, 1.0}, 1};
  run(brief);
  CHECK(brief.result(0).end == RunEnd::days);
  CHECK_FALSE(brief.all_arrived());
}

TEST_CASE("an accident ends the run of its glider only") {
  FormulaField small = kStill;
  small.limits.north = degrees(40.03).si();
  MemoryToGlider a, b;
  auto there = plan_to(2, "near");
  there.goal_radius = Metres{500};
  Simulation sim{{{plan_to(60, "far"), &a}, {there, &b}}, {small, small}, kOpen, EndPlan{}, 1};
  run(sim);
  CHECK(sim.result(0).end == RunEnd::accident);
  CHECK(sim.result(0).reason.find("left the area of the true ocean") == 0);
  CHECK(sim.result(1).end == RunEnd::arrived);
}

TEST_CASE("a bad list ends the mission and is counted") {
  MemoryToGlider folder;
  folder.offer("goto_l10.ma", "behavior_name=goto_list\n<start:b_arg>\nb_arg: nonsense(m) 1\n<end:b_arg>\n");
  Simulation sim{{{plan_to(60), &folder}}, {kStill, kStill}, kOpen, EndPlan{}, 1};
  run(sim);
  CHECK(sim.result(0).end == RunEnd::behaviour_error);
  CHECK(sim.result(0).behaviour_errors == 1);
  CHECK(sim.result(0).reason == "bad goto list after Ctrl-F, line 3, column 8: unknown b_arg nonsense");
}

TEST_CASE("faults strike the surfacings that they name, and by chance as often as they should") {
  MemoryToGlider folder;
  auto named = plan_to(600);
  named.lost_calls.surfacings = {2, 3};
  named.redial.surfacings = {4};
  Simulation sim{{{named, &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 5, std::nullopt}, 1};
  run(sim);
  for (const auto& s : sim.surfacings(0)) {
    CHECK(s.faults.lost == (s.number == 2 || s.number == 3));
    CHECK(s.faults.redial == (s.number == 4));
  }
  auto chance = plan_to(6000);
  chance.not_taken.probability = 0.3;
  chance.setup.cycle_s = 600;
  Simulation many{{{chance, &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 400, std::nullopt}, 5};
  run(many);
  int struck = 0;
  for (const auto& s : many.surfacings(0)) struck += s.faults.not_taken ? 1 : 0;
  // Binomial(400, 0.3): mean 120, deviation 9.2; four deviations.
  CHECK(std::abs(struck - 120) < 37);
}

namespace {

/// Everything that came over the line of one glider: epoch seconds and events.
std::vector<std::pair<double, simulator::LineEvent>> events_of(Simulation& sim) {
  std::vector<std::pair<double, simulator::LineEvent>> all;
  while (const auto next = sim.next_event())
    for (auto& o : sim.step()) all.emplace_back(epoch_seconds(*next), std::move(o.event));
  return all;
}

}  // namespace

TEST_CASE("a slow line passes its bytes second by second and in order") {
  const auto fly = [](bool slow) {
    MemoryToGlider folder;
    auto plan = plan_to(200);
    if (slow) plan.line.slow.surfacings = {1};
    plan.line.setup.slow_bytes_per_s = 100;
    Simulation sim{{{plan, &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 1, std::nullopt}, 1};
    return events_of(sim);
  };
  const auto fast = fly(false), slow = fly(true);
  std::string at_once, spread;
  for (const auto& [t, e] : fast) at_once += e.bytes;
  for (const auto& [t, e] : slow) {
    CHECK(e.bytes.size() <= 500);  // 5 s of 100 bytes
    spread += e.bytes;
  }
  CHECK(spread == at_once);
  // A second never passes more than it may: of any two pieces the later is 5 s later, but for the first of a print.
  CHECK(slow.size() > 2 * fast.size());
  CHECK(slow[1].first - slow[0].first == Approx(5).margin(1e-2));
}

TEST_CASE("each connection has a log that holds its bytes, named by when it began") {
  MemoryToGlider folder;
  auto plan = plan_to(200);
  plan.redial.surfacings = {1};
  plan.call.firmware = simulator::Firmware::g1;
  Simulation sim{{{plan, &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 2, std::nullopt}, 1};
  std::string all;
  for (const auto& [t, e] : events_of(sim)) all += e.bytes;
  REQUIRE(folder.logs().size() == 3);
  std::string logged;
  for (const auto& log : folder.logs()) {
    CHECK(log.glider == "sim01");
    CHECK(log.medium == "modem");
    logged += log.bytes;
  }
  CHECK(logged == all);
  CHECK(epoch_seconds(folder.logs()[0].opened) == Approx(1.7e9 + 105));
  CHECK(epoch_seconds(folder.logs()[1].opened) == Approx(1.7e9 + 105 + 15 + 20 + 45));
  CHECK(sim.surfacings(0)[0].connections == 2);
  CHECK(sim.surfacings(0)[0].bytes + sim.surfacings(0)[1].bytes == all.size());
}

TEST_CASE("the simulator counts the fix lines that left whole") {
  const auto fly = [](const std::function<void(GliderPlan&)>& change) {
    MemoryToGlider folder;
    auto plan = plan_to(200);
    change(plan);
    Simulation sim{{{plan, &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 1, std::nullopt}, 1};
    while (sim.next_event()) sim.step();
    return sim.surfacings(0)[0].whole_fixes;
  };
  CHECK(fly([](GliderPlan&) {}) == 14);  // the connection block and 13 at the surface
  CHECK(fly([](GliderPlan& p) { p.lost_calls.surfacings = {1}; }) == 0);
  CHECK(fly([](GliderPlan& p) { p.line.duplicated.surfacings = {1}; }) == 28);
  const int garbled = fly([](GliderPlan& p) {
    p.line.garbled.surfacings = {1};
    p.line.setup.garbled_per_kilobyte = 20;
  });
  // A line of 76 bytes stays whole with e^(−0.02·76) = 22 %: of 14 lines 3, and not all of them.
  CHECK(garbled < 10);
}

TEST_CASE("the older faults strike when they did before the newer ones were there") {
  const auto struck = [](bool more) {
    MemoryToGlider folder;
    auto plan = plan_to(300);
    plan.lost_calls.probability = 0.3;
    if (more) plan.line.garbled.probability = plan.line.wrong_keys.probability = 0.5;
    Simulation sim{{{plan, &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 12, std::nullopt}, 5};
    while (sim.next_event()) sim.step();
    std::vector<bool> lost;
    for (const auto& r : sim.surfacings(0)) lost.push_back(r.faults.lost);
    return lost;
  };
  CHECK(struck(false) == struck(true));
}

TEST_CASE("an aborted mission ends the run, or goes on from call to call as lastgasp.mi and tells why") {
  for (const int calls : {0, 3}) {
    MemoryToGlider folder;
    auto plan = plan_to(60);
    plan.setup.aborts.max_wpt_distance = Metres{50'000};
    plan.setup.aborts.fallback_calls = calls;
    Simulation sim{{{plan, &folder}}, {kStill, kStill}, kOpen, EndPlan{}, 1};
    const auto said = run(sim);
    CHECK(sim.result(0).end == RunEnd::aborted);
    CHECK(sim.result(0).reason.find("MS_ABORT_WPT_TOOFAR(18)") == 0);
    CHECK(sim.result(0).surfacings == 2 + calls);  // before the dive, after it, and the fallback's
    CHECK((said.find("MissionName:lastgasp.mi") != std::string::npos));
    CHECK((said.find("ABORT HISTORY: total since reset: 1") != std::string::npos));
    CHECK((said.find("MS_ABORT_WPT_TOOFAR") != std::string::npos));
  }
}

TEST_CASE("a bad list is followed by the fallback when there is one") {
  MemoryToGlider folder;
  folder.offer("goto_l10.ma", "behavior_name=goto_list\n");
  auto plan = plan_to(30);
  plan.setup.aborts.fallback_calls = 1;
  Simulation sim{{{plan, &folder}}, {kStill, kStill}, kOpen, EndPlan{}, 1};
  run(sim);
  CHECK(sim.result(0).end == RunEnd::aborted);
  CHECK(sim.result(0).reason.find("MS_ABORT_BEH_ERROR(6)") == 0);
}

TEST_CASE("the dialog names the behaviour that brought the glider up, and an old or invalid fix") {
  MemoryToGlider folder;
  auto plan = plan_to(200);
  plan.setup.surfacing.every_s = 3600;
  plan.setup.gps.stale.surfacings = {3};
  plan.setup.gps.invalid.surfacings = {4};
  plan.setup.energy.battery_wh = 1000;
  Simulation sim{{{plan, &folder}}, {kStill, kStill}, kOpen, EndPlan{true, 4, std::nullopt}, 1};
  const auto said = run(sim);
  CHECK((said.find("Because:timeout expired [behavior surface_6 start_when = 9.0]") != std::string::npos));
  REQUIRE(sim.surfacings(0).size() == 4);
  const auto& third = sim.surfacings(0)[2];
  CHECK_FALSE(third.fix_is_fresh);
  CHECK(third.fix_s == sim.surfacings(0)[1].fix_s);
  // The fix of the second surfacing is printed with its age: a dive of at least an hour and the interval before it.
  CHECK(third.dive_s - third.fix_s > 3600 + 900);
  CHECK(third.dive_s - third.surfaced_s == Approx(960));
  CHECK(sim.surfacings(0)[3].fix_s == third.fix_s);
  CHECK(sim.glider(0).invalid_fix());
  CHECK(sim.result(0).energy.call_wh == Approx(4 * 6.0 * (900 - 45 - 60) / 3600).epsilon(1e-9));
  CHECK(sim.result(0).energy.total_wh() > sim.surfacings(0)[1].energy.total_wh());
}
