#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ocean/freshness.hpp"
#include "daemon/ocean_pool.hpp"

namespace glidehelm::daemon {

/// Keeps the newest forecast of one mission loaded: looks for new or changed files, has them ingested by the child, swaps the
/// whole forecast at once. A running plan keeps the one it began with.
///
/// Files that cannot be used leave the last good forecast in use, also after a restart (GridCache::accepted): a bad file is
/// left out where the others are whole without it, and they replace what is in use only when they are not older. What was
/// refused is not read again until it changes; what may pass (a file still being written, a child that could not start) is
/// tried again every ten minutes. The address of an OPeNDAP server is asked anew when an hour has begun.
class ForecastWatch {
 public:
  struct Handlers {
    std::function<void(const std::shared_ptr<const OceanSource>&)> loaded;
    std::function<void(const std::string& problem)> refused;  ///< said once per set of files; see `in_use`
    std::function<void(const std::string& note)> noted{};     ///< a warning
    std::function<void()> settled{};                          ///< a load has ended, in whatever way
  };
  /// How long a published file must have been left alone, but on a simulated clock.
  static constexpr Seconds kSettle{10};
  /// `grids`: the folder of the cache; `cache`: shared by all watches of a daemon; none: opened here. `pool`: shared as well, and
  /// outlives them; none: this watch loads for itself alone.
  ForecastWatch(world::World world, std::string grids, Handlers handlers, std::shared_ptr<GridCache> cache = nullptr,
                Seconds settle = kSettle, OceanPool* pool = nullptr);
  ~ForecastWatch();

  /// From now on these currents; loads them.
  void follow(const mission::Mission& mission);
  /// Looks at the files; loads them when they changed. Cheap when they did not.
  void look();
  [[nodiscard]] std::shared_ptr<const OceanSource> current() const { return current_; }
  [[nodiscard]] bool loading() const { return loading_; }
  /// Whether a plan has to wait for the load under way: there is nothing to plan on yet, or time stands still meanwhile.
  [[nodiscard]] bool holds_up() const { return loading_ && (!current_ || world_.clock.simulated()); }
  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// Why the forecast in use is not planned on now: it is older than product.md 7 allows. None: it may be.
  [[nodiscard]] std::optional<std::string> expired() const;
  /// It may be planned on, but is old enough to be said so.
  [[nodiscard]] bool old() const { return age_s() > ocean::kOldAfter; }
  /// "rtofs 2024-10-28T00:00:00Z (sha256 1a2b3c4d5e6f), 7.5 h old", or "none".
  [[nodiscard]] std::string in_use() const;

 private:
  /// Of the forecast in use, as the verifier counts it; 0 when it does not age.
  [[nodiscard]] double age_s() const;
  [[nodiscard]] std::string fingerprint() const;
  [[nodiscard]] OceanOrder order() const;
  void load(std::string seen);
  void loaded(const OceanOrder& order, OceanOutcome outcome);
  void take(const OceanOrder& order, const std::shared_ptr<const OceanSource>& ocean);
  void refuse(const OceanOrder& order, const IngestFault& fault);
  void say_refused(const std::string& problem);
  [[nodiscard]] std::optional<IngestFault> untimely(const OceanSource& ocean) const;

  world::World world_;
  std::string grids_;
  Handlers handlers_;
  std::shared_ptr<GridCache> cache_;
  Seconds settle_;
  OceanPool* pool_;
  std::optional<mission::Mission> mission_;
  std::shared_ptr<const OceanSource> current_;
  std::string seen_, problem_, said_;
  bool loading_{}, again_{};
  std::optional<Tick> try_again_;
  std::uint64_t generation_{};
  std::shared_ptr<bool> alive_;
};

}  // namespace glidehelm::daemon
