#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
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
  std::string keep_in;       ///< folder where the grid keeps its name (another process maps it too); empty: none
  Seconds deadline{120};
  std::size_t memory_at_most{};  ///< of the child, bytes; 0: no limit
};

/// A checked grid, mapped read-only from a private file that has no name any more: nobody can change or truncate it, and
/// its room on disk is free when the last user lets go.
struct LoadedGrid {
  std::unique_ptr<world::Mapping> mapping;
  ocean::GridView view;            ///< into the mapping
  std::string path;                ///< with `keep_in`: the grid's name, for the caller to remove; else empty
  std::vector<std::string> files;  ///< what went in, in order
};

using IngestResult = Expected<std::unique_ptr<LoadedGrid>, std::string>;

/// Reads every file that the patterns match (sorted within a pattern, patterns in order) into one grid. Blocks: for the
/// command line. The error is one line: which file, what, what is allowed; nothing is left behind.
IngestResult ingest_files(const std::vector<std::string>& patterns, const IngestOptions& options,
                          const world::World& world);

/// The same for the daemon: returns at once, `then` is called from the loop. `world`'s adapters must outlive the child.
void ingest_files_async(const std::vector<std::string>& patterns, const IngestOptions& options,
                        const world::World& world, std::function<void(IngestResult)> then);

}  // namespace glidehelm::daemon
