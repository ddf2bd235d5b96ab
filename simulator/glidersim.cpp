#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "core/chart/coast.hpp"
#include "daemon/world/real.hpp"
#include "simulator/cdl.hpp"
#include "simulator/ocean_truth.hpp"
#include "simulator/prints.hpp"
#include "simulator/runner.hpp"
#include "simulator/scenario.hpp"

namespace {

using namespace glidehelm;
using namespace glidehelm::simulator;

constexpr int kDone = 0, kNegative = 1, kUsage = 2, kNoDaemon = 3;
constexpr std::size_t kLargestCoast = chart::Coast::kLargestFile;

struct RunOptions {
  std::string scenario, log;
  std::optional<double> realtime;
  std::optional<std::uint64_t> seed;
  bool json{}, alone{};
};

struct OceanOptions {
  std::string area, from, to, start, variant{"forecast"}, coast, output;
  CoastalSpec spec;
  CdlGrid grid;
};

int usage(const std::string& message) {
  std::cerr << "glidersim: " << message << '\n';
  return kUsage;
}

Expected<chart::Chart, std::string> chart_from(const std::string& path, world::Files& files) {
  if (path.empty()) return chart::Chart{};
  const auto bytes = files.read(path, kLargestCoast);
  if (!bytes) return unexpected(bytes.error().message());
  auto coast = chart::Coast::parse(*bytes);
  if (!coast) return unexpected(path + ": " + coast.error().message());
  return chart::Chart{chart::ChartSources{std::move(*coast), {}, {}}};
}

/// stdout, and the log file when one is wanted (written whole at the end: it is a record, not a stream).
class Teller {
 public:
  explicit Teller(bool quiet) : quiet_{quiet} {}
  void line(const std::string& text) {
    if (!quiet_) std::cout << text << '\n' << std::flush;
    record_ += text + "\n";
  }
  void aside(const std::string& text) {
    std::cerr << text << '\n';
    record_ += text + "\n";
  }
  [[nodiscard]] const std::string& record() const { return record_; }

 private:
  bool quiet_;
  std::string record_;
};

bool write_file(world::Files& files, const std::string& path, const std::string& bytes) {
  const auto slash = path.find_last_of('/');
  const auto folder_path = slash == std::string::npos ? std::string{"."}
                           : slash == 0               ? std::string{"/"}
                                                      : path.substr(0, slash);
  const auto name = slash == std::string::npos ? path : path.substr(slash + 1);
  auto folder = files.open_folder(folder_path);
  if (!folder) {
    std::cerr << "glidersim: " << folder.error().message() << '\n';
    return false;
  }
  if ((*folder)->stat(name)) {
    if (const auto gone = (*folder)->unlink(name); !gone) {
      std::cerr << "glidersim: " << gone.error().message() << '\n';
      return false;
    }
  }
  if (const auto made = (*folder)->create(name, bytes, 0644); !made) {
    std::cerr << "glidersim: " << made.error().message() << '\n';
    return false;
  }
  return true;
}

/// The lists that gliders start with, read by the gliders' own reader.
bool load_lists(Scenario& scenario, world::Files& files) {
  for (auto& glider : scenario.gliders) {
    if (glider.initial_list.empty()) continue;
    const auto bytes = files.read(glider.initial_list, 1U << 16);
    if (!bytes) {
      std::cerr << "glidersim: " << bytes.error().message() << '\n';
      return false;
    }
    auto list = read_goto_list(*bytes);
    if (!list) {
      std::cerr << "glidersim: " << glider.initial_list << ": " << list.error().message() << '\n';
      return false;
    }
    glider.plan.setup.list = std::move(*list);
  }
  return true;
}

std::optional<std::string> complaint(const Scenario& s, const RunOptions& o) {
  if (o.alone) return std::nullopt;
  if (s.clock.empty() && !o.realtime)
    return "the scenario names no `clock:` socket, so time cannot be handed to the daemon: name one, or give "
           "--realtime N";
  for (const auto& g : s.gliders)
    if (g.line.port == 0)
      return "glider " + g.plan.setup.name + " has no `line:`: say where its dialog goes, or give --alone";
  return std::nullopt;
}

int finish(const Simulation& simulation, const Scenario& scenario, const RunOptions& o, Teller& teller,
           world::Files& files) {
  for (std::size_t i = 0; i < simulation.count(); ++i)
    teller.line(result_line(simulation.result(i), simulation.plan(i)));
  if (o.json) std::cout << results_json(simulation, scenario.seed) << '\n';
  if (!o.log.empty() && !write_file(files, o.log, teller.record())) return kNegative;
  return simulation.all_arrived() ? kDone : kNegative;
}

int run(const RunOptions& o, world::World& world) {
  const auto text = world.files.read(o.scenario, config::kLargestFile);
  if (!text) return usage(text.error().message());
  auto scenario = read_scenario(*text, o.scenario, o.seed);
  if (!scenario) {
    for (const auto& error : scenario.error()) std::cerr << error.message() << '\n';
    return kUsage;
  }
  if (const auto wrong = complaint(*scenario, o)) return usage(*wrong);
  if (!load_lists(*scenario, world.files)) return kUsage;
  const auto chart = chart_from(scenario->coast, world.files);
  if (!chart) return usage("coast: " + chart.error());
  auto truth = OceanTruth::make(scenario->truth, scenario->start, chart->has_coast(), world.files);
  if (!truth) return usage(truth.error().message());

  Teller teller{o.json};
  teller.line("seed " + std::to_string(scenario->seed) + ", starts " + utc_text(scenario->start));
  std::vector<std::unique_ptr<ToGlider>> folders;
  std::vector<Runner::Port> ports;
  std::vector<Simulation::Member> members;
  for (const auto& g : scenario->gliders) {
    if (o.alone) {
      folders.push_back(std::make_unique<MemoryToGlider>());
    } else {
      auto folder = DockFolder::make(world.files, g.folder);
      if (!folder) return usage(folder.error().message());
      ports.push_back({g.plan.setup.name, g.line, folder->get()});
      folders.push_back(std::move(*folder));
    }
    members.push_back({g.plan, folders.back().get()});
  }
  std::unique_ptr<ForecastFeed> feed;
  if (!scenario->forecasts.folder.empty() && !o.alone) {
    auto made = ForecastFeed::make(world.files, scenario->forecasts, truth->model());
    if (!made) return usage("forecasts: " + made.error());
    feed = std::move(*made);
    if (const auto first = feed->publish(scenario->start); !first) return usage("forecasts: " + first.error());
  }
  Simulation simulation{std::move(members), truth->ocean(), *chart, scenario->end, scenario->seed};
  const auto surfaced = [&](const SurfacingRecord& r) { teller.line(surfacing_line(r, simulation.plan(r.glider))); };
  if (o.alone) {
    run_alone(simulation, surfaced);
    return finish(simulation, *scenario, o, teller, world.files);
  }
  const Pace pace{scenario->clock, o.realtime, scenario->charge_computing, scenario->daemon_wait_s};
  Runner runner{world.net,
                world.clock,
                simulation,
                std::move(ports),
                scenario->start,
                pace,
                {surfaced, [&](const std::string& said) { teller.aside("glidersim: " + said); },
                 [&](Instant now) {
                   if (!feed) return;
                   const auto published = feed->publish(now);
                   if (!published) teller.aside("glidersim: forecasts: " + published.error());
                   if (published && *published > 0) teller.line("forecast cycle published at " + utc_text(now));
                 }}};
  switch (runner.run()) {
    case RunOutcome::finished:
      break;
    case RunOutcome::no_daemon:
      return kNoDaemon;
    case RunOutcome::failed:
      return kUsage;
    case RunOutcome::stopped:
      return kNegative;
  }
  return finish(simulation, *scenario, o, teller, world.files);
}

/// Numbers separated by one character; nothing when there are not exactly `count`.
std::optional<std::vector<double>> numbers(const std::string& text, char separator, std::size_t count) {
  std::vector<double> found;
  std::size_t at = 0;
  while (at <= text.size()) {
    const auto end = std::min(text.find(separator, at), text.size());
    const auto value = number_from(trimmed(std::string_view{text}.substr(at, end - at)));
    if (!value) return std::nullopt;
    found.push_back(*value);
    at = end + 1;
  }
  if (found.size() != count) return std::nullopt;
  return found;
}

std::optional<GeoPoint> place(const std::string& text) {
  const auto pair = numbers(text, ',', 2);
  if (!pair) return std::nullopt;
  const auto p = GeoPoint::from_degrees((*pair)[0], (*pair)[1]);
  if (!p) return std::nullopt;
  return *p;
}

std::optional<std::string> fill(OceanOptions& o) {
  const auto area = numbers(o.area, '/', 4);
  if (!area) return "--area takes W/E/S/N in degrees, as in --area 3/5.5/40/42.5";
  auto& s = o.spec;
  s.west_deg = (*area)[0];
  s.east_deg = (*area)[1];
  s.south_deg = (*area)[2];
  s.north_deg = (*area)[3];
  if (!(s.east_deg > s.west_deg && s.east_deg - s.west_deg <= 20 && s.north_deg > s.south_deg &&
        s.north_deg - s.south_deg <= 20 && s.south_deg >= -85 && s.north_deg <= 85 && s.west_deg >= -180 &&
        s.east_deg <= 540))
    return "--area W/E/S/N wants W < E and S < N, at most 20 degrees apart, between 85 S and 85 N";
  const auto start = utc_from_text(o.start);
  if (!start) return "--start takes a UTC time, as in 2026-03-01T00:00:00Z";
  s.start_s = epoch_seconds(*start);
  const double height = s.north_deg - s.south_deg, width = s.east_deg - s.west_deg;
  const auto inside = [&](double share) {
    return GeoPoint::from_degrees(s.south_deg + share * height, s.west_deg + share * width);
  };
  s.from = inside(0.2).value_or(GeoPoint{});
  s.to = inside(0.8).value_or(GeoPoint{});
  for (const auto& [text, into, option] : {std::tuple{&o.from, &s.from, "--from"}, std::tuple{&o.to, &s.to, "--to"}}) {
    if (text->empty()) continue;
    const auto p = place(*text);
    if (!p) return std::string{option} + " takes LAT,LON in degrees";
    *into = *p;
  }
  const double nodes =
      (width / o.grid.step_deg + 1) * (height / o.grid.step_deg + 1) * (o.grid.hours / o.grid.every_h + 1);
  if (nodes > 2e7)
    return "that grid has more than 20 million values a component: take a larger --step-deg or fewer --hours";
  return std::nullopt;
}

int ocean_text(OceanOptions& o, world::World& world) {
  if (const auto wrong = fill(o)) return usage(*wrong);
  const auto chart = chart_from(o.coast, world.files);
  if (!chart) return usage("--coast: " + chart.error());
  const auto variant = o.variant == "truth" ? Variant::truth : Variant::forecast;
  const auto cdl = coastal_cdl(o.spec, variant, o.grid, *chart);
  std::cerr << "seed " << o.spec.seed << ", " << o.variant << '\n';
  if (o.output.empty()) {
    std::cout << cdl << std::flush;
    return std::cout ? kDone : kNegative;
  }
  return write_file(world.files, o.output, cdl) ? kDone : kNegative;
}

CLI::App* add_run(CLI::App& app, RunOptions& o) {
  auto* verb = app.add_subcommand("run", "Fly the gliders of a scenario against a daemon");
  verb->add_option("SCENARIO", o.scenario, "YAML file, schema glidehelm/scenario/v1 (examples: simulator/scenarios)")
      ->required();
  verb->add_option("--realtime", o.realtime,
                   "No faster than N-fold wall time; computing then takes time as it does at sea")
      ->check(CLI::Range(0.01, 1e6));
  verb->add_option("--seed", o.seed, "Replaces the scenario's seed");
  verb->add_option("--log", o.log, "Also write what is printed to this file");
  verb->add_flag("--json", o.json, "Print one JSON document at the end instead of lines");
  verb->add_flag("--alone", o.alone, "No daemon: the gliders fly the lists that they start with");
  verb->footer(
      "A daemon on the same clock (`clock: {simulated: SOCKET}` in its file) is handed its time: the run takes seconds "
      "and gives the\n"
      "same files on any machine. Start either first; each waits for the other. Folders are made where the scenario "
      "says, with\n"
      "a marker file .glidersim beside to-glider.\n"
      "Exit: 0 every glider arrived, 1 one did not, 2 usage, 3 no daemon.");
  return verb;
}

CLI::App* add_ocean(CLI::App& app, OceanOptions& o) {
  auto* verb = app.add_subcommand("ocean", "Make a coastal sea of jets, eddies and a tide, as CDL text");
  auto& s = o.spec;
  verb->add_option("--area", o.area, "W/E/S/N in degrees")->required();
  verb->add_option("--start", o.start, "First time, UTC")->required();
  verb->add_option("--variant", o.variant,
                   "What the model says, or what the water does; the same seed makes them alike")
      ->check(CLI::IsMember({"forecast", "truth"}))
      ->capture_default_str();
  verb->add_option("--seed", s.seed, "Places, sizes, signs and phases are drawn from it")->capture_default_str();
  verb->add_option("--from", o.from,
                   "LAT,LON: start of the straight way, which gets an opposing jet (default: 20 % into the area)");
  verb->add_option("--to", o.to, "LAT,LON: its end (default: 80 % into the area)");
  verb->add_option("--step-deg", o.grid.step_deg, "Grid spacing")->check(CLI::Range(0.002, 5.0))->capture_default_str();
  verb->add_option("--hours", o.grid.hours, "Length of the forecast")
      ->check(CLI::Range(0, 8760))
      ->capture_default_str();
  verb->add_option("--every", o.grid.every_h, "Hours between two times")
      ->check(CLI::Range(1, 240))
      ->capture_default_str();
  verb->add_option("--coast", o.coast, "Coast file: nodes on land hold the fill value");
  verb->add_option("-o,--output", o.output, "File; standard output when absent");
  verb->add_option("--jet", s.jet, "Opposing jet on the straight way, m/s")
      ->check(CLI::Range(-3.0, 3.0))
      ->capture_default_str();
  verb->add_option("--counter-jet", s.counter_jet, "Favourable jet beside it, m/s")
      ->check(CLI::Range(-3.0, 3.0))
      ->capture_default_str();
  verb->add_option("--jet-width-km", s.jet_width_km, "Half width of the jets")
      ->check(CLI::Range(0.5, 200.0))
      ->capture_default_str();
  verb->add_option("--jet-offset-km", s.jet_offset_km, "Between the jets")
      ->check(CLI::Range(0.0, 500.0))
      ->capture_default_str();
  verb->add_option("--eddy", s.eddy, "Strongest eddy, m/s")->check(CLI::Range(0.0, 3.0))->capture_default_str();
  verb->add_option("--eddies", s.eddies, "Eddies per 2.5 x 2.5 degrees")
      ->check(CLI::Range(0, 200))
      ->capture_default_str();
  verb->add_option("--tide", s.tide, "M2, major axis, m/s")->check(CLI::Range(0.0, 3.0))->capture_default_str();
  verb->add_option("--shift-km", s.shift_km, "truth: how far every eddy is elsewhere")
      ->check(CLI::Range(0.0, 200.0))
      ->capture_default_str();
  verb->add_option("--tide-lag-deg", s.tide_lag_deg, "truth: phase of the tide ahead of the forecast's")
      ->check(CLI::Range(-360.0, 360.0))
      ->capture_default_str();
  verb->add_option("--jet-change", s.jet_change, "truth: share by which the jets differ")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->add_option("--noise", s.noise, "truth: small eddies that the forecast lacks, m/s")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->footer(
      "Example:\n"
      "  glidersim ocean --area 3/5.5/40/42.5 --start 2026-03-01T00:00Z --seed 7 -o forecast.cdl && ncgen -o "
      "forecast.nc forecast.cdl\n"
      "  glidersim ocean --area 3/5.5/40/42.5 --start 2026-03-01T00:00Z --seed 7 --variant truth -o truth.cdl\n"
      "Same arguments, same bytes. Exit: 0 done, 1 not written, 2 usage.");
  return verb;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "glidersim: simulated Slocum gliders and their dockserver, in a simulated ocean. See `glidersim VERB --help`."};
  app.require_subcommand(1);
  RunOptions run_options;
  OceanOptions ocean_options;
  auto* run_verb = add_run(app, run_options);
  add_ocean(app, ocean_options);
  const auto* keys_verb = app.add_subcommand("keys", "Print every key of a scenario, as a Markdown table");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kDone : kUsage;
  }
  if (keys_verb->parsed()) {
    std::cout << scenario_key_table();
    return kDone;
  }
  world::RealWorld real;
  auto world = real.world();
  return run_verb->parsed() ? run(run_options, world) : ocean_text(ocean_options, world);
}
