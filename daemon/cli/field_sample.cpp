#include "daemon/cli/field_sample.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/ocean/depth_average.hpp"
#include "core/ocean/family.hpp"
#include "core/ocean/gridded.hpp"
#include "daemon/cli/field_text.hpp"

namespace glidehelm::cli {

namespace {

using nlohmann::ordered_json;

/// One place that is asked for.
struct Query {
  GeoPoint at;
  double lat_deg{}, lon_deg{};
  double time_s{};
  std::optional<double> depth_m;
};

constexpr double kTop = -100;  // metres: above the shallowest level, which then answers

/// The field that a query is answered from, and the whole one for telling land from missing data.
struct Source {
  ocean::GriddedField field, full;
  std::vector<double> times_s;
  double least_depth_m{kTop};  ///< the water must reach deeper than this for the mean to exist

  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double t_s) const {
    const auto sample = field.sample(p, z, t_s);
    // A mean borrowed from a neighbouring column would pass for one of this column, whose water ends above it.
    if (sample && !full.sample(p, Depth{Metres{least_depth_m}}, t_s)) return unexpected(ocean::NoCurrent::no_data);
    return sample;
  }
  [[nodiscard]] ocean::Coverage coverage() const { return field.coverage(); }
  [[nodiscard]] MetresPerSecond fastest() const { return field.fastest(); }
};

Depth depth_of(const Query& query) { return Depth{Metres{query.depth_m.value_or(kTop)}}; }

ordered_json answer(const Source& source, const Query& query) {
  const auto sample = source.sample(query.at, depth_of(query), query.time_s);
  if (sample)
    return {{"east_m_per_s", sample->current.east.si()},
            {"north_m_per_s", sample->current.north.si()},
            {"extrapolated", sample->extrapolated}};
  auto reason = sample.error();
  std::string message;
  switch (reason) {
    case ocean::NoCurrent::outside_area:
      message = "outside the area of the files";
      break;
    case ocean::NoCurrent::outside_time:
      message = "outside the times of the files, " + time_text(source.times_s.front()) + " to " +
                time_text(source.times_s.back());
      break;
    case ocean::NoCurrent::below_bottom:
      message = "below the deepest level with water here";
      break;
    case ocean::NoCurrent::no_data:
    case ocean::NoCurrent::land: {
      // The shallowest level decides whether there is water at all.
      const Depth top{Metres{kTop}};
      if (source.full.sample(query.at, top, query.time_s)) {
        reason = ocean::NoCurrent::below_bottom;
        message = "the water here ends above the depths asked for";
        break;
      }
      const bool ever = std::any_of(source.times_s.begin(), source.times_s.end(),
                                    [&](double t) { return source.full.sample(query.at, top, t).has_value(); });
      reason = ever ? ocean::NoCurrent::no_data : ocean::NoCurrent::land;
      message = ever ? "no value here at this time" : "no value here at any time: land by the model's mask";
      break;
    }
  }
  return {{"none", word(reason)}, {"message", message}};
}

/// Mean and spread of the members; null where most of them have no current.
ordered_json answer(const ocean::Family& family, const Query& query) {
  const auto sample = family.sample(query.at, depth_of(query), query.time_s);
  if (!sample) return nullptr;
  ordered_json json{{"members", sample->members},
                    {"mean_east_m_per_s", sample->mean.east.si()},
                    {"mean_north_m_per_s", sample->mean.north.si()},
                    {"extrapolated", sample->extrapolated}};
  const auto put = [&](const char* key, std::optional<MetresPerSecond> v) {
    json[key] = v ? ordered_json(v->si()) : ordered_json(nullptr);
  };
  const auto& spread = sample->spread;
  put("spread_east_m_per_s", spread ? std::optional{spread->east} : std::nullopt);
  put("spread_north_m_per_s", spread ? std::optional{spread->north} : std::nullopt);
  put("spread_m_per_s", spread ? std::optional{spread->vector()} : std::nullopt);
  return json;
}

/// Splits a line at commas; blanks around a cell do not count.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t at = 0;;) {
    const auto end = line.find(',', at);
    cells.emplace_back(trimmed(line.substr(at, end == std::string::npos ? end : end - at)));
    if (end == std::string::npos) return cells;
    at = end + 1;
  }
}

Expected<Query, std::string> query_of(const std::vector<std::string>& cells) {
  if (cells.size() != 3 && cells.size() != 4)
    return unexpected(std::to_string(cells.size()) + " columns, allowed is lat,lon,time or lat,lon,time,depth");
  const auto lat = number_from(cells[0]), lon = number_from(cells[1]);
  if (!lat || !lon) return unexpected("\"" + (lat ? cells[1] : cells[0]) + "\" is no number of degrees");
  const auto at = GeoPoint::from_degrees(*lat, *lon);
  if (!at) return unexpected(at.error().message());
  const auto time = utc_from_text(cells[2]);
  if (!time) return unexpected("\"" + cells[2] + "\" is no time, allowed is like 2024-10-28T03:00:00Z");
  Query query{*at, *lat, *lon, epoch_seconds(*time), std::nullopt};
  if (cells.size() == 4 && !cells[3].empty()) {
    query.depth_m = number_from(cells[3]);
    if (!query.depth_m) return unexpected("\"" + cells[3] + "\" is no depth in metres");
  }
  return query;
}

Expected<std::vector<Query>, std::string> queries_of(const std::string& path, world::Files& files) {
  const auto text = files.read(path, std::size_t{64} << 20);
  if (!text) return unexpected(text.error().message());
  std::vector<Query> queries;
  int number = 0;
  for (std::size_t at = 0; at < text->size();) {
    auto end = text->find('\n', at);
    if (end == std::string::npos) end = text->size();
    const std::string line{trimmed(text->substr(at, end - at))};
    at = end + 1;
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const auto cells = cells_of(line);
    if (queries.empty() && lower(cells.front()).compare(0, 3, "lat") == 0) continue;
    auto query = query_of(cells);
    if (!query) return unexpected(path + ":" + std::to_string(number) + ": " + query.error());
    queries.push_back(*query);
  }
  if (queries.empty()) return unexpected(path + ": no point in it");
  return queries;
}

Source source_of(const FieldSampleOptions& options, const ocean::GridView& view) {
  const ocean::GriddedOptions gridded{ocean::OutsideTime::forbid, options.interpolation, 1.5, false};
  ocean::GriddedField full{view, gridded};
  if (!options.depth_mean || view.axes.depths_m.size() == 1) return {full, full, view.axes.times_s};
  const auto profile =
      ocean::DiveProfile::between(Metres{options.depth_mean->first}, Metres{options.depth_mean->second});
  return {ocean::GriddedField{ocean::depth_average(view, profile), gridded}, full, view.axes.times_s,
          options.depth_mean->first};
}

void print_answer(const ordered_json& json, std::ostream& out) {
  if (json.contains("none"))
    out << json["none"].get<std::string>() << ": " << json["message"].get<std::string>() << '\n';
  else
    out << "east " << decimal(json["east_m_per_s"].get<double>(), 4) << " m/s, north "
        << decimal(json["north_m_per_s"].get<double>(), 4) << " m/s"
        << (json["extrapolated"].get<bool>() ? ", extrapolated from the nearest water" : "") << '\n';
  const auto ensemble = json.find("ensemble");
  if (ensemble == json.end()) return;
  if (ensemble->is_null()) {
    out << "  most members have no current there\n";
    return;
  }
  out << "  mean of " << ensemble->at("members").get<std::size_t>() << " members: east "
      << decimal(ensemble->at("mean_east_m_per_s").get<double>(), 4) << " m/s, north "
      << decimal(ensemble->at("mean_north_m_per_s").get<double>(), 4) << " m/s";
  if (!ensemble->at("spread_m_per_s").is_null())
    out << "; spread " << decimal(ensemble->at("spread_m_per_s").get<double>(), 4) << " m/s (east "
        << decimal(ensemble->at("spread_east_m_per_s").get<double>(), 4) << ", north "
        << decimal(ensemble->at("spread_north_m_per_s").get<double>(), 4) << ")";
  out << '\n';
}

/// What is wrong with the options alone; empty when nothing is.
std::string misuse_of(const FieldSampleOptions& options) {
  if (options.files.empty()) return "no file was named";
  if (options.points.empty() && (!options.lat_deg || !options.lon_deg))
    return "--lat and --lon, or --points, are needed";
  if (!options.points.empty() && (options.lat_deg || options.lon_deg || options.time))
    return "--points brings its own places and times; leave out --lat, --lon and --time";
  if (options.members > 0 && options.ingest.member) return "--member and --members exclude each other";
  if (options.depth_m && options.depth_mean) return "--depth and --depth-mean exclude each other";
  if (options.depth_m && !(*options.depth_m >= 0)) return "--depth is positive down, allowed is 0 or more";
  if (options.depth_mean && !(options.depth_mean->first >= 0 && options.depth_mean->second > options.depth_mean->first))
    return "--depth-mean MIN,MAX: allowed is 0 ≤ MIN < MAX";
  return {};
}

/// The members of the files that are asked for, at least the control, each a field of its own, and what keeps their grids.
struct LoadedFamily {
  std::vector<std::unique_ptr<daemon::LoadedGrid>> grids;
  std::vector<Source> sources;
  [[nodiscard]] ocean::Family family() const { return ocean::Family{{sources.begin(), sources.end()}}; }
};

Expected<LoadedFamily, std::string> family_of(const FieldSampleOptions& options,
                                              std::unique_ptr<daemon::LoadedGrid> control, world::World& world) {
  LoadedFamily loaded;
  const auto take = [&](std::unique_ptr<daemon::LoadedGrid> grid) {
    loaded.sources.push_back(source_of(options, grid->view));
    loaded.grids.push_back(std::move(grid));
  };
  take(std::move(control));
  for (std::uint32_t member = 1; member < static_cast<std::uint32_t>(options.members); ++member) {
    auto ingest = options.ingest;
    ingest.member = member;
    auto grid = daemon::ingest_files(options.files, ingest, world);
    if (!grid) return unexpected("member " + std::to_string(member) + ": " + grid.error());
    take(std::move(grid).value());
  }
  return loaded;
}

}  // namespace

int run_field_sample(const FieldSampleOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  if (const auto misuse = misuse_of(options); !misuse.empty()) return refuse_field(err, 2, misuse);
  std::vector<Query> queries;
  if (!options.points.empty()) {
    auto read = queries_of(options.points, world.files);
    if (!read) return refuse_field(err, 2, read.error());
    queries = std::move(*read);
  } else {
    const auto at = GeoPoint::from_degrees(*options.lat_deg, *options.lon_deg);
    if (!at) return refuse_field(err, 2, at.error().message());
    queries.push_back({*at, *options.lat_deg, *options.lon_deg, 0, options.depth_m});
  }
  auto loaded = daemon::ingest_files(options.files, options.ingest, world);
  if (!loaded) return refuse_field(err, 1, loaded.error());
  const auto& view = (*loaded)->view;
  for (const auto& warning : view.facts.warnings) err << "glidehelm field: warning: " << warning << '\n';
  if (options.points.empty()) {
    if (!options.time && view.axes.times_s.size() > 1)
      return refuse_field(err, 2,
                          "--time is needed: the files have " + std::to_string(view.axes.times_s.size()) + " times, " +
                              time_text(view.axes.times_s.front()) + " to " + time_text(view.axes.times_s.back()));
    queries.front().time_s = options.time ? epoch_seconds(*options.time) : view.axes.times_s.front();
  } else if (options.depth_m) {
    for (auto& query : queries)
      if (!query.depth_m) query.depth_m = options.depth_m;
  }

  const auto members = family_of(options, std::move(loaded).value(), world);
  if (!members) return refuse_field(err, 1, members.error());
  const auto& source = members->sources.front();
  const auto family = members->family();
  bool all = true;
  ordered_json samples = ordered_json::array();
  for (const auto& query : queries) {
    auto result = answer(source, query);
    if (options.members > 0) result["ensemble"] = answer(family, query);
    all = all && !result.contains("none");
    if (!options.json) {
      if (!options.points.empty())
        out << decimal(query.lat_deg, 5) << " " << decimal(query.lon_deg, 5) << " " << time_text(query.time_s) << "  ";
      print_answer(result, out);
      continue;
    }
    ordered_json entry{{"lat_deg", query.lat_deg}, {"lon_deg", query.lon_deg}, {"time", time_text(query.time_s)}};
    if (query.depth_m) entry["depth_m"] = *query.depth_m;
    entry.update(result);
    samples.push_back(options.points.empty() ? result : entry);
  }
  if (options.json) {
    const ordered_json document = options.points.empty() ? samples.front()
                                                         : ordered_json{{"schema", "glidehelm/field-samples/v1"},
                                                                        {"samples", std::move(samples)}};
    out << document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  }
  return all ? 0 : 1;
}

}  // namespace glidehelm::cli
