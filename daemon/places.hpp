#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/load.hpp"
#include "core/chart/coast.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::daemon {

/// Start and goal of missions against coast file and areas: the mistakes that a mission's text alone cannot show. What
/// start, reload, `glidehelm check` and `glidehelm plan` share.
///
/// An error says where the point lies (on land, outside the coast file, outside the allowed area), and when the same two
/// numbers the other way round are a place in charted water, nearer to the mission's other point when there is one, that
/// latitude comes first. A coast file that cannot be read is an error of `safety.coast`.
class Places {
 public:
  /// `files` must outlive this object. Coast files are read once each.
  explicit Places(world::Files& files) : files_{files} {}

  /// `text` is the mission's YAML as read from `file`: errors name its line and column.
  std::vector<config::ConfigError> errors_of(const mission::Mission& mission, const std::string& text,
                                             const std::string& file);
  std::vector<config::ConfigError> errors_of(const config::Configuration& all);

 private:
  /// A bathymetry that cannot be read, or a goal where it knows no water.
  std::vector<config::ConfigError> depth_errors(const mission::Mission& m, const std::string& text,
                                                const std::string& file);
  struct Known {
    std::shared_ptr<const chart::Coast> coast;
    std::string problem;  ///< why there is none, though one is named
  };
  const Known& coast_of(const std::string& path);

  world::Files& files_;
  std::map<std::string, Known> known_;
};

}  // namespace glidehelm::daemon
