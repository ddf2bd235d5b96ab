#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "core/ocean/time_axis.hpp"
#include "daemon/ingest_client.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm field sample FILE… --lat --lon --time [--depth M | --depth-mean MIN,MAX] | --points CSV [--members N] [--json]`.
struct FieldSampleOptions {
  std::vector<std::string> files;
  daemon::IngestOptions ingest;
  std::optional<double> lat_deg, lon_deg;
  std::optional<Instant> time;                          ///< may be left out for a field with at most one time
  std::optional<double> depth_m;                        ///< none: the shallowest level
  std::optional<std::pair<double, double>> depth_mean;  ///< plain mean between two depths
  std::string points;                                   ///< CSV of lat,lon,time[,depth]; a heading line is allowed
  ocean::Interpolation interpolation{ocean::Interpolation::linear};
  int members{};  ///< mean and spread of so many members too; 0: of none
  bool json{};
};

/// The current at one place, or at every place of a CSV. JSON for one: {"east_m_per_s", "north_m_per_s", "extrapolated"} or
/// {"none": "land | no_data | below_bottom | outside_area | outside_time", "message"}; for many, schema
/// glidehelm/field-samples/v1: {"schema", "samples": [{"lat_deg", "lon_deg", "time", "depth_m"?, and the same}]}.
/// A place that has no value at any time of the files is `land` (there is no coastline here: the model's mask is all there
/// is); one that has a value at another time is `no_data`. Times outside the files are `outside_time`.
/// With `members` each answer has the key `ensemble`: {"members", "mean_east_m_per_s", "mean_north_m_per_s", "extrapolated",
/// "spread_east_m_per_s", "spread_north_m_per_s", "spread_m_per_s"} as ocean::Family has them (the last is Spread::vector; null of one
/// member), or null where most members have no current. All members are in memory, as mapped grids.
/// Returns 0; 1 when a place has no current or the files are refused; 2 for misuse, the line of the CSV named.
int run_field_sample(const FieldSampleOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
