#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/yaml_reader/fields.hpp"
#include "core/mission/mission.hpp"

/// The key `currents` of a mission: files, analytic fields, or a list of both.
namespace glidehelm::config {

/// Parameters of every analytic kind; `parameters_of` says which belong to one.
struct AnalyticParams {
  std::optional<double> u, v, omega, rate, a, epsilon, b0, theta, k, c;
  std::optional<bool> dynamic;
  std::vector<std::vector<double>> list;
};

/// `analytic:` as it stands in the file.
struct AnalyticDraft : mission::AnalyticSpec {
  std::optional<double> lat_deg, lon_deg;
  AnalyticParams given;
};

/// One item of `currents`: files or one analytic field, and how to read the files.
struct CurrentsItem {
  std::vector<std::string> files;
  std::optional<AnalyticDraft> analytic;
  mission::OutsideTime outside_time{mission::OutsideTime::hold};
  mission::Interpolation interpolation{mission::Interpolation::linear};
  std::string east, north;
  std::optional<Instant> time_epoch;
  mission::Currents::Heights heights{mission::Currents{}.heights};
  Radians equator_band{mission::Currents{}.equator_band};
  std::optional<Metres> fill_gaps;
  std::string grid_file;
  mission::Currents::Rotation rotation{mission::Currents{}.rotation};
  std::optional<int> vtransform, vstretching;  ///< of s_levels: all five or none
  std::optional<double> theta_s, theta_b;
  std::optional<Metres> critical_depth;
  bool local_correction{mission::Currents{}.local_correction};
  Metres correction_length{mission::Currents{}.correction_length};
  Seconds correction_time{mission::Currents{}.correction_time};
};

/// The shape of `currents`: a map, or a list of maps whose fields add up.
Shape currents_shape();
/// Reads `currents` into its items: each has either files or an analytic field; at most one has files; what they say
/// about reading files agrees. Relative files are meant from the folder of the mission file.
void read_currents(const At& at, std::vector<CurrentsItem>& items);
void print_currents(const std::vector<CurrentsItem>& items, const std::string& path, Effective& out);
/// Items without error as the mission has them, parameters filled in from their defaults.
mission::Currents resolve_currents(const std::vector<CurrentsItem>& items);

}  // namespace glidehelm::config
