#pragma once

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "core/base/utc.hpp"
#include "core/safety/judge.hpp"
#include "core/safety/rules.hpp"
#include "tests/support/fields.hpp"

/// A file that passes every rule, the ocean it is judged in, and the handles to break one rule at a time.
namespace glidehelm::test {

inline constexpr double kUnits = 600'000.0;  ///< 1e-4 minutes per degree

using Answer = Expected<ocean::Sample, ocean::NoCurrent>;

/// A field given by a formula of position, depth in metres and epoch second.
struct FormulaField {
  std::function<Answer(GeoPoint, double, double)> formula;
  ocean::Coverage box{};
  [[nodiscard]] Answer sample(GeoPoint p, Depth z, double t) const { return formula(p, z.below_surface.si(), t); }
  [[nodiscard]] ocean::Coverage coverage() const { return box; }
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{6}; }
};

inline FormulaField uniform(double east, double north) {
  return {[=](GeoPoint, double, double) -> Answer { return ocean::Sample{current(east, north), false}; }, {}};
}

/// DDMM.mmmm by whole units of 1e-4 minute.
inline std::string ddmm(double degrees) {
  const long long units = std::llround(std::abs(degrees) * kUnits);
  char text[32];
  std::snprintf(text, sizeof text, "%s%lld.%04lld", degrees < 0 ? "-" : "",
                units / 600'000 * 100 + units % 600'000 / 10'000, units % 10'000);
  return text;
}

inline std::string goto_list(const std::vector<GeoPoint>& points, double radius, const std::string& legs = "-1",
                             const std::string& end_action = "0") {
  char head[600];
  std::snprintf(head, sizeof head,
                "behavior_name=goto_list\n"
                "# Glidehelm 2026-11-25T10:20:30Z plan 7\n"
                "<start:b_arg>\n"
                "  b_arg: num_legs_to_run(nodim) %s\n"
                "  b_arg: start_when(enum) 0 # BAW_IMMEDIATELY\n"
                "  b_arg: list_stop_when(enum) 7\n"
                "  b_arg: list_when_wpt_dist(m) %.1f\n"
                "  b_arg: initial_wpt(enum) 0\n"
                "  b_arg: num_waypoints(nodim) %zu\n"
                "  b_arg: end_action(enum) %s\n"
                "<end:b_arg>\n"
                "<start:waypoints>\n",
                legs.c_str(), radius, points.size(), end_action.c_str());
  std::string text = head;
  for (const auto& p : points) text += ddmm(p.lon.degrees()) + " " + ddmm(p.lat.degrees()) + "\n";
  return text + "<end:waypoints>\n";
}

/// The position that the file's text names.
inline GeoPoint as_written(const GeoPoint& p) {
  return geo_point(std::round(p.lat.degrees() * kUnits) / kUnits, std::round(p.lon.degrees() * kUnits) / kUnits);
}

struct Case {
  safety::Dossier dossier;
  FormulaField field = uniform(0.05, 0.02);
  chart::ChartSources sources;

  /// Writes the list again and promises what it does in this ocean.
  void write(const std::vector<GeoPoint>& points, double radius, const std::string& legs = "-1",
             const std::string& end_action = "0") {
    dossier.file_bytes = goto_list(points, radius, legs, end_action);
    dossier.promise.points.clear();
    for (const auto& p : points) dossier.promise.points.push_back({as_written(p), model::WaypointRole::aim});
    dossier.promise.points.back().role = model::WaypointRole::goal;
    promise_as_flown();
  }
  void promise_as_flown() {
    const auto list = safety::read_list(dossier.file_bytes, dossier.rules.max_waypoints);
    if (!list) return;
    const auto flight = safety::fly(safety::order_for(dossier, *list), field);
    if (!flight.stints.empty()) dossier.promise.next_surfacing = flight.stints.front().surfaced;
    dossier.promise.list_arrival_s = flight.arrival_s;
  }
  [[nodiscard]] safety::Verdict judged() const { return safety::judge(dossier, field, chart::Chart{sources}); }
  /// Names of the rules that do not hold, in the order of the verdict, joined by ", ".
  [[nodiscard]] std::string failing() const {
    std::string names;
    for (const auto& m : judged().margins)
      if (!m.holds) names += (names.empty() ? "" : ", ") + m.rule;
    return names;
  }
};

inline const safety::Margin& margin(const safety::Verdict& verdict, const std::string& rule) {
  for (const auto& m : verdict.margins)
    if (m.rule == rule) return m;
  throw std::runtime_error("no margin for rule " + rule);
}

/// Three waypoints north-eastwards, 4.5 km apart, then a goal 20 km from the fix, in a uniform current that the glider
/// knows. First point 4.5 km = 14400 s · 0.3 m/s and some current.
inline Case good_case() {
  Case c;
  auto& d = c.dossier;
  d.file_name = "goto_l10.ma";
  d.glider_expected = "sim01";
  d.at.glider = "sim01";
  d.at.fix = geo_point(40.0, -30.0);
  d.fix_s = 1'700'000'000.0;
  d.at.fix_taken = instant_at(d.fix_s);
  d.at.heard = instant_at(d.fix_s + 50);
  d.current_surfacing = d.answers_surfacing = "sim01 0012.0003";
  d.glider.name = "sim01";
  d.believed_current = current(0.05, 0.02);
  d.horizon_s = d.fix_s + 3 * 86'400.0;
  d.judged_s = d.fix_s + 60;
  d.deadline_s = d.fix_s + 300;
  const Bearing north_east{degrees(45)};
  d.promise.goal = as_written(destination(d.at.fix, north_east, Metres{20'000}));
  d.promise.goal_radius = Metres{2000};
  c.write({destination(d.at.fix, north_east, Metres{4500}), destination(d.at.fix, north_east, Metres{9000}),
           destination(d.at.fix, north_east, Metres{13'500}), d.promise.goal},
          400);
  return c;
}

}  // namespace glidehelm::test
