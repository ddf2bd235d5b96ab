#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "core/base/utc.hpp"
#include "daemon/cli/rehearsal_flight.hpp"
#include "tests/support/fields.hpp"

namespace glidehelm::test {

inline const Instant kSeaStart = *utc_from_text("2026-03-01T00:00:00Z");  ///< when flown missions begin

using FlownMission = cli::RehearsalFlight;

/// A glider `sim01` that flies from one place to another by method `direct` from `start` on, with files that go unasked.
inline FlownMission::Setup leg_setup(GeoPoint from, GeoPoint goal, int correction, Instant start) {
  FlownMission::Setup s;
  s.mission.name = "leg";
  s.mission.glider = "sim01";
  s.mission.goal = goal;
  s.mission.method = "direct";
  s.mission.approval = mission::Approval::automatic;
  s.mission.current_correction = correction;
  s.glider.setup.start = from;
  s.glider.setup.start_s = epoch_seconds(start);
  s.glider.setup.belief.correction = correction;
  s.glider.setup.list.waypoints = {goal};
  s.glider.setup.list.radius = Metres{500};
  s.glider.setup.list.initial = 0;
  s.glider.goal = goal;
  s.glider.goal_radius = Metres{2000};
  return s;
}

/// A forecast on a 0.02° grid, sampled from analytic fields at `start` over a box around two places: a grid has the fast kernel.
inline std::shared_ptr<const daemon::OceanSource> gridded_forecast(const std::vector<ocean::AnalyticSpec>& specs,
                                                                   GeoPoint from, GeoPoint to, Instant start) {
  constexpr double kStep = 0.02, kAround = 0.6;
  const double south = std::min(from.lat.degrees(), to.lat.degrees()) - kAround,
               north = std::max(from.lat.degrees(), to.lat.degrees()) + kAround;
  const double west = std::min(from.lon.degrees(), to.lon.degrees()) - kAround,
               east = std::max(from.lon.degrees(), to.lon.degrees()) + kAround;
  std::vector<ocean::AnalyticField> fields;
  for (const auto& spec : specs) {
    auto field = ocean::AnalyticField::make(spec, start, {});
    if (!field) throw std::runtime_error(field.error().message());
    fields.push_back(std::move(field).value());
  }
  const auto count = [](double span) { return static_cast<std::size_t>(span / kStep) + 1; };
  auto grid = std::make_shared<ocean::Grid>(
      make_grid(flat_axes(steps(south, kStep, count(north - south)), steps(west, kStep, count(east - west))),
                [&](double lat, double lon, double, double) {
                  double u = 0, v = 0;
                  for (const auto& field : fields) {
                    const auto sample = field.sample(geo_point(lat, lon), Depth{}, epoch_seconds(start));
                    u += sample->current.east.si();
                    v += sample->current.north.si();
                  }
                  return std::pair{u, v};
                }));
  auto forecast = ocean::Forecast::prepare(ocean::view_of(*grid), ocean::DiveProfile{}, {}, grid);
  if (!forecast) throw std::runtime_error(forecast.error().message());
  return std::make_shared<const daemon::OceanSource>(
      daemon::OceanSource{std::move(forecast).value(), std::nullopt, {}, {}, start, {}, {}, {}});
}

}  // namespace glidehelm::test
