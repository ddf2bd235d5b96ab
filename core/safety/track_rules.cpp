#include "core/safety/track_rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/chart/bathymetry.hpp"
#include "core/safety/margins.hpp"

namespace glidehelm::safety {

namespace {

constexpr double kTailSeconds = 72 * 3600.0;
constexpr double kChartSlack = 10.0;
constexpr double kLongestStep = 350.0;
/// Waves of the bottom that a way out of shallow water may cross.
constexpr double kDepthSlack = 1.0;

/// True when some water within `margin` is not charted: what lies there may be land.
bool uncharted_within(const GeoPoint& p, double margin, const chart::Chart& chart) {
  for (int i = 0; i < 8; ++i)
    if (!chart.is_charted(destination(p, Bearing{Radians{i * kPi / 4}}, Metres{margin}))) return true;
  return false;
}

double coast_distance(const GeoPoint& p, double margin, const chart::Chart& chart) {
  const double coast = chart.distance_to_coast(p).si();
  const double clearance = chart.clearance(p).si();
  // Something other than the shore is near: a border of areas, or of the chart itself.
  if (chart.has_coast() && clearance < std::min(coast, margin) &&
      (!chart.is_charted(p) || uncharted_within(p, margin, chart)))
    return clearance;
  return coast;
}

std::size_t first_dive(std::span<const TrackPoint> track) {
  for (std::size_t i = 0; i < track.size(); ++i)
    if (!track[i].drifting) return i == 0 ? 0 : i - 1;
  return track.empty() ? 0 : track.size() - 1;
}

std::string place(const TrackPoint& p, const Dossier& d) {
  return sentence("%.5f, %.5f in stint %d, %.1f h after the fix", p.at().lat.degrees(), p.at().lon.degrees(),
                  p.stint + 1, (p.t_s - d.fix_s) / 3600);
}

/// Follows track points [first, last): the shallowest water once deeper than `least`, or where it failed.
Kept keeps_depth(std::span<const TrackPoint> track, std::size_t first, std::size_t last, double least,
                 const chart::Bathymetry& bottom) {
  Kept kept{true, std::numeric_limits<double>::infinity(), first};
  if (first >= last) return kept;
  const double begin = bottom.depth(track[first].lat, track[first].lon);
  bool outside = begin >= least;
  Kept inside{true, begin, first};
  if (outside) kept.found = begin;
  for (std::size_t i = first + 1; i < last; ++i) {
    const auto &a = track[i - 1], &b = track[i];
    if (!outside) {
      const double here = bottom.depth(b.lat, b.lon);
      inside = {here >= begin - kDepthSlack, here, i};
      if (!inside.holds) return inside;
      outside = here >= least;
      continue;
    }
    if (bottom.is_deep_along(a.lat, a.lon, b.lat, b.lon, std::max(least, kept.found))) continue;
    const double here = bottom.shoalest_along(a.lat, a.lon, b.lat, b.lon);
    // The first piece outside may still hold water of before.
    const double depth = i > first + 1 && bottom.depth(track[i - 2].lat, track[i - 2].lon) < least
                             ? std::max(here, bottom.depth(b.lat, b.lon))
                             : here;
    if (depth < kept.found) kept.found = depth, kept.where = i;
    if (depth < least) kept.holds = false;
  }
  return outside ? kept : inside;
}

/// The part of a flight that is judged before and after the arrival.
Kept worst_of(const Kept& a, const Kept& b) {
  if (a.holds != b.holds) return a.holds ? b : a;
  return b.found < a.found ? b : a;
}

}  // namespace

Kept keeps_margin(std::span<const TrackPoint> track, std::size_t first, std::size_t last, double margin, Distance kind,
                  const chart::Chart& chart) {
  Kept kept{true, chart::Chart::kHorizon, first};
  Kept inside = kept;
  bool outside = false;
  double farthest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; ++i) {
    const auto& p = track[i];
    // The raster's lower bound spares the geometry wherever neither the verdict nor the minimum can change.
    if (outside && chart.clearance_at_least(p.at().lat.radians(), p.at().lon.radians()) >=
                       std::max(margin + kLongestStep, kept.found))
      continue;
    const double d = kind == Distance::coast ? coast_distance(p.at(), margin, chart) : chart.clearance(p.at()).si();
    if (!outside && d < margin) {
      if (d < farthest - kChartSlack) return {false, d, i};
      farthest = std::max(farthest, d);
      inside = {true, d, i};
      continue;
    }
    const bool crosses = outside && margin <= 0 && kind == Distance::clearance &&
                         !chart.segment_is_clear(track[i - 1].lat, track[i - 1].lon, p.lat, p.lon, 0.0);
    outside = true;
    if (d < margin || crosses) kept.holds = false;
    const double nearest = crosses ? std::min(d, 0.0) : d;
    if (nearest < kept.found) {
      kept.found = nearest;
      kept.where = i;
    }
  }
  return outside ? kept : inside;
}

Margin judge_flight(const Evidence& e) {
  if (!e.flight) return not_judged("the list was not flown");
  const auto& flight = *e.flight;
  const auto& end = flight.track.back();
  Margin m;
  m.found = (end.t_s - e.dossier.fix_s) / 3600;
  m.limit = kNoNumber;
  m.unit = "h";
  const bool arrived = flight.arrival_s.has_value();
  switch (flight.end) {
    case FlightEnd::horizon:
    case FlightEnd::stints:
    case FlightEnd::list_finished:
      m.holds = true;
      break;
    case FlightEnd::outside_time:
      m.holds = arrived || flight.stints.size() >= 2;
      break;
    case FlightEnd::outside_area:
      m.holds = arrived;
      break;
    // With a coastline the model's mask is no land of its own.
    case FlightEnd::no_data:
      m.holds = arrived;
      break;
    case FlightEnd::land:
      m.holds = arrived && e.chart.has_coast();
      break;
    case FlightEnd::not_finite:
      m.holds = false;
      break;
  }
  if (flight.stints.empty()) m.holds = false;
  m.message = sentence("flown for %zu stints to %s; ended by: ", flight.stints.size(), place(end, e.dossier).c_str());
  m.message += word(flight.end);
  return m;
}

Margin judge_land(const Evidence& e) {
  if (!e.flight) return not_judged("the list was not flown");
  const std::span<const TrackPoint> track{e.flight->track};
  const std::size_t arrival = e.flight->arrival_index, dive = first_dive(track);
  const double margin = e.dossier.rules.coast_margin.si();
  const auto before = keeps_margin(track, dive, std::min(arrival, track.size()), margin, Distance::coast, e.chart);
  const auto after = keeps_margin(track, std::max(arrival, dive), track.size(), 0.0, Distance::coast, e.chart);
  Margin m;
  m.holds = before.holds && after.holds && after.found > 0;
  const bool shown_after = before.holds && !m.holds;
  const auto& shown = shown_after ? after : before;
  m.found = shown.found;
  m.limit = shown_after ? 0.0 : margin;
  m.unit = "m";
  m.message = sentence("%.0f m from the coast at %s, allowed from %.0f m", m.found,
                       place(track[shown.where < track.size() ? shown.where : 0], e.dossier).c_str(), m.limit);
  if (!e.chart.has_coast()) m.message = "no coastline is given: only the forecast's own land is judged";
  return m;
}

Margin judge_depth(const Evidence& e) {
  if (!e.flight) return not_judged("the list was not flown");
  Margin m;
  m.unit = "m";
  m.found = m.limit = kNoNumber;
  const auto* bottom = e.chart.bathymetry();
  if (bottom == nullptr) {
    m.holds = true;
    m.message = "no bathymetry is given: the depth of the water is not judged";
    return m;
  }
  const std::span<const TrackPoint> track{e.flight->track};
  const std::size_t arrival = std::min(e.flight->arrival_index, track.size()), dive = first_dive(track);
  const double least = e.chart.least_depth().si();
  const auto before = keeps_depth(track, dive, arrival, least, *bottom);
  const auto after = keeps_depth(track, std::max(arrival, dive), track.size(), 0.0, *bottom);
  m.holds = before.holds && after.holds && after.found > 0;
  const bool shown_after = before.holds && !m.holds;
  const auto& shown = shown_after ? after : before;
  m.limit = shown_after ? 0.0 : least;
  const auto where = place(track[std::min(shown.where, track.size() - 1)], e.dossier);
  if (std::isfinite(shown.found)) {
    m.found = shown.found;
    m.message = sentence("%.0f m of water at %s, allowed from %.0f m", m.found, where.c_str(), m.limit);
  } else {
    m.message = before.holds && m.holds ? "nothing was flown before the arrival"
                                        : "the depth of the water is not known at " + where + ", so it may be land";
  }
  return m;
}

Margin judge_areas(const Evidence& e) {
  if (!e.flight) return not_judged("the list was not flown");
  const std::span<const TrackPoint> track{e.flight->track};
  const auto kept = keeps_margin(track, first_dive(track), std::min(e.flight->arrival_index, track.size()), 0.0,
                                 Distance::clearance, e.chart);
  Margin m;
  m.holds = kept.holds;
  m.found = kept.found;
  m.limit = 0;
  m.unit = "m";
  m.message = sentence("%.0f m inside what is allowed at %s", kept.found,
                       place(track[kept.where < track.size() ? kept.where : 0], e.dossier).c_str());
  return m;
}

Margin judge_tail(const Evidence& e) {
  if (!e.flight || !e.list) return not_judged("the list was not flown");
  Margin m;
  m.holds = true;
  m.found = chart::Chart::kHorizon;
  m.limit = 0;
  m.unit = "m";
  const auto& rules = e.dossier.rules;
  m.message = sentence("with the stint %.0f %% shorter or longer and the speed %.0f %% lower or %.0f %% higher",
                       100 * rules.tail_stint, 100 * rules.tail_slower, 100 * rules.tail_faster);
  for (const double length : {1 - rules.tail_stint, 1 + rules.tail_stint}) {
    for (const double speed : {1 - rules.tail_slower, 1 + rules.tail_faster}) {
      FlightOrder order = order_for(e.dossier, *e.list);
      order.schedule.stint *= length;
      order.schedule.first_stint *= length;
      order.glider.horizontal_speed = speed * order.glider.horizontal_speed;
      order.horizon_s = std::min(order.horizon_s, order.fix_s + kTailSeconds);
      const Flight flight = fly(order, e.full);
      const std::span<const TrackPoint> track{flight.track};
      const std::size_t dive = first_dive(track), arrival = std::min(flight.arrival_index, track.size());
      const auto kept =
          worst_of(keeps_margin(track, dive, arrival, 0.0, Distance::clearance, e.chart),
                   keeps_margin(track, std::max(dive, arrival), track.size(), 0.0, Distance::coast, e.chart));
      const bool aground = flight.end == FlightEnd::land && !(flight.arrival_s && e.chart.has_coast());
      const auto* bottom = e.chart.bathymetry();
      const Kept water = bottom == nullptr ? Kept{true, chart::Chart::kHorizon, dive}
                                           : keeps_depth(track, dive, track.size(), 0.0, *bottom);
      const bool dry = !water.holds || !(water.found > 0);
      if (kept.found < m.found) m.found = kept.found;
      if (m.holds && (!kept.holds || aground || dry)) {
        m.holds = false;
        const bool touches = !kept.holds || aground;
        const auto& where =
            aground ? track.back() : track[touches ? kept.where : std::min(water.where, track.size() - 1)];
        m.message = sentence(
            "%s with stint length %+.0f %% and speed %+.0f %%: %s",
            touches ? "touches land or a forbidden area" : "comes where the depth is not known or there is no water",
            100 * (length - 1), 100 * (speed - 1), place(where, e.dossier).c_str());
      }
    }
  }
  return m;
}

}  // namespace glidehelm::safety
