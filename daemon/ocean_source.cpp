#include "daemon/ocean_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/utc.hpp"
#include "core/chart/coast.hpp"
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

OceanResult assemble(const OceanOrder& order, std::unique_ptr<LoadedGrid> grid, world::Files& files) {
  const auto box = box_of(order);
  auto formulas = formulas_of(order, box);
  if (!formulas) return unexpected(formulas.error());
  const auto& m = order.mission;
  ocean::GriddedOptions options{m.currents.outside_time, m.currents.interpolation, m.currents.coastal_fill_cells,
                                !order.has_coast};
  std::optional<verify::InputFile> input;
  std::vector<std::string> sources;
  std::shared_ptr<const void> grid_file;
  std::optional<Sha256> key;
  std::vector<LeftOut> left_out;
  bool try_again = false;
  std::vector<std::string> notes;
  auto forecast = [&]() -> Expected<ocean::Forecast, ocean::ForecastError> {
    if (!grid) return ocean::Forecast::prepare(*formulas);
    sources = grid->files;
    const auto bytes = grid->mapping->bytes();
    const auto identity =
        verify::grid_identity({reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), verify::kGridHead)});
    if (identity && !grid->path.empty()) input = verify::InputFile{grid->path, *identity};
    if (grid->hold)
      grid_file = grid->hold;
    else if (!grid->path.empty())
      grid_file = remover(grid->path, files);
    key = grid->key;
    left_out = grid->left_out;
    try_again = grid->try_again;
    notes = grid->notes;
    const auto profile =
        ocean::DiveProfile::of_stint(m.climb_to, m.dive_depth, m.horizontal_speed, m.glide_angle, m.stint);
    const std::shared_ptr<LoadedGrid> owner{std::move(grid)};
    return ocean::Forecast::prepare(owner->view, profile, options, owner, *formulas);
  }();
  if (!forecast) return unexpected(forecast.error().message());
  return std::make_shared<const OceanSource>(OceanSource{std::move(forecast).value(), input, options,
                                                         m.currents.analytic, order.start, box, sources, grid_file, key,
                                                         left_out, try_again, notes});
}

}  // namespace

std::string OceanSource::label() const {
  const auto& facts = forecast.facts();
  std::string text = facts.name;
  if (std::isfinite(facts.reference_s)) text += " " + utc_text(instant_at(facts.reference_s));
  return text + " (sha256 " + facts.provenance.hex().substr(0, 12) + ")";
}

OceanResult load_ocean(const OceanOrder& order, world::World& world) {
  if (order.mission.currents.files.empty()) return assemble(order, nullptr, world.files);
  auto grid = ingest_files(order.mission.currents.files, ingest_options(order), world);
  if (!grid) return unexpected(grid.error());
  return assemble(order, std::move(grid).value(), world.files);
}

namespace {

/// Numbers that are no field to plan on stay so until the files change.
OceanOutcome outcome(OceanResult assembled) {
  if (!assembled) return unexpected(IngestFault{assembled.error(), false});
  return std::move(*assembled);
}

/// Which files, and how they are read.
std::string name_of(const OceanOrder& order) {
  std::string name = recipe_of(ingest_options(order));
  for (const auto& pattern : order.mission.currents.files) name += "\n" + pattern;
  return name;
}

}  // namespace

void load_ocean_async(const OceanOrder& order, world::World& world, std::function<void(OceanOutcome)> then) {
  if (order.mission.currents.files.empty()) {
    world.net.post(
        [order, then = std::move(then), &files = world.files] { then(outcome(assemble(order, nullptr, files))); });
    return;
  }
  ingest_files_async(order.mission.currents.files, ingest_options(order), world,
                     [order, then = std::move(then), &files = world.files](IngestOutcome grid) {
                       if (!grid)
                         then(unexpected(grid.error()));
                       else
                         then(outcome(assemble(order, std::move(grid).value(), files)));
                     });
}

std::shared_ptr<const OceanSource> last_accepted(const OceanOrder& order, world::World& world) {
  if (!order.cache || order.mission.currents.files.empty()) return nullptr;
  const auto key = order.cache->accepted(name_of(order));
  std::string damage;
  auto mapped = key ? order.cache->take(*key, damage) : nullptr;
  if (!mapped) return nullptr;
  std::vector<std::string> files;
  for (const auto& source : mapped->view.facts.sources) files.push_back(source.name);
  auto grid = std::make_unique<LoadedGrid>(LoadedGrid{std::move(mapped->mapping),
                                                      std::move(mapped->view),
                                                      std::move(mapped->path),
                                                      std::move(files),
                                                      std::move(mapped->hold),
                                                      key,
                                                      {},
                                                      false,
                                                      {}});
  auto ocean = assemble(order, std::move(grid), world.files);
  return ocean ? *ocean : nullptr;
}

void accept_ocean(const OceanOrder& order, const OceanSource& ocean) {
  if (!order.cache || !ocean.key) return;
  order.cache->accept(name_of(order), *ocean.key);
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
  source->chart = chart::Chart{std::move(parts)};
  return std::shared_ptr<const ChartSource>{std::move(source)};
}

}  // namespace glidehelm::daemon
