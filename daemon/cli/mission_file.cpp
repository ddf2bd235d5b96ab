#include "daemon/cli/mission_file.hpp"

#include <utility>

#include "config/mission.hpp"

namespace glidehelm::cli {

Expected<mission::Mission, Trouble> mission_from(const std::string& path, world::Files& files, std::string& text) {
  const auto bytes = files.read(path, std::size_t{1} << 20);
  if (!bytes) return unexpected(Trouble{2, bytes.error().message()});
  text = *bytes;
  const auto load = [&files](const std::string& area) -> Expected<std::string, config::Unreadable> {
    auto area_text = files.read(area, std::size_t{16} << 20);
    if (!area_text) return unexpected(config::Unreadable{area_text.error().message()});
    return std::move(area_text).value();
  };
  auto mission = config::read_mission(text, path, load);
  if (mission) return std::move(mission).value();
  std::string all;
  for (const auto& error : mission.error()) all += (all.empty() ? "" : "\n") + error.message();
  return unexpected(Trouble{2, all});
}

}  // namespace glidehelm::cli
