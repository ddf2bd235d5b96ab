#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/network.hpp"
#include "config/yaml_reader/fields.hpp"
#include "core/base/expected.hpp"
#include "protocol/dialog_words.hpp"

/// The daemon file, `schema: glidehelm/daemon/v1` (product.md 5). docs/configuration.md lists every key.
namespace glidehelm::config {

inline constexpr const char* kDaemonSchema = "glidehelm/daemon/v1";

/// Somebody pipes the dialog to us.
struct Listen {
  Endpoint at;
  std::vector<Network> allow;  ///< peers that are let in; empty: loopback only
  /// Whether a peer ("192.0.2.7") may connect.
  [[nodiscard]] bool lets_in(std::string_view peer) const;
  friend bool operator==(const Listen&, const Listen&) = default;
};
/// We dial.
struct Connect {
  Endpoint to;
  friend bool operator==(const Connect&, const Connect&) = default;
};
using Line = std::variant<Listen, Connect>;

struct GliderEntry {
  std::string name;
  Line line;
  std::string to_glider;  ///< the dockserver's folder of files for this glider; resolved, without a slash at the end
  protocol::DialogWords dialog;  ///< texts of its dialog that firmwares, dockservers and scripts word differently
  bool clock_skew_ok{};  ///< a difference of more than 5 min between glider and daemon clock is known and accepted
  friend bool operator==(const GliderEntry&, const GliderEntry&) = default;
};

enum class LogLevel { debug, info, warn, error };

struct DaemonConfig {
  std::optional<std::string> simulated_clock;   ///< socket of glidersim that hands out time; none: `clock: system`
  std::string state_dir{"/var/lib/glidehelm"};  ///< journal, grids
  std::string control_socket{"/run/glidehelm/control.sock"};
  std::vector<std::string> missions{"missions.d/*.yaml"};  ///< shell patterns of mission files; resolved
  std::string coast;                                       ///< coast file of missions that name none; empty: none
  LogLevel log_level{LogLevel::info};
  std::vector<GliderEntry> gliders;  ///< at least one
  friend bool operator==(const DaemonConfig&, const DaemonConfig&) = default;
};

/// A daemon file that is right, and the values in force as YAML with the origin of each.
struct DaemonFile {
  DaemonConfig config;
  std::string effective;
  std::vector<Place> glider_places;  ///< where each glider's entry stands
  friend bool operator==(const DaemonFile&, const DaemonFile&) = default;
};

/// Reads the daemon file. Relative paths are meant from the folder of `file` and come back resolved. A glider that
/// listens beyond loopback without `allow`, and two gliders with one name, one port or one `to_glider` folder are errors.
/// On failure every error, by line.
Expected<DaemonFile, std::vector<ConfigError>> read_daemon_file(std::string_view text, const std::string& file);

/// The resolved `missions` patterns of a daemon file, as far as they can be made out, whatever else is wrong in it: so that
/// the mistakes of the missions are told together with those of the file that names them.
std::vector<std::string> mission_patterns(std::string_view text, const std::string& file);

Shape daemon_shape();
/// config/daemon.schema.json.
std::string daemon_schema();

}  // namespace glidehelm::config
