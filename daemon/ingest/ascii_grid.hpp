#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "daemon/ingest/fault.hpp"

namespace glidehelm::ingest {

/// An ESRI ASCII grid as it stands in the file.
struct AsciiGrid {
  std::size_t columns{}, rows{};
  double x{}, y{};             ///< centre of the south-west cell, in the file's units
  double dx{}, dy{};           ///< size of a cell
  bool corner{};               ///< the file gave the corner of the cell (xllcorner)
  std::vector<double> values;  ///< rows from north to south; NaN where NODATA
};

/// True when a file begins like an ESRI ASCII grid: its first word is `ncols` (any case).
bool is_ascii_grid(std::string_view text);

/// Reads one: keys in any case and order (ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize or dx and
/// dy, NODATA_value), then ncols · nrows numbers in lines of any length. A fault names line and column: a key twice or
/// unknown, a decimal comma, no number, too few or too many of them. Safe on hostile bytes: memory is bounded by their
/// number. Linear.
Result<AsciiGrid> read_ascii_grid(std::string_view text);

}  // namespace glidehelm::ingest
