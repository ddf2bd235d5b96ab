#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/expected.hpp"
#include "daemon/world/files.hpp"
#include "simulator/netcdf_classic.hpp"
#include "simulator/ocean_error.hpp"

namespace glidehelm::simulator {

/// The model's runs that reach the shore while the gliders fly: one file per cycle, `cycle_20260301T000000.nc`.
struct ForecastPlan {
  std::string folder;  ///< made if absent; empty: no files
  double every_h{24};  ///< from one reference time to the next, counted from midnight UTC
  double delay_h{6};   ///< from the reference time until the file is there
  double hours{96};    ///< length of each
  double time_step_h{3};
  int keep{2};  ///< newest files that stay; older ones are removed
  ForecastGrid grid;
  /// Each cycle's own error beside what the model has wrong anyway, drawn anew: two cycles never say quite the same.
  double cycle_noise_m_per_s{0.02};
  std::uint64_t seed{1};
};

/// Puts the files of a plan into their folder as simulated time passes, each complete at once (written under a name that no
/// `*.nc` matches, then renamed). The same plan and times make the same bytes.
class ForecastFeed {
 public:
  /// `model` must outlive the feed. The message says what is wrong with the folder.
  static Expected<std::unique_ptr<ForecastFeed>, std::string> make(world::Files& files, ForecastPlan plan,
                                                                   ocean::FieldRef model);
  /// Publishes every cycle that is due at `now` and not yet there: at the first call only the newest one.
  [[nodiscard]] Expected<int, std::string> publish(Instant now);

 private:
  ForecastFeed(ForecastPlan plan, ocean::FieldRef model, std::unique_ptr<world::Folder> folder)
      : plan_{std::move(plan)}, model_{model}, folder_{std::move(folder)} {}
  [[nodiscard]] Expected<Done, std::string> publish_cycle(double reference_s);
  void forget_old();

  ForecastPlan plan_;
  ocean::FieldRef model_;
  std::unique_ptr<world::Folder> folder_;
  std::optional<double> last_s_;  ///< reference time of the newest cycle that is there
};

}  // namespace glidehelm::simulator
