#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/chart/bathymetry.hpp"
#include "tests/daemon/ingest/run.hpp"
#include "tests/support/data.hpp"

// Every bathymetry of the samples: what becomes of it, as the table that stands in docs/bathymetry.md.

using namespace glidehelm;

namespace {

struct Order {
  const char* file;
  const char* options;
  const char* refused;
};

const Order kOrders[] = {{"bc_coast_depth_2min.nc", "", nullptr},
                         {"etopo2022_30s_west_med.nc", "", nullptr},
                         {"etopo5_agulhas.nc", "", nullptr},
                         {"etopo5_canaries_lon360.nc", "", nullptr},
                         {"etopo5_ionian.nc", "", nullptr},
                         {"etopo5_us_east_lon360.nc", "", nullptr},
                         {"etopo5_washington_lon360.nc", "", nullptr},
                         {"gebco_2020_n56.3_s55.2_w12.2_e13.1.nc", "", nullptr},
                         {"salishsea_bathymetry_202108.nc", "", nullptr},
                         {"celtic_sea_etopo1_1min.asc", "--positive up", nullptr},
                         {"medes_islands_10m_utm31.asc", "--positive up --crs utm31n", nullptr},
                         {"cairns_gbr_270m_utm55s.asc", "--positive up --crs EPSG:32755", nullptr},
                         {"puget_F00788_8m_utm10.asc", "--positive up", nullptr},
                         {"celtic_sea_etopo1_1min.asc", "", "does not say which way its numbers count"},
                         {"medes_islands_10m_utm31.asc", "--positive up", "say in which metres it is"},
                         {"kahului_sample_1s.tt2", "--positive up", "not a NetCDF file: plain text"}};

std::string row(const Order& order, const chart::DepthGrid& g) {
  float shoalest = std::numeric_limits<float>::infinity(), deepest = -shoalest;
  std::size_t known = 0;
  for (const float depth : g.depths_m)
    if (!std::isnan(depth)) ++known, shoalest = std::min(shoalest, depth), deepest = std::max(deepest, depth);
  char text[600];
  std::snprintf(text, sizeof text,
                "| %s | %s | %zu × %zu, %.4g′ × %.4g′ | %.4f° E, %.4f° N | %.6g to %.6g | %zu | %s |", order.file,
                order.options, g.columns, g.rows, 60 * g.lon_step_deg, 60 * g.lat_step_deg, g.west_deg, g.south_deg,
                static_cast<double>(shoalest), static_cast<double>(deepest), known, g.decided.c_str());
  return text;
}

}  // namespace

TEST_CASE("real data: every sample of bathymetry is read as the documentation says") {
  GLIDEHELM_NEEDS_DATA(data);
  std::ifstream document{std::string{GLIDEHELM_SOURCE} + "/docs/bathymetry.md"};
  std::stringstream words;
  words << document.rdbuf();
  const std::string documentation = words.str();
  REQUIRE_FALSE(documentation.empty());
  test::ScratchFolder folder;
  for (const auto& order : kOrders) {
    INFO(order.file << " " << order.options);
    const auto ran = test::run_command(std::string{GLIDEHELM_INGEST} + " --bathymetry " + data + "/bathymetry/" +
                                           order.file + " " + order.options + " -o " + (folder / "d.depth"),
                                       folder);
    if (order.refused != nullptr) {
      CHECK(ran.code == 1);
      CHECK(ran.err.find(order.refused) != std::string::npos);
      continue;
    }
    REQUIRE(ran.code == 0);
    const auto bottom = chart::Bathymetry::parse(test::file_bytes(folder / "d.depth"));
    REQUIRE(bottom);
    const auto line = row(order, (*bottom)->grid());
    INFO(line);
    CHECK(documentation.find(line) != std::string::npos);
    std::filesystem::remove(folder / "d.depth");
  }
}
