#pragma once

#include <span>
#include <string>
#include <vector>

#include "daemon/cli/compare.hpp"

namespace glidehelm::cli {

/// Heads and rows of the table, the earliest arrival first, then by the distance left.
std::vector<std::string> comparison_columns();
std::vector<std::vector<std::string>> comparison_rows(const Comparison& comparison);
/// The table as text, under a line that says what was compared and what is the bound.
std::string comparison_text(const Comparison& comparison);
/// What the bound says, in one sentence; empty without one.
std::string bound_text(const Comparison& comparison);
/// One document for all missions, schema glidehelm/comparison/v1.
std::string comparison_json(std::span<const Comparison> comparisons);
/// One page without anything from outside: table and map of each mission. `charts`: one for each.
std::string comparison_page(std::span<const Comparison> comparisons, std::span<const chart::Chart* const> charts);

}  // namespace glidehelm::cli
