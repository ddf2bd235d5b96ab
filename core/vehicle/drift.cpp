#include "core/vehicle/drift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/vehicle/motion.hpp"
#include "core/vehicle/yo.hpp"

namespace glidehelm::vehicle {

namespace {

constexpr double kInstant = 1e-3;  // seconds: shorter than any phase, longer than the rounding of epoch seconds
constexpr double kLastStep = 10;   // seconds: the shortest step of `move`, which is tried before it gives up
constexpr double kShoreNear =
    60;  // metres: what the fastest current that is believed (5 m/s) covers in it, and a margin

/// One phase: its depth changes evenly from `from_m` to `to_m`.
struct DriftLeg {
  DriftPhase phase{};
  double seconds{}, from_m{}, to_m{};
  bool turns_at_bottom{};  ///< carried by the deepest current above the bottom, else the bottom ends it
};

/// The phases of a vehicle, which come again and again; all of them last, but not all of them some time.
std::vector<DriftLeg> legs_of(const Passive& vehicle) {
  if (const auto* drifter = std::get_if<Drifter>(&vehicle)) {
    const double depth = drifter->depth.si();
    return {{DriftPhase::drifting, std::numeric_limits<double>::infinity(), depth, depth, false}};
  }
  const auto& f = std::get<ProfilingFloat>(vehicle);
  const double park = f.park.si(), profile = f.profile.si(), speed = f.vertical.si();
  const double parked = f.cycle.count() - f.surface.count() - 2 * profile / speed;
  std::vector<DriftLeg> legs{{DriftPhase::sinking, park / speed, 0, park, true},
                             {DriftPhase::parked, parked, park, park, true},
                             {DriftPhase::deepening, (profile - park) / speed, park, profile, true},
                             {DriftPhase::rising, profile / speed, profile, 0, true},
                             {DriftPhase::surfaced, f.surface.count(), 0, 0, true}};
  std::erase_if(legs, [](const DriftLeg& leg) { return leg.seconds <= kInstant; });
  return legs;
}

/// The currents of one phase as a field in two dimensions: the depth is the clock's.
struct DriftField {
  ocean::FieldRef full;
  DriftLeg leg;
  double begin_s{};

  [[nodiscard]] double due(double t_s) const {
    if (leg.from_m == leg.to_m) return leg.from_m;
    return std::lerp(leg.from_m, leg.to_m, std::clamp((t_s - begin_s) / leg.seconds, 0.0, 1.0));
  }
  [[nodiscard]] Expected<Reached, ocean::NoCurrent> reached(GeoPoint p, double t_s) const {
    const double depth = due(t_s);
    if (leg.turns_at_bottom) return reached_above_bottom(full, p, depth, t_s);
    const auto sample = full.sample(p, Depth{Metres{depth}}, t_s);
    if (!sample) return unexpected(sample.error());
    return Reached{*sample, depth};
  }
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth, double t_s) const {
    const auto found = reached(p, t_s);
    if (!found) return unexpected(found.error());
    return found->sample;
  }
  [[nodiscard]] ocean::Coverage coverage() const { return full.coverage(); }
  [[nodiscard]] MetresPerSecond fastest() const { return full.fastest(); }
};

DriftEnd end_by(ocean::NoCurrent reason) {
  switch (reason) {
    case ocean::NoCurrent::land:
      return DriftEnd::aground;
    case ocean::NoCurrent::outside_area:
      return DriftEnd::left_area;
    case ocean::NoCurrent::outside_time:
      return DriftEnd::forecast;
    case ocean::NoCurrent::below_bottom:
      return DriftEnd::bottom;
    case ocean::NoCurrent::no_data:
      return DriftEnd::no_data;
  }
  return DriftEnd::no_data;
}

/// Why the vehicle is not at sea where it begins.
std::optional<DriftEnd> not_at_sea(const chart::Chart& chart, GeoPoint from) {
  if (chart.is_land(from)) return DriftEnd::aground;
  if (!chart.is_charted(from)) return DriftEnd::left_chart;
  return std::nullopt;
}

/// What stopped a motion there.
DriftEnd end_of(Lost lost, const State& there, const DriftField& field, const chart::Chart& chart) {
  switch (lost) {
    case Lost::aground:
      return chart.has_coast() && chart.distance_to_coast(there.at()).si() > kShoreNear ? DriftEnd::left_chart
                                                                                        : DriftEnd::aground;
    case Lost::left_area:
      return DriftEnd::left_area;
    case Lost::left_forecast:
      return DriftEnd::forecast;
    case Lost::no_data:
      break;
  }
  // Of the floor and of a gap in the data a motion says the same; its last step, tried once more, tells them apart.
  ocean::Lanes lanes{};
  lanes.count = 1;
  lanes.lat[0] = there.lat;
  lanes.lon[0] = there.lon;
  ocean::FieldRef{field}.advance(lanes, there.t_s, kLastStep);
  return lanes.lost[0] == 0 ? DriftEnd::no_data : end_by(static_cast<ocean::NoCurrent>(lanes.lost[0]));
}

/// The point at a state; none without a current, and then `why` has the reason.
std::optional<DriftPoint> point_at(const State& s, const DriftField& field, DriftEnd& why) {
  const auto found = field.reached(s.at(), s.t_s);
  if (!found) {
    why = end_by(found.error());
    return std::nullopt;
  }
  return DriftPoint{s.t_s,          s.at(), Metres{found->depth_m}, Metres{field.due(s.t_s)}, found->sample.current,
                    field.leg.phase};
}

}  // namespace

std::string_view word(DriftPhase phase) {
  constexpr std::array<std::string_view, 6> kWords{"drifting", "sinking", "parked", "deepening", "rising", "surfaced"};
  return kWords.at(static_cast<std::size_t>(phase));
}

std::string_view word(DriftEnd end) {
  constexpr std::array<std::string_view, 7> kWords{"time",      "forecast", "aground", "left_chart",
                                                   "left_area", "bottom",   "no_data"};
  return kWords.at(static_cast<std::size_t>(end));
}

std::string why_no_float(const ProfilingFloat& f) {
  if (f.profile < f.park) return "the profile must begin at the parking depth or deeper";
  const double needed = 2 * f.profile.si() / f.vertical.si() + f.surface.count();
  if (f.cycle.count() < needed)
    return "the cycle is too short: down, up and the time at the surface take " +
           std::to_string(static_cast<long>(std::ceil(needed / 60))) + " min of it";
  return "";
}

DriftTrack drift(const Passive& vehicle, ocean::FieldRef full, const chart::Chart& chart, GeoPoint from,
                 const DriftSettings& settings) {
  DriftTrack track;
  const auto legs = legs_of(vehicle);
  std::size_t number = 0;
  DriftField field{full, legs.front(), settings.start_s};
  const Waters waters{{full, full}, chart, Metres{0}};
  const double wanted = settings.start_s + settings.duration.count();
  const double last = std::min(wanted, settings.forecast_last_s);
  track.end = last < wanted ? DriftEnd::forecast : DriftEnd::time;
  if (const auto dry = not_at_sea(chart, from)) {
    track.end = *dry;
    return track;
  }
  State now = state_at(from, settings.start_s, waters);
  double told = 1;  // how many points are due by the clock
  const auto tell = [&] {
    const auto point = point_at(now, field, track.end);
    if (point) track.points.push_back(*point);
    return point.has_value();
  };
  if (!tell()) return track;
  while (last - now.t_s > kInstant) {
    const double leg_end = field.begin_s + field.leg.seconds, due = settings.start_s + told * settings.every.count();
    const double next = std::min({last, leg_end, due});
    const auto motion = move(waters, field, now, next - now.t_s, {}, nullptr);
    const bool moved = motion.end.t_s > now.t_s;
    now = motion.end;
    if (motion.lost) {
      if (moved) tell();
      track.end = end_of(*motion.lost, now, field, chart);
      return track;
    }
    now.t_s = next;
    if (due - next <= kInstant) ++told;
    if (leg_end - next <= kInstant) {
      number = (number + 1) % legs.size();
      field = {full, legs[number], leg_end};
    }
    if (!tell()) return track;
  }
  return track;
}

}  // namespace glidehelm::vehicle
