#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/ocean_source.hpp"

namespace glidehelm::daemon {

/// Forecasts in use, so that gliders that fly on the same files with the same profile share one: ten gliders ingest a cycle once
/// and hold it once. A forecast stays only as long as somebody else uses it. Analytic currents lie around each glider's own
/// goal and are never shared. Used from the loop's thread.
class OceanPool {
 public:
  using Then = std::function<void(OceanOutcome)>;

  /// As load_ocean_async. `seen` tells these files from later ones of the same names. Who asks while the same order is being
  /// read waits for that answer, in the order of asking; a failure is told to all of them and forgotten, and a forecast in
  /// which a file was left out for a reason that passes is not handed on later.
  void load(const OceanOrder& order, const std::string& seen, world::World& world, Then then);

 private:
  struct Entry {
    OceanOrder order;
    std::string seen;
    std::weak_ptr<const OceanSource> ocean;
    std::vector<Then> waiting;  ///< for the answer; not empty while it is being read
  };
  std::vector<std::shared_ptr<Entry>> entries_;
};

}  // namespace glidehelm::daemon
