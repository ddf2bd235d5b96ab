#include "daemon/cli/field_animate.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/cli/field_page.hpp"
#include "daemon/cli/field_text.hpp"
#include "daemon/cli/new_file.hpp"

namespace glidehelm::cli {

namespace {

constexpr std::size_t kNodesAtMost = 40'000, kAllAtMost = 1'500'000;

std::size_t every(std::size_t count, std::size_t step) { return (count + step - 1) / step; }

std::vector<double> thinned(const std::vector<double>& axis, std::size_t step) {
  std::vector<double> kept;
  for (std::size_t k = 0; k < axis.size(); k += step) kept.push_back(axis[k]);
  return kept;
}

/// "every 3rd" in words that need no English ordinals.
std::string left_out_text(std::size_t step, std::size_t time_step) {
  std::string text;
  if (step > 1) text += "one of " + std::to_string(step) + " rows and columns is shown";
  if (time_step > 1)
    text += (text.empty() ? "" : ", ") + std::string{"one of "} + std::to_string(time_step) + " times is shown";
  return text;
}

/// The shore in degrees about the field's longitudes, thinned; without the borders along which the coast was cut.
std::vector<std::vector<std::pair<double, double>>> shores_of(const chart::Coast& coast, const Animation& field) {
  const double west = field.lons_deg.front(), east = field.lons_deg.back(), south = field.lats_deg.front(),
               north = field.lats_deg.back();
  const double apart = std::max(east - west, north - south) / 1000;
  const double zero = static_cast<double>(coast.area().west) / chart::kCoastUnitsPerDegree;
  const double middle = zero + static_cast<double>(coast.area().width()) / chart::kCoastUnitsPerDegree / 2;
  const double turn = 360 * std::round(((west + east) / 2 - middle) / 360);
  std::vector<std::vector<std::pair<double, double>>> shores;
  for (const auto& ring : coast.rings()) {
    std::vector<std::pair<double, double>> line;
    bool inside = false;
    const auto finish = [&] {
      if (inside && line.size() > 1) shores.push_back(line);
      line.clear();
      inside = false;
    };
    for (std::size_t k = 0; k <= ring.points.size(); ++k) {
      const auto& p = ring.points[k % ring.points.size()];
      const double lon = zero + turn + p.x / chart::kCoastUnitsPerDegree, lat = p.y / chart::kCoastUnitsPerDegree;
      const bool last = k == ring.points.size() || ring.cut[k % ring.points.size()];
      if (line.empty() || last || std::hypot(lon - line.back().first, lat - line.back().second) >= apart)
        line.emplace_back(lon, lat);
      inside = inside || (lon >= west && lon <= east && lat >= south && lat <= north);
      if (k < ring.points.size() && ring.cut[k]) finish();
    }
    finish();
  }
  return shores;
}

std::size_t nearest_level(const std::vector<double>& depths, double depth) {
  std::size_t best = 0;
  for (std::size_t z = 1; z < depths.size(); ++z)
    if (std::abs(depths[z] - depth) < std::abs(depths[best] - depth)) best = z;
  return best;
}

std::string misuse_of(const FieldAnimateOptions& options) {
  if (options.files.empty()) return "no file was named";
  if (!options.out.ends_with(".html") && !options.out.ends_with(".kml"))
    return "--out " + options.out + ": allowed is a name that ends in .html or .kml";
  if (options.depth_m && !(*options.depth_m >= 0)) return "--depth is positive down, allowed is 0 or more";
  return {};
}

}  // namespace

Animation animation_of(const ocean::GridView& view, std::size_t level, const chart::Coast* coast) {
  const auto& axes = view.axes;
  const std::size_t rows = axes.lats_deg.size(), columns = axes.lons_deg.size(), times = axes.times_s.size();
  std::size_t step = 1;
  while (every(rows, step) * every(columns, step) > kNodesAtMost) ++step;
  // Two nodes at least remain of an axis.
  step = std::min({step, rows - 1, columns - 1});
  const std::size_t nodes = every(rows, step) * every(columns, step);
  std::size_t time_step = 1;
  while (nodes * every(times, time_step) > kAllAtMost && every(times, time_step) > 1) ++time_step;

  Animation animation;
  animation.title = view.facts.cycle;
  animation.warnings = view.facts.warnings;
  animation.decimation = left_out_text(step, time_step);
  if (axes.has_depth) animation.depth_text = decimal(axes.depths_m[level], 1) + " m";
  if (axes.has_time) animation.times_s = thinned(axes.times_s, time_step);
  animation.lats_deg = thinned(axes.lats_deg, step);
  animation.lons_deg = thinned(axes.lons_deg, step);
  animation.mm_per_s.reserve(2 * nodes * every(times, time_step));
  for (std::size_t t = 0; t < times; t += time_step)
    for (std::size_t j = 0; j < rows; j += step)
      for (std::size_t i = 0; i < columns; i += step) {
        const float* at = view.values + 2 * (((t * axes.depths_m.size() + level) * rows + j) * columns + i);
        for (std::size_t side = 0; side < 2; ++side)
          animation.mm_per_s.push_back(
              std::isnan(at[0]) ? Animation::kNoCurrent
                                : static_cast<std::int16_t>(std::lround(1000 * static_cast<double>(at[side]))));
      }
  if (coast != nullptr) animation.shores = shores_of(*coast, animation);
  return animation;
}

int run_field_animate(const FieldAnimateOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  if (const auto misuse = misuse_of(options); !misuse.empty()) return refuse_field(err, 2, misuse);
  if (const auto why = why_not_new(options.out, world.files); !why.empty()) return refuse_field(err, 1, why);
  std::shared_ptr<const chart::Coast> coast;
  if (!options.coast.empty()) {
    const auto bytes = world.files.read(options.coast, chart::Coast::kLargestFile);
    if (!bytes) return refuse_field(err, 1, bytes.error().message());
    auto parsed = chart::Coast::parse(*bytes);
    if (!parsed) return refuse_field(err, 1, options.coast + ": " + parsed.error().message());
    coast = std::move(*parsed);
  }
  const auto loaded = daemon::ingest_files(options.files, options.ingest, world);
  if (!loaded) return refuse_field(err, 1, loaded.error());
  const auto& view = (*loaded)->view;
  for (const auto& warning : view.facts.warnings) err << "glidehelm field: warning: " << warning << '\n';
  if (options.depth_m && !view.axes.has_depth)
    err << "glidehelm field: warning: the files have no depths: --depth changes nothing\n";
  const std::size_t level = options.depth_m ? nearest_level(view.axes.depths_m, *options.depth_m) : 0;
  const auto animation = animation_of(view, level, coast.get());
  const auto bytes = options.out.ends_with(".html") ? animation_page(animation) : animation_kml(animation);
  if (const auto wrong = write_new_file(options.out, bytes, world.files); !wrong.empty())
    return refuse_field(err, 1, wrong);
  out << options.out << ": " << animation.frames() << (animation.frames() == 1 ? " time, " : " times, ")
      << animation.lats_deg.size() << " by " << animation.lons_deg.size() << " nodes, " << bytes.size() << " bytes"
      << (animation.decimation.empty() ? "" : "; " + animation.decimation) << '\n';
  return 0;
}

}  // namespace glidehelm::cli
