#include "tests/bench/real_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/utc.hpp"
#include "core/ocean/forecast.hpp"
#include "core/planning/flight.hpp"
#include "daemon/ingest_client.hpp"
#include "daemon/world/real.hpp"

namespace glidehelm::suite {

namespace {

constexpr MetresPerSecond kSpeed{0.3};

/// From start to goal, degrees.
struct Way {
  const char* name;
  double from_lat, from_lon, to_lat, to_lon;
};

struct Dataset {
  const char* name;
  std::vector<std::string> files;  ///< patterns below currents/
  std::vector<Way> ways;
  daemon::IngestOptions options{};
};

daemon::IngestOptions part(double west, double east, double south, double north) {
  daemon::IngestOptions options;
  options.area = daemon::IngestOptions::Area{west, east, south, north};
  return options;
}

/// The samples of the Sandy case name neither their epoch nor their levels: docs/forecasts.md.
daemon::IngestOptions sandy() {
  daemon::IngestOptions options;
  options.time_epoch = utc_from_text("1858-11-17");
  options.s_levels = "vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,hc=50";
  return options;
}

/// Ways that were chosen by map alone, before any method had seen them; where a field has a strong current, one way across it or against it.
std::vector<Dataset> datasets() {
  return {
      {"rtofs_washington",
       {"rtofs_washington/wa_RTOFS_global.nc"},
       {{"south", 48.3, -126.1, 47.0, -124.9}, {"north", 47.0, -124.9, 48.3, -126.1}}},
      {"hycom_washington", {"hycom_washington/gridded_current.nc"}, {{"south", 48.5, -125.6, 47.2, -124.8}}},
      {"cmems_glo12_ionian_3d",
       {"cmems_glo12_ionian_3d/currents.nc"},
       {{"jet", 37.9, 17.3, 36.75, 20.3}, {"otranto", 38.2, 17.6, 40.25, 18.8}}},
      {"duacs west_med",
       {"duacs/derived_geostrophic_west_med_2005T2.nc"},
       {{"south", 41.0, 4.5, 38.2, 6.2}, {"algerian", 37.5, 7.0, 37.2, 3.0}}},
      {"duacs global",
       {"duacs/nrt_global_allsat_phy_l4_20190223_20190226.nc"},
       {{"stream", 40.3, -66.5, 37.2, -65.0}},
       part(-75, -50, 30, 45)},
      {"globcurrent_agulhas",
       {"globcurrent_agulhas/*.nc"},
       {{"across", -35.0, 21.0, -37.0, 23.5}, {"retroflection", -38.0, 17.0, -36.2, 20.5}}},
      {"glorys_packed", {"glorys_packed/GLORYS_NA_2012.nc"}, {{"faroes", 59.0, -11.5, 61.0, -6.5}}},
      {"roms_wcofs_oregon",
       {"roms_wcofs_oregon/WCOFS_subset.nc"},
       {{"inshore", 45.6, -125.2, 44.3, -124.4}, {"offshore", 44.3, -124.4, 45.6, -125.2}}},
      {"roms_us_east_sandy",
       {"roms_us_east_sandy/coawst_clm_*.nc", "roms_us_east_sandy/Sandy_roms_grid.nc"},
       {{"shelf", 40.0, -73.2, 37.4, -74.9}, {"stream", 38.3, -71.5, 35.8, -70.5}},
       sandy()},
      {"hfradar_midatlantic",
       {"hfradar_midatlantic/hfr_rtv_midatl_6km_oi_maracoos_2022_02_21_1200.nc"},
       {{"shelf", 39.9, -73.3, 38.3, -74.4}}},
  };
}

/// A message without the folder of the samples, which differs from machine to machine.
std::string without(std::string text, const std::string& folder) {
  for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder, at)) text.erase(at, folder.size());
  return text;
}

Expected<ocean::Forecast, std::string> read(const Dataset& data, const std::string& currents, world::World& world) {
  std::vector<std::string> files;
  for (const auto& pattern : data.files) files.push_back(currents + pattern);
  auto read = daemon::ingest_files(files, data.options, world);
  if (!read) return unexpected(without(read.error(), currents));
  const std::shared_ptr<daemon::LoadedGrid> grid{std::move(read).value()};
  const planning::Problem problem = problem_of({}, {}, kSpeed);
  const auto& glider = problem.glider;
  const auto profile = ocean::DiveProfile::of_stint(glider.climb_to, glider.dive_depth, kSpeed, glider.glide_angle,
                                                    problem.schedule.stint);
  ocean::GriddedOptions options;
  options.mask_is_land = true;
  auto forecast = ocean::Forecast::prepare(grid->view, profile, options, grid);
  if (!forecast) return unexpected(forecast.error().message());
  return std::move(forecast).value();
}

std::string place(double lat, double lon) {
  return fmt::format("{:.2f} {} {:.2f} {}", std::abs(lat), lat < 0 ? "S" : "N", std::abs(lon), lon < 0 ? "W" : "E");
}

/// Why no plan can begin or end there; none: it lies in water.
std::optional<std::string> dry(const char* which, GeoPoint p, const ocean::Forecast& forecast) {
  const auto sample = forecast.ocean().dive.sample(p, forecast.facts().first_s);
  if (sample) return std::nullopt;
  return fmt::format("its {} has no current ({})", which, word(sample.error()));
}

void add(RealCases& all, const std::string& name, const Way& way, const ocean::Forecast& forecast) {
  const auto from = geo_point(way.from_lat, way.from_lon), to = geo_point(way.to_lat, way.to_lon);
  for (const auto& why : {dry("start", from, forecast), dry("goal", to, forecast)})
    if (why) return all.notes.push_back("left out: " + name + ": " + *why);
  const auto& facts = forecast.facts();
  auto problem = problem_of(from, to, kSpeed);
  problem.start.fix_s = facts.first_s;
  problem.horizon_s = problem.start.fix_s + planning::automatic_horizon(problem).count();
  problem.coast_margin = Metres{0};
  all.notes.push_back(fmt::format(
      "{}: {:.0f} km from {} to {}, {} to {}, {}", name, distance(from, to).si() / 1000,
      place(way.from_lat, way.from_lon), place(way.to_lat, way.to_lon), utc_text(instant_at(facts.first_s)),
      utc_text(instant_at(facts.last_s)),
      facts.levels > 1 ? fmt::format("mean over the dive of {} levels", facts.levels) : std::string{"one level"}));
  all.cases.emplace_back(name, problem, forecast);
}

}  // namespace

RealCases real_cases(const std::string& folder) {
  world::RealWorld real;
  auto world = real.world();
  RealCases all;
  for (const auto& data : datasets()) {
    const auto forecast = read(data, folder + "/currents/", world);
    for (const auto& way : data.ways) {
      const auto name = std::string{data.name} + " " + way.name;
      if (forecast)
        add(all, name, way, *forecast);
      else
        all.notes.push_back("left out: " + name + ": " + forecast.error());
    }
  }
  return all;
}

}  // namespace glidehelm::suite
