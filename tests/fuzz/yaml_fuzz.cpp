#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "config/areas.hpp"
#include "config/daemon.hpp"
#include "config/mission.hpp"

namespace {

using namespace glidehelm;

void require(bool holds) {
  if (!holds) std::abort();
}

template <class T>
void check_errors(const Expected<T, std::vector<config::ConfigError>>& result) {
  if (result) return;
  require(!result.error().empty());
  for (const auto& error : result.error()) {
    require(!error.problem.empty());
    for (const char c : error.message()) require(static_cast<unsigned char>(c) >= 0x20);  // no forged log line
  }
}

}  // namespace

/// Any bytes as a mission, a daemon file and a GeoJSON area: errors or values, and what is taken prints so that it is
/// taken again for the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  const auto load = [&](const std::string&) -> Expected<std::string, config::Unreadable> { return std::string{text}; };

  const auto document = config::read_yaml(text, "f");
  require(document.readable || !document.errors.empty());
  for (const auto& error : document.errors) require(error.line == 0 || (error.line >= 1 && error.column >= 1));

  const auto mission = config::read_mission_file(text, "f", load);
  check_errors(mission);
  if (mission) {
    const auto again = config::read_mission_file(mission->effective, "f", load);
    require(again && again->mission == mission->mission);
  }
  const auto daemon = config::read_daemon_file(text, "f");
  check_errors(daemon);
  if (daemon) {
    const auto again = config::read_daemon_file(daemon->effective, "f");
    require(again && again->config == daemon->config);
  }
  if (const auto areas = config::areas_from_geojson(std::string{text}))
    for (const auto& area : *areas) require(area.vertices.size() >= 3);
  return 0;
}
