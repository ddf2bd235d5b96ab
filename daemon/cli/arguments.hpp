#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "daemon/world/world.hpp"

/// Reading the words of a command line.
namespace glidehelm::cli {

/// A verb's run, chosen by the parser.
using Action = std::function<int(world::World&)>;

/// "28.2,-15.2": CLI11 would take "-15.2" of two words for an option, so pairs are one word.
inline std::pair<double, double> pair_from(const std::string& text, const char* what) {
  const auto comma = text.find(',');
  const auto first = number_from(trimmed(std::string_view{text}.substr(0, comma)));
  const auto second =
      comma == std::string::npos ? std::nullopt : number_from(trimmed(std::string_view{text}.substr(comma + 1)));
  if (!first || !second)
    throw CLI::ValidationError{what, "'" + text + "' is not two numbers with a comma between, as 28.2,-15.2"};
  return {*first, *second};
}

inline Instant time_from(const std::string& text, const char* what) {
  const auto t = utc_from_text(text);
  if (!t) throw CLI::ValidationError{what, "'" + text + "' is not a UTC time, as 2026-11-25T10:20:30Z"};
  return *t;
}

}  // namespace glidehelm::cli
