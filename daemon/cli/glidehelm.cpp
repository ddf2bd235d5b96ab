#include <CLI/CLI.hpp>
#include <iostream>

#include "daemon/cli/arguments.hpp"
#include "daemon/cli/check.hpp"
#include "daemon/cli/coast.hpp"
#include "daemon/cli/compare.hpp"
#include "daemon/cli/drift_verb.hpp"
#include "daemon/cli/field_verbs.hpp"
#include "daemon/cli/mafile.hpp"
#include "daemon/cli/plan.hpp"
#include "daemon/cli/polar.hpp"
#include "daemon/cli/rehearse.hpp"
#include "daemon/cli/replay.hpp"
#include "daemon/world/program_version.hpp"
#include "daemon/world/real.hpp"
#include "daemon/world/terminal.hpp"

namespace {

using namespace glidehelm;
using cli::Action;
using cli::pair_from;
using cli::time_from;

constexpr const char* kHelp =
    "Planning and looking for pilots of underwater gliders. Every verb that reads takes --json.\n"
    "Exit codes: 0 done, 1 a finding or a negative answer, 2 usage, 4 refused by safety, 5 deadline missed.";

void add_check(CLI::App& app, Action& action) {
  auto o = std::make_shared<cli::CheckOptions>();
  auto* verb =
      app.add_subcommand("check", "Every error of mission and daemon files, with line, column and nearest key");
  verb->add_option("FILE", o->files, "Mission or daemon files, told apart by `schema:`")->required();
  verb->add_flag("--effective", o->effective, "Print the values in force and where each comes from");
  verb->add_flag("--json", o->json, "One JSON document on standard output");
  verb->callback(
      [o, &action] { action = [o](world::World& w) { return cli::run_check(*o, w, std::cout, std::cerr); }; });
}

void add_plan(CLI::App& app, Action& action) {
  struct Words {
    cli::PlanOptions options;
    std::string from, at, water;
    double budget{};
  };
  auto o = std::make_shared<Words>();
  auto* verb = app.add_subcommand("plan", "Plan a mission once, offline");
  verb->add_option("MISSION", o->options.mission, "Mission file (schema glidehelm/mission/v1)")->required();
  verb->add_option("--method", o->options.method,
                   "direct, astar, cts-astar, abs-cts-astar, tve, astar-tve, ztve, zastar-tve, cts-astar-refined, rrt, "
                   "optimization, iterative-optimization, zermelo or best (default: the mission's)");
  auto* from = verb->add_option("--from", o->from, "LAT,LON of the fix, degrees (default: the mission's start)");
  auto* at = verb->add_option("--at", o->at, "UTC of the fix (default: the mission's start time, else now)");
  auto* water = verb->add_option("--water", o->water, "E,N: measured current that the glider believes, m/s");
  auto* seed = verb->add_option("--seed", "For methods that draw");
  auto* budget =
      verb->add_option("--budget", o->budget,
                       "Seconds; without it every stage runs to its work limit and the answer is deterministic")
          ->check(CLI::PositiveNumber);
  auto* member = verb->add_option_function<std::uint32_t>(
                         "--member", [o](std::uint32_t k) { o->options.member = k; },
                         "Plan in this member of the forecast's ensemble, counted from 0 (default 0)")
                     ->check(CLI::Range(0, 99'999));
  verb->add_option(
          "--members", o->options.members,
          "Fly the plan in the members 0 to N - 1 too: who arrives, when, how near the coast (default: in all of "
          "the mission's currents.ensemble)")
      ->check(CLI::Range(1, 100'000))
      ->excludes(member);
  verb->add_flag("--each", o->options.each,
                 "Plan anew in each of those members: how arrivals, first headings and ways spread")
      ->excludes(member)
      ->excludes(budget);
  verb->add_option("--goto", o->options.goto_file, "Write the verified goto list to this new file");
  verb->add_flag("--json", o->options.json, "One JSON document on standard output (schema glidehelm/plan/v1)");
  verb->callback([=, &action] {
    if (*from) o->options.from = pair_from(o->from, "--from");
    if (*at) o->options.at = time_from(o->at, "--at");
    if (*water) o->options.water = pair_from(o->water, "--water");
    if (*seed) o->options.seed = seed->as<std::uint64_t>();
    if (*budget) o->options.budget = Seconds{o->budget};
    action = [o](world::World& w) { return cli::run_plan(o->options, w, std::cout, std::cerr); };
  });
}

void add_rehearse(CLI::App& app, Action& action) {
  struct Words {
    cli::RehearseOptions options;
    std::string from, at;
  };
  auto o = std::make_shared<Words>();
  auto& r = o->options;
  auto* verb = app.add_subcommand("rehearse", "Fly a mission in simulated oceans that differ from the forecast");
  verb->add_option("MISSION", r.plan.mission, "Mission file (schema glidehelm/mission/v1)")->required();
  verb->add_option("--truth", r.truth,
                   "Forecast files that play the ocean (default: the mission's forecast, perturbed; then --noise, "
                   "--shift and --late do nothing)");
  verb->add_option("--seeds", r.seeds, "Oceans to fly in, seeds 1 to N")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  verb->add_option("--method", r.plan.method,
                   "direct, astar, cts-astar, abs-cts-astar, tve, astar-tve, ztve, zastar-tve, cts-astar-refined, rrt, "
                   "optimization, iterative-optimization, zermelo or best (default: the mission's)");
  auto* from = verb->add_option("--from", o->from, "LAT,LON of the start, degrees (default: the mission's start)");
  auto* at = verb->add_option("--at", o->at, "UTC of the start (default: the mission's start time, else now)");
  verb->add_option("--delays", r.delays_h, "Hours by which the departure is put off, e.g. 0,6,12 (default: 0)")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 10000.0));
  verb->add_option("--noise", r.noise_m_per_s, "Speed of eddies that the forecast does not have, m/s")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 2.0));
  verb->add_option("--shift", r.shift_km, "How far everything lies elsewhere, km")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 500.0));
  verb->add_option("--late", r.late_h, "How much earlier or later everything happens at most, hours")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 240.0));
  verb->add_option("--html", r.html, "Write one page with map and table to this new file");
  verb->add_flag("--json", r.json, "One JSON document on standard output (schema glidehelm/rehearsal/v1)");
  verb->footer(
      "In every ocean the real pilot flies a simulated glider twice from every departure: by the mission's method, and "
      "by\n"
      "`direct`. Ocean and glider are drawn from the seed: the glider's speed differs by 3 % at most, its compass by "
      "2\n"
      "degrees, its stints by 3 %. Nothing is drawn otherwise: the same command says the same.\n"
      "\n"
      "Examples:\n"
      "  glidehelm rehearse leg-2.yaml --html leg-2.html\n"
      "  glidehelm rehearse leg-2.yaml --seeds 20 --delays 0,6,12,18   # when is the best time to leave?\n"
      "  glidehelm rehearse leg-2.yaml --truth yesterday/*.nc --seeds 3\n"
      "\n"
      "Columns: median and 10-90 % of the travel times of those that arrived; regret, by how much they are longer than "
      "the\n"
      "plan of somebody who knew the ocean; missed, surface intervals in which no new list reached the glider; "
      "refused, files\n"
      "that the verifier did not accept; coast, the closest of all flights; energy, of a flight (median).\n"
      "Exit: 0 every flight of the mission's method arrived, 1 one did not or nothing can be flown, 2 usage.");
  verb->callback([=, &action] {
    o->options.progress =
        world::is_terminal(2) ? cli::RehearseOptions::Progress::bar : cli::RehearseOptions::Progress::lines;
    if (*from) o->options.plan.from = pair_from(o->from, "--from");
    if (*at) o->options.plan.at = time_from(o->at, "--at");
    action = [o](world::World& w) { return cli::run_rehearse(o->options, w, std::cout, std::cerr); };
  });
}

void add_compare(CLI::App& app, Action& action) {
  struct Words {
    cli::CompareOptions options;
    std::string from, at;
    double budget{};
  };
  auto o = std::make_shared<Words>();
  auto& c = o->options;
  auto* verb = app.add_subcommand("compare", "Plan missions with every method and hold the plans against each other");
  verb->add_option("MISSION", c.missions, "Mission files (schema glidehelm/mission/v1)")->required();
  verb->add_option("--methods", c.methods, "Only these, e.g. direct,best (default: all)")->delimiter(',');
  auto* from = verb->add_option("--from", o->from, "LAT,LON of the fix, degrees (default: each mission's start)");
  auto* at = verb->add_option("--at", o->at, "UTC of the fix (default: the mission's start time, else now)");
  auto* seed = verb->add_option("--seed", "For methods that draw");
  auto* budget = verb->add_option("--budget", o->budget, "Seconds for each method (default: until its work is done)")
                     ->check(CLI::PositiveNumber);
  verb->add_flag("!--no-bound", c.bound, "Without the lower bound (it takes a few seconds on long ways)");
  verb->add_option("--html", c.html, "Write one page with tables and maps to this new file");
  verb->add_flag("--json", c.json, "One JSON document on standard output (schema glidehelm/comparison/v1)");
  verb->footer(
      "All methods see the same currents, coast, schedule and glider; the best comes first. `above bound` says by how "
      "much a\n"
      "plan is slower than the earliest arrival that any vehicle of this speed could have, whatever it steers: the "
      "rest "
      "is not\n"
      "to be had. `made by` names the stage whose plan it is.\n"
      "\n"
      "Examples:\n"
      "  glidehelm compare leg-2.yaml\n"
      "  glidehelm compare leg-*.yaml --methods direct,cts-astar,best --html methods.html\n"
      "\n"
      "Exit: 0 some method reaches every goal, 1 none reaches one of them, 2 usage.");
  verb->callback([=, &action] {
    if (*from) o->options.plan.from = pair_from(o->from, "--from");
    if (*at) o->options.plan.at = time_from(o->at, "--at");
    if (*seed) o->options.plan.seed = seed->as<std::uint64_t>();
    if (*budget) o->options.plan.budget = Seconds{o->budget};
    action = [o](world::World& w) { return cli::run_compare(o->options, w, std::cout, std::cerr); };
  });
}

void add_polar(CLI::App& app, Action& action) {
  auto o = std::make_shared<cli::PolarOptions>();
  auto* verb = app.add_subcommand("polar", "Speeds of a glider by pitch and pump volume: the spider plot");
  verb->add_option("MISSION", o->mission, "Mission file with vehicle.force_balance (default: that section's defaults)");
  verb->add_flag("--forecast", o->forecast,
                 "In the temperature and salinity of the mission's forecast, as plans take it");
  verb->add_option("--depth", o->depth_m, "Metres: where the water's density is taken")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 6000.0));
  verb->add_option("--csv", o->csv, "Write every point to this new file");
  verb->add_option("--svg", o->svg, "Draw it into this new file");
  verb->add_flag("--json", o->json, "One JSON document on standard output (schema glidehelm/polar/v1)");
  verb->footer(
      "The forces of lift, drag, buoyancy and weight decide how fast a glider goes. Put hull, pump and pitch into\n"
      "vehicle.force_balance of the mission, and plans use the speed and glide angle that follow. Example:\n"
      "  glidehelm polar leg-2.yaml --svg polar.svg\n"
      "\n"
      "Exit: 0 done, 1 the mission's trim does not fly or its forecast is not read, 2 usage.");
  verb->callback(
      [o, &action] { action = [o](world::World& w) { return cli::run_polar(*o, w, std::cout, std::cerr); }; });
}

void add_replay(CLI::App& app, Action& action) {
  auto o = std::make_shared<cli::ReplayOptions>();
  auto* verb = app.add_subcommand("replay", "Every surfacing of dialog logs, and why a fix is refused");
  verb->add_option("LOG", o->logs, "Dialog logs of a dockserver or terminal")->required();
  verb->add_option("--glider", o->glider, "Only this glider's");
  verb->add_flag("--json", o->json, "One JSON document on standard output");
  verb->callback(
      [o, &action] { action = [o](world::World& w) { return cli::run_replay(*o, w.files, std::cout, std::cerr); }; });
}

void add_mafile(CLI::App& app, Action& action) {
  struct Words {
    cli::MafileOptions options;
    std::string near;
  };
  auto o = std::make_shared<Words>();
  auto* verb = app.add_subcommand("mafile", "Read a mafile: b_args, waypoints, problems with line and column");
  verb->add_option("FILE", o->options.file, "A goto_list, surface, yo, sample or other mafile")->required();
  auto* near =
      verb->add_option("--near", o->near, "LAT,LON of the glider, degrees: finds decimal degrees taken for DDMM");
  verb->add_flag("--strict", o->options.strict, "As strict as for our own files");
  verb->add_flag("--json", o->options.json, "One JSON document on standard output");
  verb->callback([=, &action] {
    if (*near) {
      const auto [lat, lon] = pair_from(o->near, "--near");
      const auto point = GeoPoint::from_degrees(lat, lon);
      if (!point) throw CLI::ValidationError{"--near", point.error().message()};
      o->options.near = *point;
    }
    action = [o](world::World& w) { return cli::run_mafile(o->options, w.files, std::cout, std::cerr); };
  });
}

void add_coast(CLI::App& app, Action& action) {
  auto o = std::make_shared<cli::CoastOptions>();
  auto* verb = app.add_subcommand("coast", "Cut a coastline from GSHHG full resolution (Debian: gmt, gmt-gshhg-full)");
  verb->add_option("--area", o->areas,
                   "W/E/S/N in degrees, e.g. -19/-12/26.5/30: cut from GSHHG. Again for another area in the same file; "
                   "what lies between them is forbidden")
      ->take_all();
  verb->add_option("--from", o->from, "Start from this .coast file instead");
  verb->add_option("--grow", o->grow_m, "Metres: all water this near to land becomes land");
  verb->add_option(
      "--simplify", o->simplify_m,
      "Metres: fewer corners, on the safe side. No land is lost, no water farther from it than --grow plus "
      "this becomes land, islands stay (100 with --grow alone)");
  verb->add_option("-o,--output", o->output, "The .coast file")->required();
  verb->footer(
      "The coast file is what missions name in safety.coast. Cut it once, wider than the operating area: what it does "
      "not\n"
      "chart is forbidden. Examples:\n"
      "  glidehelm coast --area -19/-12/26.5/30 -o canaries.coast\n"
      "  glidehelm coast --from canaries.coast --grow 3000 --simplify 200 -o canaries-3km.coast\n"
      "The shore of the second lies 3000 to 3200 m off that of the first, never nearer.");
  verb->callback(
      [o, &action] { action = [o](world::World& w) { return cli::run_coast(*o, w, std::cout, std::cerr); }; });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{kHelp, "glidehelm"};
  app.set_version_flag("--version", std::string{"glidehelm "} + world::program_version());
  app.require_subcommand(1);
  Action action;
  add_check(app, action);
  add_plan(app, action);
  add_compare(app, action);
  add_rehearse(app, action);
  cli::add_drift(app, action);
  add_polar(app, action);
  add_replay(app, action);
  add_mafile(app, action);
  cli::add_field(app, action);
  add_coast(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  world::RealWorld real;
  auto w = real.world();
  return action(w);
}
