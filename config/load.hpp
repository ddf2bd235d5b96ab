#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/daemon.hpp"
#include "config/mission.hpp"
#include "core/base/hash.hpp"

/// Everything that is configured, or every error of it: what start, reload and `glidehelm check` share.
namespace glidehelm::config {

/// How files are reached: config/ opens none itself.
struct Sources {
  LoadFile read;  ///< bytes of a file
  std::function<std::vector<std::string>(const std::string& pattern)>
      matches;  ///< existing files of a shell pattern, sorted
};

struct LoadedMission {
  std::string file;          ///< path, from the patterns of the daemon file
  mission::Mission mission;  ///< with the daemon's `coast` where the mission names none
  std::string text;          ///< bytes of the file, as read
  Sha256 sha256;             ///< of `text`
  std::string follows;       ///< name of the mission whose `after_goal` leads here; empty: it begins
  friend bool operator==(const LoadedMission&, const LoadedMission&) = default;
};

struct Configuration {
  std::string file;  ///< the daemon file
  DaemonConfig daemon;
  Sha256 sha256;  ///< of the daemon file's bytes
  /// In the order of the patterns, then by name. Each glider has at most one mission with an empty `follows`; that one is
  /// flown, the others wait for their turn.
  std::vector<LoadedMission> missions;
  friend bool operator==(const Configuration&, const Configuration&) = default;
};

/// Reads the daemon file and every mission file that its patterns match. All or nothing: one error anywhere and the
/// answer is all errors, by file and line. Across files: a mission for a glider that is not configured (with the nearest
/// name), two missions of one name, two missions for one glider unless one leads to the other by `after_goal`, an
/// `after_goal` that names no mission of that glider, a pattern without wildcard that names no file. A glider without a
/// mission is none.
Expected<Configuration, std::vector<ConfigError>> load(const std::string& daemon_file, const Sources& sources);

/// An error of a key (`safety.coast`) of a file that is right by itself: its place is looked up in `text`, that of the
/// innermost part of the key that stands there.
ConfigError error_at(const std::string& text, const std::string& file, const std::string& key, std::string problem);

}  // namespace glidehelm::config
