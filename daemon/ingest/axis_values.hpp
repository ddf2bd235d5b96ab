#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "daemon/ingest/recognise.hpp"
#include "daemon/ingest/units.hpp"

/// Axes as the grid wants them: ascending, in degrees, metres and epoch seconds, with the way back to the file's order.
namespace glidehelm::ingest {

/// Values in ascending order; `source[k]` is the file's index of value k.
struct Ascending {
  std::vector<double> values;
  std::vector<std::size_t> source;
};

/// Area to keep, degrees; east ≥ west (170 … 190 across the antimeridian).
struct Area {
  double west{}, east{}, south{}, north{};
};

/// Latitudes in degrees. Missing unit: degrees, with a warning.
Result<Ascending> latitudes(const NetcdfFile& file, const Variable& coordinate, const Units& units,
                            std::vector<std::string>& warnings);
/// Longitudes, unwrapped (0–360, ±180 and jumps within the axis), beginning in [−180, 180); a closing column that repeats
/// the first is left out.
Result<Ascending> longitudes(const NetcdfFile& file, const Variable& coordinate, const Units& units,
                             std::vector<std::string>& warnings);
/// Depths in metres, positive down (an axis with `positive: up`, or all values negative, is turned round).
Result<Ascending> depths(const NetcdfFile& file, const Variable& coordinate, const Units& units,
                         std::vector<std::string>& warnings);
/// Times as epoch seconds, to the millisecond. `epoch` counts where the unit names none.
Result<Ascending> times(const NetcdfFile& file, const Variable& coordinate, const Units& units,
                        std::optional<Instant> epoch, std::vector<std::string>& warnings);

/// The part of both axes that covers `area` with one node to spare on each side (global longitudes are rotated so that the
/// part is in one piece). A fault when nothing of the grid lies in the area.
Result<Done> cut(Ascending& lats, Ascending& lons, const Area& area);

}  // namespace glidehelm::ingest
