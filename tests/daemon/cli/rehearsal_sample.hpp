#pragma once

#include <optional>

#include "core/base/geo.hpp"
#include "core/base/utc.hpp"
#include "daemon/cli/rehearsal_report.hpp"

namespace glidehelm::test {

inline cli::Rehearsed rehearsed(int seed, const char* method, std::optional<double> travel_h, double hindcast_h) {
  cli::Rehearsed r;
  r.seed = seed;
  r.method = method;
  r.end = travel_h ? "inside the goal radius" : "ran out of time";
  if (travel_h) r.travel_s = *travel_h * 3600;
  r.hindcast_s = hindcast_h * 3600;
  r.surfacings = 10 * seed;
  r.missed = 1;
  r.closest_goal = travel_h ? 1990 : 12'000;
  r.rules = {{"2 land", seed}};
  r.track = {geo_point(28, -15), geo_point(28.5, -14.5)};
  return r;
}

/// Two oceans, two methods; one flight does not arrive.
inline cli::Rehearsal rehearsal() {
  cli::Rehearsal all;
  all.mission = "leg <2>";
  all.method = "best";
  all.start = geo_point(28, -15);
  all.goal = geo_point(28.5, -14.5);
  all.goal_radius = Metres{2000};
  all.departure_s = epoch_seconds(utc_from_text("2026-03-01T00:00:00Z").value());
  all.runs = {rehearsed(1, "best", 100, 90), rehearsed(1, "direct", std::nullopt, 90), rehearsed(2, "best", 120, 100),
              rehearsed(2, "direct", 150, 100)};
  return all;
}

}  // namespace glidehelm::test
