#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <utility>

#include "core/vehicle/drift.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm drift MISSION [--depth M | --float [--park M] [--profile M] [--cycle H] [--surface MIN] [--vertical-speed M_PER_S]]
/// [--from LAT,LON] [--at TIME] [--hours H] [--every MIN] [--members N] [--json]`.
struct DriftOptions {
  std::string mission;
  vehicle::Passive vehicle;                       ///< a drifter at the surface
  std::optional<std::pair<double, double>> from;  ///< degrees: latitude, longitude
  std::optional<Instant> at;
  Seconds duration{240 * 3600.0};
  Seconds every{6 * 3600.0};
  int members{};  ///< of the forecast's ensemble to drift in; 0: in all of the mission's ensemble
  bool json{};
};

/// Where a drifter or a profiling float goes in the mission's currents (core/vehicle/drift.hpp). Start and time are those of `plan`; of the
/// mission only start, currents and coast count: what is an area or too shallow for its glider is open water here. It ends early when the
/// forecast does (unless `currents.outside_time` is cycle, or it has one time only), and on land.
///
/// JSON: {"schema": "glidehelm/drift/v1", "vehicle": {"kind": "drifter", "depth_m"} or {"kind": "float", "park_m", "profile_m", "cycle_s",
/// "surface_s", "vertical_speed_m_per_s"}, "start": {lat_deg, lon_deg, time}, "end": {"reason", "after_s", "lat_deg", "lon_deg", "time",
/// "distance_m", "bearing_deg"}, "track": [{time, lat_deg, lon_deg, phase, depth_m, due_m, east_m_per_s, north_m_per_s, distance_m}],
/// "provenance": {"forecast", "mission_sha256", "version"}}, with `ensemble` {"members", "afloat", "mean": {lat_deg, lon_deg}, "spread_m",
/// "ends": [{"member", and the keys of end}]} where there is one; reasons are the words of vehicle::DriftEnd. A drift that does not get under
/// way has an empty track and a null time and place of its end.
///
/// Returns 0 when it is afloat at the end of the time or of the forecast, 1 when it ends otherwise or nothing can be computed, 2 misuse.
int run_drift(const DriftOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
