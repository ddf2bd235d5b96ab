#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/safety/list_reader.hpp"

/// The verifier's reader: any bytes, and what it takes keeps the promises of its header.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glidehelm::safety;
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  const auto list = read_list(bytes, 8);
  if (!list) {
    if (list.error().message.empty()) std::abort();
    return 0;
  }
  if (size > kLargestFile || list->points.empty() || list->points.size() > 8) std::abort();
  if (!(list->radius.si() >= 10 && list->radius.si() <= 100'000)) std::abort();
  for (const auto& p : list->points)
    if (std::llabs(p.lat_units) > 90 * 600'000 || std::llabs(p.lon_units) > 180 * 600'000) std::abort();
  if (read_list(bytes.substr(0, size - 1), 8)) std::abort();  // a cut file is never a list
  return 0;
}
