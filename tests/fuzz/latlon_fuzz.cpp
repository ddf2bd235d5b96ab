#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "protocol/latlon.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

/// Any bytes as a coordinate: what is taken is in range, and is written so that it is read again within half a unit.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glidehelm::protocol;
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  for (const auto axis : {Axis::latitude, Axis::longitude}) {
    const auto deg = degrees_from_ddmm(text, axis);
    if (!deg) {
      require(!deg.error().message().empty());
      continue;
    }
    require(std::abs(*deg) <= (axis == Axis::latitude ? 90 : 180));
    const auto units = minute_units(*deg);
    const auto again = degrees_from_ddmm(ddmm_from_units(units), axis);
    require(again && minute_units(*again) == units);
    // Half a unit of 1e-4 minute, and the rounding of doubles near 180.
    require(std::abs(*again - *deg) * 60 <= 0.5e-4 + 1e-10);
  }
  require(!is_dialog_coordinate(text) || size >= 5);
  return 0;
}
