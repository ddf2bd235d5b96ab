#include "core/safety/rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/text.hpp"
#include "core/ocean/freshness.hpp"
#include "core/safety/margins.hpp"
#include "core/safety/track_rules.hpp"

namespace glidehelm::safety {

namespace {

constexpr double kHalfUnit = 0.5e-4 + 1e-9;  // minutes; the rest is the rounding of radians to degrees
constexpr double kSamePlace = 1.0;           // metres: a waypoint so near the goal is the goal
constexpr double kFixResolution = 20.0;      // metres: ten times the dialog's 0.001 minute
constexpr double kGliderMinute = 60.0;       // seconds: the step of the re-flight

bool is_goal(const GeoPoint& p, const Dossier& d) { return distance(p, d.promise.goal).si() <= kSamePlace; }
bool goal_alone(const GotoFile& list, const Dossier& d) {
  return list.points.size() == 1 && is_goal(list.points.front().at, d);
}

// ---- 0, 4: the dossier and the bytes

Margin judge_dossier(const Evidence& e) {
  std::string why;
  const bool sound = can_be_flown(e.dossier, why);
  return plain(sound, sound ? "all numbers are usable" : why);
}

Margin judge_name(const Evidence& e) {
  const auto& d = e.dossier;
  const std::string wanted = list_name(d.rules.slot);
  if (wanted.empty()) return plain(false, sentence("slot %d is not 0 to 99", d.rules.slot));
  return plain(d.file_name == wanted, "the file is called '" + d.file_name.substr(0, 60) + "', slot takes " + wanted);
}

Margin judge_size(const Evidence& e) {
  const auto bytes = e.dossier.file_bytes.size();
  return {"",
          bytes > 0 && bytes <= kLargestFile,
          static_cast<double>(bytes),
          static_cast<double>(kLargestFile),
          "bytes",
          sentence("%zu bytes, allowed are 1 to %zu", bytes, kLargestFile)};
}

Margin judge_format(const Evidence& e) {
  if (e.list) return plain(true, sentence("a goto list of %zu waypoints", e.list->points.size()));
  Margin m = plain(false, e.list.error().text());
  m.found = e.list.error().line;
  m.unit = "line";
  return m;
}

/// Difference of two angles in units of 1e-4 minute, across the antimeridian too.
double apart(double file_units, double meant_deg) {
  return std::abs(std::remainder(file_units - meant_deg * kUnitsPerDegree, 360.0 * kUnitsPerDegree));
}

Margin judge_points(const Evidence& e) {
  if (!e.list) return not_judged("the file could not be read");
  const auto& file = *e.list;
  const auto& promise = e.dossier.promise;
  if (file.points.size() != promise.points.size())
    return plain(false,
                 sentence("%zu waypoints in the file, %zu were meant", file.points.size(), promise.points.size()));
  double worst = 0;
  int worst_line = 0;
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    const auto& f = file.points[i];
    const auto& meant = promise.points[i].at;
    const double off = std::max(apart(static_cast<double>(f.lat_units), meant.lat.degrees()),
                                apart(static_cast<double>(f.lon_units), meant.lon.degrees()));
    if (i == 0 || off > worst) {
      worst = off;
      worst_line = f.line;
    }
  }
  Margin m;
  m.found = worst * 1e-4;
  m.limit = 0.5e-4;
  m.unit = "minutes";
  m.holds = m.found <= kHalfUnit;
  m.message = sentence("line %d is %.6f minutes from what was meant, allowed is half a digit", worst_line, m.found);
  if (m.holds && promise.radius && std::abs(file.radius.si() - promise.radius->si()) > 0.0501) {
    m.holds = false;
    m.message = sentence("list_when_wpt_dist is %.1f m, meant were %.2f m", file.radius.si(), promise.radius->si());
  }
  if (m.holds && promise.at_end && file.at_end != *promise.at_end) {
    m.holds = false;
    m.message = "num_legs_to_run is not what was meant";
  }
  return m;
}

// ---- 1: the waypoints

Margin judge_waypoints(const Evidence& e) {
  if (!e.list) return not_judged("the file could not be read");
  Margin m;
  m.holds = true;
  m.found = chart::Chart::kHorizon;
  m.limit = 0;
  m.unit = "m";
  m.message = "every waypoint is in allowed water";
  const auto coverage = e.full.coverage();
  for (const auto& p : e.list->points) {
    const double clearance = e.chart.clearance(p.at).si();
    m.found = std::min(m.found, clearance);
    const char* fault = nullptr;
    if (e.chart.is_land(p.at))
      fault = "lies on land";
    else if (!e.chart.is_charted(p.at))
      fault = "lies outside the coast file";
    else if (!(clearance > 0))
      fault = "lies outside the allowed area or inside a forbidden one";
    else if (!coverage.contains(p.at))
      fault = "lies outside the area of the forecast";
    else if (!e.chart.has_coast()) {
      const auto sample = e.full.sample(p.at, Depth{}, e.dossier.fix_s);
      if (!sample && sample.error() == ocean::NoCurrent::land) fault = "lies on the forecast's land";
    }
    if (fault != nullptr && m.holds) {
      m.holds = false;
      m.message =
          sentence("waypoint of line %d (%.5f, %.5f) %s", p.line, p.at.lat.degrees(), p.at.lon.degrees(), fault);
    }
  }
  return m;
}

/// Largest current that glider or forecast believes in the stints the list is made for.
double largest_believed(const Evidence& e) {
  double largest = e.dossier.believed_current ? e.dossier.believed_current->speed().si() : 0.0;
  const std::size_t made_for = std::min(e.flight->stints.size(), e.list->points.size());
  for (std::size_t k = 0; k < made_for; ++k) {
    const auto& s = e.flight->stints[k];
    largest = std::max({largest, s.believed.speed().si(), s.met.speed().si(), s.drift.speed().si()});
  }
  return largest;
}

Margin judge_legs(const Evidence& e) {
  if (!e.list || !e.flight) return not_judged("the list was not flown");
  const auto& d = e.dossier;
  const auto& points = e.list->points;
  const double speed = d.glider.believed_speed.si() + largest_believed(e);
  // The planner lengthens a leg to this, whatever the stint (product.md 6).
  const double shortest_leg = std::max(2 * e.list->radius.si(), 500.0);
  Margin m{"", true, 0.0, kNoNumber, "m", "no leg has a limit: the list leads straight to the goal"};
  double most_used = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + 1 == points.size() && is_goal(points[i].at, d)) break;
    const double length = distance(i == 0 ? d.at.fix : points[i - 1].at, points[i].at).si();
    const double stint = (i == 0 ? d.schedule.first_stint : d.schedule.stint).count();
    const double limit = 1.1 * std::max(speed * stint, shortest_leg);
    if (length / limit <= most_used) continue;
    most_used = length / limit;
    m.found = length;
    m.limit = limit;
    m.holds = length <= limit;
    m.message =
        sentence("the leg to the waypoint of line %d is %.0f m, a stint allows %.0f m", points[i].line, length, limit);
  }
  return m;
}

Margin judge_first_leg(const Evidence& e) {
  if (!e.list) return not_judged("the file could not be read");
  const auto& d = e.dossier;
  const double length = distance(d.at.fix, e.list->points.front().at).si(), radius = e.list->radius.si();
  const bool exempt = goal_alone(*e.list, d);
  return {"",
          exempt || length > radius,
          length,
          radius,
          "m",
          exempt ? "the list is the goal alone"
                 : sentence("the first waypoint is %.0f m from the fix, its radius %.0f m", length, radius)};
}

Margin judge_neighbours(const Evidence& e) {
  if (!e.list) return not_judged("the file could not be read");
  const auto& points = e.list->points;
  const double radius = e.list->radius.si();
  Margin m{"", true, kNoNumber, radius, "m", "a single waypoint"};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double length = distance(points[i - 1].at, points[i].at).si();
    if (i > 1 && length >= m.found) continue;
    m.found = length;
    m.holds = length > radius;
    m.message = sentence("lines %d and %d are %.0f m apart, the radius is %.0f m", points[i - 1].line, points[i].line,
                         length, radius);
  }
  return m;
}

Margin judge_reach(const Evidence& e) {
  if (!e.list || !e.flight) return not_judged("the list was not flown");
  const auto& limit = e.dossier.rules.max_wpt_distance;
  double reach = std::max(e.flight->farthest_target, distance(e.dossier.at.fix, e.list->points.front().at).si());
  for (std::size_t i = 1; i < e.list->points.size(); ++i)
    reach = std::max(reach, distance(e.list->points[i - 1].at, e.list->points[i].at).si());
  if (!limit) return {"", true, reach, kNoNumber, "m", "the glider's mission sets no max_wpt_distance"};
  const double allowed = 0.9 * limit->si();
  return {"",    reach <= allowed,
          reach, allowed,
          "m",   sentence("%.0f m to a waypoint, 0.9 of max_wpt_distance is %.0f m", reach, allowed)};
}

// ---- 5: whom, what and when it answers

Margin judge_surfacing(const Evidence& e) {
  const auto& d = e.dossier;
  const double off = std::abs(d.fix_s - epoch_seconds(d.at.fix_taken));
  Margin m{"", false, off, 1.0, "s", ""};
  if (d.current_surfacing.empty() || d.answers_surfacing != d.current_surfacing)
    m.message = "made for surfacing '" + d.answers_surfacing + "', current is '" + d.current_surfacing + "'";
  else if (!(off <= 1.0))
    m.message = sentence("flown from a fix %.0f s apart from the surfacing's", off);
  else {
    m.holds = true;
    m.message = "answers '" + d.current_surfacing + "'";
  }
  return m;
}

Margin judge_glider(const Evidence& e) {
  const auto& d = e.dossier;
  const bool same = !d.glider_expected.empty() && equal_without_case(d.at.glider, d.glider_expected) &&
                    (d.glider.name.empty() || equal_without_case(d.glider.name, d.glider_expected));
  return plain(same, "heard '" + d.at.glider + "', configured is '" + d.glider_expected + "'");
}

Margin judge_deadline(const Evidence& e) {
  const double left = e.dossier.deadline_s - e.dossier.judged_s;
  return {"", left > 0, left, 0.0, "s", sentence("%.1f s before the deadline", left)};
}

// ---- promises and forecast

Margin judge_next_surfacing(const Evidence& e) {
  if (!e.flight || e.flight->stints.empty()) return not_judged("the first stint was not flown to its end");
  const auto& d = e.dossier;
  const double way = d.glider.horizontal_speed.si() * d.schedule.first_stint.count();
  const double limit = std::max(d.rules.surfacing_tolerance * way, kFixResolution);
  const double off = distance(e.flight->stints.front().surfaced, d.promise.next_surfacing).si();
  return {"",    off <= limit, off,
          limit, "m",          sentence("re-flown surfacing %.0f m from the promised one, allowed %.0f m", off, limit)};
}

Margin judge_arrival(const Evidence& e) {
  if (!e.flight) return not_judged("the list was not flown");
  const auto& promised = e.dossier.promise.list_arrival_s;
  const auto& flown = e.flight->arrival_s;
  if (!promised)
    return {"", true, kNoNumber, kNoNumber, "s", flown ? "arrives, though not promised" : "no arrival is promised"};
  const double travel = *promised - e.dossier.fix_s;
  const double limit = std::max(e.dossier.rules.arrival_tolerance * travel, kGliderMinute);
  if (!flown) return {"", false, kNoNumber, limit, "s", "an arrival is promised, the re-flown list does not arrive"};
  const double off = std::abs(*flown - *promised);
  return {"",
          off <= limit,
          off,
          limit,
          "s",
          sentence("re-flown arrival after %.2f h, promised %.2f h, allowed difference %.0f s",
                   (*flown - e.dossier.fix_s) / 3600, travel / 3600, limit)};
}

Margin judge_cover(const Evidence& e) {
  const auto coverage = e.full.coverage();
  const double found = (coverage.last_s - e.dossier.fix_s) / 3600;
  const double limit = e.dossier.schedule.surfacing_time(1).count() / 3600;
  Margin m{"", found >= limit && coverage.first_s <= e.dossier.fix_s, found, limit, "h", ""};
  if (coverage.first_s > e.dossier.fix_s)
    m.message = sentence("the forecast begins %.1f h after the fix", (coverage.first_s - e.dossier.fix_s) / 3600);
  else
    m.message =
        sentence("the forecast reaches %.1f h after the fix, the second next surfacing is at %.1f h", found, limit);
  return m;
}

Margin judge_age(const Evidence& e) {
  const double limit = ocean::kExpiredAfter / 3600;
  if (!e.issued_s) return {"", true, kNoNumber, limit, "h", "the currents are not of one time"};
  const double found = (e.dossier.judged_s - *e.issued_s) / 3600;
  return {
      "", found <= limit, found, limit, "h", sentence("the forecast is %.1f h old, allowed are %.0f h", found, limit)};
}

Margin judge_speed(const Evidence& e) {
  if (!e.flight) return not_judged("the list was not flown");
  const double limit = e.dossier.rules.refused_speed.si(), found = e.flight->fastest_current;
  return {"",    found <= limit, found,
          limit, "m/s",          sentence("fastest current met %.2f m/s, refused above %.2f", found, limit)};
}

Margin judge_values(const Evidence& e) {
  if (!e.flight) return not_judged("the list was not flown");
  const bool finite = e.flight->end != FlightEnd::not_finite;
  return plain(finite, finite ? "every current met is a number" : "the forecast gave a current that is not a number");
}

constexpr std::array<Rule, 24> kRules{{{"0 dossier", judge_dossier},
                                       {"4 name", judge_name},
                                       {"4 size", judge_size},
                                       {"4 format", judge_format},
                                       {"4 points", judge_points},
                                       {"1 waypoints", judge_waypoints},
                                       {"1 legs", judge_legs},
                                       {"1 first leg", judge_first_leg},
                                       {"1 neighbours", judge_neighbours},
                                       {"1 reach", judge_reach},
                                       {"2 flight", judge_flight},
                                       {"2 land", judge_land},
                                       {"2 depth", judge_depth},
                                       {"2 areas", judge_areas},
                                       {"2 tail", judge_tail},
                                       {"5 surfacing", judge_surfacing},
                                       {"5 glider", judge_glider},
                                       {"5 deadline", judge_deadline},
                                       {"promise surfacing", judge_next_surfacing},
                                       {"promise arrival", judge_arrival},
                                       {"forecast cover", judge_cover},
                                       {"forecast age", judge_age},
                                       {"forecast speed", judge_speed},
                                       {"forecast values", judge_values}}};

}  // namespace

std::span<const Rule> rules() { return kRules; }

bool can_be_flown(const Dossier& d, std::string& why) {
  struct Bound {
    const char* what;
    double value, low, high;
  };
  const double around_year_3000 = 3.25e10;
  const Bound bounds[] = {
      {"horizontal speed", d.glider.horizontal_speed.si(), 0.01, 5.0},
      {"believed speed", d.glider.believed_speed.si(), 0.01, 5.0},
      {"glide angle", in_degrees(d.glider.glide_angle), 1.0, 80.0},
      {"dive depth", d.glider.dive_depth.si(), 1.0, 12'000.0},
      {"upper turning depth", d.glider.climb_to.si(), 0.0, 12'000.0},
      {"current correction", static_cast<double>(d.glider.current_correction), 0.0, 1.0},
      {"believed current", d.believed_current ? d.believed_current->speed().si() : 0.0, 0.0,
       d.rules.refused_speed.si()},
      {"stint", d.schedule.stint.count(), 60.0, 72 * 3600.0},
      {"first stint", d.schedule.first_stint.count(), 60.0, 72 * 3600.0},
      {"surface interval", d.schedule.surface.count(), 0.0, 24 * 3600.0},
      {"time to dive", d.schedule.time_to_dive.count(), 0.0, 24 * 3600.0},
      {"time of the fix", d.fix_s, 0.0, around_year_3000},
      {"horizon", d.horizon_s, d.fix_s + d.schedule.surfacing_time(0).count(), around_year_3000},
      {"promised arrival", d.promise.list_arrival_s.value_or(d.fix_s), d.fix_s, around_year_3000},
      {"time of judging", d.judged_s, 0.0, around_year_3000},
      {"deadline", d.deadline_s, 0.0, around_year_3000},
      {"goal radius", d.promise.goal_radius.si(), 1.0, 1e6},
      {"coast margin", d.rules.coast_margin.si(), 0.0, 50'000.0},
      {"max_wpt_distance", d.rules.max_wpt_distance.value_or(Metres{1.0}).si(), 1.0, 1e8},
      {"arrival tolerance", d.rules.arrival_tolerance, 0.0, 1.0},
      {"surfacing tolerance", d.rules.surfacing_tolerance, 0.0, 1.0},
      {"refused speed", d.rules.refused_speed.si(), 0.0, 5.0},
      {"most waypoints", static_cast<double>(d.rules.max_waypoints), 1.0, 50.0},
      {"heading bias", in_degrees(d.glider.heading_bias), -45.0, 45.0},
      {"correction of the forecast", d.correction ? d.correction->added.speed().si() : 0.0, 0.0,
       d.correction && !d.correction->plausible() ? -1.0 : ocean::LocalCorrection::kStrongest},
      {"tail's stints", d.rules.tail_stint, 0.0, 0.5},
      {"tail's slower speed", d.rules.tail_slower, 0.0, 0.6},
      {"tail's faster speed", d.rules.tail_faster, 0.0, 0.5},
  };
  for (const auto& b : bounds)
    if (!(b.value >= b.low && b.value <= b.high)) {
      why = sentence("%s is %g, allowed is %g to %g", b.what, b.value, b.low, b.high);
      return false;
    }
  return true;
}

FlightOrder order_for(const Dossier& d, const GotoFile& list) {
  FlightOrder order;
  for (const auto& p : list.points) order.points.push_back(p.at);
  order.radius = list.radius;
  order.at_end = list.at_end;
  order.glider = d.glider;
  order.schedule = d.schedule;
  order.believed_current = d.believed_current;
  order.fix = d.at.fix;
  order.fix_s = d.fix_s;
  order.horizon_s = d.horizon_s;
  order.goal = d.promise.goal;
  order.goal_radius = d.promise.goal_radius;
  return order;
}

}  // namespace glidehelm::safety
