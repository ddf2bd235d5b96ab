#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/base/geo.hpp"
#include "core/base/hash.hpp"
#include "core/base/utc.hpp"
#include "daemon/event_json.hpp"
#include "daemon/journal.hpp"
#include "daemon/world/real_files.hpp"
#include "simulator/scenario.hpp"
#include "tests/simulator/temp_folder.hpp"
#include "tests/support/processes.hpp"

// A fleet of glidersim against one glidehelmd, as processes on a simulated clock, every line with every fault: what the simulator
// knows of each surfacing is held against what the daemon's journal says of it.
//   GLIDEHELM_FLEET_GLIDERS, GLIDEHELM_FLEET_DAYS   larger than the cut of the quick tests (scripts/campaign fleet)
//   GLIDEHELM_FLEET_PROGRESS_S                      seconds between two lines of progress on stderr; none without it

using namespace glidehelm;
using namespace glidehelm::test;
using Json = nlohmann::json;

namespace {

// Sanitized programs are ten times slower: what they look for shows in a few gliders as well.
#if defined(GLIDEHELM_SANITIZED)
constexpr int kGliders = 6;
#else
constexpr int kGliders = 50;
#endif

double wanted(const char* name, double standard) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtod(text, nullptr) : standard;
}

std::string slurp(const std::filesystem::path& path) {
  std::ifstream in{path, std::ios::binary};
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), with);
}

/// The first of `count` ports of the loopback on which nobody listens.
int free_ports(int count) {
  for (int first = free_port(), tries = 0; tries < 200; first = free_port(), ++tries) {
    int next = first;
    while (next < first + count && free_port() == ++next) {
    }
    if (next >= first + count) return first;
  }
  FAIL("no free ports in a row");
  return 0;
}

/// The planner's name in a goto list that the daemon wrote.
std::string method_of(const std::string& list) {
  constexpr std::string_view kLabel = "# method: ";
  const auto at = list.find(kLabel);
  if (at == std::string::npos) return "unnamed";
  return list.substr(at + kLabel.size(), list.find('\n', at) - at - kLabel.size());
}

/// Seconds between two UTC texts.
double seconds_at(const Json& text) {
  const auto t = utc_from_text(text.get<std::string>());
  REQUIRE(t);
  return epoch_seconds(*t);
}

struct Voyage {
  /// `each_fault`: from the scenario as it is shipped. The first `best` gliders are planned with `best`.
  Voyage(int gliders, double days, int best) : port{free_ports(gliders)} {
    auto text = slurp(GLIDEHELM_SOURCE "/simulator/scenarios/fleet.yaml");
    text = replaced(text, "days: 30", "days: " + std::to_string(days));
    text = replaced(text, "count: 50", "count: " + std::to_string(gliders));
    text = replaced(text, "127.0.0.1:7000", "127.0.0.1:" + std::to_string(port));
    folder.write("fleet.yaml", text);
    auto read = simulator::read_scenario(text, path("fleet.yaml"));
    REQUIRE(read);
    scenario = std::move(*read);
    write_daemon(best);
  }

  void write_daemon(int best) {
    std::filesystem::create_directory(folder.path / "missions.d");
    std::ostringstream daemon;
    daemon << "schema: glidehelm/daemon/v1\n"
           << "clock: {simulated: " << path("run/clock.sock") << "}\n"
           << "state_dir: " << path("state") << "\n"
           << "control_socket: " << path("control.sock") << "\n"
           << "missions: [missions.d/*.yaml]\n"
           << "gliders:\n";
    int number = 0;
    for (const auto& g : scenario.gliders) {
      const auto& name = g.plan.setup.name;
      daemon << "  - {name: " << name << ", line: {listen: \"127.0.0.1:" << g.line.port
             << "\"}, to_glider: " << g.folder << "/to-glider}\n";
      std::ostringstream mission;
      mission.precision(10);
      mission << "schema: glidehelm/mission/v1\n"
              << "name: leg-" << name << "\n"
              << "glider: " << name << "\n"
              << "goal: {lat_deg: " << g.plan.goal.lat.degrees() << ", lon_deg: " << g.plan.goal.lon.degrees()
              << ", radius_m: 2000}\n"
              << "currents: {files: [\"" << path("run/forecasts/*.nc") << "\"]}\n"
              << "approval: {mode: auto}\n"
              << "planning: {method: " << (number++ < best ? "best" : "direct") << "}\n";
      folder.write("missions.d/" + name + ".yaml", mission.str());
    }
    folder.write("glidehelm.yaml", daemon.str());
  }

  /// Flies; wall time in seconds.
  double fly(std::chrono::seconds limit) {
    const auto began = WallClock::now();
    Program sim{{GLIDEHELM_BIN "/glidersim", {"run", path("fleet.yaml"), "--json"}, path("sim.out"), {}, false}};
    Program daemon{{GLIDEHELM_BIN "/glidehelmd", {"--config", path("glidehelm.yaml")}, path("daemon.log"), {}, false}};
    watch(sim, began, limit);
    const auto ended = sim.wait(std::chrono::seconds{1});
    const auto wall = std::chrono::duration<double>(WallClock::now() - began).count();
    static_cast<void>(daemon.wait(std::chrono::seconds{30}));
    const auto out = folder.read("sim.out");
    INFO(out.substr(0, 2000));
    INFO(folder.read("daemon.log").substr(0, 2000));
    REQUIRE(ended.in_time);
    const auto begin = out.find("{\n \"schema\"");
    REQUIRE(begin != std::string::npos);
    results = Json::parse(out.substr(begin));
    return wall;
  }

  /// Until the simulator has ended or the time is over.
  void watch(Program& sim, WallClock::time_point began, std::chrono::seconds limit) {
    const double every_s = wanted("GLIDEHELM_FLEET_PROGRESS_S", 0);
    auto told = began;
    wait_until(
        [&] {
          const auto now = WallClock::now();
          if (every_s > 0 && std::chrono::duration<double>(now - told).count() >= every_s) {
            told = now;
            say_progress(std::chrono::duration<double>(now - began).count());
          }
          return !sim.running();
        },
        limit);
  }

  /// The names of the first glider's logs say how far the simulated time is.
  void say_progress(double wall_s) const {
    std::string newest;
    const auto logs = folder.path / "run" / scenario.gliders.front().plan.setup.name / "logs";
    std::error_code none_yet;
    for (const auto& log : std::filesystem::directory_iterator{logs, none_yet})
      newest = std::max(newest, log.path().filename().string());
    const auto from = newest.find('_');
    if (from == std::string::npos || newest.size() < from + 16) return;
    const auto digits = newest.substr(from + 1, 15);  // 20260301T041500
    const auto at = utc_from_text(digits.substr(0, 4) + "-" + digits.substr(4, 2) + "-" + digits.substr(6, 5) + ":" +
                                  digits.substr(11, 2) + ":" + digits.substr(13, 2) + "Z");
    if (!at) return;
    const double done = std::chrono::duration<double>(*at - scenario.start).count() / 86400, all = *scenario.end.days;
    std::ostringstream line;
    line << std::fixed << std::setprecision(1) << done << " of " << all << " simulated days after "
         << std::setprecision(0) << wall_s << " s of wall time; about " << wall_s * (all - done) / std::max(done, 1e-3)
         << " s to go\n";
    std::cerr << line.str() << std::flush;
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder.path / name).string(); }
  [[nodiscard]] std::vector<daemon::JournalRecord> journal() const {
    world::RealFiles files;
    auto state = files.open_folder(path("state"));
    REQUIRE(state);
    auto opened = daemon::Journal::open(**state, {}, {});
    REQUIRE(opened);
    return (*opened)->past();
  }
  /// Goto lists that were sent to a glider, by the time of their transfer.
  [[nodiscard]] std::vector<std::string> archived(const std::string& glider) const {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator{folder.path / "run" / glider / "archive"})
      paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> files;
    for (const auto& p : paths) files.push_back(slurp(p));
    return files;
  }

  TempFolder folder;
  int port{};
  simulator::Scenario scenario;
  Json results;
};

/// What the journal says, per glider.
struct SaidOfFleet {
  struct Accepted {
    double heard_s{}, taken_s{};
    GeoPoint fix;
    std::string surfacing;
  };
  std::vector<Accepted> accepted;
  std::vector<double> refused;                 ///< when, with a reason each
  std::set<std::string> committed;             ///< sha256 of every committed file
  std::map<std::string, int> first_emissions;  ///< by surfacing; replacements of our own queued file not counted
  std::map<std::string, std::string> kept;     ///< why there is no file, by surfacing
  std::map<std::string, int> methods;          ///< whose plans the committed files are
  std::map<std::string, int> rules;            ///< that refused a fix
  int replacements{};
};

std::map<std::string, SaidOfFleet> read_journal(const std::vector<daemon::JournalRecord>& records) {
  std::map<std::string, SaidOfFleet> said;
  std::map<std::uint64_t, Json> intents;
  std::map<std::string, model::Surfacing> heard;  // the last one of each glider: what the next decision is about
  for (const auto& record : records) {
    using Type = daemon::RecordType;
    const double at_s = epoch_seconds(record.utc);
    if (record.type == Type::event) {
      const auto event = daemon::event_from_json(record.payload);
      if (!event) continue;
      if (const auto* s = std::get_if<mission::SurfacingHeard>(&event->event.what)) heard[event->glider] = s->surfacing;
      continue;
    }
    const auto json = Json::parse(record.payload, nullptr, false);
    if (!json.is_object() || !json.contains("glider")) continue;
    const std::string glider = json["glider"];
    auto& of = said[glider];
    switch (record.type) {
      case Type::surfacing:
        of.accepted.push_back(
            {at_s, epoch_seconds(heard[glider].fix_taken), heard[glider].fix, json["surfacing"].get<std::string>()});
        break;
      case Type::refusal:
        CHECK(json["text"].get<std::string>().size() > 4);  // a rule and a reason
        of.refused.push_back(at_s);
        ++of.rules[json["text"].get<std::string>().substr(0, json["text"].get<std::string>().find(':'))];
        break;
      case Type::keep:
        CHECK(json["text"].get<std::string>().size() > 4);
        of.kept[json["surfacing"].get<std::string>()] = json["text"].get<std::string>();
        break;
      case Type::intent:
        intents[record.sequence] = json;
        break;
      case Type::committed: {
        const auto& intent = intents[json["intent"].get<std::uint64_t>()];
        REQUIRE(intent.is_object());
        CHECK(intent["glider"] == glider);
        CHECK(json["surfacing"] == intent["surfacing"]);
        of.committed.insert(intent["sha256"].get<std::string>());
        ++of.methods[method_of(intent["bytes"].get<std::string>())];
        if (intent["replacement"].get<bool>())
          ++of.replacements;
        else
          ++of.first_emissions[intent["surfacing"].get<std::string>()];
        break;
      }
      default:
        break;
    }
  }
  return said;
}

/// The accounts of a voyage.
struct Count {
  int surfacings{}, accepted{}, refused{}, unreadable{}, unaccounted{};
  int refusals{};                           ///< of single fixes, also where another one was accepted
  int altered{}, altered_by_clean_calls{};  ///< accepted with another position than the glider's
  int kept{}, silent{};                     ///< accepted without a file: with a reason, and without
  std::map<std::string, int> reasons, rules;
  int emitted{}, replacements{}, twice{}, of_nobody{};
  int archived{}, archived_uncommitted{}, partial{}, lists_taken{}, ended_badly{};
  /// Emissions that must not be: twice, for another glider's or no surfacing, or past the journal.
  [[nodiscard]] int wrong() const { return twice + of_nobody + archived_uncommitted; }
};

Count count(const Voyage& voyage, const std::map<std::string, SaidOfFleet>& said) {
  Count c;
  for (const auto& glider : voyage.results["gliders"]) {
    const std::string name = glider["name"];
    const auto found = said.find(name);
    const SaidOfFleet of = found == said.end() ? SaidOfFleet{} : found->second;
    const auto& track = glider["track"];
    if (glider["end"] == "behaviour_error") ++c.ended_badly;
    c.lists_taken += glider["lists_taken"].get<int>();
    std::vector<double> fixes;
    for (std::size_t i = 0; i < track.size(); ++i) {
      const auto& row = track[i];
      ++c.surfacings;
      if (row["partial_file"].get<bool>()) ++c.partial;
      const double fix_s = seconds_at(row["fix_time"]), dived_s = seconds_at(row["dived"]);
      fixes.push_back(fix_s);
      const auto in_window = [&](double t) { return t >= fix_s && t <= dived_s; };
      const bool refused = std::any_of(of.refused.begin(), of.refused.end(), in_window);
      const SaidOfFleet::Accepted* accepted = nullptr;
      for (const auto& a : of.accepted)
        if (in_window(a.heard_s) && accepted == nullptr) accepted = &a;
      if (accepted != nullptr) {
        ++c.accepted;
        if (of.first_emissions.count(accepted->surfacing) == 0) {
          const auto why = of.kept.find(accepted->surfacing);
          if (why != of.kept.end()) {
            ++c.kept;
            ++c.reasons[why->second.substr(0, why->second.find_first_of("0123456789"))];
          } else {
            ++c.silent;
            UNSCOPED_INFO("no file and no reason: " << accepted->surfacing << " " << row.dump());
          }
        }
        // The dialog's 0.001 minute is 1.9 m, half of that rounded in each direction: 3 m are the same place.
        const auto truth = geo_point(row["lat_deg"].get<double>(), row["lon_deg"].get<double>());
        if (distance(truth, accepted->fix).si() > 3 || std::abs(accepted->taken_s - fix_s) > 2) {
          ++c.altered;
          const auto& faults = row["faults"];
          const auto has = [&](const char* fault) {
            return std::find(faults.begin(), faults.end(), fault) != faults.end();
          };
          // A slow line brings the age of a fix late: then its time is off by as much, by no fault of the reader.
          if (!has("garbled") && !has("slow")) ++c.altered_by_clean_calls;
        }
      } else if (refused) {
        ++c.refused;
      } else if (row["whole_fixes"] == 0) {
        ++c.unreadable;
      } else {
        ++c.unaccounted;
        UNSCOPED_INFO("unaccounted: " << name << " " << row.dump());
      }
    }
    c.replacements += of.replacements;
    c.refusals += static_cast<int>(of.refused.size());
    for (const auto& [rule, times] : of.rules) c.rules[rule] += times;
    for (const auto& [surfacing, times] : of.first_emissions) {
      ++c.emitted;
      if (times > 1) ++c.twice;
      const auto slash = surfacing.find('/');
      const auto taken = utc_from_text(surfacing.substr(slash + 1));
      REQUIRE(taken);
      // One of this glider's surfacings: from its fix to a little after its dive (a slow line tells a fix later).
      const double t = epoch_seconds(*taken);
      const bool own = surfacing.substr(0, slash) == name &&
                       std::any_of(fixes.begin(), fixes.end(), [&](double f) { return t >= f - 2 && t <= f + 900; });
      if (!own) {
        ++c.of_nobody;
        UNSCOPED_INFO("emitted for no surfacing: " << surfacing);
      }
    }
    for (const auto& bytes : voyage.archived(name)) {
      ++c.archived;
      if (of.committed.count(Sha256::of(std::string_view{bytes}).hex()) == 0) ++c.archived_uncommitted;
    }
  }
  return c;
}

std::string listed(const std::map<std::string, int>& counts) {
  std::string text;
  for (const auto& [what, times] : counts) text += " " + what + " " + std::to_string(times);
  return counts.empty() ? " none" : text;
}

std::string report(const Count& c) {
  std::ostringstream text;
  text << "surfacings " << c.surfacings << ": accepted " << c.accepted << ", refused with a reason " << c.refused
       << ", nothing readable came " << c.unreadable << ", unaccounted " << c.unaccounted << "\n"
       << "single fixes refused " << c.refusals << ", by rule:" << listed(c.rules) << "\n"
       << "accepted with another fix than the glider's " << c.altered << " (of calls neither garbled nor slow "
       << c.altered_by_clean_calls << ")\n"
       << "files emitted " << c.emitted << ", exchanged before their transfer " << c.replacements
       << "; accepted without a file, with a reason " << c.kept << ", without one " << c.silent << "\n";
  for (const auto& [why, times] : c.reasons) text << "  " << times << " x " << why << "\n";
  text << "wrong emissions " << c.wrong() << ": two for one surfacing " << c.twice
       << ", for no surfacing of that glider " << c.of_nobody
       << ", files that reached a glider and are not in the journal " << c.archived_uncommitted << "\n"
       << "files that reached a glider " << c.archived << ", goto lists taken " << c.lists_taken
       << ", torn in the transfer " << c.partial << ", missions that a file ended " << c.ended_badly << "\n";
  return text.str();
}

/// Whose plans the committed files are: of the first `best` gliders, and of the others.
std::pair<std::map<std::string, int>, std::map<std::string, int>> methods_flown(
    const Voyage& voyage, const std::map<std::string, SaidOfFleet>& said, int best) {
  std::pair<std::map<std::string, int>, std::map<std::string, int>> flown;
  int number = 0;
  for (const auto& g : voyage.scenario.gliders) {
    auto& into = number++ < best ? flown.first : flown.second;
    const auto found = said.find(g.plan.setup.name);
    if (found == said.end()) continue;
    for (const auto& [method, times] : found->second.methods) into[method] += times;
  }
  return flown;
}

}  // namespace

TEST_CASE("a fleet on bad lines: every surfacing is accounted for, and no file goes out wrongly") {
  const int gliders = static_cast<int>(wanted("GLIDEHELM_FLEET_GLIDERS", kGliders));
  const double days = wanted("GLIDEHELM_FLEET_DAYS", 0.3);
  const int best = std::max(1, gliders / 10);
  Voyage voyage{gliders, days, best};
  const double wall_s = voyage.fly(std::chrono::seconds{static_cast<int>(wanted("GLIDEHELM_FLEET_LIMIT_S", 280))});
  const auto said = read_journal(voyage.journal());
  const auto c = count(voyage, said);
  const auto [of_best, of_direct] = methods_flown(voyage, said, best);
  std::map<std::string, int> struck;
  for (const auto& glider : voyage.results["gliders"])
    for (const auto& row : glider["track"])
      for (const auto& fault : row["faults"]) ++struck[fault.get<std::string>()];
  std::cout << "seed " << voyage.results["seed"] << ", gliders " << gliders << ", days " << days << "\n"
            << "wall time " << wall_s << " s: each glider " << days * 86400 / wall_s << " x real time, all together "
            << gliders * days * 86400 / wall_s << " glider-seconds a second\n"
            << report(c) << "files of the " << best << " gliders with method best:" << listed(of_best)
            << "\nfiles of the " << gliders - best << " gliders with method direct:" << listed(of_direct)
            << "\nfaults:" << listed(struck) << std::endl;

  CHECK(c.surfacings >=
        static_cast<int>(gliders * days * 24 / 5));  // stints of 4 h ± 8 % and a quarter of an hour afloat
  CHECK(c.unaccounted == 0);
  CHECK(c.silent == 0);
  CHECK(c.altered_by_clean_calls == 0);
  CHECK(c.wrong() == 0);
  CHECK(c.ended_badly == 0);
  CHECK(c.emitted > c.surfacings / 2);
  CHECK(c.archived > c.surfacings / 2);
  if (c.surfacings > 100) CHECK(struck.size() == simulator::fault_names().size());  // each at 3 % and more
  // `best` flies what a search has found; `direct` never does.
  const auto searched = [](const std::map<std::string, int>& methods) {
    return std::any_of(methods.begin(), methods.end(), [](const auto& m) {
      return m.first != "direct" && m.first != "station" && m.first != "queued";
    });
  };
  CHECK(searched(of_best));
  CHECK_FALSE(searched(of_direct));
}

TEST_CASE("a fleet on bad lines flies to the same bytes again") {
  const auto fly = [] {
    Voyage voyage{kGliders == 50 ? 6 : 3, 0.3, 1};
    voyage.fly(std::chrono::seconds{140});
    std::string all = voyage.results.dump();
    for (const auto& g : voyage.scenario.gliders)
      for (const auto& file : voyage.archived(g.plan.setup.name)) all += file;
    return all;
  };
  const auto once = fly();
  CHECK(once.size() > 10'000);
  CHECK(once == fly());
}
