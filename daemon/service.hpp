#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/load.hpp"
#include "daemon/journal.hpp"
#include "daemon/log.hpp"
#include "daemon/planning_worker.hpp"
#include "daemon/session.hpp"
#include "daemon/world/service_manager.hpp"
#include "daemon/world/simulated_clock.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::daemon {

/// Reads configuration through an adapter: what start, reload and `--check` share.
config::Sources sources_of(world::Files& files);

/// glidehelmd: owns everything and wires it. The only file that knows everybody.
class Service {
 public:
  /// `world` has the clock that the configuration asks for; `simulated` is the same clock when glidersim drives it, else null.
  Service(config::Configuration configuration, world::World world, world::SimulatedClock* simulated, Log& log);
  ~Service();

  /// Opens journal, folders and lines, replays, then runs until stopped. Returns the exit code: 0 stopped, 1 could not start, 70 a sync
  /// failed (systemd restarts, recovery reads the disk).
  int run();

 private:
  bool start();
  [[nodiscard]] std::vector<mission::MissionText> chain_for(const std::string& glider,
                                                            const config::Configuration& configuration) const;
  [[nodiscard]] Expected<std::unique_ptr<Session>, std::string> make_session(
      const config::GliderEntry& entry, const config::Configuration& configuration);
  void reload();
  [[nodiscard]] bool change_gliders(const config::Configuration& next);
  void stop(int code, const std::string& why);
  void settled();
  void tend();

  config::Configuration configuration_;
  world::World world_;
  world::SimulatedClock* simulated_;
  Log& log_;
  world::ServiceManager manager_;
  std::unique_ptr<world::Folder> state_;
  std::string grids_;
  std::shared_ptr<GridCache> cache_;
  std::unique_ptr<Journal> journal_;
  std::unique_ptr<PlanningWorker> worker_;
  OceanPool oceans_;
  std::vector<std::unique_ptr<Session>> sessions_;
  int exit_code_{};
  bool stopping_{};
};

}  // namespace glidehelm::daemon
