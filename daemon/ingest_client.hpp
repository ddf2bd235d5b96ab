#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/grid_cache.hpp"
#include "daemon/world/world.hpp"

/// How the daemon and the command line get at forecasts: they run the child `glidehelm-ingest` and map what it wrote.
namespace glidehelm::daemon {

struct IngestOptions {
  std::string east, north;            ///< velocity variables; empty: recognised
  std::optional<Instant> time_epoch;  ///< for a time axis whose unit names none
  struct Area {
    double west_deg{}, east_deg{}, south_deg{}, north_deg{};
  };
  std::optional<Area> area;  ///< part to keep; none: all
  std::string heights;       ///< "always", "never"; empty: currents from heights where a file has no velocity
  std::optional<double> equator_band_deg, fill_gaps_km;  ///< none: as glidehelm-ingest has it
  std::string grid_file;  ///< of a model whose grid is not in its forecasts; never left out of a set; empty: none
  std::string rotation;   ///< "angle", "grid", "none"; empty: recognised
  std::string s_levels;   ///< "vtransform=…,vstretching=…,theta_s=…,theta_b=…,hc=…"; empty: as the files say
  std::optional<std::uint32_t> member;  ///< of an ensemble, from 0 in the order of the file; none: 0
  std::string keep_in;    ///< folder where the grid keeps its name (another process maps it too); empty: none
  Seconds deadline{300};  ///< on the wall; longer than the CPU time that the child may use
  /// Of the child, bytes; 0: no limit. Enough for a file of 4 GB beside its grid.
  std::size_t memory_at_most{std::size_t{8} << 30};
  Seconds settle{0};                 ///< how long a file must have been left alone; a younger one is waited for
  std::shared_ptr<GridCache> cache;  ///< async only: grids and refusals of before; `keep_in` is not used with it
};

/// A file of a set that was not used, and why.
struct LeftOut {
  std::string file, why;
  friend bool operator==(const LeftOut&, const LeftOut&) = default;
};

/// A checked grid, mapped read-only: from the cache, or from a private file that has no name any more (nobody can change or
/// truncate it, and its room on disk is free when the last user lets go).
struct LoadedGrid {
  std::unique_ptr<world::Mapping> mapping;
  ocean::GridView view;  ///< into the mapping
  std::string path;      ///< with `keep_in` or a cache: the grid's name; with `keep_in` the caller's to remove
  std::vector<std::string> files;    ///< what went in, in order
  std::shared_ptr<const void> hold;  ///< with a cache: while it lives the name stays
  std::optional<Sha256> key;         ///< with a cache: which grid it is
  std::vector<LeftOut> left_out;
  bool try_again{};                ///< one was left out for a reason that passes
  std::vector<std::string> notes;  ///< what an operator may want to know: a damaged cache that was repaired
};

using IngestResult = Expected<std::unique_ptr<LoadedGrid>, std::string>;

/// Reads every file that the patterns match (sorted within a pattern, patterns in order) into one grid. Blocks: for the
/// command line. The error is one line: which file, what, what is allowed; nothing is left behind.
IngestResult ingest_files(const std::vector<std::string>& patterns, const IngestOptions& options,
                          const world::World& world);

/// Why there is no grid.
struct IngestFault {
  std::string what;  ///< one line: which file, what, what is allowed
  bool passing{};    ///< nobody need correct anything: a later try may succeed
  friend bool operator==(const IngestFault&, const IngestFault&) = default;
};
using IngestOutcome = Expected<std::unique_ptr<LoadedGrid>, IngestFault>;

/// The same for the daemon: returns at once, `then` is called from the loop. `world`'s adapters must outlive the child.
///
/// With a cache, files that were read before give their grid, and files that were refused before their reason, without a
/// child. A bad file is left out of a set when the others are whole without it: they read as they are, and their times have
/// no hole (no step above 1.5 times the median one). Otherwise the set is refused as a whole.
void ingest_files_async(const std::vector<std::string>& patterns, const IngestOptions& options,
                        const world::World& world, std::function<void(IngestOutcome)> then);

/// How files are read, as one text: what a grid depends on beside their contents.
std::string recipe_of(const IngestOptions& options);

/// What `--tell` told of a run.
struct IngestStory {
  struct Source {
    std::size_t file{};
    Sha256 content;
    FileIdentity identity;
  };
  std::vector<Source> sources;
  std::optional<std::size_t> at;  ///< the file that was copied or read last; none: the set as a whole
  bool copying{};                 ///< the last file was still being copied: its content is not known
};
/// Lines that are not understood are passed over: they come from a child that may have died while writing.
IngestStory read_story(const std::string& out);

}  // namespace glidehelm::daemon
