#include <algorithm>
#include <utility>

#include "core/base/text.hpp"
#include "daemon/ingest/ensemble.hpp"
#include "daemon/ingest/part.hpp"
#include "daemon/ingest/plausible.hpp"

namespace glidehelm::ingest {

namespace {

/// Puts the north of `north` into `east`.
Result<Part> paired(Part east, const Part& north) {
  auto& grid = east.grid;
  for (std::size_t n = 0; n < grid.axes.nodes(); ++n) grid.values[2 * n + 1] = north.grid.values[2 * n + 1];
  auto& facts = grid.facts;
  const auto& other = north.grid.facts;
  facts.north_variable = other.north_variable;
  facts.north_unit = other.north_unit;
  facts.sources.insert(facts.sources.end(), other.sources.begin(), other.sources.end());
  for (const auto& warning : other.warnings)
    if (std::find(facts.warnings.begin(), facts.warnings.end(), warning) == facts.warnings.end())
      facts.warnings.push_back(warning);
  if (facts.water.layers.empty()) facts.water = other.water;
  facts.recognised_by += ", with " + std::string{base_name(north.file)};
  const std::string names = east.file + " with " + std::string{base_name(north.file)};
  if (auto plausible = make_plausible(grid, facts.warnings); !plausible)
    return fault(names + ": " + plausible.error().what);
  east.file = names;
  east.holds = Holds::both;
  return east;
}

}  // namespace

Result<std::vector<Part>> pair_halves(std::vector<Part> parts) {
  std::vector<Part> whole;
  std::vector<bool> used(parts.size(), false);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (used[p]) continue;
    used[p] = true;
    if (parts[p].holds == Holds::both) {
      whole.push_back(std::move(parts[p]));
      continue;
    }
    const Holds wanted = parts[p].holds == Holds::east ? Holds::north : Holds::east;
    std::size_t other = p + 1;
    while (other < parts.size() &&
           (used[other] || parts[other].holds != wanted || parts[other].grid.axes != parts[p].grid.axes ||
            !of_one_member(parts[p], parts[other])))
      ++other;
    if (other == parts.size())
      return fault(parts[p].file + ": it has the " + (wanted == Holds::north ? "eastward" : "northward") +
                   " velocity only, and no file with the " + (wanted == Holds::north ? "northward" : "eastward") +
                   " one of the same times and nodes was given");
    used[other] = true;
    const bool east_first = wanted == Holds::north;
    auto pair = east_first ? paired(std::move(parts[p]), parts[other]) : paired(std::move(parts[other]), parts[p]);
    if (!pair) return unexpected(pair.error());
    whole.push_back(std::move(*pair));
  }
  return whole;
}

}  // namespace glidehelm::ingest
