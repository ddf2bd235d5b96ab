#include "simulator/netcdf_classic.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>

#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using namespace glidehelm::simulator;

namespace {

std::uint32_t be32(const std::string& s, std::size_t at) {
  std::uint32_t v = 0;
  for (std::size_t i = 0; i < 4; ++i) v = v << 8U | static_cast<unsigned char>(s[at + i]);
  return v;
}

ForecastGrid grid() {
  ForecastGrid g;
  g.west_deg = 4;
  g.east_deg = 5;
  g.south_deg = 39;
  g.north_deg = 40;
  g.step_deg = 0.5;
  g.times_s = {1.7e9, 1.7e9 + 3600};
  return g;
}

}  // namespace

TEST_CASE("a forecast file is a classic NetCDF file whose lengths add up") {
  for (const bool deep : {false, true}) {
    auto g = grid();
    if (deep) g.depths_m = {0, 100, 200};
    const auto bytes = forecast_file(kUniform, g, 1.7e9);
    CHECK(bytes.substr(0, 4) == std::string("CDF\x02", 4));
    CHECK(be32(bytes, 8) == 10);  // dimensions follow
    CHECK(be32(bytes, 12) == (deep ? 4U : 3U));
    // The last variable ends with the file, and its last value is the northward current.
    const auto last = std::bit_cast<float>(be32(bytes, bytes.size() - 4));
    CHECK(last == Approx(-0.10));
    const std::size_t nodes = 2U * 3 * 3 * (deep ? 3U : 1U);
    const auto first_v = std::bit_cast<float>(be32(bytes, bytes.size() - 4 * nodes));
    CHECK(first_v == Approx(-0.10));
    CHECK(std::bit_cast<float>(be32(bytes, bytes.size() - 4 * nodes - 4)) == Approx(0.12));
  }
}

TEST_CASE("a node without a current holds the fill value") {
  struct Land {
    [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint, Depth, double) const {
      return unexpected(ocean::NoCurrent::land);
    }
    [[nodiscard]] ocean::Coverage coverage() const { return {}; }
    [[nodiscard]] MetresPerSecond fastest() const { return {}; }
  };
  const Land land;
  const auto bytes = forecast_file(land, grid(), 1.7e9);
  CHECK(std::bit_cast<float>(be32(bytes, bytes.size() - 4)) == -32768.0F);
}
