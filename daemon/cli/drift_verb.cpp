#include "daemon/cli/drift_verb.hpp"

#include <iostream>
#include <memory>

#include "daemon/cli/drift.hpp"

namespace glidehelm::cli {

void add_drift(CLI::App& app, Action& action) {
  struct Words {
    DriftOptions options;
    std::string from, at;
    bool is_float{};
    double depth_m{}, hours{240}, every_min{360};
    double park_m{1000}, profile_m{2000}, cycle_h{240}, surface_min{30}, vertical{0.10};
  };
  auto o = std::make_shared<Words>();
  auto* verb = app.add_subcommand("drift", "Where a drifter or a profiling float goes in a mission's currents");
  verb->add_option("MISSION", o->options.mission, "Mission file, for start, currents and coast")->required();
  const auto number = [verb](const char* name, double& value, const char* what, double least, double most) {
    return verb->add_option(name, value, what)->capture_default_str()->check(CLI::Range(least, most));
  };
  auto* depth = number("--depth", o->depth_m, "Metres at which the drifter drifts", 0, 12000);
  auto* is_float = verb->add_flag("--float", o->is_float, "A float that parks, profiles and surfaces")->excludes(depth);
  number("--park", o->park_m, "Metres at which the float parks", 0, 12000)->needs(is_float);
  number("--profile", o->profile_m, "Metres at which its profile begins", 0, 12000)->needs(is_float);
  number("--cycle", o->cycle_h, "Hours from one dive to the next", 0.1, 10000)->needs(is_float);
  number("--surface", o->surface_min, "Minutes of each cycle at the surface", 0, 10000)->needs(is_float);
  number("--vertical-speed", o->vertical, "Of the float when it sinks or rises, m/s", 0.01, 2)->needs(is_float);
  auto* from = verb->add_option("--from", o->from, "LAT,LON of the start, degrees (default: the mission's start)");
  auto* at = verb->add_option("--at", o->at, "UTC of the start (default: the mission's start time, else now)");
  number("--hours", o->hours, "How long, hours", 0, 100'000);
  number("--every", o->every_min, "Minutes between the places that are told", 1, 100'000);
  verb->add_option(
          "--members", o->options.members,
          "Drift in the members 0 to N - 1 of the forecast's ensemble too: how they spread (default: in all of "
          "the mission's currents.ensemble)")
      ->check(CLI::Range(1, 100'000));
  verb->add_flag("--json", o->options.json, "One JSON document on standard output (schema glidehelm/drift/v1)");
  verb->footer(
      "Neither steers: the currents of the mission carry them. A drifter stays at one depth. A float sinks, drifts\n"
      "parked, sinks on, rises and drifts at the surface, again and again; where the water ends above its depth the\n"
      "deepest current carries it. Wind is not in it. The drift ends early where the forecast does, and on land.\n"
      "\n"
      "Examples:\n"
      "  glidehelm drift leg-2.yaml --hours 48 --every 60      # where would a disabled glider be in two days?\n"
      "  glidehelm drift leg-2.yaml --depth 15 --from 28.2,-15.2\n"
      "  glidehelm drift leg-2.yaml --float --park 500 --profile 1000 --cycle 24\n"
      "\n"
      "Exit: 0 afloat at the end of the time or of the forecast, 1 it ends otherwise, 2 usage.");
  verb->callback([=, &action] {
    if (*from) o->options.from = pair_from(o->from, "--from");
    if (*at) o->options.at = time_from(o->at, "--at");
    o->options.duration = Seconds{o->hours * 3600};
    o->options.every = Seconds{o->every_min * 60};
    if (o->is_float)
      o->options.vehicle =
          vehicle::ProfilingFloat{Metres{o->park_m}, Metres{o->profile_m}, MetresPerSecond{o->vertical},
                                  Seconds{o->cycle_h * 3600}, Seconds{o->surface_min * 60}};
    else
      o->options.vehicle = vehicle::Drifter{Metres{o->depth_m}};
    action = [o](world::World& w) { return run_drift(o->options, w, std::cout, std::cerr); };
  });
}

}  // namespace glidehelm::cli
