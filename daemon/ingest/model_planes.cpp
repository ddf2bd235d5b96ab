#include "daemon/ingest/model_planes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/ingest/vertical.hpp"

namespace glidehelm::ingest {

namespace {

bool all_around(const Area& area) { return area.east - area.west >= 359; }

}  // namespace

bool in_area(const Mesh& mesh, std::size_t point, const std::optional<Area>& area) {
  if (!area || all_around(*area)) return true;
  const double middle = 0.5 * (area->west + area->east), half = 0.5 * (area->east - area->west);
  return mesh.lat[point] >= area->south && mesh.lat[point] <= area->north &&
         std::abs(fold_degrees(mesh.lon[point] - middle)) <= half;
}

Result<Window> window_of(const Mesh& mesh, const std::optional<Area>& area) {
  if (!area || all_around(*area)) return Window{0, mesh.rows, 0, mesh.columns};
  std::size_t low_j = mesh.rows, high_j = 0, low_i = mesh.columns, high_i = 0;
  for (std::size_t j = 0; j < mesh.rows; ++j)
    for (std::size_t i = 0; i < mesh.columns; ++i) {
      if (!in_area(mesh, mesh.index(j, i), area)) continue;
      low_j = std::min(low_j, j), high_j = std::max(high_j, j);
      low_i = std::min(low_i, i), high_i = std::max(high_i, i);
    }
  if (low_j == mesh.rows) return fault("no point of the grid lies in the area asked for");
  constexpr std::size_t kMore = 2;
  const std::size_t row = low_j > kMore ? low_j - kMore : 0, column = low_i > kMore ? low_i - kMore : 0;
  return Window{row, std::min(high_j + kMore + 1, mesh.rows) - row, column,
                std::min(high_i + kMore + 1, mesh.columns) - column};
}

Result<Mask> mask_of(const ModelFiles& files, std::initializer_list<std::string_view> names, const Shape& shape,
                     std::size_t levels) {
  for (const auto name : names) {
    const Found found = files.find(name);
    if (!found || shape_of(found) != shape) continue;
    const auto values = plain_numbers(found);
    if (!values) return unexpected(values.error());
    const std::size_t plane = shape.rows * shape.columns;
    if (values->size() != plane && values->size() != plane * levels) continue;
    Mask mask{std::vector<std::uint8_t>(values->size()), values->size() / plane, found};
    for (std::size_t k = 0; k < values->size(); ++k) {
      const double value = (*values)[k];
      if (!std::isnan(value) && value != 0 && value != 1)
        return fault("mask " + found.variable->name + " holds " + printed("%.6g", value) +
                     ", allowed is 0 (land) and 1 (water)");
      mask.wet[k] = value == 1 ? 1 : 0;
    }
    return mask;
  }
  return Mask{};
}
std::vector<std::uint8_t> plane_of(const Mask& mask, std::size_t level, const Shape& shape, const Window& w) {
  if (mask.wet.empty()) return {};
  const std::size_t plane = shape.rows * shape.columns, first = mask.levels > 1 ? level * plane : 0;
  const auto begin = mask.wet.begin() + static_cast<std::ptrdiff_t>(first);
  return cut_out(std::vector<std::uint8_t>(begin, begin + static_cast<std::ptrdiff_t>(plane)), shape.columns, w);
}

Result<LevelPlanes> read_levels(const Side& part, std::size_t time, std::size_t levels, std::size_t& outside) {
  const auto& variable = *part.found.variable;
  const std::size_t rank = variable.dimensions.size();
  std::vector<std::size_t> start(rank, 0), count(rank, 1);
  start[rank - 2] = part.at.row, count[rank - 2] = part.at.rows;
  start[rank - 1] = part.at.column, count[rank - 1] = part.at.columns;
  if (part.split.time) start[*part.split.time] = time;
  LevelPlanes planes;
  for (std::size_t k = 0; k < levels; ++k) {
    if (part.split.level) start[*part.split.level] = k;
    auto stored = part.found.file->read(variable, start, count);
    if (!stored) return unexpected(stored.error());
    for (double& value : *stored) {
      outside += part.component.outside_valid(value) ? 1U : 0U;
      value = part.component(value);
    }
    planes.push_back(std::move(*stored));
  }
  return planes;
}

std::vector<double> depths_of(const Levels& levels, const Shape& whole, const Window& w,
                              const std::vector<std::uint8_t>& wet) {
  if (!levels.terrain) return levels.depths;
  const auto h = cut_out(levels.h, whole.columns, w);
  double deepest = 0;
  for (std::size_t n = 0; n < h.size(); ++n)
    if (h[n] > deepest && (wet.empty() || wet[n] != 0)) deepest = h[n];
  return fixed_depths(deepest);
}

std::array<LevelPlanes, 2> at_fixed_depths(const Levels& levels, std::size_t columns, const Window& w,
                                           const std::vector<double>& surface, const std::vector<double>& depths,
                                           const std::array<const LevelPlanes*, 2>& in) {
  std::array<LevelPlanes, 2> out;
  for (auto& planes : out) planes.assign(depths.size(), std::vector<double>(w.points(), kNaN));
  std::vector<double> at(levels.count), values(levels.count);
  Column column;
  for (std::size_t n = 0; n < w.points(); ++n) {
    const std::size_t whole = w.whole(n, columns);
    const double h = levels.h[whole];
    double zeta = surface.empty() ? 0.0 : surface[whole];
    if (std::isnan(zeta)) zeta = 0;
    if (!(h + zeta > 0)) continue;  // land, or fallen dry
    for (std::size_t k = 0; k < levels.count; ++k) at[k] = levels.terrain->depth(k, h, zeta);
    column.set(at, h + zeta);
    for (std::size_t side = 0; side < in.size(); ++side) {
      for (std::size_t k = 0; k < levels.count; ++k) values[k] = (*in[side])[k][n];
      for (std::size_t z = 0; z < depths.size(); ++z) out[side][z][n] = column.at(depths[z], values);
    }
  }
  return out;
}

}  // namespace glidehelm::ingest
