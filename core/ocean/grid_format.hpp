#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/hash.hpp"
#include "core/ocean/seawater.hpp"

/// The flat grid: what `glidehelm-ingest` writes and everybody else maps.
///
/// One file, little-endian, laid out so that it can be used in place:
///
///     offset  size  field
///          0     8  magic "GLHGRID1"
///          8     4  version (5; 4, which has no water, is read too)
///         12     4  bytes of the whole header (a multiple of 64): the payload begins there
///         16     4  CRC-32C of the header, computed with this field zero
///         20     4  CRC-32C of the payload
///         24     8  bytes of the payload = 8 · times · depths · latitudes · longitudes
///         32    16  number of times, depths, latitudes, longitudes
///         48     4  flags: 1 the times mean something, 2 the depths mean something
///         52     4  zero
///         56     8  reference time of the forecast, epoch seconds; NaN when the sources name none
///         64    32  SHA-256 over the hashes of the sources, in order
///         96     …  doubles: times (epoch seconds), depths (m, positive down), latitudes, longitudes (degrees)
///          …     …  texts: each a 32-bit length and its bytes; see GridFacts
///          …     …  filled nodes: their number of runs (32 bits), then each run's first node and length (64 bits each)
///          …     …  water: its number of layers (32 bits), each layer's depth (m), temperature (°C) and salinity (doubles), and a text
///     header     …  float (east, north) in m/s, interleaved, [time][depth][latitude][longitude]; NaN = no value
///
/// All axes ascend. Longitudes are unwrapped (170 … 190 across the antimeridian), begin in [−180, 180) and span less
/// than 360. Either both components of a node are finite or both are NaN.
namespace glidehelm::ocean {

/// Version of the layout; another version is another file, but for one.
inline constexpr std::uint32_t kGridVersion = 5, kGridVersionWithoutWater = 4;

/// One file that went into a grid.
struct GridSource {
  std::string name;
  Sha256 hash;
  friend bool operator==(const GridSource&, const GridSource&) = default;
};

/// Temperature and salinity of a forecast as one column, a mean over its area and times: what a glider is weighed in.
struct GridWater {
  std::vector<WaterLayer> layers;  ///< from the top; empty: none
  std::string words;               ///< of which variables it was made, or why there is none; empty: nobody looked
  friend bool operator==(const GridWater&, const GridWater&) = default;
};

/// What a person wants to know about a grid beside its numbers.
struct GridFacts {
  std::string cycle;                                             ///< name of the source and cycle, as log lines show it
  double reference_s{std::numeric_limits<double>::quiet_NaN()};  ///< forecast reference time; NaN when not named
  std::string east_variable, north_variable;
  std::string east_unit, north_unit;  ///< as the file writes them; empty when it has none
  std::string recognised_by;          ///< why these variables: "standard_name …", "name …", "asked for"
  std::string time_unit;              ///< as the file writes it
  std::string layout;                 ///< how the file's own grid was brought onto this one; empty: it is this one
  std::vector<GridSource> sources;    ///< in the order of the arguments
  std::vector<std::string> warnings;
  GridWater water;
};

/// Axes of a grid. Without a time (depth) axis the vector holds one value that means nothing.
struct GridAxes {
  std::vector<double> times_s;   ///< epoch seconds
  std::vector<double> depths_m;  ///< positive down
  std::vector<double> lats_deg, lons_deg;
  bool has_time{true}, has_depth{true};
  [[nodiscard]] std::size_t nodes() const {
    return times_s.size() * depths_m.size() * lats_deg.size() * lons_deg.size();
  }
  friend bool operator==(const GridAxes&, const GridAxes&) = default;
};

/// Nodes that follow each other, counted [time][depth][latitude][longitude].
struct NodeRun {
  std::uint64_t first{}, length{};
  friend bool operator==(const NodeRun&, const NodeRun&) = default;
};
/// The marked nodes as runs, ascending, with at least one unmarked node between them.
std::vector<NodeRun> runs_of(const std::vector<bool>& marked);

/// A grid that owns its numbers: what ingest builds and tests make.
struct Grid {
  GridAxes axes;
  GridFacts facts;
  std::vector<float> values;      ///< 2 · nodes: east, north, interleaved, [time][depth][latitude][longitude]
  std::vector<NodeRun> filled{};  ///< nodes whose values were borrowed from their neighbours; as `runs_of` makes them
};

/// Why bytes are not a grid.
struct GridError {
  std::string what;   ///< the fault in words: "the payload's checksum is wrong"
  std::string where;  ///< the part of the file: "header", "latitudes", "payload"
  [[nodiscard]] std::string message() const { return where + ": " + what; }
  friend bool operator==(const GridError&, const GridError&) = default;
};

/// A checked, non-owning view of a grid's bytes: axes and facts are copied out, the values are read in place. The bytes
/// must outlive the view.
struct GridView {
  GridAxes axes;
  GridFacts facts;
  Sha256 provenance;      ///< over the hashes of the sources
  const float* values{};  ///< 2 · axes.nodes() floats
  std::vector<NodeRun> filled{};
};

/// The bytes of a grid. Precondition: axes and values fit together (ascending axes, sizes, NaN in pairs); `open_grid`
/// on the result succeeds.
std::string write_grid(const Grid& grid);

/// Believes nothing: magic, version, sizes (with overflow), checksums, texts, ascending finite axes in range, span of the
/// longitudes, that every value is finite or half of a pair of NaN, that filled nodes exist and have values, and that the water is one that
/// a sea can have. One pass over the payload. The bytes must be
/// aligned to four (a mapping and the heap are).
Expected<GridView, GridError> open_grid(std::span<const std::byte> bytes);

/// The view of an owned grid, unchecked: for fields made in memory. `grid` must outlive the view.
GridView view_of(const Grid& grid);

/// SHA-256 over the hashes of the sources in order: one name for everything that went in.
Sha256 provenance_of(const std::vector<GridSource>& sources);

/// Share of nodes with a value, and the range and mean of the speeds (m/s) there.
struct GridStatistics {
  double wet_fraction{}, slowest{}, fastest{}, mean{};
};
GridStatistics statistics_of(const GridView& view);

}  // namespace glidehelm::ocean
