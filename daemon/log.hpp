#pragma once

#include <spdlog/logger.h>

#include <memory>
#include <string>
#include <string_view>

#include "core/mission/event.hpp"
#include "daemon/world/clock.hpp"

namespace glidehelm::daemon {

/// The operator's log: one line per fact, read at 3 a.m.
///
///     2026-11-25T03:12:07Z info  sim01     surfacing 12: fix 28.4213,-15.2011 taken 2026-11-25T03:11:11Z, …
///     2026-11-25T03:12:09Z ALERT sim01     standing down for this surfacing: …
///
/// Time (UTC, of the clock that is handed in), level, glider or "-", fact. `info` is a mission fact, `note` and `warn` mean
/// degraded but flying, `ALERT` and `PAGE` want an operator. With a simulated clock every line says SIMULATED.
class Log {
 public:
  Log(std::shared_ptr<spdlog::logger> sink, const world::Clock& clock);

  void fact(mission::Level level, std::string_view glider, std::string_view text) const;
  void info(std::string_view glider, std::string_view text) const { fact(mission::Level::info, glider, text); }
  void warn(std::string_view glider, std::string_view text) const { fact(mission::Level::note, glider, text); }
  void alert(std::string_view glider, std::string_view text) const { fact(mission::Level::alert, glider, text); }

 private:
  std::shared_ptr<spdlog::logger> sink_;
  const world::Clock& clock_;
};

/// A logger that writes whole lines to stdout, unbuffered enough for a terminal and journald.
std::shared_ptr<spdlog::logger> stdout_sink();

}  // namespace glidehelm::daemon
