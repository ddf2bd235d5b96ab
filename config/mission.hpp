#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/paths.hpp"
#include "config/yaml_reader/fields.hpp"
#include "core/mission/mission.hpp"

/// The mission file, `schema: glidehelm/mission/v1` (product.md 5). docs/configuration.md lists every key.
namespace glidehelm::config {

inline constexpr const char* kMissionSchema = "glidehelm/mission/v1";

/// A mission file that is right: the mission with every default filled in, and the same as YAML with the origin of
/// each value ("FILE:LINE" or "default"). The YAML reads back to the same mission; relative paths in it are resolved, so it
/// means the same only in the folder from which the file was named.
struct MissionFile {
  mission::Mission mission;
  std::string effective;
  friend bool operator==(const MissionFile&, const MissionFile&) = default;
};

/// Reads a mission. `file` is its path: it stands in the errors, and relative paths of the mission (`currents.files`,
/// `safety.coast`, the GeoJSON of `keep_in` and `keep_out`) are meant from its folder and come back resolved. `load`
/// reads the GeoJSON files. On failure every error of the file, by line.
///
/// Checks what the file alone can tell. That the goal is in water, that forecasts exist and reach, needs currents and
/// coast and is checked where they are known. Deterministic; throws nothing.
Expected<MissionFile, std::vector<ConfigError>> read_mission_file(std::string_view text, const std::string& file,
                                                                  const LoadFile& load);

/// `read_mission_file` without the YAML.
Expected<mission::Mission, std::vector<ConfigError>> read_mission(std::string_view text, const std::string& file,
                                                                  const LoadFile& load);

/// Every key of a mission file as declared: for the JSON Schema and the key table.
Shape mission_shape();
/// config/mission.schema.json.
std::string mission_schema();

}  // namespace glidehelm::config
