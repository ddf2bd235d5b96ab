#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/utm.hpp"
#include "daemon/ingest/axis_values.hpp"
#include "daemon/ingest/even_depths.hpp"
#include "daemon/ingest/units.hpp"

namespace glidehelm::ingest {

/// What the reader of a bathymetry is told about it.
struct DepthOptions {
  enum class Positive { unknown, up, down };
  Positive positive{Positive::unknown};  ///< --positive: what the numbers mean, whatever the file says
  std::string variable;                  ///< --depth-variable: of a NetCDF file with several
  std::string crs;                       ///< --crs: degrees, utm33n, EPSG:32633; empty: as the file says
  std::string prj;                       ///< text of the .prj file beside an ASCII grid; empty: none
  std::optional<Area> area;              ///< --area: part to keep
};

/// The zone that a .prj file (WKT) names. Refused: anything but UTM on WGS84, NAD83 or ETRS89, in metres.
Result<UtmZone> zone_of_prj(std::string_view wkt);

/// Which way the numbers of a variable count, and why: by `positive`, standard_name, name, long_name, in this order, the
/// first that says it; two that disagree are a fault, and so is nothing that says it (the message names --positive).
struct Sign {
  bool up{};
  std::string why;
};
Result<Sign> sign_of(const Variable& variable);

/// Reads a bathymetry: ESRI ASCII in degrees or UTM metres (is_ascii_grid), else NetCDF with latitude and longitude as axes
/// or in two dimensions. Depths come out positive down on an even grid (even_depths); `decided` says in words which way the
/// file counts and how that is known, `source` what was read.
///
/// Which way up an ASCII grid counts is in no header: --positive must say it. A file in which every known depth would be
/// land is refused, for then the sign is wrong.
Result<chart::DepthGrid> read_depths(std::string_view bytes, const DepthOptions& options, const Units& units);

}  // namespace glidehelm::ingest
