#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "protocol/mafile.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

/// Any bytes as a mafile: problems in order, in words without raw bytes; strict mode is never more lenient.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glidehelm;
  using namespace glidehelm::protocol;
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  MafileOptions options;
  options.near = geo_point(33.4, -118.6);
  const auto lenient = read_mafile(bytes, options);
  options.mode = MafileOptions::Mode::strict;
  const auto strict = read_mafile(bytes, options);
  require(strict.b_args == lenient.b_args && strict.waypoints == lenient.waypoints);
  require(strict.problems.size() >= lenient.problems.size());
  require(lenient.valid() || !strict.valid());
  for (const auto& arg : strict.b_args) require(strict.in_force(arg.name) == strict.b_arg(arg.name)->value);
  int line = 0;
  for (const auto& problem : strict.problems) {
    require(problem.line >= line && problem.severity == Severity::error && !problem.code.empty());
    line = problem.line;
  }
  for (const auto& problem : lenient.problems)
    for (const char c : problem.text()) require(static_cast<unsigned char>(c) >= 0x20);  // no forged log line
  return 0;
}
