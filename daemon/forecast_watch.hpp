#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/ocean_source.hpp"

namespace glidehelm::daemon {

/// Keeps the newest forecast of one mission loaded: looks for new or changed files, has them ingested by the child, swaps the whole
/// forecast at once. A running plan keeps the one it began with; a forecast that cannot be read leaves the last good one in use.
class ForecastWatch {
 public:
  struct Handlers {
    std::function<void(const std::shared_ptr<const OceanSource>&)> loaded;
    std::function<void(const std::string& problem)> refused;  ///< said once per set of files
  };
  ForecastWatch(world::World world, std::string grids, Handlers handlers);
  ~ForecastWatch();

  /// From now on these currents; loads them.
  void follow(const mission::Mission& mission);
  /// Looks at the files; loads them when they changed. Cheap when they did not.
  void look();
  [[nodiscard]] std::shared_ptr<const OceanSource> current() const { return current_; }
  [[nodiscard]] bool loading() const { return loading_; }
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  [[nodiscard]] std::string fingerprint() const;
  void load(std::string seen);

  world::World world_;
  std::string grids_;
  Handlers handlers_;
  std::optional<mission::Mission> mission_;
  std::shared_ptr<const OceanSource> current_;
  std::string seen_, problem_;
  bool loading_{}, again_{};
  std::uint64_t generation_{};
  std::shared_ptr<bool> alive_;
};

}  // namespace glidehelm::daemon
