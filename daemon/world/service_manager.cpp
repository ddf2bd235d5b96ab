#include "daemon/world/service_manager.hpp"

#include <systemd/sd-daemon.h>

namespace glidehelm::world {

void ServiceManager::ready(const std::string& status) const { sd_notify(0, ("READY=1\nSTATUS=" + status).c_str()); }
void ServiceManager::reloading() const { sd_notify(0, "RELOADING=1"); }
void ServiceManager::stopping() const { sd_notify(0, "STOPPING=1"); }
void ServiceManager::status(const std::string& text) const { sd_notify(0, ("STATUS=" + text).c_str()); }
void ServiceManager::still_alive() const { sd_notify(0, "WATCHDOG=1"); }

std::optional<Seconds> ServiceManager::watchdog_interval() const {
  std::uint64_t microseconds{};
  if (sd_watchdog_enabled(0, &microseconds) <= 0) return std::nullopt;
  return Seconds{static_cast<double>(microseconds) * 0.5e-6};
}

}  // namespace glidehelm::world
