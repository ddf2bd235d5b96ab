#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/chart/coast.hpp"

namespace glidehelm::chart {

/// What is wrong with a ring, and at which of its points (from 0).
struct RingFault {
  std::size_t point;
  std::string problem;
};

/// Checks the rings of one coast in order, and counts what they will cost.
class RingCheck {
 public:
  explicit RingCheck(const CoastArea& area) : area_{area} {}
  [[nodiscard]] std::optional<RingFault> next(const CoastRing& ring);

 private:
  [[nodiscard]] bool on_border(const CoastPoint& a, const CoastPoint& b) const;
  CoastArea area_;
  std::size_t points_{};
};

/// A source is one line of 1 to 400 printable ASCII characters.
std::optional<std::string> problem_of_source(std::string_view source);

}  // namespace glidehelm::chart
