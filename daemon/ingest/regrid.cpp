#include "daemon/ingest/regrid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/base/local_metric.hpp"

namespace glidehelm::ingest {

namespace {

constexpr double kWidestCell = 90;  // degrees of longitude

/// Index of the face `side` (0 before, 1 behind) of a centre; nothing where the mesh ends.
std::optional<std::size_t> face_of(const Faces& faces, std::size_t j, std::size_t i, int side) {
  const auto centre = static_cast<std::ptrdiff_t>(faces.along_eta ? j : i);
  const std::ptrdiff_t face = centre + faces.before + side;
  if (face < 0 || face >= static_cast<std::ptrdiff_t>(faces.along_eta ? faces.rows : faces.columns))
    return std::nullopt;
  const auto at = static_cast<std::size_t>(face);
  return faces.along_eta ? at * faces.columns + i : j * faces.columns + at;
}

/// Even multiples of `step` within [low, high].
std::vector<double> multiples(double low, double high, double step) {
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  std::vector<double> values;
  for (double k = first; k <= last; ++k) values.push_back(k * step);
  return values;
}

Ascending counted(std::vector<double> values) {
  Ascending axis{std::move(values), {}};
  for (std::size_t k = 0; k < axis.values.size(); ++k) axis.source.push_back(k);
  return axis;
}

/// The arc of longitudes that the mesh covers: west, and how far east of it; 360 when the widest gap is below `cell`·3.
std::pair<double, double> longitude_arc(const Mesh& mesh, double cell_deg) {
  std::vector<double> lons;
  for (const double lon : mesh.lon)
    if (!std::isnan(lon)) lons.push_back(fold_degrees(lon));
  std::sort(lons.begin(), lons.end());
  double widest = lons.front() + 360 - lons.back(), west = lons.front();
  for (std::size_t k = 1; k < lons.size(); ++k)
    if (lons[k] - lons[k - 1] > widest) {
      widest = lons[k] - lons[k - 1];
      west = lons[k];
    }
  if (widest < 3 * cell_deg) return {-180, 360};
  return {west, 360 - widest};
}

/// Six significant digits downwards: steps that a person can read, never coarser than asked for.
double readable(double step) {
  const double unit = std::pow(10.0, std::floor(std::log10(step)) - 5);
  return std::floor(step / unit) * unit;
}

/// Nodes of one time up to which the grid is twice as fine as the mesh: 16 MB.
constexpr double kFineNodes = 2e6;

Result<TargetAxes> even_axes(const Mesh& mesh, std::size_t levels) {
  const auto spacing = median_spacing(mesh);
  double low = 90, high = -90;
  for (std::size_t k = 0; k < mesh.lat.size(); ++k)
    if (!std::isnan(mesh.lat[k]) && !std::isnan(mesh.lon[k])) {
      low = std::min(low, mesh.lat[k]);
      high = std::max(high, mesh.lat[k]);
    }
  if (std::isnan(spacing.xi_m) || std::isnan(spacing.eta_m)) return fault("the grid has no two neighbouring positions");
  double step_m = std::min(spacing.xi_m, spacing.eta_m);
  const auto metric = LocalMetric::at(0.5 * (low + high) * kDegree);
  const double coarse_lon = step_m / metric.parallel_radius / kDegree;
  const double height = (high - low) * kDegree * metric.meridian_radius;
  const double width = longitude_arc(mesh, coarse_lon).second * kDegree * metric.parallel_radius;
  const bool fine = 4 * height * width / (step_m * step_m) * static_cast<double>(levels) <= kFineNodes;
  if (fine) step_m /= 2;
  const double dlat = readable(step_m / metric.meridian_radius / kDegree);
  double dlon = readable(step_m / metric.parallel_radius / kDegree);
  const auto [west, span] = longitude_arc(mesh, dlon);
  TargetAxes axes;
  axes.lats = counted(multiples(low, high, dlat));
  if (span == 360) {
    const double columns = std::ceil(360 / dlon);
    dlon = 360 / columns;
    std::vector<double> lons;
    for (double k = 0; k < columns; ++k) lons.push_back(-180 + k * dlon);
    axes.lons = counted(std::move(lons));
  } else {
    axes.lons = counted(multiples(west, west + span, dlon));
  }
  axes.words = "brought onto " + printed("%.5g° of latitude by %.5g° of longitude", dlat, dlon) +
               printed(fine ? " (half the finer median spacing of its points, %.0f m)"
                            : " (the finer median spacing of its points, %.0f m)",
                       fine ? 2 * step_m : step_m, 0);
  return axes;
}

TargetAxes native_axes(SeparableAxes separable) {
  TargetAxes axes;
  for (auto* list : {&separable.lats, &separable.lons})
    if (list->back() < list->front()) std::reverse(list->begin(), list->end());
  axes.lats = counted(std::move(separable.lats));
  axes.lons = counted(std::move(separable.lons));
  axes.native = true;
  axes.words = "kept on its own latitudes and longitudes";
  return axes;
}

}  // namespace

std::vector<double> to_centres(const Faces& faces, std::size_t rows, std::size_t columns,
                               std::span<const double> values, std::span<const std::uint8_t> open) {
  std::vector<double> centres(rows * columns, kNaN);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      double sum = 0;
      int with_value = 0, closed = 0, unknown = 0;
      for (const int side : {0, 1}) {
        const auto face = face_of(faces, j, i, side);
        if (!face) continue;
        if (!open.empty() && open[*face] == 0)
          ++closed;
        else if (std::isnan(values[*face]))
          ++unknown;
        else
          sum += values[*face], ++with_value;
      }
      if (with_value > 0)
        centres[j * columns + i] = sum / with_value;
      else if (closed > 0 && unknown == 0)
        centres[j * columns + i] = 0;
    }
  return centres;
}

std::vector<std::uint8_t> open_faces(const Faces& faces, std::size_t rows, std::size_t columns,
                                     std::span<const std::uint8_t> wet) {
  std::vector<std::uint8_t> open(faces.rows * faces.columns, 1);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      if (wet[j * columns + i] != 0) continue;
      for (const int side : {0, 1})
        if (const auto face = face_of(faces, j, i, side)) open[*face] = 0;
    }
  return open;
}

Result<TargetAxes> target_axes(const Mesh& mesh, std::size_t levels, const std::optional<Area>& area) {
  Result<TargetAxes> axes = [&]() -> Result<TargetAxes> {
    if (auto separable = separable_axes(mesh)) return native_axes(std::move(*separable));
    return even_axes(mesh, levels);
  }();
  if (!axes) return axes;
  if (axes->lats.values.size() < 2 || axes->lons.values.size() < 2)
    return fault("the grid is too small: " + std::to_string(axes->lats.values.size()) + " rows of " +
                 std::to_string(axes->lons.values.size()) + ", allowed is two or more of each");
  if (area) {
    if (auto done = cut(axes->lats, axes->lons, *area); !done) return unexpected(done.error());
  } else {
    const double turn = 360 * std::floor((axes->lons.values.front() + 180) / 360);
    for (double& lon : axes->lons.values) lon -= turn;
  }
  return axes;
}

namespace {

/// Corners of a cell with longitudes on one branch; nothing for cells that hold no node.
std::optional<CellCorners> corners_of(const Mesh& mesh, std::size_t j, std::size_t i) {
  CellCorners corners{};
  const std::size_t at[4] = {mesh.index(j, i), mesh.index(j, i + 1), mesh.index(j + 1, i), mesh.index(j + 1, i + 1)};
  double west = 0, east = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (std::isnan(mesh.lat[at[k]]) || std::isnan(mesh.lon[at[k]])) return std::nullopt;
    const double off = fold_degrees(mesh.lon[at[k]] - mesh.lon[at[0]]);
    west = std::min(west, off);
    east = std::max(east, off);
    corners.x[k] = mesh.lon[at[0]] + off;
    corners.y[k] = mesh.lat[at[k]];
  }
  if (east - west > kWidestCell) return std::nullopt;
  return corners;
}

/// Indices of the axis' values within [low, high], first and one behind the last.
std::pair<std::size_t, std::size_t> within(const std::vector<double>& axis, double low, double high) {
  const auto first = std::lower_bound(axis.begin(), axis.end(), low), last = std::upper_bound(first, axis.end(), high);
  return {static_cast<std::size_t>(first - axis.begin()), static_cast<std::size_t>(last - axis.begin())};
}

}  // namespace

Remap Remap::of(const Mesh& mesh, const std::vector<double>& lats, const std::vector<double>& lons) {
  Remap remap;
  remap.columns_ = mesh.columns;
  remap.places_.resize(lats.size() * lons.size());
  const auto pass = [&](double slack) {
    for (std::size_t j = 0; j + 1 < mesh.rows; ++j)
      for (std::size_t i = 0; i + 1 < mesh.columns; ++i) {
        auto corners = corners_of(mesh, j, i);
        if (!corners) continue;
        const auto [south, north] = std::minmax_element(corners->y, corners->y + 4);
        const double tall = slack * (*north - *south);
        const auto [row, row_end] = within(lats, *south - tall, *north + tall);
        if (row == row_end) continue;
        // The cell on the branch of the axis; its western part may lie beyond the axis' end, one turn on.
        const double turn = 360 * std::floor((corners->x[0] - lons.front()) / 360);
        for (const double branch : {turn, turn + 360, turn - 360}) {
          CellCorners cell = *corners;
          for (double& x : cell.x) x -= branch;
          const auto [west, east] = std::minmax_element(cell.x, cell.x + 4);
          const double wide = slack * (*east - *west);
          const auto [column, column_end] = within(lons, *west - wide, *east + wide);
          for (std::size_t r = row; r < row_end; ++r)
            for (std::size_t c = column; c < column_end; ++c) {
              Place& place = remap.places_[r * lons.size() + c];
              if (place.corner != kOutside) continue;
              if (const auto found = place_in_cell(cell, lons[c], lats[r], slack))
                place = {static_cast<std::uint32_t>(mesh.index(j, i)), found->xi, found->eta};
            }
        }
      }
  };
  pass(1e-9);
  pass(1e-3);  // what only rounding puts outside
  return remap;
}

void Remap::apply(std::span<const double> east, std::span<const double> north, float* out) const {
  for (std::size_t n = 0; n < places_.size(); ++n) {
    const Place& place = places_[n];
    double weight = 0, sum_east = 0, sum_north = 0;
    if (place.corner != kOutside) {
      const std::size_t at[4] = {place.corner, place.corner + 1, place.corner + columns_, place.corner + columns_ + 1};
      const double w[4] = {(1 - place.xi) * (1 - place.eta), place.xi * (1 - place.eta), (1 - place.xi) * place.eta,
                           place.xi * place.eta};
      for (std::size_t k = 0; k < 4; ++k) {
        if (w[k] == 0 || std::isnan(east[at[k]]) || std::isnan(north[at[k]])) continue;
        weight += w[k];
        sum_east += w[k] * east[at[k]];
        sum_north += w[k] * north[at[k]];
      }
    }
    const bool wet = weight >= 0.5;
    out[2 * n] = wet ? static_cast<float>(sum_east / weight) : std::numeric_limits<float>::quiet_NaN();
    out[2 * n + 1] = wet ? static_cast<float>(sum_north / weight) : std::numeric_limits<float>::quiet_NaN();
  }
}

std::size_t Remap::inside() const {
  return static_cast<std::size_t>(
      std::count_if(places_.begin(), places_.end(), [](const Place& place) { return place.corner != kOutside; }));
}

}  // namespace glidehelm::ingest
