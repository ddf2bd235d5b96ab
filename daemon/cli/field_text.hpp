#pragma once

#include <cstdio>
#include <ostream>
#include <string>

#include "core/base/utc.hpp"

/// How the verbs `field …` word numbers, times and refusals.
namespace glidehelm::cli {

/// Says why nothing was done; returns `code`.
inline int refuse_field(std::ostream& err, int code, const std::string& what) {
  err << "glidehelm field: " << what << '\n';
  return code;
}

/// "0.350".
inline std::string decimal(double value, int digits) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
  return buffer;
}

/// Epoch seconds as UTC.
inline std::string time_text(double seconds) { return utc_text(instant_at(seconds)); }

}  // namespace glidehelm::cli
