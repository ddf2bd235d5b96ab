#pragma once

#include <cstdarg>
#include <cstdio>
#include <limits>
#include <string>

#include "core/safety/judge.hpp"

namespace glidehelm::safety {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// printf into a string; cut at 400 characters.
[[gnu::format(printf, 1, 2)]] inline std::string sentence(const char* format, ...) {
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

/// What is unknown is refused.
inline Margin not_judged(const char* why) {
  return {"", false, kNoNumber, kNoNumber, "", std::string{"not judged: "} + why};
}
/// A rule without a number.
inline Margin plain(bool holds, std::string message) {
  return {"", holds, kNoNumber, kNoNumber, "", std::move(message)};
}

}  // namespace glidehelm::safety
