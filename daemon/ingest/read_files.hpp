#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/ingest/part.hpp"

namespace glidehelm::ingest {

/// The way to the files of a set, by their index.
struct FileAccess {
  std::function<void(std::size_t file)> tell;                  ///< that it is being parsed from now on
  std::function<Result<std::string>(std::size_t file)> load;   ///< its bytes; may be asked for the same file twice
  std::function<Result<Part>(std::size_t file)> read_address;  ///< of names that are addresses (opendap.hpp)
};

/// Reads a set of files that belong together into parts, in the order of the arguments.
///
/// Files that only describe a grid (grid_file.hpp) serve the others, wherever they stand in the list; the last `grid_files`
/// names are known to be such and refused when they are not. A model's u and v in two files (NEMO's grid_U and grid_V) are
/// paired by their times, in the order of the list. With one file nothing is looked at twice; with several, each is first
/// opened for its header. Halves that are left are paired by `pair_halves`. The fault begins with the name of the file;
/// `alone` says that it concerns the set.
Result<std::vector<Part>> read_files(const std::vector<std::string>& names, std::size_t grid_files,
                                     const FileAccess& access, const Units& units, const ReadOptions& options);

}  // namespace glidehelm::ingest
