#include "daemon/cli/field_info.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/ocean/gridded.hpp"
#include "daemon/cli/field_text.hpp"

namespace glidehelm::cli {

namespace {

using nlohmann::ordered_json;

ordered_json text_or_null(const std::string& text) { return text.empty() ? ordered_json{} : ordered_json(text); }

ordered_json axis_json(const std::vector<double>& axis) {
  const double step = (axis.back() - axis.front()) / static_cast<double>(axis.size() - 1);
  return {{"count", axis.size()},
          {"first_deg", axis.front()},
          {"last_deg", axis.back()},
          {"step_deg", step},
          {"even", ocean::GridAxis{axis}.uniform()}};
}

/// Null when the files have no temperature and salinity.
ordered_json water_json(const ocean::GridWater& water) {
  if (water.words.empty()) return {};
  ordered_json layers = ordered_json::array();
  for (const auto& layer : water.layers)
    layers.push_back({{"depth_m", layer.depth.si()},
                      {"temperature_c", layer.temperature_c},
                      {"salinity", layer.salinity},
                      {"density_kg_per_m3", ocean::sea_water_density(layer.salinity, layer.temperature_c,
                                                                     ocean::pressure_at(layer.depth))}});
  return {{"words", water.words}, {"layers", std::move(layers)}};
}

ordered_json info_json(const ocean::GridView& view) {
  const auto& axes = view.axes;
  const auto& facts = view.facts;
  const auto statistics = ocean::statistics_of(view);
  const ocean::GriddedField field{view, {}};
  const auto box = field.coverage();
  const auto degrees = [](double rad) { return rad * 180 / kPi; };
  double longest = 0;
  for (std::size_t t = 1; t < axes.times_s.size(); ++t)
    longest = std::max(longest, axes.times_s[t] - axes.times_s[t - 1]);

  ordered_json json;
  json["schema"] = "glidehelm/field-info/v1";
  json["cycle"] = facts.cycle;
  json["reference_time"] = std::isnan(facts.reference_s) ? ordered_json{} : ordered_json(time_text(facts.reference_s));
  json["provenance"] = view.provenance.hex();
  json["variables"] = {{"east", {{"name", facts.east_variable}, {"unit", text_or_null(facts.east_unit)}}},
                       {"north", {{"name", facts.north_variable}, {"unit", text_or_null(facts.north_unit)}}},
                       {"recognised_by", facts.recognised_by}};
  // "curvilinear Arakawa C grid of …; turned by …": the published grid, and the way onto this one.
  const std::string kind = facts.layout.rfind("curvilinear", 0) == 0 ? "curvilinear" : "rectilinear";
  json["grid"] = {{"kind", kind},
                  {"published_as", text_or_null(facts.layout)},
                  {"latitudes", axis_json(axes.lats_deg)},
                  {"longitudes", axis_json(axes.lons_deg)}};
  json["extent"] = {{"west_deg", axes.lons_deg.front()},
                    {"east_deg", axes.lons_deg.back()},
                    {"south_deg", axes.lats_deg.front()},
                    {"north_deg", axes.lats_deg.back()},
                    {"around_globe", degrees(box.east - box.west) > 359.999}};
  json["times"] = axes.has_time ? ordered_json{{"count", axes.times_s.size()},
                                               {"first", time_text(axes.times_s.front())},
                                               {"last", time_text(axes.times_s.back())},
                                               {"longest_step_s", longest},
                                               {"unit", text_or_null(facts.time_unit)}}
                                : ordered_json{};
  json["depths_m"] = axes.has_depth ? ordered_json(axes.depths_m) : ordered_json::array();
  json["wet_fraction"] = statistics.wet_fraction;
  json["speed_m_per_s"] = {{"min", statistics.slowest}, {"mean", statistics.mean}, {"max", statistics.fastest}};
  json["water"] = water_json(facts.water);
  json["sources"] = ordered_json::array();
  for (const auto& source : facts.sources)
    json["sources"].push_back({{"file", source.name}, {"sha256", source.hash.hex()}});
  json["warnings"] = facts.warnings;
  return json;
}

void print_info(const ocean::GridView& view, std::ostream& out) {
  const auto& axes = view.axes;
  const auto& facts = view.facts;
  const auto statistics = ocean::statistics_of(view);
  const auto unit = [](const std::string& text) { return text.empty() ? std::string{"no unit, taken as m/s"} : text; };
  out << "forecast   " << facts.cycle << '\n';
  // "computed from heights: adt, …": then the variable is no velocity.
  if (facts.recognised_by.rfind("computed from heights", 0) == 0)
    out << "variables  " << facts.east_variable << " (" << (facts.east_unit.empty() ? "no unit" : facts.east_unit)
        << "); the current is " << facts.recognised_by << '\n';
  else
    out << "variables  " << facts.east_variable << " (" << unit(facts.east_unit) << "), " << facts.north_variable
        << " (" << unit(facts.north_unit) << "), by " << facts.recognised_by << '\n';
  out << "grid       rectilinear, " << axes.lats_deg.size() << " latitudes " << decimal(axes.lats_deg.front(), 4)
      << " to " << decimal(axes.lats_deg.back(), 4) << ", " << axes.lons_deg.size() << " longitudes "
      << decimal(axes.lons_deg.front(), 4) << " to " << decimal(axes.lons_deg.back(), 4) << '\n';
  if (!facts.layout.empty()) out << "published  " << facts.layout << '\n';
  if (axes.has_time)
    out << "times      " << axes.times_s.size() << ", " << time_text(axes.times_s.front()) << " to "
        << time_text(axes.times_s.back()) << '\n';
  else
    out << "times      none: the same at every instant\n";
  if (axes.has_depth)
    out << "depths     " << axes.depths_m.size() << ", " << decimal(axes.depths_m.front(), 1) << " to "
        << decimal(axes.depths_m.back(), 1) << " m\n";
  else
    out << "depths     none\n";
  out << "water      " << decimal(100 * statistics.wet_fraction, 1) << " % of the nodes, "
      << decimal(statistics.slowest, 3) << " to " << decimal(statistics.fastest, 3) << " m/s, mean "
      << decimal(statistics.mean, 3) << " m/s\n";
  if (!facts.water.words.empty()) {
    out << "density    ";
    if (!facts.water.layers.empty()) {
      const auto &top = facts.water.layers.front(), &deepest = facts.water.layers.back();
      out << "at " << decimal(top.depth.si(), 1) << " m " << decimal(top.temperature_c, 2) << " C and salinity "
          << decimal(top.salinity, 2) << ", at " << decimal(deepest.depth.si(), 1) << " m "
          << decimal(deepest.temperature_c, 2) << " C and " << decimal(deepest.salinity, 2) << "; ";
    }
    out << facts.water.words << '\n';
  }
  for (const auto& warning : facts.warnings) out << "warning    " << warning << '\n';
}

}  // namespace

int run_field_info(const FieldInfoOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  if (options.files.empty()) return refuse_field(err, 2, "no file was named");
  const auto loaded = daemon::ingest_files(options.files, options.ingest, world);
  if (!loaded) return refuse_field(err, 1, loaded.error());
  if (options.json)
    out << info_json((*loaded)->view).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  else
    print_info((*loaded)->view, out);
  return 0;
}

}  // namespace glidehelm::cli
