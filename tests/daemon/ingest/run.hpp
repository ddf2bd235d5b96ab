#pragma once

#include <optional>
#include <string>

#include "core/ocean/grid_format.hpp"
#include "tests/support/netcdf.hpp"

/// Runs of the built program.
namespace glidehelm::test {

/// A run of the program, and the grid it wrote.
struct Ingested {
  Ran ran;
  std::string bytes;
  std::optional<ocean::GridView> view;

  [[nodiscard]] float at(std::size_t t, std::size_t z, std::size_t j, std::size_t i, std::size_t component) const {
    const auto& axes = view->axes;
    return view->values[2 * (((t * axes.depths_m.size() + z) * axes.lats_deg.size() + j) * axes.lons_deg.size() + i) +
                        component];
  }
};

inline Ingested run_ingest(const ScratchFolder& folder, const std::string& arguments) {
  Ingested result;
  result.ran = run_command(std::string{GLIDEHELM_INGEST} + " -o " + (folder / "grid") + " " + arguments, folder);
  if (result.ran.code != 0) {
    CHECK_FALSE(std::filesystem::exists(folder / "grid"));  // a refusal writes nothing
    return result;
  }
  result.bytes = file_bytes(folder / "grid");
  auto view = ocean::open_grid(std::as_bytes(std::span{result.bytes.data(), result.bytes.size()}));
  REQUIRE(view);
  result.view = *view;
  std::filesystem::remove(folder / "grid");
  return result;
}

}  // namespace glidehelm::test
