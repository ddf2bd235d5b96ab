#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <set>

#include "core/base/utc.hpp"
#include "tests/daemon/ingest/run.hpp"
#include "tests/support/data.hpp"

// Every file of the samples: what becomes of it, as a table (docs/forecasts.md has it).

using namespace glidehelm;

namespace {

/// Files that are read together, with options; a reason where they are refused.
struct Order {
  const char* files;  ///< a name or a shell pattern below the samples
  const char* options;
  const char* refused;
};

const Order kOrders[] = {
    {"rtofs_washington/wa_RTOFS_global.nc", "", nullptr},
    {"hycom_washington/gridded_current.nc", "", nullptr},
    {"cmems_glo12_ionian_3d/currents.nc", "", nullptr},
    {"glorys_packed/GLORYS_NA_2012.nc", "", nullptr},
    {"globcurrent_agulhas/*.nc", "", nullptr},
    {"duacs/nrt_global_allsat_phy_l4_20190223_20190226.nc", "", nullptr},
    {"duacs/nrt_global_allsat_phy_l4_20190223_20190226.nc", "--heights always", nullptr},
    {"duacs/derived_geostrophic_west_med_2005T2.nc", "", nullptr},
    {"hfradar_midatlantic/hfr_rtv_midatl_6km_oi_maracoos_2022_02_21_1200.nc", "", nullptr},
    {"tides/derived_hourly_tidal_current_forth.nc", "", nullptr},
    {"roms_us_east_sandy/*.nc", "--time-epoch 1858-11-17T00:00:00Z --variables ubar,vbar", nullptr},
    {"roms_us_east_sandy/*.nc",
     "--time-epoch 1858-11-17T00:00:00Z --s-levels vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,hc=50", nullptr},
    {"roms_us_east_sandy/coawst_clm_20121028.nc", "", "axis v3d_time has the unit \"days\" without an epoch"},
    {"roms_us_east_sandy/coawst_clm_20121028.nc", "--time-epoch 1858-11-17T00:00:00Z",
     "16 terrain-following levels whose depths are not known"},
    {"roms_us_east_sandy/Sandy_roms_grid.nc", "", "it describes a model's grid (lat_rho, lon_rho) and has no current"},
    {"roms_wcofs_oregon/WCOFS_subset.nc", "", nullptr},
    {"unstructured/test_creofs_selfe.nc", "", "unstructured grid: lat(node) and lon(node) lie on one dimension"},
    {"tides/tidepredictor_currents.nc", "", "tidal constituents: major_axis(cons, lon, lat)"},
    {"tides/tide_forc_Sandy.nc", "", "tidal constituents: tide_Cmax(tide_period, erho, xrho)"},
    {"tides/ACT1951_1_Annual_2021.csv", "", "not a NetCDF file"},
    {"json/water-gbr.json", "", "not a NetCDF file"}};

std::string number(const char* format, double value) {
  char buffer[48];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}
std::string span_of(const std::vector<double>& axis, const char* format) {
  return number(format, axis.front()) + " to " + number(format, axis.back());
}

/// A row of the table: grid, times, depths, land, speeds, warnings.
std::string row(const ocean::GridView& view) {
  const auto& axes = view.axes;
  const auto statistics = ocean::statistics_of(view);
  std::string text = std::to_string(axes.lats_deg.size()) + " × " + std::to_string(axes.lons_deg.size()) + ", " +
                     span_of(axes.lats_deg, "%.2f") + " N, " + span_of(axes.lons_deg, "%.2f") + " E | ";
  text += axes.has_time ? std::to_string(axes.times_s.size()) + ", from " + utc_text(instant_at(axes.times_s.front()))
                        : std::string{"none"};
  if (axes.times_s.size() > 1) text += " to " + utc_text(instant_at(axes.times_s.back()));
  text += " | " + (axes.depths_m.size() > 1
                       ? std::to_string(axes.depths_m.size()) + ", " + span_of(axes.depths_m, "%.1f") + " m"
                       : std::string{"surface"});
  text += " | " + number("%.1f %%", 100 * (1 - statistics.wet_fraction));
  text += " | " + number("%.3f", statistics.slowest) + " to " + number("%.3f", statistics.fastest) + " | ";
  for (const auto& warning : view.facts.warnings) {
    // Every warning begins with the file's name, or with how many files said it.
    const auto colon = warning.find(": ");
    text += (text.back() == ' ' ? "" : "; ") + (colon == std::string::npos ? warning : warning.substr(colon + 2));
  }
  return text;
}

}  // namespace

TEST_CASE("real data: every file of the samples is read, or refused with its reason: the table") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  const std::string samples = data + "/currents/";
  std::cout << "| file | grid | times | depths | land or no data | speeds, m/s | warnings, or why it is refused |\n"
            << "|---|---|---|---|---|---|---|\n";
  std::set<std::string> told;
  for (const auto& order : kOrders) {
    INFO(order.files << " " << order.options);
    const auto result = test::run_ingest(folder, std::string{order.options} + " " + samples + order.files);
    INFO(result.ran.err);
    const std::string name = std::string{order.files} + (*order.options != '\0' ? " " : "") + order.options;
    if (order.refused == nullptr) {
      REQUIRE(result.view);
      for (const auto& source : result.view->facts.sources) told.insert(source.name);
      std::cout << "| " << name << " | " << row(*result.view) << " |\n";
      const auto statistics = ocean::statistics_of(*result.view);
      CHECK(statistics.wet_fraction > 0.05);
      CHECK(statistics.fastest < 5);
      continue;
    }
    REQUIRE_FALSE(result.view);
    told.insert(samples + order.files);
    const std::string begin = "glidehelm-ingest: " + samples + order.files + ": ";
    REQUIRE(result.ran.err.compare(0, begin.size(), begin) == 0);
    const std::string said = result.ran.err.substr(begin.size(), result.ran.err.size() - begin.size() - 1);
    CHECK(said.compare(0, std::string{order.refused}.size(), order.refused) == 0);
    std::cout << "| " << name << " | | | | | | refused: " << said << " |\n";
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator{samples}) {
    const auto path = entry.path().string();
    if (!entry.is_regular_file() || path.find("/headers/") != std::string::npos || entry.path().extension() == ".md")
      continue;
    INFO(path);
    CHECK(told.count(path) == 1);
  }
}
