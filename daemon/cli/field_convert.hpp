#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "daemon/ingest_client.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm field convert FILE… --out NEW.nc|NEW.grid [--box W/E/S/N] [--depth-mean MIN,MAX] [--times FROM,TO]`.
struct FieldConvertOptions {
  std::vector<std::string> files;
  daemon::IngestOptions
      ingest;       ///< its `area` is --box: nodes in it and next to it, so that all of it lies between nodes
  std::string out;  ///< a new file; what it becomes is told by its ending
  std::optional<std::pair<double, double>> depth_mean;  ///< metres: one level, the plain mean between two depths
  std::optional<Instant> from, to;                      ///< times kept, both ends included
};

/// Writes what was read as a clean file: `.nc`, CF NetCDF (classic, 64-bit offsets: every tool reads it), or `.grid`, the
/// flat grid that glidehelm-ingest writes. The NetCDF file has float currents `uo` and `vo` in m s-1 over (time, [depth,] lat,
/// lon), NaN as _FillValue, times in seconds since 1970, the forecast's reference time where the sources name one, and their
/// names and SHA-256 in `source`. Numbers and axes keep every bit: read again, the same floats come back.
///
/// Gaps of surface currents are left as published unless --fill-gaps asks: a filled value looks like a measured one then, and
/// a warning says so. `out` says in one line what was written. Returns 0; 1 when the files are refused, nothing is left
/// of them, or the file cannot be written (one that exists is never replaced); 2 for misuse. Memory: twice the file.
int run_field_convert(const FieldConvertOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
