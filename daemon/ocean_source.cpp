#include "daemon/ocean_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/utc.hpp"
#include "core/chart/bathymetry.hpp"
#include "core/chart/coast.hpp"
#include "core/mission/in_water.hpp"
#include "core/ocean/freshness.hpp"
#include "daemon/ingest_client.hpp"

namespace glidehelm::daemon {

namespace {

constexpr double kBoxAround = 300'000.0;  // metres around the goal when no start is named

/// The box of analytic fields: start and goal with room around them.
ocean::Coverage box_of(const OceanOrder& order) {
  const auto goal = order.mission.goal, from = order.from.value_or(goal);
  const double apart = distance(from, goal).si();
  const double around = order.from ? std::max(60'000.0, 0.6 * apart) : kBoxAround;
  const double dlat = around / 6'335'000.0;
  const double lat0 = std::min(from.lat.radians(), goal.lat.radians()) - dlat,
               lat1 = std::max(from.lat.radians(), goal.lat.radians()) + dlat;
  const double dlon = dlat / std::max(0.05, std::cos(std::max(std::abs(lat0), std::abs(lat1))));
  const double to = from.lon.radians() + std::remainder(goal.lon.radians() - from.lon.radians(), 2 * kPi);
  ocean::Coverage box;
  box.south = std::max(lat0, -kPi / 2);
  box.north = std::min(lat1, kPi / 2);
  box.west = std::min(from.lon.radians(), to) - dlon;
  box.east = std::max(from.lon.radians(), to) + dlon;
  return box;
}

/// Each member has files of its own.
bool in_own_files(const mission::Currents& currents) { return currents.ensemble && !currents.ensemble->files.empty(); }

/// As the child reads it.
std::string s_levels_text(const mission::Currents::SLevels& levels) {
  return fmt::format("vtransform={},vstretching={},theta_s={:.9g},theta_b={:.9g},hc={:.9g}", levels.vtransform,
                     levels.vstretching, levels.theta_s, levels.theta_b, levels.critical_depth.si());
}

IngestOptions ingest_options(const OceanOrder& order) {
  IngestOptions options;
  options.east = order.mission.currents.east_variable;
  options.north = order.mission.currents.north_variable;
  options.time_epoch = order.mission.currents.time_epoch;
  using Heights = mission::Currents::Heights;
  const auto& currents = order.mission.currents;
  if (currents.heights != Heights::when_needed)
    options.heights = currents.heights == Heights::always ? "always" : "never";
  if (currents.equator_band != mission::Currents{}.equator_band)
    options.equator_band_deg = currents.equator_band.si() * 180 / kPi;
  if (currents.fill_gaps) options.fill_gaps_km = currents.fill_gaps->si() / 1000;
  options.grid_file = currents.grid_file;
  using Rotation = mission::Currents::Rotation;
  options.rotation = currents.rotation == Rotation::angle  ? "angle"
                     : currents.rotation == Rotation::grid ? "grid"
                     : currents.rotation == Rotation::none ? "none"
                                                           : "";
  if (currents.s_levels) options.s_levels = s_levels_text(*currents.s_levels);
  if (!in_own_files(currents)) options.member = order.member;
  options.keep_in = order.grids;
  options.cache = order.cache;
  options.settle = order.settle;
  return options;
}

Expected<std::vector<ocean::AnalyticField>, std::string> formulas_of(const OceanOrder& order,
                                                                     const ocean::Coverage& box) {
  std::vector<ocean::AnalyticField> fields;
  for (const auto& spec : order.mission.currents.analytic) {
    auto field = ocean::AnalyticField::make(spec, order.start, box);
    if (!field) return unexpected("currents.analytic " + spec.kind + ": " + field.error().message());
    fields.push_back(std::move(field).value());
  }
  return fields;
}

/// What a removed name is to the last user of a grid that no cache keeps.
std::shared_ptr<const void> remover(const std::string& path, world::Files& files) {
  return std::shared_ptr<const void>{nullptr, [path, &files](const void*) {
                                       const auto slash = path.find_last_of('/');
                                       if (auto folder = files.open_folder(path.substr(0, slash)))
                                         static_cast<void>((*folder)->unlink(path.substr(slash + 1)));
                                     }};
}

/// One set of files that was read, and what it counts for.
struct Read {
  mission::CurrentSource source;  ///< without a name: the only one
  std::shared_ptr<LoadedGrid> grid;
};

/// The order of one source alone.
OceanOrder order_of(const OceanOrder& order, const mission::CurrentSource& source) {
  OceanOrder one = order;
  static_cast<mission::CurrentFiles&>(one.mission.currents) = source;
  return one;
}

ocean::ForecastSource forecast_source(const Read& read, bool has_coast) {
  const auto& source = read.source;
  const auto& view = read.grid->view;
  ocean::ForecastSource result{source.name,
                               view,
                               {source.outside_time, source.interpolation, source.coastal_fill_cells, !has_coast},
                               read.grid,
                               ocean::SourceRegion{source.region}};
  const double reference = std::isnan(view.facts.reference_s) ? view.axes.times_s.front() : view.facts.reference_s;
  if (source.from) result.from_s = reference + source.from->count();
  if (source.to) result.to_s = reference + source.to->count();
  return result;
}

std::optional<verify::InputFile> input_file(const LoadedGrid& grid) {
  const auto bytes = grid.mapping->bytes();
  const auto identity =
      verify::grid_identity({reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), verify::kGridHead)});
  if (!identity || grid.path.empty()) return std::nullopt;
  return verify::InputFile{grid.path, *identity};
}

/// Sources that have expired are left out while another one remains.
std::vector<std::string> leave_out_expired(const OceanOrder& order, std::vector<Read>& reads) {
  std::vector<std::string> notes;
  if (!order.now_s) return notes;
  const auto age = [&](const Read& read) {
    const auto issued = ocean::issued_s(read.grid->view.axes, read.grid->view.facts, read.source.outside_time);
    return issued ? *order.now_s - *issued : 0;
  };
  const auto fresh = [&](const Read& read) { return age(read) <= ocean::kExpiredAfter; };
  if (std::none_of(reads.begin(), reads.end(), fresh)) return notes;
  for (const auto& read : reads)
    if (!fresh(read))
      notes.push_back(fmt::format("source '{}' is left out: it is {:.1f} h old, allowed are {:.0f} h", read.source.name,
                                  age(read) / 3600, ocean::kExpiredAfter / 3600));
  std::erase_if(reads, [&](const Read& read) { return !fresh(read); });
  return notes;
}

using Bottom = std::shared_ptr<const chart::Bathymetry>;

/// The bathymetry of a mission; null when it has none.
Expected<Bottom, std::string> load_bathymetry(const mission::Mission& m, world::Files& files,
                                              std::optional<verify::InputFile>& input) {
  if (m.bathymetry_file.empty()) return Bottom{};
  const auto bytes = files.read(m.bathymetry_file, chart::Bathymetry::kLargestFile);
  if (!bytes) return unexpected("safety.bathymetry: " + bytes.error().message());
  auto bottom = chart::Bathymetry::parse(*bytes);
  if (!bottom) return unexpected("safety.bathymetry " + m.bathymetry_file + ": " + bottom.error());
  input = verify::InputFile{m.bathymetry_file, Sha256::of(std::string_view{*bytes})};
  return std::move(bottom).value();
}

/// Where a glider turns by its altimeter, `margin` above the bottom.
ocean::TurningDepth turning_depth(const Bottom& bottom, Metres margin) {
  if (!bottom) return {};
  return [bottom, margin](double lat, double lon) { return bottom->depth(lat, lon) - margin.si(); };
}

OceanResult assemble(const OceanOrder& order, std::vector<Read> reads, world::Files& files) {
  const auto box = box_of(order);
  auto formulas = formulas_of(order, box);
  if (!formulas) return unexpected(formulas.error());
  const auto& m = order.mission;
  std::optional<verify::InputFile> ignored;
  const auto bottom = load_bathymetry(m, files, ignored);
  if (!bottom) return unexpected(bottom.error());
  const bool composite = !m.currents.sources.empty();
  auto notes = leave_out_expired(order, reads);
  std::vector<ocean::ForecastSource> sources;
  for (const auto& read : reads) sources.push_back(forecast_source(read, order.has_coast));
  const ocean::Seams seams{m.currents.blend, m.currents.join};
  const auto v = mission::in_water(m, ocean::water_of(sources).layers).mission;
  const auto profile =
      ocean::DiveProfile::of_stint(v.climb_to, v.dive_depth, v.horizontal_speed, v.glide_angle, v.stint);
  auto forecast = sources.empty() ? ocean::Forecast::prepare(*formulas)
                                  : ocean::Forecast::prepare(sources, seams, profile, *formulas,
                                                             turning_depth(*bottom, m.depth_margin));
  if (!forecast) return unexpected(forecast.error().message());

  OceanSource ocean{std::move(forecast).value(), {}, {}, m.currents.analytic, order.start, box, {}, {}};
  ocean.options = {m.currents.outside_time, m.currents.interpolation, m.currents.coastal_fill_cells, !order.has_coast};
  ocean.notes = std::move(notes);
  ocean.seams = seams;
  auto holds = std::make_shared<std::vector<std::shared_ptr<const void>>>();
  for (std::size_t k = 0; k < reads.size(); ++k) {
    const auto& grid = *reads[k].grid;
    const auto& source = sources[k];
    const auto input = input_file(grid);
    if (!composite) {
      ocean.grid = input;
      ocean.key = grid.key;
    } else if (input) {
      ocean.sources.push_back(
          {source.name, *input, source.options, reads[k].source.region, source.from_s, source.to_s});
    }
    if (composite)
      ocean.origins.push_back(
          {source.name, grid.key, ocean::issued_s(grid.view.axes, grid.view.facts, source.options.outside_time)});
    ocean.files.insert(ocean.files.end(), grid.files.begin(), grid.files.end());
    ocean.left_out.insert(ocean.left_out.end(), grid.left_out.begin(), grid.left_out.end());
    ocean.notes.insert(ocean.notes.end(), grid.notes.begin(), grid.notes.end());
    ocean.try_again = ocean.try_again || grid.try_again;
    holds->push_back(grid.hold ? grid.hold : grid.path.empty() ? nullptr : remover(grid.path, files));
  }
  ocean.grid_file = std::move(holds);
  if (composite) {
    std::string keys;
    for (const auto& origin : ocean.origins) keys += origin.key ? origin.name + " " + origin.key->hex() + "\n" : "";
    if (!keys.empty()) ocean.key = Sha256::of(keys);
  }
  return std::make_shared<const OceanSource>(std::move(ocean));
}

/// Which files, and how they are read.
std::string name_of(const OceanOrder& order) {
  std::string name = recipe_of(ingest_options(order));
  for (const auto& pattern : order.mission.currents.files) name += "\n" + pattern;
  return name;
}

/// The grid that was accepted last for one set of files, whatever the files are now.
std::shared_ptr<LoadedGrid> accepted_grid(const OceanOrder& order) {
  if (!order.cache) return nullptr;
  const auto key = order.cache->accepted(name_of(order));
  std::string damage;
  auto mapped = key ? order.cache->take(*key, damage) : nullptr;
  if (!mapped) return nullptr;
  auto grid = std::make_shared<LoadedGrid>();
  for (const auto& source : mapped->view.facts.sources) grid->files.push_back(source.name);
  grid->mapping = std::move(mapped->mapping);
  grid->view = std::move(mapped->view);
  grid->path = std::move(mapped->path);
  grid->hold = std::move(mapped->hold);
  grid->key = key;
  return grid;
}

/// Every set of files of an order; one without a name where it has no `sources`.
std::vector<mission::CurrentSource> sets_of(const OceanOrder& order) {
  if (!order.mission.currents.sources.empty()) return order.mission.currents.sources;
  if (order.mission.currents.files.empty()) return {};
  mission::CurrentSource only{order.mission.currents, {}, {}, {}, {}};
  if (order.member && in_own_files(order.mission.currents))
    only.files = order.mission.currents.ensemble->files_of(static_cast<int>(*order.member));
  return {only};
}

/// Numbers that are no field to plan on stay so until the files change.
OceanOutcome outcome(OceanResult assembled) {
  if (!assembled) return unexpected(IngestFault{assembled.error(), false});
  return std::move(*assembled);
}

/// Sources that are read one after the other; what one of them lacks the others make up for.
struct Gathering {
  OceanOrder order;
  std::vector<mission::CurrentSource> sets;
  std::vector<Read> reads{};
  std::optional<IngestFault> fault{};  ///< of the first set that was not read
  std::vector<LeftOut> left_out{};

  void take(const mission::CurrentSource& set, IngestOutcome grid) {
    if (grid) {
      reads.push_back({set, std::move(grid).value()});
      return;
    }
    auto why = grid.error();
    if (!set.name.empty()) why.what = "source '" + set.name + "': " + why.what;
    fault = fault ? IngestFault{fault->what, fault->passing || why.passing} : why;
    if (set.name.empty()) return;
    left_out.push_back({set.name, why.what});
    if (auto last = accepted_grid(order_of(order, set))) reads.push_back({set, std::move(last)});
  }
  [[nodiscard]] OceanOutcome finish(world::Files& files) {
    if (reads.empty() && fault) return unexpected(*fault);
    if (!reads.empty() && !left_out.empty()) {
      auto& grid = *reads.front().grid;
      grid.left_out.insert(grid.left_out.end(), left_out.begin(), left_out.end());
      grid.try_again = grid.try_again || fault->passing;
    }
    return outcome(assemble(order, std::move(reads), files));
  }
};

void gather(const std::shared_ptr<Gathering>& all, std::size_t next, const world::World& world,
            std::function<void(OceanOutcome)> then) {
  if (next == all->sets.size()) return then(all->finish(world.files));
  const auto order = order_of(all->order, all->sets[next]);
  ingest_files_async(order.mission.currents.files, ingest_options(order), world,
                     [all, next, world, then = std::move(then)](IngestOutcome grid) {
                       all->take(all->sets[next], std::move(grid));
                       gather(all, next + 1, world, then);
                     });
}

}  // namespace

std::string OceanSource::label() const {
  const auto& facts = forecast.facts();
  std::string text = facts.name;
  if (std::isfinite(facts.reference_s)) text += " " + utc_text(instant_at(facts.reference_s));
  return text + " (sha256 " + facts.provenance.hex().substr(0, 12) + ")";
}

void put_ocean(const OceanSource& ocean, verify::VerifyRequest& request) {
  request.grid = ocean.grid;
  request.grid_options = ocean.options;
  request.sources = ocean.sources;
  request.seams = ocean.seams;
  request.analytic = ocean.analytic;
  request.analytic_start = ocean.analytic_start;
  request.analytic_box = ocean.analytic_box;
}

OceanResult load_ocean(const OceanOrder& order, world::World& world) {
  Gathering all{order, sets_of(order)};
  for (const auto& set : all.sets) {
    const auto one = order_of(order, set);
    auto grid = ingest_files(one.mission.currents.files, ingest_options(one), world);
    if (!grid) return unexpected(set.name.empty() ? grid.error() : "source '" + set.name + "': " + grid.error());
    all.take(set, std::move(grid).value());
  }
  auto ocean = all.finish(world.files);
  if (!ocean) return unexpected(ocean.error().what);
  return std::move(ocean).value();
}

void load_ocean_async(const OceanOrder& order, world::World& world, std::function<void(OceanOutcome)> then) {
  const auto all = std::make_shared<Gathering>(Gathering{order, sets_of(order)});
  if (all->sets.empty())  // told from the loop, as an answer that was read would be
    return world.net.post([all, then = std::move(then), &files = world.files] { then(all->finish(files)); });
  gather(all, 0, world, std::move(then));
}

std::shared_ptr<const OceanSource> last_accepted(const OceanOrder& order, world::World& world) {
  Gathering all{order, sets_of(order)};
  for (const auto& set : all.sets)
    if (auto grid = accepted_grid(order_of(order, set))) all.reads.push_back({set, std::move(grid)});
  if (all.reads.empty()) return nullptr;
  auto ocean = all.finish(world.files);
  return ocean ? *ocean : nullptr;
}

void accept_ocean(const OceanOrder& order, const OceanSource& ocean) {
  if (!order.cache || !ocean.key) return;
  if (ocean.origins.empty()) order.cache->accept(name_of(order), *ocean.key);
  for (const auto& source : order.mission.currents.sources)
    for (const auto& origin : ocean.origins)
      if (origin.name == source.name && origin.key) order.cache->accept(name_of(order_of(order, source)), *origin.key);
  static_cast<void>(order.cache->save());  // without it a restart reads the files again
}

std::optional<Current> mean_along(const OceanSource& ocean, const mission::Dive& dive, GeoPoint to, double until_s) {
  constexpr int kSamples = 24;
  const double seconds = until_s - dive.from_s;
  if (!(seconds > 600 && seconds < 4 * 86400.0)) return std::nullopt;
  const auto field = ocean.forecast.ocean().dive;
  const double lat = dive.from.lat.radians(), lon = dive.from.lon.radians();
  const double dlat = to.lat.radians() - lat, dlon = std::remainder(to.lon.radians() - lon, 2 * kPi);
  double east = 0, north = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double share = (i + 0.5) / kSamples;
    const auto sample =
        field.sample(GeoPoint::from_kernel(lat + share * dlat, lon + share * dlon), dive.from_s + share * seconds);
    if (!sample) return std::nullopt;
    east += sample->current.east.si() / kSamples;
    north += sample->current.north.si() / kSamples;
  }
  return Current{MetresPerSecond{east}, MetresPerSecond{north}};
}

Expected<std::shared_ptr<const ChartSource>, std::string> load_chart(const mission::Mission& mission,
                                                                     world::Files& files) {
  auto source = std::make_shared<ChartSource>();
  source->keep_in = mission.keep_in;
  source->keep_out = mission.keep_out;
  chart::ChartSources parts;
  parts.keep_in = mission.keep_in;
  parts.keep_out = mission.keep_out;
  if (!mission.coast_file.empty()) {
    const auto bytes = files.read(mission.coast_file, chart::Coast::kLargestFile);
    if (!bytes) return unexpected("safety.coast: " + bytes.error().message());
    auto coast = chart::Coast::parse(*bytes);
    if (!coast) return unexpected("safety.coast " + mission.coast_file + ": " + coast.error().message());
    parts.coast = std::move(coast).value();
    source->coast = verify::InputFile{mission.coast_file, Sha256::of(std::string_view{*bytes})};
  }
  auto bottom = load_bathymetry(mission, files, source->bathymetry);
  if (!bottom) return unexpected(bottom.error());
  parts.bathymetry = std::move(bottom).value();
  parts.least_depth = source->least_depth = mission.least_depth();
  source->chart = chart::Chart{std::move(parts)};
  return std::shared_ptr<const ChartSource>{std::move(source)};
}

}  // namespace glidehelm::daemon
