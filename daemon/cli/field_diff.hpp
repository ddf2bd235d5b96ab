#pragma once

#include <ostream>
#include <string>

#include "daemon/ingest_client.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm field diff A B [--tolerance M_PER_S] [--json]`.
struct FieldDiffOptions {
  std::string a, b;  ///< each a file, an address or a shell pattern whose files are joined
  daemon::IngestOptions ingest;
  double tolerance{};  ///< m/s: the largest difference of two currents that still passes
  bool json{};
};

/// How B differs from A, on the nodes, depths and times of A that B covers; between its own, B is interpolated linearly and
/// only where all nodes around have a value. A side without depths is compared at the other's shallowest level, a side
/// without times with every time of the other.
///
/// The table has a row for everything, one per depth and one per time: number of compared nodes; rms, the root of the mean
/// squared length of B − A, m/s; bias, the mean of B − A east and north; Pearson's correlation of either component ("-"
/// where one does not vary); the longest B − A with its place and time. Nodes where only one side has a value are counted.
/// JSON, schema glidehelm/field-diff/v1: {"schema", "a", "b" (cycles), "same_axes", "tolerance_m_per_s", "differ", "only_a",
/// "only_b", "all": ROW, "depths": [{"depth_m", ROW}], "times": [{"time", ROW}]}, ROW being {"nodes", "rms_m_per_s",
/// "bias_east_m_per_s", "bias_north_m_per_s", "correlation_east", "correlation_north" (null), "max_m_per_s", "max_lat_deg",
/// "max_lon_deg", "max_depth_m" (null), "max_time" (null)}; numbers of a row without nodes are null.
///
/// Returns 0 when no difference exceeds the tolerance; 1 when one does, when the axes are the same and only one side has a
/// value somewhere, when the two have no node in common (the message says which axis), or when files are refused; 2 for misuse.
/// O(nodes of A).
int run_field_diff(const FieldDiffOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
