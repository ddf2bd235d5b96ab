#include "daemon/ingest/fault.hpp"

#include <cstdio>

namespace glidehelm::ingest {

std::string printed(const char* format, double a, double b) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

}  // namespace glidehelm::ingest
