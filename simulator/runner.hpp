#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/world/clock.hpp"
#include "daemon/world/net.hpp"
#include "simulator/dockserver/dock_folder.hpp"
#include "simulator/dockserver/server.hpp"
#include "simulator/lockstep.hpp"
#include "simulator/simulation.hpp"

namespace glidehelm::simulator {

/// How simulated time passes.
struct Pace {
  std::string clock;               ///< Unix socket of the lockstep clock; empty: the daemon has its own clock
  std::optional<double> realtime;  ///< N: no faster than N-fold wall time; needed when `clock` is empty
  bool charge_computing{};         ///< what the daemon's answer takes in wall time passes in simulated time too (× N)
  double daemon_wait_s{60};
};

enum class RunOutcome {
  finished,   ///< every glider's run is over
  no_daemon,  ///< nobody connected, or nobody answered, for daemon_wait_s
  failed,     ///< a port or socket could not be had
  stopped,    ///< by a signal
};

/// Plays a simulation to a daemon over sockets, in lockstep or in wall time.
///
/// Lockstep: time goes to the earlier of the simulation's next event and the daemon's next timer. First the daemon is
/// told the new time and answers; then what happened is written to the lines and the daemon is told how many bytes that
/// makes, so that it never reads bytes before it knows what time it is. While the daemon or a line is missing no
/// simulated time passes: a daemon that was killed can come back. Bytes are counted from the daemon's clock connection.
///
/// Wall time (`realtime` without a clock socket): events happen when N-fold wall time has reached them; what comes while
/// no line is open is lost, as at sea.
class Runner {
 public:
  struct Told {
    std::function<void(const SurfacingRecord&)> surfacing;
    std::function<void(const std::string&)> said;
    std::function<void(Instant)> time_comes;  ///< before anybody is told: files appear that are there from then on
  };
  struct Port {
    std::string name;  ///< of the glider
    LineAddress address;
    DockFolder* folder{};
  };
  Runner(world::Net& net, world::Clock& wall, Simulation& simulation, std::vector<Port> ports, Instant start, Pace pace,
         Told told);
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// Runs the loop until the end.
  RunOutcome run();

 private:
  enum class State { waiting, pacing, told_time, told_bytes, over };
  void begin();
  void proceed();
  void tell(State state);
  void on_idle(const Idle& idle);
  void on_daemon_lost();
  void let_it_happen();
  void let_links_fall();
  void wait_for_a_dial();
  [[nodiscard]] bool greet_again();
  [[nodiscard]] bool daemon_must_dial() const;
  void free_running();
  void expect_answer();
  void end(RunOutcome outcome, const std::string& why);
  void say(const std::string& text) const {
    if (told_.said) told_.said(text);
  }
  [[nodiscard]] bool everybody_there() const;
  [[nodiscard]] std::int64_t tick_of(Instant t) const;
  [[nodiscard]] std::optional<Tick> wall_due(Instant t) const;

  world::Net& net_;
  world::Clock& wall_;
  Simulation& simulation_;
  std::vector<Port> ports_;
  Instant start_, now_;
  Pace pace_;
  Told told_;
  std::vector<std::unique_ptr<DialogLine>> lines_;
  std::vector<std::uint64_t> counted_from_;
  std::vector<std::size_t> surfacings_told_;
  struct Fall {
    std::size_t line{};
    bool noticed{};  ///< false: the older connection stays open
  };
  std::vector<Fall> to_drop_;
  std::vector<bool> to_greet_;
  ClockServer clock_;
  State state_{State::waiting};
  std::optional<std::int64_t> next_timer_ms_;
  std::optional<world::TimerId> watchdog_, pacer_, poll_;
  std::optional<Tick> missing_since_;
  Tick wall_start_{}, asked_at_{};
  bool started_{};
  RunOutcome outcome_{RunOutcome::failed};
};

/// Plays a simulation without any daemon: the gliders fly the lists that they started with.
void run_alone(Simulation& simulation, const std::function<void(const SurfacingRecord&)>& told);

}  // namespace glidehelm::simulator
