#include "daemon/ingest/model_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "daemon/ingest/component.hpp"
#include "daemon/ingest/model_levels.hpp"
#include "daemon/ingest/model_planes.hpp"
#include "daemon/ingest/model_water.hpp"
#include "daemon/ingest/recognise.hpp"

namespace glidehelm::ingest {

namespace {

constexpr double kNodesAtMost = 5e8;  // 4 GB of floats, beside which the planes of one time are small

/// The faces that a window of centres needs, as a window of the faces.
struct FaceWindow {
  Faces faces;  ///< within the window
  Window at;    ///< within the file
};
FaceWindow faces_of(const Faces& whole, const Window& w) {
  FaceWindow f{whole, w};
  const std::size_t first_centre = whole.along_eta ? w.row : w.column, centres = whole.along_eta ? w.rows : w.columns;
  const std::size_t length = whole.along_eta ? whole.rows : whole.columns;
  const auto low = static_cast<std::ptrdiff_t>(first_centre) + whole.before;
  const std::size_t first = low > 0 ? static_cast<std::size_t>(low) : 0;
  const std::size_t last = std::min(length, static_cast<std::size_t>(low + static_cast<std::ptrdiff_t>(centres) + 1));
  f.faces.before = static_cast<int>(low - static_cast<std::ptrdiff_t>(first));
  (whole.along_eta ? f.at.row : f.at.column) = first;
  (whole.along_eta ? f.at.rows : f.at.columns) = last - first;
  f.faces.rows = f.at.rows;
  f.faces.columns = f.at.columns;
  return f;
}

/// Everything that stays the same from time to time.
struct Job {
  Side u, v;
  ModelGrid grid;
  Window window{};
  Mesh mesh{};  ///< of the window
  std::optional<Rotation> rotation{};
  FaceWindow faces_u{}, faces_v{};
  Mask wet{}, open_u{}, open_v{};
  std::string land{};  ///< which points are land, in words
  Levels levels{};
  std::vector<double> depths{};  ///< of the grid that is made
  TargetAxes target{};
  Ascending times{};
  bool has_time{};
};

/// Centres of both components of one level, turned to east and north.
struct Planes {
  std::size_t outside_u{}, outside_v{};  ///< values beyond the valid range
  LevelPlanes east, north;               ///< per level of the file
};

std::vector<std::uint8_t> open_plane(const Job& job, const Mask& mask, const FaceWindow& faces, std::size_t level) {
  const Shape whole{faces.faces.along_eta ? job.grid.staggering.v.rows : job.grid.staggering.u.rows,
                    faces.faces.along_eta ? job.grid.staggering.v.columns : job.grid.staggering.u.columns};
  if (!mask.wet.empty()) return plane_of(mask, level, whole, faces.at);
  if (job.wet.wet.empty()) return {};
  const auto wet = plane_of(job.wet, level, {job.grid.centres.rows, job.grid.centres.columns}, job.window);
  return open_faces(faces.faces, job.window.rows, job.window.columns, wet);
}

Result<Planes> planes_at(const Job& job, std::size_t time) {
  std::size_t outside_u = 0, outside_v = 0;
  auto u = read_levels(job.u, time, job.levels.count, outside_u);
  auto v = read_levels(job.v, time, job.levels.count, outside_v);
  if (!u) return unexpected(u.error());
  if (!v) return unexpected(v.error());
  const Window& w = job.window;
  for (std::size_t k = 0; k < job.levels.count; ++k) {
    auto &a = (*u)[k], &b = (*v)[k];
    if (job.grid.staggering.staggered) {
      a = to_centres(job.faces_u.faces, w.rows, w.columns, a, open_plane(job, job.open_u, job.faces_u, k));
      b = to_centres(job.faces_v.faces, w.rows, w.columns, b, open_plane(job, job.open_v, job.faces_v, k));
    }
    const auto wet = plane_of(job.wet, k, {job.grid.centres.rows, job.grid.centres.columns}, w);
    for (std::size_t n = 0; n < a.size(); ++n) {
      if ((!wet.empty() && wet[n] == 0) || std::isnan(a[n]) || std::isnan(b[n])) {
        a[n] = b[n] = kNaN;
      } else if (job.rotation) {
        const double c = std::cos(job.rotation->theta[n]), s = std::sin(job.rotation->theta[n]), along = a[n];
        a[n] = along * c - b[n] * s;
        b[n] = along * s + b[n] * c;
      }
    }
  }
  return Planes{outside_u, outside_v, std::move(*u), std::move(*v)};
}

/// Points that are exactly 0, 0 on every level of every time are land, when the files mark land in no other way.
Result<std::vector<std::uint8_t>> zeros_as_land(const Job& job, std::vector<std::string>& warnings) {
  std::vector<std::uint8_t> wet(job.window.rows * job.window.columns, 0);
  for (std::size_t t = 0; t < job.times.values.size(); ++t) {
    const auto planes = planes_at(job, job.times.source[t]);
    if (!planes) return unexpected(planes.error());
    for (std::size_t k = 0; k < job.levels.count; ++k)
      for (std::size_t n = 0; n < wet.size(); ++n) {
        if (std::isnan(planes->east[k][n])) return std::vector<std::uint8_t>{};  // there is another mark
        if (planes->east[k][n] != 0 || planes->north[k][n] != 0) wet[n] = 1;
      }
  }
  const auto land = std::count(wet.begin(), wet.end(), 0);
  if (land == 0)
    warnings.emplace_back("no land mask and no missing values: every point of the grid counts as water");
  else
    warnings.push_back("no land mask and no missing values: the " + std::to_string(land) +
                       " points that are exactly zero at every time and level are taken as land");
  return wet;
}

Result<std::optional<Rotation>> rotation_for(const ModelFiles& files, const ModelVelocity& velocity,
                                             const ModelGrid& grid, Turning turning,
                                             std::vector<std::string>& warnings) {
  using Sense = ModelVelocity::Sense;
  Sense sense = velocity.sense;
  if (turning == Turning::none) sense = Sense::east_north;
  if (turning == Turning::angle || turning == Turning::grid) sense = Sense::grid_axes;
  if (sense == Sense::open && grid.staggering.staggered) sense = Sense::grid_axes;      // only these are staggered
  if (sense == Sense::open && separable_axes(grid.centres)) sense = Sense::east_north;  // its axes are east and north
  if (sense == Sense::east_north) return std::optional<Rotation>{};
  if (auto handed = check_right_handed(grid.centres); !handed) return unexpected(handed.error());
  const Shape shape{grid.centres.rows, grid.centres.columns};
  const Found angle = files.first_of({"angle", "ANGLET", "ANGLE", "angle_rho"});
  const bool fits = angle && shape_of(angle) == shape;
  if (turning == Turning::angle && !fits) return fault("there is no angle of shape " + text(shape) + " in the files");
  Result<Rotation> rotation = computed_rotation(grid.centres);
  if (fits && turning != Turning::grid) {
    const auto stored = plain_numbers(angle);
    if (!stored) return unexpected(stored.error());
    if (stored->size() != grid.centres.lat.size())
      return fault("angle " + angle.file->shape_of(*angle.variable) + " is no single plane");
    rotation = rotation_from(grid.centres, angle.variable->name, angle.variable->unit().value_or("radians"), *stored,
                             warnings);
    if (!rotation) return unexpected(rotation.error());
  }
  if (sense == Sense::open) {
    double most = 0;
    for (const double theta : rotation->theta)
      if (!std::isnan(theta)) most = std::max(most, std::abs(theta));
    // Under half a degree the two readings differ by less than 1 % of the speed.
    if (most > 0.5 * kPi / 180)
      return fault(velocity.u.variable->name + " and " + velocity.v.variable->name +
                   " may be east and north or along the grid's axes, which are turned by up to " +
                   printed("%.1f°", most * 180 / kPi) + "; say which with --rotation none or --rotation grid");
  }
  for (std::size_t k = 0; k < rotation->theta.size(); ++k)
    if (std::isnan(rotation->theta[k])) rotation->theta[k] = 0;  // a point without neighbours holds no node
  return std::optional{std::move(*rotation)};
}

/// True when the plain reader's refusal is not the last word.
bool is_model(const ModelFiles& files, const ModelVelocity& velocity, const Splitting& u, const Splitting& v) {
  if (velocity.u.file != velocity.v.file) return true;
  const auto shape_u = *shape_of(velocity.u), shape_v = *shape_of(velocity.v);
  // The one along latitude and longitude, the other turned over: a mistake, no staggering.
  const bool turned_over = own_positions(velocity.u) && shape_v == Shape{shape_u.columns, shape_u.rows};
  if (shape_u != shape_v) return !turned_over;
  if (u.terrain || v.terrain) return true;
  const auto positions = own_positions(velocity.u);
  if (positions && positions->lat.variable->dimensions.size() > 1) return true;
  return files.files().size() > 1;
}

Result<Done> read_times(Job& job, const Units& units, const ReadOptions& options, std::vector<std::string>& warnings,
                        std::string& time_unit) {
  job.times = {{0.0}, {0}};
  if (job.u.split.time.has_value() != job.v.split.time.has_value())
    return fault("only one of the two components has times");
  const auto* coordinate = job.u.split.time_coordinate;
  if (coordinate == nullptr) {
    if (job.u.split.time && length_of(job.u.found, *job.u.split.time) > 1)
      return fault("the time dimension of " + job.u.found.file->shape_of(*job.u.found.variable) + " has no times");
    warnings.emplace_back("no time axis: taken as the same at every instant");
    return Done{};
  }
  auto values = times(*job.u.found.file, *coordinate, units, options.time_epoch, warnings);
  if (!values) return unexpected(values.error());
  const auto all = *values;
  if (options.only_time_s) {
    const auto at = std::find(all.values.begin(), all.values.end(), *options.only_time_s) - all.values.begin();
    if (at == static_cast<std::ptrdiff_t>(all.values.size())) return fault("it has not the time that was asked for");
    values = Ascending{{*options.only_time_s}, {all.source[static_cast<std::size_t>(at)]}};
  }
  job.times = std::move(*values);
  job.has_time = true;
  time_unit = coordinate->unit().value_or("");
  if (job.v.split.time_coordinate == nullptr) return fault("the second component has no times");
  std::vector<std::string> said;
  const auto others = times(*job.v.found.file, *job.v.split.time_coordinate, units, options.time_epoch, said);
  if (!others) return unexpected(others.error());
  if (others->values != all.values || others->source != all.source)
    return fault("the two components have different times");
  return Done{};
}

Result<Done> read_masks(Job& job, const ModelFiles& files) {
  const Shape centres{job.grid.centres.rows, job.grid.centres.columns};
  const std::size_t levels = job.levels.count;
  auto wet = mask_of(files, {"mask_rho", "tmask", "tmaskutil", "wet_c", "wet", "mask"}, centres, levels);
  if (!wet) return unexpected(wet.error());
  job.wet = std::move(*wet);
  if (!job.grid.staggering.staggered) return Done{};
  const auto &u = job.grid.staggering.u, &v = job.grid.staggering.v;
  auto open_u = mask_of(files, {"mask_u", "umask", "wet_u"}, {u.rows, u.columns}, levels);
  if (!open_u) return unexpected(open_u.error());
  auto open_v = mask_of(files, {"mask_v", "vmask", "wet_v"}, {v.rows, v.columns}, levels);
  if (!open_v) return unexpected(open_v.error());
  job.open_u = std::move(*open_u);
  job.open_v = std::move(*open_v);
  return Done{};
}

Result<Done> settle_windows(Job& job, const ReadOptions& options) {
  auto window = window_of(job.grid.centres, options.area);
  if (!window) return unexpected(window.error());
  job.window = *window;
  const std::size_t columns = job.grid.centres.columns;
  job.mesh = {window->rows, window->columns, cut_out(job.grid.centres.lat, columns, *window),
              cut_out(job.grid.centres.lon, columns, *window)};
  if (job.rotation) job.rotation->theta = cut_out(job.rotation->theta, columns, *window);
  if (job.grid.staggering.staggered) {
    job.faces_u = faces_of(job.grid.staggering.u, *window);
    job.faces_v = faces_of(job.grid.staggering.v, *window);
    job.u.at = job.faces_u.at;
    job.v.at = job.faces_v.at;
  } else {
    job.u.at = job.v.at = *window;
  }
  // Steps come from the whole mesh, so that they do not depend on the area.
  auto target = target_axes(job.grid.centres, job.levels.count, options.area);
  if (!target) return unexpected(target.error());
  job.target = std::move(*target);
  return Done{};
}

Result<Done> fill(const Job& job, const Remap& remap, ocean::Grid& grid) {
  const std::size_t plane = 2 * remap.nodes();
  grid.values.resize(2 * grid.axes.nodes());
  std::size_t outside_u = 0, outside_v = 0;
  for (std::size_t t = 0; t < job.times.values.size(); ++t) {
    auto planes = planes_at(job, job.times.source[t]);
    if (!planes) return unexpected(planes.error());
    outside_u += planes->outside_u;
    outside_v += planes->outside_v;
    if (job.levels.terrain) {
      const auto surface = surface_at(job.levels, job.times.source[t]);
      if (!surface) return unexpected(surface.error());
      auto deep = at_fixed_depths(job.levels, job.grid.centres.columns, job.window, *surface, job.depths,
                                  {&planes->east, &planes->north});
      planes->east = std::move(deep[0]);
      planes->north = std::move(deep[1]);
    }
    for (std::size_t z = 0; z < job.depths.size(); ++z) {
      const std::size_t level = job.levels.order.empty() ? z : job.levels.order[z];
      remap.apply(planes->east[level], planes->north[level], grid.values.data() + (t * job.depths.size() + z) * plane);
    }
  }
  for (const auto& [side, outside] : {std::pair{&job.u, outside_u}, std::pair{&job.v, outside_v}})
    if (outside > 0)
      grid.facts.warnings.push_back(std::to_string(outside) + " values of " + side->found.variable->name +
                                    " lie outside its valid range " + side->component.valid_text() + " and are kept");
  return Done{};
}

/// Terrain-following levels: fixed depths as far down as the water of the window reaches.
void settle_depths(Job& job) {
  const Shape whole{job.grid.centres.rows, job.grid.centres.columns};
  job.depths = depths_of(job.levels, whole, job.window, plane_of(job.wet, 0, whole, job.window));
  if (job.levels.terrain)
    job.levels.words +=
        ", brought onto " + std::to_string(job.depths.size()) + " depths to " + printed("%.0f m", job.depths.back());
}

/// Everything but the numbers: where they are, what they mean, where they go. Sets the units' warnings and the time unit.
Result<Job> prepare(const ModelFiles& files, const ModelVelocity& pair, const Splitting& split_u,
                    const Splitting& split_v, const Units& units, const ReadOptions& options, ocean::GridFacts& facts) {
  auto horizontal = model_grid(files, pair.u, pair.v,
                               pair.sense == ModelVelocity::Sense::east_north || options.turning == Turning::none);
  if (!horizontal) return unexpected(horizontal.error());
  auto component_u = Component::of(*pair.u.variable, units, facts.warnings);
  if (!component_u) return unexpected(component_u.error());
  auto component_v = Component::of(*pair.v.variable, units, facts.warnings);
  if (!component_v) return unexpected(component_v.error());
  Job job{{pair.u, *component_u, split_u, {}}, {pair.v, *component_v, split_v, {}}, std::move(*horizontal)};
  auto rotation = rotation_for(files, pair, job.grid, options.turning, facts.warnings);
  if (!rotation) return unexpected(rotation.error());
  job.rotation = std::move(*rotation);
  if (auto done = read_times(job, units, options, facts.warnings, facts.time_unit); !done)
    return unexpected(done.error());
  auto levels = levels_of(files, pair, split_u, split_v, {job.grid.centres.rows, job.grid.centres.columns}, units,
                          options.stretching, facts.warnings);
  if (!levels) return unexpected(levels.error());
  job.levels = std::move(*levels);
  if (auto done = read_masks(job, files); !done) return unexpected(done.error());
  if (auto done = settle_windows(job, options); !done) return unexpected(done.error());
  settle_depths(job);
  return job;
}

Result<Done> check_size(const ocean::GridAxes& axes, double allowed) {
  const std::size_t times = axes.times_s.size(), depths = axes.depths_m.size(), rows = axes.lats_deg.size(),
                    columns = axes.lons_deg.size();
  double nodes = 1;  // in floating point, which does not wrap
  for (const auto size : {times, depths, rows, columns}) nodes *= static_cast<double>(size);
  if (nodes <= allowed) return Done{};
  return fault("brought onto latitudes and longitudes it has " + printed("%.3g", nodes) + " nodes (" +
               std::to_string(times) + " times, " + std::to_string(depths) + " depths, " + std::to_string(rows) +
               " by " + std::to_string(columns) + "), allowed is " + printed("%.3g", allowed) +
               "; cut it with --area W/E/S/N");
}

/// Without a mask: land is where values are missing, else where they are zero for ever.
Result<Done> settle_land(Job& job, std::vector<std::string>& warnings) {
  if (!job.wet.wet.empty()) {
    job.land = "land by " + job.wet.from.variable->name;
    if (std::find(job.wet.wet.begin(), job.wet.wet.end(), 1) == job.wet.wet.end())
      return fault("every point of the grid is land by " + job.wet.from.variable->name + ": there is no water to read");
    return Done{};
  }
  job.land = "land where values are missing";
  auto wet = zeros_as_land(job, warnings);
  if (!wet) return unexpected(wet.error());
  if (std::find(wet->begin(), wet->end(), 0) == wet->end()) return Done{};
  job.land = "land where " + job.u.found.variable->name + " and " + job.v.found.variable->name + " are always zero";
  // As a mask over the whole shape: what lies outside the window is never asked.
  job.wet.wet.assign(job.grid.centres.lat.size(), 1);
  for (std::size_t n = 0; n < wet->size(); ++n)
    job.wet.wet[(job.window.row + n / job.window.columns) * job.grid.centres.columns + job.window.column +
                n % job.window.columns] = (*wet)[n];
  return Done{};
}

void tell(const Job& job, const ModelVelocity& pair, ocean::GridFacts& facts) {
  facts.east_variable = pair.u.variable->name;
  facts.north_variable = pair.v.variable->name;
  facts.east_unit = pair.u.variable->unit().value_or("");
  facts.north_unit = pair.v.variable->unit().value_or("");
  facts.recognised_by = pair.why;
  facts.layout = job.grid.words + "; " + (job.rotation ? job.rotation->words : "components are east and north") + "; " +
                 job.land + "; " + job.target.words + (job.levels.words.empty() ? "" : "; " + job.levels.words);
}

}  // namespace

Result<std::optional<ocean::Grid>> read_model(const ModelFiles& files, const Units& units, const ReadOptions& options) {
  auto velocity = model_velocity(files, options.east, options.north);
  if (!velocity) {
    if (has_plane_positions(files)) return unexpected(velocity.error());
    return std::optional<ocean::Grid>{};
  }
  if (!velocity->has_value()) return std::optional<ocean::Grid>{};
  const ModelVelocity& pair = **velocity;
  const auto split_u = split(pair.u), split_v = split(pair.v);
  if (!split_u || !split_v || !is_model(files, pair, *split_u, *split_v)) return std::optional<ocean::Grid>{};

  ocean::Grid grid;
  auto job = prepare(files, pair, *split_u, *split_v, units, options, grid.facts);
  if (!job) {
    // What several files say together is no fault of the first.
    auto why = job.error();
    why.alone = why.alone || files.files().size() > 1;
    return unexpected(std::move(why));
  }
  grid.axes = {job->times.values,       job->depths,   job->target.lats.values,
               job->target.lons.values, job->has_time, job->levels.has_depth};
  if (auto done = check_size(grid.axes, std::min(kNodesAtMost, options.nodes_at_most)); !done)
    return unexpected(done.error());
  if (auto done = settle_land(*job, grid.facts.warnings); !done) return unexpected(done.error());
  const auto remap = Remap::of(job->mesh, grid.axes.lats_deg, grid.axes.lons_deg);
  if (remap.inside() == 0) return fault("no node of the grid lies between the model's points");
  if (auto done = fill(*job, remap, grid); !done) return unexpected(done.error());
  if (!options.only_time_s)
    grid.facts.water = read_model_water(files, {job->grid.centres, job->window, job->wet}, units, options);
  tell(*job, pair, grid.facts);
  return std::optional{std::move(grid)};
}

}  // namespace glidehelm::ingest
