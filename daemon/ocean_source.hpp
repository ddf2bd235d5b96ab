#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/mission/learning.hpp"
#include "core/mission/mission.hpp"
#include "core/ocean/forecast.hpp"
#include "daemon/ingest_client.hpp"
#include "daemon/verify/dossier_json.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::daemon {

/// A forecast as planners take it, and as the verifier finds it again. Immutable; a running plan keeps the one it began with.
struct OceanSource {
  ocean::Forecast forecast;
  std::optional<verify::InputFile> grid;  ///< the flat grid, by name and identity; of several see `sources`
  ocean::GriddedOptions options;
  std::vector<ocean::AnalyticSpec> analytic;
  Instant analytic_start;
  ocean::Coverage analytic_box;
  std::vector<std::string> files;  ///< published files that went in
  /// Removes the grid's file when the last user lets go; empty when nothing is to be removed.
  std::shared_ptr<const void> grid_file;
  std::optional<Sha256> key{};  ///< with a cache: which grid it is
  std::vector<LeftOut> left_out{};
  bool try_again{};                           ///< a file was left out for a reason that passes
  std::vector<std::string> notes{};           ///< what an operator may want to know of the loading
  std::vector<verify::SourceFile> sources{};  ///< of `currents.sources`, in order of trust
  ocean::Seams seams{};
  /// Of each of `sources`: which grid it is in the cache, and from when it ages.
  struct Origin {
    std::string name;
    std::optional<Sha256> key;
    std::optional<double> issued_s;
  };
  std::vector<Origin> origins{};

  /// "rtofs 2024-10-28T00:00:00Z (sha256 1a2b3c4d5e6f)": provenance in one line.
  [[nodiscard]] std::string label() const;
};
using OceanResult = Expected<std::shared_ptr<const OceanSource>, std::string>;

/// What a mission's `currents` says, made ready for its vehicle and schedule. `start` is t0 of analytic fields that name none and the
/// middle of their box together with the goal. `grids`: the folder that keeps the flat grid. `has_coast`: without one the model's mask is land.
struct OceanOrder {
  mission::Mission mission;
  std::string grids;
  bool has_coast{};
  Instant start;
  std::optional<GeoPoint> from;
  std::shared_ptr<GridCache> cache{};  ///< async only
  Seconds settle{};                    ///< how long a file must have been left alone
  /// Epoch second at which a source that has expired is left out while another one remains; none: all are kept.
  std::optional<double> now_s{};
  /// Of the ensemble, from 0; none: 0. Where the mission's members have files of their own it is one of them.
  std::optional<std::uint32_t> member{};
};
/// What of the ocean a verifier opens itself.
void put_ocean(const OceanSource& ocean, verify::VerifyRequest& request);
/// Blocks: for the command line.
OceanResult load_ocean(const OceanOrder& order, world::World& world);
using OceanOutcome = Expected<std::shared_ptr<const OceanSource>, IngestFault>;
/// `then` is called from the loop.
void load_ocean_async(const OceanOrder& order, world::World& world, std::function<void(OceanOutcome)> then);
/// The last forecast that was accepted for this order, from its cache, whatever the files are now; none when there was none.
std::shared_ptr<const OceanSource> last_accepted(const OceanOrder& order, world::World& world);
/// Remembers this forecast as the one that was accepted last for this order.
void accept_ocean(const OceanOrder& order, const OceanSource& ocean);

/// Mean of the uncorrected forecast over the dive profile along the straight way from `dive` to a fix at epoch second
/// `until_s`, flown at constant speed: 24 samples. None when a sample has no current, or the dive is shorter than 10 min
/// or longer than 4 days.
std::optional<Current> mean_along(const OceanSource& ocean, const mission::Dive& dive, GeoPoint to, double until_s);

/// What a mission's chart is made of.
struct ChartOrder {
  std::string coast_file, bathymetry_file;
  Metres least_depth;
  std::vector<chart::Area> keep_in, keep_out;
  explicit ChartOrder(const mission::Mission& m)
      : coast_file{m.coast_file},
        bathymetry_file{m.bathymetry_file},
        least_depth{m.least_depth()},
        keep_in{m.keep_in},
        keep_out{m.keep_out} {}
  friend bool operator==(const ChartOrder&, const ChartOrder&) = default;
};

/// The chart of a mission: coast file, bathymetry and areas.
struct ChartSource {
  chart::Chart chart;
  std::optional<verify::InputFile> coast, bathymetry;
  Metres least_depth{};
  std::vector<chart::Area> keep_in, keep_out;
};
Expected<std::shared_ptr<const ChartSource>, std::string> load_chart(const mission::Mission& mission,
                                                                     world::Files& files);

}  // namespace glidehelm::daemon
