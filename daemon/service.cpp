#include "daemon/service.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/mission.hpp"
#include "daemon/places.hpp"

namespace glidehelm::daemon {

namespace {

constexpr int kDefaultSlot = 10;
constexpr int kExitNotDurable = 70;
constexpr std::size_t kLargestConfiguration = std::size_t{2} << 20;
constexpr Seconds kTend{60};  // how often forecast files are looked for

}  // namespace

config::Sources sources_of(world::Files& files) {
  config::Sources sources;
  sources.read = [&files](const std::string& path) -> Expected<std::string, config::Unreadable> {
    auto bytes = files.read(path, kLargestConfiguration);
    if (!bytes) return unexpected(config::Unreadable{bytes.error().message()});
    return std::move(bytes).value();
  };
  sources.matches = [&files](const std::string& pattern) { return files.glob(pattern); };
  return sources;
}

Service::Service(config::Configuration configuration, world::World world, world::SimulatedClock* simulated, Log& log)
    : configuration_{std::move(configuration)}, world_{world}, simulated_{simulated}, log_{log} {}

Service::~Service() {
  sessions_.clear();  // each stops its jobs, so the worker outlives them
  worker_.reset();
}

int Service::run() {
  for (const int number : {15, 2}) world_.net.on_signal(number, [this] { stop(0, "asked to stop"); });
  world_.net.on_signal(1, [this] { reload(); });
  const auto begin = [this] {
    if (!start()) stop(1, "");
  };
  if (simulated_ != nullptr)
    simulated_->start(begin);
  else
    world_.net.post(begin);
  world_.net.run();
  manager_.stopping();
  return exit_code_;
}

void Service::stop(int code, const std::string& why) {
  if (stopping_) return;
  stopping_ = true;
  exit_code_ = code;
  if (!why.empty()) log_.info("", "stopping: " + why);
  if (code == 0 && journal_) static_cast<void>(journal_->sync());  // what fails here is read back at the next start
  world_.net.stop();
}

bool Service::start() {
  const auto& d = configuration_.daemon;
  auto state = world_.files.make_folder(d.state_dir, 0750);
  if (!state) {
    log_.alert("", "state_dir: " + state.error().message());
    return false;
  }
  state_ = std::move(state).value();
  grids_ = d.state_dir + "/grids";
  if (auto made = world_.files.make_folder(grids_, 0750); !made) {
    log_.alert("", "state_dir: " + made.error().message());
    return false;
  }
  auto journal = Journal::open(*state_, world_.clock.utc(), world_.clock.tick(), world_.clock.boot());
  if (!journal) {
    log_.fact(mission::Level::page, "", "the journal cannot be used: " + journal.error().message);
    return false;
  }
  journal_ = std::move(journal).value();
  // After the journal, which tells whether another daemon owns the folder. Everything in it can be made again: without it
  // each start reads the forecasts anew.
  if (auto cache = GridCache::open(world_.files, grids_))
    cache_ = std::move(*cache);
  else
    log_.warn("", "forecasts are not kept: " + cache.error());
  if (!journal_->note().empty()) log_.warn("", journal_->note());
  worker_ = std::make_unique<PlanningWorker>();
  for (const auto& entry : d.gliders) {
    auto session = make_session(entry, configuration_);
    if (!session) {
      log_.alert(entry.name, session.error());
      return false;
    }
    sessions_.push_back(std::move(session).value());
  }
  journal_->forget_past();
  log_.info("", fmt::format("ready: gliders {}, missions {}, epoch {} of the journal", d.gliders.size(),
                            configuration_.missions.size(), journal_->epoch()));
  manager_.ready(fmt::format("{} gliders", d.gliders.size()));
  tend();
  settled();
  return true;
}

std::vector<mission::MissionText> Service::chain_for(const std::string& glider,
                                                     const config::Configuration& configuration) const {
  std::vector<mission::MissionText> chain;
  const config::LoadedMission* next = nullptr;
  for (const auto& m : configuration.missions)
    if (m.mission.glider == glider && m.follows.empty()) next = &m;
  while (next != nullptr && chain.size() < configuration.missions.size()) {
    // The effective YAML has every default and path written out, so a replay reads the same mission whatever changes later.
    const auto read = sources_of(world_.files);
    const auto full = config::read_mission_file(next->text, next->file, read.read);
    chain.push_back({next->mission, full ? full->effective : next->text, next->sha256.hex()});
    const auto& name = next->mission.name;
    const auto follower =
        std::find_if(configuration.missions.begin(), configuration.missions.end(),
                     [&](const config::LoadedMission& m) { return m.mission.glider == glider && m.follows == name; });
    next = follower == configuration.missions.end() ? nullptr : &*follower;
  }
  return chain;
}

/// A session with its folder open, its past replayed and its line started.
Expected<std::unique_ptr<Session>, std::string> Service::make_session(const config::GliderEntry& entry,
                                                                      const config::Configuration& configuration) {
  Desk desk{world_,
            log_,
            *journal_,
            *worker_,
            grids_,
            [this] { settled(); },
            [this](const std::string& line, std::uint64_t total) {
              if (simulated_ != nullptr) simulated_->handled(line, total);
            },
            [this](const std::string& why) {
              log_.fact(mission::Level::page, "",
                        why + ": the process ends at once and reads the disk again when it is restarted");
              stop(kExitNotDurable, "");
            },
            cache_,
            &oceans_};
  auto session = std::make_unique<Session>(entry, std::move(desk));
  const auto chain = chain_for(entry.name, configuration);
  if (auto opened = session->open(chain.empty() ? kDefaultSlot : chain.front().mission.slot); !opened)
    return unexpected(opened.error());
  if (chain.empty())
    log_.warn(entry.name, "no mission names this glider: its surfacings are recorded, nothing is planned");
  auto past = journal_->all();
  if (!past) return unexpected(past.error().message);
  session->recover(*past);
  session->fly(chain, "start");
  if (auto started = session->start(); !started) return unexpected(started.error());
  return session;
}

/// All or nothing: one error anywhere and everything stays as it is.
void Service::reload() {
  manager_.reloading();
  auto next = config::load(configuration_.file, sources_of(world_.files));
  if (next)
    if (auto errors = Places{world_.files}.errors_of(*next); !errors.empty()) next = unexpected(std::move(errors));
  if (!next) {
    log_.alert("", fmt::format("reload refused, nothing changed: {} error{}", next.error().size(),
                               next.error().size() == 1 ? "" : "s"));
    for (const auto& error : next.error()) log_.alert("", error.message());
  } else if (next->daemon.simulated_clock != configuration_.daemon.simulated_clock ||
             next->daemon.state_dir != configuration_.daemon.state_dir) {
    log_.alert("", "reload refused, nothing changed: clock and state_dir can only change with a restart");
  } else if (change_gliders(*next)) {
    configuration_ = std::move(next).value();
    for (const auto& session : sessions_) session->fly(chain_for(session->entry().name, configuration_), "reload");
    log_.info("", "reloaded: in force at each glider's next surfacing");
  }
  manager_.ready(fmt::format("{} gliders", sessions_.size()));
  settled();
}

/// Opens everything that is new before anything that is gone is closed: one failure and all stays as it is.
bool Service::change_gliders(const config::Configuration& next) {
  const auto session_of = [this](const std::string& name) {
    return std::find_if(sessions_.begin(), sessions_.end(),
                        [&](const std::unique_ptr<Session>& s) { return s->entry().name == name; });
  };
  std::vector<std::unique_ptr<Session>> added;
  std::vector<std::pair<Session*, Session::Change>> changed;
  for (const auto& entry : next.daemon.gliders) {
    const auto session = session_of(entry.name);
    std::string problem;
    if (session == sessions_.end()) {
      auto made = make_session(entry, next);
      if (made)
        added.push_back(std::move(made).value());
      else
        problem = made.error();
    } else if ((*session)->entry() != entry) {
      auto change = (*session)->prepare(entry);
      if (change)
        changed.emplace_back(session->get(), std::move(change).value());
      else
        problem = change.error();
    }
    if (!problem.empty()) {
      log_.alert(entry.name, "reload refused, nothing changed: " + problem);
      return false;
    }
  }
  for (auto& [session, change] : changed) session->apply(std::move(change));
  std::erase_if(sessions_, [&](const std::unique_ptr<Session>& s) {
    return std::none_of(next.daemon.gliders.begin(), next.daemon.gliders.end(),
                        [&](const config::GliderEntry& entry) { return entry.name == s->entry().name; });
  });
  for (auto& session : added) sessions_.push_back(std::move(session));
  return true;
}

/// The simulated clock may go on when nothing is under way.
void Service::settled() {
  if (simulated_ == nullptr) return;
  simulated_->set_busy(
      !std::all_of(sessions_.begin(), sessions_.end(), [](const std::unique_ptr<Session>& s) { return s->quiet(); }));
}

/// Looks for forecasts and strokes the watchdog: from the loop that does the work, so that a hung daemon is restarted.
void Service::tend() {
  for (const auto& session : sessions_) session->look_at_forecast();
  const auto watchdog = manager_.watchdog_interval();
  manager_.still_alive();
  const Seconds wait = watchdog ? std::min(kTend, *watchdog) : kTend;
  world_.clock.call_at(
      world_.clock.tick() + std::chrono::duration_cast<Tick::duration>(simulated_ != nullptr ? Seconds{3600} : wait),
      [this] { tend(); });
}

}  // namespace glidehelm::daemon
