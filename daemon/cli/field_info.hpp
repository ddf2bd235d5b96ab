#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "daemon/ingest_client.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm field info FILE… [--json]`.
struct FieldInfoOptions {
  std::vector<std::string> files;  ///< names or shell patterns
  daemon::IngestOptions ingest;
  bool json{};
};

/// Says what a forecast is: variables recognised and why, grid, extent, times, depths, units, wet fraction, speeds,
/// sources with their hashes, warnings.
///
/// JSON on `out`, schema glidehelm/field-info/v1: {"schema", "cycle", "reference_time" (null when not named), "provenance",
/// "variables": {"east": {"name", "unit" (null: none, taken as m/s)}, "north": {…}, "recognised_by"},
/// "grid": {"kind": "rectilinear" or "curvilinear" (as published), "published_as" (how a model's own grid was read and
/// brought onto these axes, in words; null: it is these axes), "latitudes": AXIS, "longitudes": AXIS}, "extent": {"west_deg", "east_deg", "south_deg",
/// "north_deg", "around_globe"}, "times": {"count", "first", "last", "longest_step_s", "unit"} (null without a time axis),
/// "depths_m": […] (empty without a depth axis), "wet_fraction", "speed_m_per_s": {"min", "mean", "max"},
/// "sources": [{"file", "sha256"}], "warnings": […]}, AXIS being {"count", "first_deg", "last_deg", "step_deg" (mean),
/// "even"}. Messages on `err`. Returns 0; 1 when the files are refused; 2 without files.
int run_field_info(const FieldInfoOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
