#include <CLI/CLI.hpp>
#include <iostream>

#include "daemon/places.hpp"
#include "daemon/service.hpp"
#include "daemon/world/program_version.hpp"
#include "daemon/world/real.hpp"

namespace {

constexpr const char* kHelp =
    "The pilot that never sleeps: reads each surfacing of a glider, replans on the newest forecast, has the plan "
    "proven safe, and leaves the "
    "waypoint file where the dockserver picks it up.\n\n"
    "Signals: SIGHUP reads all files again (all or nothing), SIGTERM stops.\n"
    "Exit codes: 0 stopped, 1 configuration or start failed, 2 usage, 70 a disk write could not be made durable.\n"
    "See glidehelmd(8), docs/configuration.md and config/examples/.";

/// The clock of the configuration: the system's, or the one that glidersim drives.
int fly(glidehelm::config::Configuration configuration, glidehelm::world::RealWorld& real) {
  using namespace glidehelm;
  const auto sink = daemon::stdout_sink();
  if (!configuration.daemon.simulated_clock) {
    auto world = real.world();
    daemon::Log log{sink, world.clock};
    return daemon::Service{std::move(configuration), world, nullptr, log}.run();
  }
  daemon::Log* voice = nullptr;
  auto& net = real.world().net;
  world::SimulatedClock clock{net, real.world().clock, *configuration.daemon.simulated_clock,
                              [&](std::string_view reason) {
                                if (voice != nullptr)
                                  voice->info("", "stopping, the simulator ended: " + std::string{reason});
                                net.stop();
                              }};
  daemon::Log log{sink, clock};
  voice = &log;
  const int code = daemon::Service{std::move(configuration), real.world_with(clock), &clock, log}.run();
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{kHelp, "glidehelmd"};
  std::string file = "/etc/glidehelm/glidehelm.yaml";
  bool check = false;
  app.add_option("--config", file, "Daemon file (schema glidehelm/daemon/v1)")->capture_default_str();
  app.add_flag("--check", check, "Read the daemon file and all missions, print every error, and end");
  app.set_version_flag("--version", std::string{"glidehelmd "} + glidehelm::world::program_version());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  glidehelm::world::RealWorld real;
  auto configuration = glidehelm::config::load(file, glidehelm::daemon::sources_of(real.world().files));
  if (configuration)
    if (auto errors = glidehelm::daemon::Places{real.world().files}.errors_of(*configuration); !errors.empty())
      configuration = glidehelm::unexpected(std::move(errors));
  if (!configuration) {
    for (const auto& error : configuration.error()) std::cerr << error.message() << "\n";
    std::cerr << "glidehelmd: " << configuration.error().size()
              << (configuration.error().size() == 1 ? " error" : " errors") << ", not started\n";
    return 1;
  }
  if (check) {
    std::cout << file << ": right, " << configuration->daemon.gliders.size() << " gliders, "
              << configuration->missions.size() << " missions\n";
    return 0;
  }
  return fly(std::move(configuration).value(), real);
}
