#pragma once

#include <optional>
#include <string>

#include "core/base/time.hpp"

namespace glidehelm::world {

/// systemd, or nobody: readiness, status and watchdog messages (sd_notify). Without NOTIFY_SOCKET every call is a no-op.
class ServiceManager {
 public:
  void ready(const std::string& status) const;
  void reloading() const;
  void stopping() const;
  void status(const std::string& text) const;
  void still_alive() const;
  /// Half of WatchdogSec: how often `still_alive` is due; none when no watchdog is wanted.
  [[nodiscard]] std::optional<Seconds> watchdog_interval() const;
};

}  // namespace glidehelm::world
