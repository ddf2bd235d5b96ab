#include "daemon/ingest/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "core/base/text.hpp"

namespace glidehelm::ingest {

namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream{text};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// The flag's number for "fail".
std::optional<double> failing_value(const Variable& flag) {
  const auto meanings = words_of(lower(flag.text("flag_meanings")));
  const auto values = numbers_of(flag, "flag_values");
  for (std::size_t k = 0; k < std::min(meanings.size(), values.size()); ++k)
    if (meanings[k] == "fail" || meanings[k] == "failed" || meanings[k] == "bad" || meanings[k] == "bad_data")
      return values[k];
  return std::nullopt;
}

bool is_summary(const Variable* flag) {
  const auto name = lower(flag->name);
  return name.find("primary") != std::string::npos || name.find("aggregate") != std::string::npos;
}

}  // namespace

Result<Done> drop_failed(const NetcdfFile& file, const Variable& velocity, const Axes& axes, const Box& box,
                         ocean::Grid& grid, std::vector<std::string>& warnings) {
  std::vector<const Variable*> flags;
  for (const auto& name : words_of(velocity.text("ancillary_variables"))) {
    const auto* flag = file.find(name);
    if (flag != nullptr && is_number(flag->type) && flag->dimensions == velocity.dimensions && failing_value(*flag))
      flags.push_back(flag);
  }
  if (std::any_of(flags.begin(), flags.end(), is_summary))
    flags.erase(std::remove_if(flags.begin(), flags.end(), [](const Variable* flag) { return !is_summary(flag); }),
                flags.end());
  if (flags.empty()) return Done{};
  std::size_t dropped = 0, before = 0;
  std::string names;
  std::vector<float> values(grid.axes.nodes());
  for (std::size_t n = 0; n < grid.axes.nodes(); ++n)
    before += std::isnan(grid.values[2 * n]) || std::isnan(grid.values[2 * n + 1]) ? 0 : 1;
  for (const auto* flag : flags) {
    auto read = read_values(file, *flag, axes, box, Component::plain(*flag), values.data(), 1);
    if (!read) return unexpected(read.error());
    const auto failing = static_cast<float>(*failing_value(*flag));
    for (std::size_t n = 0; n < values.size(); ++n) {
      float* at = grid.values.data() + 2 * n;
      if (values[n] != failing || std::isnan(at[0]) || std::isnan(at[1])) continue;
      at[0] = at[1] = std::numeric_limits<float>::quiet_NaN();
      ++dropped;
    }
    names += (names.empty() ? "" : ", ") + flag->name;
  }
  if (dropped > 0)
    warnings.push_back(std::to_string(dropped) + " of " + std::to_string(before) +
                       " values failed the producer's quality control (" + names + ") and are left out");
  return Done{};
}

}  // namespace glidehelm::ingest
