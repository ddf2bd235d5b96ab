#pragma once

#include <optional>
#include <ostream>
#include <string>

#include "core/base/geo.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::cli {

/// `glidehelm mafile FILE [--near LAT,LON] [--strict] [--json]`.
struct MafileOptions {
  std::string file;
  std::optional<GeoPoint> near;  ///< the glider: waypoints are checked for plausibility against it
  bool strict{};                 ///< judge it as if we were to send it
  bool json{};
};

/// Reads a mafile and lists its problems (the codes are those of protocol/mafile.hpp).
///
/// Text: what the file says on `out`, with the defaults that the glider takes for what it leaves out; its problems on
/// `err` as "FILE: line 3, column 7: error: … [code]". JSON on `out`: product.md 9, one document; a value that is no
/// number and a waypoint that is no position are null.
/// Returns 0 when no problem is an error, 1 when one is or the file cannot be read, 2 without a file.
int run_mafile(const MafileOptions& options, world::Files& files, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
