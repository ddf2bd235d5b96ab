#include "core/mission/in_water.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace glidehelm::mission {

Seconds stint_of_half_cycles(int half_cycles, const Mission& m) {
  // Down from the surface, the inner legs, and up to the surface from where the last leg ends.
  const Metres last = half_cycles % 2 == 0 ? m.climb_to : m.dive_depth;
  const Metres vertical = m.dive_depth + (half_cycles - 1) * (m.dive_depth - m.climb_to) + last;
  return vertical / (m.horizontal_speed * std::tan(m.glide_angle.si()));
}

bool takes_forecast_water(const Mission& m) { return m.flight_model && m.flight_model->water.empty(); }

bool dive_alike(const Mission& a, const Mission& b) {
  if (a.climb_to != b.climb_to || a.dive_depth != b.dive_depth) return false;
  if (takes_forecast_water(a) != takes_forecast_water(b)) return false;
  if (!takes_forecast_water(a))
    return a.horizontal_speed == b.horizontal_speed && a.glide_angle == b.glide_angle && a.stint == b.stint;
  return a.flight_model == b.flight_model && a.half_cycles == b.half_cycles && (a.half_cycles || a.stint == b.stint);
}

std::string_view word(WaterFrom from) {
  switch (from) {
    case WaterFrom::none:
      return "none";
    case WaterFrom::mission:
      return "mission";
    case WaterFrom::forecast:
      return "forecast";
    case WaterFrom::climatology:
      return "climatology";
  }
  return "?";
}

std::string_view words(WaterFrom from) {
  switch (from) {
    case WaterFrom::none:
      return "no water";
    case WaterFrom::mission:
      return "the mission's water";
    case WaterFrom::forecast:
      return "the forecast's water";
    case WaterFrom::climatology:
      return "the climatological profile";
  }
  return "?";
}

namespace {

Expected<Mission, std::string> weighed(Mission m, std::span<const ocean::WaterLayer> layers) {
  vehicle::FlightModel model = *m.flight_model;
  model.water.assign(layers.begin(), layers.end());
  const auto means = yo_means(model.hull, model.trim, model.column(), m.climb_to, m.dive_depth);
  if (!means) return unexpected(means.error());
  m.horizontal_speed = means->horizontal;
  m.glide_angle = means->glide_angle;
  if (!m.half_cycles) return m;
  const Seconds stint = stint_of_half_cycles(*m.half_cycles, m);
  if (!(stint >= kShortestStint && stint <= kLongestStint))
    return unexpected(fmt::format("{} half cycles take {:.2f} h, allowed is {:.1f} to {:.0f} h", *m.half_cycles,
                                  stint.count() / 3600, kShortestStint.count() / 3600, kLongestStint.count() / 3600));
  if (m.first_stint == m.stint) m.first_stint = stint;
  m.stint = stint;
  return m;
}

}  // namespace

InWater in_water(const Mission& m, std::span<const ocean::WaterLayer> layers) {
  if (!takes_forecast_water(m)) return {m, m.flight_model ? WaterFrom::mission : WaterFrom::none, {}};
  std::string refused;
  if (!layers.empty()) {
    auto there = weighed(m, layers);
    if (there) return {std::move(there).value(), WaterFrom::forecast, {}};
    refused = there.error();
  }
  return {weighed(m, {}).value_or(m), WaterFrom::climatology, std::move(refused)};
}

}  // namespace glidehelm::mission
