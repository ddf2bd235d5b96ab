#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "daemon/world/files.hpp"

namespace glidehelm::cli {

/// `glidehelm replay LOG… [--glider NAME] [--json]`.
struct ReplayOptions {
  std::vector<std::string> logs;
  std::string glider;  ///< only this one's fixes are used; empty: any
  bool json{};
};

/// Reads recorded dialogs again, in the order given, and says of each distinct fix whether a pilot would have been told
/// of it, or which rule refuses it. A fix that an earlier file has shown is refused by S6. Logs have no clock of ours:
/// `heard_time` is the glider's `Curr Time` read as UTC.
///
/// Text on `out`: a line of counts per file, under it a line per fix. JSON on `out`: product.md 9, one document.
/// Returns 0 when every file was read, 1 when one could not be, 2 without files.
int run_replay(const ReplayOptions& options, world::Files& files, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
