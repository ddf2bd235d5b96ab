#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/analytic_field.hpp"
#include "config/yaml_reader/fields.hpp"
#include "core/mission/mission.hpp"

/// The key `currents` of a mission: files, analytic fields, or a list of both.
namespace glidehelm::config {

/// Files and how they are read.
struct FilesDraft {
  std::vector<std::string> files;
  mission::OutsideTime outside_time{mission::OutsideTime::hold};
  mission::Interpolation interpolation{mission::Interpolation::linear};
  std::string east, north;
  std::optional<Instant> time_epoch;
  mission::CurrentFiles::Heights heights{mission::CurrentFiles{}.heights};
  Radians equator_band{mission::CurrentFiles{}.equator_band};
  std::optional<Metres> fill_gaps;
  std::string grid_file;
  mission::CurrentFiles::Rotation rotation{mission::CurrentFiles{}.rotation};
  std::optional<int> vtransform, vstretching;  ///< of s_levels: all five or none
  std::optional<double> theta_s, theta_b;
  std::optional<Metres> critical_depth;
};

/// One of `sources`.
struct SourceDraft : FilesDraft {
  std::string name;
  std::vector<GeoPoint> region;
  std::optional<Seconds> from, to;
};

/// `ensemble:` as it stands in the file.
struct EnsembleDraft {
  std::optional<int> members;  ///< none: no ensemble
  int first{mission::Ensemble{}.first};
};

/// One item of `currents`: files, sources or one analytic field.
struct CurrentsItem : FilesDraft {
  std::vector<SourceDraft> sources;
  EnsembleDraft ensemble;
  Metres blend{mission::Currents{}.blend};
  Seconds join{mission::Currents{}.join};
  std::optional<AnalyticDraft> analytic;
  bool local_correction{mission::Currents{}.local_correction};
  Metres correction_length{mission::Currents{}.correction_length};
  Seconds correction_time{mission::Currents{}.correction_time};
};

/// The shape of `currents`: a map, or a list of maps whose fields add up.
Shape currents_shape();
/// Reads `currents` into its items: each has files, sources or an analytic field; at most one has files or sources; what they say
/// about reading files agrees. Relative files are meant from the folder of the mission file.
void read_currents(const At& at, std::vector<CurrentsItem>& items);
void print_currents(const std::vector<CurrentsItem>& items, const std::string& path, Effective& out);
/// Items without error as the mission has them, parameters filled in from their defaults.
mission::Currents resolve_currents(const std::vector<CurrentsItem>& items);

}  // namespace glidehelm::config
