#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/axis_values.hpp"
#include "daemon/ingest/netcdf_file.hpp"
#include "daemon/ingest/vertical.hpp"

/// One file, read.
namespace glidehelm::ingest {

/// What the components of a model's velocity mean, when the files leave it open.
enum class Turning {
  recognised,  ///< by standard_name, names and staggering; refused when these leave it open and the grid is turned
  angle,       ///< along the grid's axes, turned by the file's angle
  grid,        ///< along the grid's axes, turned by the directions of the axes
  none         ///< east and north already
};

/// What the command line says about reading.
struct ReadOptions {
  std::string east, north;  ///< empty: recognised
  std::optional<Instant> time_epoch;
  std::optional<Area> area;
  /// Currents from the height of the sea surface (geostrophic.hpp): where a file has no velocity, always, or never.
  enum class Heights { when_needed, always, never } heights{Heights::when_needed};
  /// |latitude| below which heights say nothing. 5° by default, as the errata of Thesis A.1–A.2 ask: there a slope of 1 cm
  /// in 100 km already stands for 0.08 m/s, and ever more towards the equator.
  double equator_band_deg{5};
  /// Gaps up to which distance are filled (gap_fill.hpp), metres; 0: none. Not named: two cells in files that say that they
  /// come from HF radar, none in others.
  std::optional<double> fill_gaps_m;
  double nodes_at_most{2e9};          ///< 16 GB of floats
  std::optional<double> only_time_s;  ///< one of the file's times alone: a second look at what may still change
  Turning turning{Turning::recognised};
  std::optional<StretchingChoice> stretching;  ///< of s-levels that the files do not describe
  std::optional<std::size_t> member;           ///< of an ensemble, from 0; none: 0 (ensemble.hpp)
};

/// An open file that describes the grid of others, with its name and hash.
struct GridFile {
  const NetcdfFile* file{};
  ocean::GridSource source;
};

/// Which components of the current a part has numbers for.
enum class Holds { both, east, north };

/// One file as a grid, with its name and what was noticed.
struct Part {
  std::string file;
  ocean::Grid grid;  ///< facts.warnings without the file's name
  Holds holds{Holds::both};
  std::optional<EnsembleMember> member{};  ///< none: the current is no member of an ensemble
};

/// Reads the currents of one file: east and north in m/s, NaN where either is missing, axes ascending. Refused, with the
/// place: files that are not whole, variables or axes that are not recognised (recognise.hpp), units that cannot be read,
/// a field of more than 2e9 nodes, and what no sea can be (plausible.hpp). A file with one component only becomes half a
/// part; a file without velocity but with heights of the sea surface becomes the geostrophic current, and its facts say
/// "computed from heights". Files that are no rectilinear grid with depths (staggered, curvilinear, terrain-following) are
/// brought onto one, with the help of `grids` (model_part.hpp). Temperature and salinity beside the currents become the water of
/// the facts (water.hpp); they refuse nothing.
Result<Part> read_part(const std::string& name, std::span<const std::byte> bytes, const Units& units,
                       const ReadOptions& options, const std::vector<GridFile>& grids = {});

/// The same of a file that is open, with its hash.
Result<Part> read_open_file(const std::string& name, const NetcdfFile& file, const Sha256& hash, const Units& units,
                            const ReadOptions& options, const std::vector<GridFile>& grids = {});

/// The u of one file and the v of another on a model's own grid, both open; then grid files.
Result<Part> read_model_pair(const std::string& name, const std::vector<GridFile>& files, const Units& units,
                             const ReadOptions& options);

/// Makes whole parts of halves: the east of one file and the north of another that lie on the same axes and times. What
/// was whole stays; a half without its other is refused.
Result<std::vector<Part>> pair_halves(std::vector<Part> parts);

}  // namespace glidehelm::ingest
