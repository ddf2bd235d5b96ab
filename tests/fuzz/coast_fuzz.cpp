#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/base/hash.hpp"
#include "core/chart/coast.hpp"

namespace {

using glidehelm::chart::Coast;

void check(std::string_view bytes) {
  const auto coast = Coast::parse(bytes);
  if (!coast) {
    if (coast.error().message().empty()) std::abort();
    return;
  }
  // What is taken is written back as an equal coast, and answers everywhere.
  const auto text = (*coast)->text();
  const auto again = Coast::parse(text);
  if (!again || (*again)->rings() != (*coast)->rings() || (*again)->text() != text) std::abort();
  for (double lat = -1.5; lat <= 1.5; lat += 0.25)
    for (double lon = -3; lon <= 3; lon += 0.5)
      if ((*coast)->land().contains(lat, lon) && !(*coast)->covers(lat, lon)) std::abort();
  if (Coast::parse(text.substr(0, text.size() - 1))) std::abort();  // a cut file is never a coast
}

/// The input without its last line, with the last line that its counts and checksum ask for: behind the checksum lies
/// nearly all of the reader.
std::string sealed(std::string_view bytes) {
  std::string body{bytes};
  if (const auto end = body.rfind("end "); end != std::string::npos) body.resize(end);
  std::size_t rings = 0, lines = 0;
  for (std::size_t at = 0; at < body.size();
       at = body.find('\n', at) == std::string::npos ? body.size() : body.find('\n', at) + 1) {
    ++lines;
    if (body.compare(at, 5, "ring ") == 0) ++rings;
  }
  const std::size_t points = lines > 3 + rings ? lines - 3 - rings : 0;
  char hex[12];
  std::snprintf(hex, sizeof hex, "%08x", static_cast<unsigned>(glidehelm::crc32c(body)));
  return body + "end " + std::to_string(rings) + " " + std::to_string(points) + " crc32c " + hex + "\n";
}

/// The reader bounds its memory by the points that long edges are divided into, 2e7; a fuzzer looks for more than that
/// with areas that cost nothing.
bool is_cheap(std::string_view bytes) { return std::count(bytes.begin(), bytes.end(), '\n') < 200; }

}  // namespace

/// Coast files: any bytes, and what is taken keeps the promises of its header.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  check(bytes);
  if (is_cheap(bytes)) check(sealed(bytes));
  return 0;
}
