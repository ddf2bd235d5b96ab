#pragma once

#include <string>

#include "simulator/scenario.hpp"

namespace glidehelm::test {

/// What is wrong with a scenario, a line each; "read" when nothing is.
inline std::string errors_of(const std::string& text) {
  const auto s = simulator::read_scenario(text, "/x/s.yaml");
  if (s) return "read";
  std::string all;
  for (const auto& e : s.error()) all += e.message() + "\n";
  return all;
}

}  // namespace glidehelm::test
