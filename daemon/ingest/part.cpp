#include "daemon/ingest/part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "daemon/ingest/box.hpp"
#include "daemon/ingest/component.hpp"
#include "daemon/ingest/ensemble.hpp"
#include "daemon/ingest/gap_fill.hpp"
#include "daemon/ingest/geostrophic.hpp"
#include "daemon/ingest/model_part.hpp"
#include "daemon/ingest/plausible.hpp"
#include "daemon/ingest/quality.hpp"
#include "daemon/ingest/water.hpp"
#include "daemon/ingest/whole_file.hpp"

namespace glidehelm::ingest {

namespace {

/// The forecast's reference time: a variable with that standard_name, else the global attribute `forecast_reference_time`
/// or `bulletin_date`; NaN when the file names none that can be read.
double reference_time(const NetcdfFile& file, const Units& units) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (const auto& variable : file.variables()) {
    if (variable.text("standard_name") != "forecast_reference_time" || !is_number(variable.type)) continue;
    std::vector<std::string> ignored;
    const auto values = times(file, variable, units, std::nullopt, ignored);
    return values ? values->values.back() : kNone;
  }
  for (const char* name : {"forecast_reference_time", "bulletin_date"})
    if (const auto time = utc_from_text(file.text(name))) return epoch_seconds(*time);
  return kNone;
}

/// What reading one file needs all the way.
struct Reading {
  const NetcdfFile& file;
  const Units& units;
  const ReadOptions& options;
  Part& part;
  const std::vector<GridFile>& grids;
  std::vector<std::string> outside{};  ///< "uo 12 (-5 to 5)": values beyond the valid range
  std::vector<std::string> empty{};    ///< variables without a value, and what stands there instead

  std::vector<std::string>& warnings() const { return part.grid.facts.warnings; }
};

/// Makes the part's grid as large as the box on these axes.
Result<Box> prepare(const Reading& reading, const Axes& axes) {
  auto box = read_box(reading.file, axes, reading.units, reading.options, reading.warnings());
  if (!box) return box;
  reading.part.grid.axes = box->axes();
  reading.part.grid.values.assign(2 * reading.part.grid.axes.nodes(), std::numeric_limits<float>::quiet_NaN());
  return box;
}

/// What stands everywhere in a variable without values, and what that means to the one who wanted them.
std::string instead_of_values(const Told& told) {
  const auto has = [&](Missing::Mark mark) { return told.marks[static_cast<std::size_t>(mark)]; };
  if (has(Missing::Mark::missing_value))
    return "marked as missing everywhere: to its producer all of this area is land; is it the right area?";
  if (has(Missing::Mark::fill_value))
    return "the fill value everywhere: the file was made and its values were never written, or are still to come";
  return "NaN everywhere: the model, or what was done with its output, computed nothing; ask its producer";
}

/// Reads one variable into the part's east (0) or north (1).
Result<Done> read_into(Reading& reading, const Variable& variable, const std::string& unit, const Axes& axes,
                       const Box& box, std::size_t side) {
  const auto component = Component::of(variable, reading.units, unit, reading.warnings());
  if (!component) return unexpected(component.error());
  const auto told =
      read_values(reading.file, variable, axes, box, *component, reading.part.grid.values.data() + side, 2);
  if (!told) return unexpected(told.error());
  if (told->nothing) reading.empty.push_back(variable.name + " is " + instead_of_values(*told));
  if (told->outside_valid == 0) return Done{};
  const std::string text = std::to_string(told->outside_valid) + " values of " + variable.name +
                           " lie outside its valid range " + component->valid_text();
  reading.warnings().push_back(text + " and are kept");
  reading.outside.push_back(text);
  return Done{};
}

void tell_cycle(Reading& reading, const std::string& name) {
  auto& facts = reading.part.grid.facts;
  facts.reference_s = reference_time(reading.file, reading.units);
  facts.cycle = std::string{base_name(name)};
  if (!std::isnan(facts.reference_s))
    facts.cycle += ", cycle " + utc_text(instant_at(facts.reference_s));
  else if (reading.part.grid.axes.has_time)
    facts.cycle += ", from " + utc_text(instant_at(reading.part.grid.axes.times_s.front()));
}
void tell_times(Reading& reading, const Axes& axes, const std::string& name) {
  if (axes.time) reading.part.grid.facts.time_unit = axes.time->coordinate->unit().value_or("");
  tell_cycle(reading, name);
}

Result<Done> finish(const Reading& reading) {
  auto done = make_plausible(reading.part.grid, reading.warnings());
  if (done) return done;
  std::string what = done.error().what;
  for (const auto& text : reading.empty) what += "; " + text;
  for (const auto& text : reading.outside)
    what += "; " + text + ", which is no mask (if they mark land, the file must say so in _FillValue)";
  return fault(std::move(what));
}

/// Fills the gaps of measured surface currents.
void fill(Reading& reading) {
  auto& grid = reading.part.grid;
  const auto& wanted = reading.options.fill_gaps_m;
  const double distance = wanted ? *wanted : is_radar(reading.file) ? two_cells(grid.axes) : 0;
  if (!(distance > 0)) return;
  if (grid.axes.depths_m.size() > 1) {
    if (wanted) reading.warnings().emplace_back("gaps are filled at the surface only: it has several depths");
    return;
  }
  const auto filled = fill_gaps(grid, distance);
  char text[96];
  std::snprintf(text, sizeof text, "%zu gaps are filled from values on both sides within %.1f km", filled,
                distance * 1e-3);
  if (filled > 0) reading.warnings().emplace_back(text);
}

Result<Done> read_currents(Reading& reading, const VelocityPair& pair, const std::string& name) {
  const auto axes = recognise_axes(reading.file, *pair.east);
  if (!axes) return unexpected(axes.error());
  const auto box = prepare(reading, *axes);
  if (!box) return unexpected(box.error());
  for (const auto& [variable, side] : {std::pair{pair.east, std::size_t{0}}, std::pair{pair.north, std::size_t{1}}})
    if (auto read = read_into(reading, *variable, "m/s", *axes, *box, side); !read) return read;
  if (auto sound = drop_failed(reading.file, *pair.east, *axes, *box, reading.part.grid, reading.warnings()); !sound)
    return sound;
  if (auto finished = finish(reading); !finished) return finished;
  fill(reading);
  auto& facts = reading.part.grid.facts;
  facts.east_variable = pair.east->name;
  facts.north_variable = pair.north->name;
  facts.east_unit = pair.east->unit().value_or("");
  facts.north_unit = pair.north->unit().value_or("");
  facts.recognised_by = pair.why;
  tell_times(reading, *axes, name);
  return Done{};
}

Result<Done> read_half(Reading& reading, const LoneComponent& lone, const std::string& name) {
  const auto axes = recognise_axes(reading.file, *lone.variable);
  if (!axes && has_plane_positions(ModelFiles{{&reading.file}}))
    return fault_alone("it has " + reading.file.shape_of(*lone.variable) +
                       " only, along an axis of a model's own grid; give the file of the other component beside it");
  if (!axes) return unexpected(axes.error());
  const auto box = prepare(reading, *axes);
  if (!box) return unexpected(box.error());
  if (auto read = read_into(reading, *lone.variable, "m/s", *axes, *box, lone.is_east ? 0 : 1); !read) return read;
  auto& facts = reading.part.grid.facts;
  (lone.is_east ? facts.east_variable : facts.north_variable) = lone.variable->name;
  (lone.is_east ? facts.east_unit : facts.north_unit) = lone.variable->unit().value_or("");
  facts.recognised_by = lone.why;
  reading.part.holds = lone.is_east ? Holds::east : Holds::north;
  tell_times(reading, *axes, name);
  return Done{};
}

/// The mean that belongs to an anomaly: on the same latitudes and longitudes, the same at every time.
Result<Done> add_mean(Reading& reading, const Variable& mean) {
  const auto axes = recognise_axes(reading.file, mean);
  if (!axes) return unexpected(axes.error());
  std::vector<std::string> ignored;  // that it has no time is as it should be
  const auto box = read_box(reading.file, *axes, reading.units, reading.options, ignored);
  if (!box) return unexpected(box.error());
  auto& grid = reading.part.grid;
  if (box->lats.values != grid.axes.lats_deg || box->lons.values != grid.axes.lons_deg ||
      box->axes().nodes() * grid.axes.times_s.size() != grid.axes.nodes())
    return fault(reading.file.shape_of(mean) + " lies on other nodes than the heights that it belongs to");
  const auto component = Component::of(mean, reading.units, "m", reading.warnings());
  if (!component) return unexpected(component.error());
  std::vector<float> values(box->axes().nodes());
  if (auto read = read_values(reading.file, mean, *axes, *box, *component, values.data(), 1); !read)
    return unexpected(read.error());
  for (std::size_t n = 0; n < grid.axes.nodes(); ++n) grid.values[2 * n] += values[n % values.size()];
  return Done{};
}

Result<Done> read_heights(Reading& reading, const SeaHeights& heights, const std::string& name) {
  const auto axes = recognise_axes(reading.file, *heights.height);
  if (!axes) return unexpected(axes.error());
  const auto box = prepare(reading, *axes);
  if (!box) return unexpected(box.error());
  if (auto read = read_into(reading, *heights.height, "m", *axes, *box, 0); !read) return read;
  if (heights.mean != nullptr)
    if (auto added = add_mean(reading, *heights.mean); !added) return added;
  auto& grid = reading.part.grid;
  for (std::size_t n = 0; n < grid.axes.nodes(); ++n) grid.values[2 * n + 1] = grid.values[2 * n];
  if (const auto land = zeros_to_land(grid); land > 0)
    reading.warnings().push_back(std::to_string(land) + " nodes have the height 0 at every time: taken as land");
  if (const auto left_out = geostrophic_currents(grid, reading.options.equator_band_deg); left_out > 0) {
    std::string band = std::to_string(reading.options.equator_band_deg);
    band.erase(band.find_last_not_of('0') + 1);
    if (band.back() == '.') band.pop_back();
    reading.warnings().push_back(std::to_string(left_out) + " nodes within " + band +
                                 " degrees of the equator have no current: heights say nothing of it there");
  }
  reading.warnings().emplace_back("computed from heights: without tide and wind drift");
  if (auto finished = finish(reading); !finished) return finished;
  auto& facts = grid.facts;
  facts.east_variable = facts.north_variable = heights.height->name;
  facts.east_unit = facts.north_unit = heights.height->unit().value_or("");
  facts.recognised_by = "computed from heights: " + heights.why;
  tell_times(reading, *axes, name);
  return Done{};
}

/// True when it is a model on a grid of its own, which then is read.
Result<bool> read_as_model(Reading& reading, const std::vector<const NetcdfFile*>& files, const std::string& name) {
  auto model = read_model(ModelFiles{files}, reading.units, reading.options);
  if (!model) return unexpected(model.error());
  if (!*model) return false;
  reading.part.grid = std::move(**model);
  if (auto finished = finish(reading); !finished) return unexpected(finished.error());
  tell_cycle(reading, name);
  return true;
}

/// What of a file is read, and how.
Result<Done> read_somehow(Reading& reading, const std::string& name) {
  using Heights = ReadOptions::Heights;
  const auto& options = reading.options;
  const bool asked_for = !options.east.empty() || !options.north.empty();
  if (options.heights == Heights::always) {
    const auto heights = recognise_heights(reading.file);
    if (!heights) return unexpected(heights.error());
    if (!*heights) return fault("it has no height of the sea surface; allowed are adt, zos, ssh, or sla with mdt");
    return read_heights(reading, **heights, name);
  }
  const auto pair = recognise_velocity(reading.file, options.east, options.north);
  if (pair && recognise_axes(reading.file, *pair->east)) return read_currents(reading, *pair, name);
  std::vector<const NetcdfFile*> files{&reading.file};
  for (const auto& grid : reading.grids) files.push_back(grid.file);
  const auto model = read_as_model(reading, files, name);
  if (!model) return unexpected(model.error());
  if (*model) return Done{};
  if (pair) return read_currents(reading, *pair, name);  // says which of its axes is not recognised
  if (const auto grid = described_grid(reading.file))
    return fault_alone("it describes a model's grid (" + *grid +
                       ") and has no current; name it beside the files that have");
  if (asked_for) return unexpected(pair.error());
  // A file that has both is refused for what is wrong with them, not read in another way.
  const auto components = velocity_components(reading.file);
  const bool one_side = std::all_of(components.begin(), components.end(), [&](const LoneComponent& component) {
    return component.is_east == components.front().is_east;
  });
  if (!components.empty() && one_side) return read_half(reading, components.front(), name);
  if (!components.empty() || options.heights == Heights::never) return unexpected(pair.error());
  const auto heights = recognise_heights(reading.file);
  if (!heights) return unexpected(heights.error());
  return *heights ? read_heights(reading, **heights, name) : Result<Done>{unexpected(pair.error())};
}

}  // namespace

Result<Part> read_open_file(const std::string& name, const NetcdfFile& file, const Sha256& hash, const Units& units,
                            const ReadOptions& options, const std::vector<GridFile>& grids) {
  Part part{name, {}, Holds::both};
  Reading reading{file, units, options, part, grids, {}};
  if (auto read = read_somehow(reading, name); !read) return unexpected(read.error());
  part.grid.facts.sources = {{name, hash}};
  if (part.grid.facts.layout.empty() && !options.only_time_s)
    part.grid.facts.water = read_water(file, units, options, part.grid);
  if (!part.grid.facts.layout.empty())  // else no grid file had a part in it
    for (const auto& grid : grids) part.grid.facts.sources.push_back(grid.source);
  if (auto told = tell_member(part, file, options.member); !told) return unexpected(told.error());
  return part;
}

Result<Part> read_model_pair(const std::string& name, const std::vector<GridFile>& files, const Units& units,
                             const ReadOptions& options) {
  Part part{name, {}, Holds::both};
  const std::vector<GridFile> none;
  Reading reading{*files.front().file, units, options, part, none, {}};
  std::vector<const NetcdfFile*> open;
  for (const auto& file : files) open.push_back(file.file);
  const auto model = read_as_model(reading, open, name);
  if (!model) return unexpected(model.error());
  if (!*model) return fault("it and the file of the other component are no velocity on one grid");
  for (const auto& file : files) part.grid.facts.sources.push_back(file.source);
  if (auto told = tell_member(part, *files.front().file, options.member); !told) return unexpected(told.error());
  return part;
}

Result<Part> read_part(const std::string& name, std::span<const std::byte> bytes, const Units& units,
                       const ReadOptions& options, const std::vector<GridFile>& grids) {
  if (auto whole = check_whole(bytes); !whole) return unexpected(whole.error());
  const auto file = one_member(NetcdfFile::open(bytes), options.member);
  if (!file) return unexpected(file.error());
  return read_open_file(name, *file, Sha256::of(bytes), units, options, grids);
}

}  // namespace glidehelm::ingest
