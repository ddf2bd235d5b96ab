#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/axis_values.hpp"

/// One file, read.
namespace glidehelm::ingest {

/// What the command line says about reading.
struct ReadOptions {
  std::string east, north;  ///< empty: recognised
  std::optional<Instant> time_epoch;
  std::optional<Area> area;
};

/// One file as a grid, with its name and what was noticed.
struct Part {
  std::string file;
  ocean::Grid grid;  ///< facts.warnings without the file's name
};

/// Reads the currents of one file: east and north in m/s, NaN where either is missing, axes ascending. Refused, with the
/// place: files that are not whole, variables or axes that are not recognised (recognise.hpp), units that cannot be read,
/// a field without any value, with nothing but zeros, with a time of nothing but zeros (a file still being written), or
/// faster than 5 m/s, or of more than 2e9 nodes. A time without any value is left out with a warning; speeds above 3.5 m/s are warned about.
Result<Part> read_part(const std::string& name, std::span<const std::byte> bytes, const Units& units,
                       const ReadOptions& options);

}  // namespace glidehelm::ingest
