#pragma once

#include <string>

#include "daemon/cli/rehearsal_report.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::cli {

/// One page without anything from outside: what came out in a sentence, map, travel times, summary and a row per flight.
std::string html_text(const Rehearsal& rehearsal, const chart::Chart& chart);
/// Writes the page to a new file; what went wrong, or nothing.
std::string save_page(const Rehearsal& rehearsal, const chart::Chart& chart, const std::string& path,
                      world::Files& files);

}  // namespace glidehelm::cli
