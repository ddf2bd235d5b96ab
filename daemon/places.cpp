#include "daemon/places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/chart/areas.hpp"
#include "core/chart/bathymetry.hpp"
#include "core/chart/space.hpp"

namespace glidehelm::daemon {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Where a point may not lie, in words; empty for a good place.
std::string trouble_at(GeoPoint p, const chart::Coast* coast, const mission::Mission& m) {
  const double lat = p.lat.radians(), lon = p.lon.radians();
  if (coast != nullptr && !coast->covers(lat, lon)) return "lies outside the coast file";
  if (coast != nullptr && coast->land().contains(lat, lon))
    return fmt::format("is on land, {:.1f} km inside the coast",
                       coast->land().distance(chart::Space::at(lat, lon), kFar) / 1000);
  const auto holds = [&](const chart::Area& area) { return chart::region_of(area).contains(lat, lon); };
  for (const auto& area : m.keep_out)
    if (holds(area)) return "lies in a keep_out area";
  if (m.keep_in.empty() || std::any_of(m.keep_in.begin(), m.keep_in.end(), holds)) return "";
  return "lies outside the keep_in areas";
}

/// What is to be said of a wrong point whose numbers are a good place the other way round.
std::string swap_hint(GeoPoint p, const std::optional<GeoPoint>& other, const chart::Coast* coast,
                      const mission::Mission& m) {
  if (coast == nullptr && !other) return "";  // nothing tells one place from the other
  const auto swapped = GeoPoint::from_degrees(p.lon.degrees(), p.lat.degrees());
  if (!swapped || !trouble_at(*swapped, coast, m).empty()) return "";
  if (other && distance(*swapped, *other) > distance(p, *other)) return "";
  return fmt::format("; swapped it would be {:.4f},{:.4f}, in the water: latitude comes first", swapped->lat.degrees(),
                     swapped->lon.degrees());
}

}  // namespace

const Places::Known& Places::coast_of(const std::string& path) {
  const auto [entry, is_new] = known_.try_emplace(path);
  if (!is_new || path.empty()) return entry->second;
  const auto bytes = files_.read(path, chart::Coast::kLargestFile);
  if (!bytes) {
    entry->second.problem = bytes.error().message();
    return entry->second;
  }
  auto coast = chart::Coast::parse(*bytes);
  if (coast)
    entry->second.coast = std::move(coast).value();
  else
    entry->second.problem = path + ": " + coast.error().message();
  return entry->second;
}

std::vector<config::ConfigError> Places::depth_errors(const mission::Mission& m, const std::string& text,
                                                      const std::string& file) {
  if (m.bathymetry_file.empty()) return {};
  const auto refused = [&](const char* key, const std::string& why) {
    return std::vector{config::error_at(text, file, key, why)};
  };
  const auto bytes = files_.read(m.bathymetry_file, chart::Bathymetry::kLargestFile);
  if (!bytes) return refused("safety.bathymetry", bytes.error().message());
  const auto bottom = chart::Bathymetry::parse(*bytes);
  if (!bottom) return refused("safety.bathymetry", m.bathymetry_file + ": " + bottom.error());
  const double depth = (*bottom)->depth(m.goal.lat.radians(), m.goal.lon.radians());
  if (depth > 0) return {};
  return refused("goal", fmt::format("{:.4f},{:.4f} {}", m.goal.lat.degrees(), m.goal.lon.degrees(),
                                     depth == chart::Bathymetry::kUnknown ? "has no known depth in safety.bathymetry"
                                                                          : "is land in safety.bathymetry"));
}

std::vector<config::ConfigError> Places::errors_of(const mission::Mission& m, const std::string& text,
                                                   const std::string& file) {
  const auto& known = coast_of(m.coast_file);
  if (!known.problem.empty()) return {config::error_at(text, file, "safety.coast", known.problem)};
  std::vector<config::ConfigError> errors = depth_errors(m, text, file);
  const auto check = [&](const char* key, GeoPoint p, const std::optional<GeoPoint>& other) {
    const auto trouble = trouble_at(p, known.coast.get(), m);
    if (trouble.empty()) return;
    errors.push_back(config::error_at(text, file, key,
                                      fmt::format("{:.4f},{:.4f} {}{}", p.lat.degrees(), p.lon.degrees(), trouble,
                                                  swap_hint(p, other, known.coast.get(), m))));
  };
  check("goal", m.goal, m.start);
  if (m.start) check("start", *m.start, m.goal);
  return errors;
}

std::vector<config::ConfigError> Places::errors_of(const config::Configuration& all) {
  std::vector<config::ConfigError> errors;
  for (const auto& m : all.missions)
    for (auto& error : errors_of(m.mission, m.text, m.file)) errors.push_back(std::move(error));
  return errors;
}

}  // namespace glidehelm::daemon
