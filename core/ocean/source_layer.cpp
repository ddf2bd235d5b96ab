#include "core/ocean/source_layer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace glidehelm::ocean {

namespace {

/// Rows and columns of a source's grid, as plain indices.
struct Nodes {
  const GridAxis &lats, &lons;
  bool around_globe;
  explicit Nodes(const GriddedField& field)
      : lats{field.latitudes()}, lons{field.longitudes()}, around_globe{field.around_globe()} {}
  [[nodiscard]] std::size_t at(std::size_t j, std::size_t i) const { return j * lons.size() + i; }
  /// The column beside one, `by` −1 or +1; none at an edge.
  [[nodiscard]] std::optional<std::size_t> beside(std::size_t i, int by) const {
    if (by < 0) return i > 0 ? std::optional{i - 1} : around_globe ? std::optional{lons.size() - 1} : std::nullopt;
    return i + 1 < lons.size() ? std::optional{i + 1} : around_globe ? std::optional<std::size_t>{0} : std::nullopt;
  }
  [[nodiscard]] std::size_t east_of(std::size_t i) const { return i + 1 < lons.size() ? i + 1 : 0; }
  /// The column at or west of a longitude, and the way to the next; none outside.
  [[nodiscard]] std::optional<AxisPlace> column(double lon) const {
    lon -= 2 * kPi * std::floor((lon - lons.first()) / (2 * kPi));
    if (lons.contains(lon)) return lons.place(lon);
    if (!around_globe) return std::nullopt;
    return AxisPlace{lons.size() - 1, (lon - lons.last()) / (lons.first() + 2 * kPi - lons.last())};
  }
  /// Metres between neighbouring nodes: along the parallel at its end nearer to a pole, so never too much.
  [[nodiscard]] double step(std::size_t j0, std::size_t i0, std::size_t j1, std::size_t i1) const {
    const double east =
        std::remainder(lons.node(i1) - lons.node(i0), 2 * kPi) * std::min(parallel_radius[j0], parallel_radius[j1]);
    const double north = (lats.node(j1) - lats.node(j0)) * LocalMetric::at(0).meridian_radius;
    return std::sqrt(east * east + north * north);
  }
  std::vector<double> parallel_radius{};  ///< by row; only for `step`
  Nodes&& with_steps() && {
    for (std::size_t j = 0; j < lats.size(); ++j)
      parallel_radius.push_back(LocalMetric::at(lats.node(j)).parallel_radius);
    return std::move(*this);
  }
};

constexpr double kFarthest = 20'000;  // metres beyond `blend` to which depth inside is known: longer than any step

/// One sweep of the distance transform, forwards or backwards; true when something became smaller. Distances run along
/// the grid's edges and diagonals: at most 8 % more than the straight way.
bool sweep(const Nodes& nodes, std::vector<float>& inside, bool forwards) {
  const std::size_t rows = nodes.lats.size(), columns = nodes.lons.size();
  bool changed = false;
  for (std::size_t n = 0; n < rows * columns; ++n) {
    const std::size_t node = forwards ? n : rows * columns - 1 - n, j = node / columns, i = node % columns;
    const auto from = [&](std::size_t row, std::optional<std::size_t> column) {
      if (!column) return;
      const auto through =
          static_cast<float>(static_cast<double>(inside[nodes.at(row, *column)]) + nodes.step(j, i, row, *column));
      if (through >= inside[node]) return;
      inside[node] = through;
      changed = true;
    };
    const int back = forwards ? -1 : 1;
    from(j, nodes.beside(i, back));
    if (forwards ? j == 0 : j + 1 == rows) continue;
    const std::size_t row = forwards ? j - 1 : j + 1;
    from(row, nodes.beside(i, -1));
    from(row, i);
    from(row, nodes.beside(i, 1));
  }
  return changed;
}

/// Seams lie at nodes that this source has not and another one has, at their neighbours (no cell with a corner beyond the
/// seam counts: there a value may be borrowed), and at edge nodes that another one has too. The edge of a region is one in
/// any case: who is alone there keeps all of the weight.
void find_seams(const std::vector<CompositeSource>& sources, const Seams& seams, std::vector<SourceLayer>& layers,
                std::size_t s) {
  const Nodes nodes = Nodes{sources[s].field}.with_steps();
  const std::size_t rows = nodes.lats.size(), columns = nodes.lons.size();
  auto& [here, inside, first_s, last_s, fades_in, fades_out] = layers[s];
  inside.assign(rows * columns, static_cast<float>(seams.blend.si() + kFarthest));
  bool any = false;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const bool edge = j == 0 || j + 1 == rows || (!nodes.around_globe && (i == 0 || i + 1 == columns));
      const bool mine = here[nodes.at(j, i)];
      if (mine && !edge) continue;
      const double lat = nodes.lats.node(j), lon = nodes.lons.node(i);
      bool seam = !sources[s].region.contains(lat, lon);
      for (std::size_t o = 0; o < sources.size() && !seam; ++o)
        seam = o != s && has_node_near(sources[o], layers[o], lat, lon);
      if (!seam) continue;
      any = true;
      inside[nodes.at(j, i)] = 0;
      if (mine) continue;
      for (std::size_t row = j > 0 ? j - 1 : j; row <= std::min(j + 1, rows - 1); ++row)
        for (const auto column : {nodes.beside(i, -1), std::optional{i}, nodes.beside(i, 1)})
          if (column) inside[nodes.at(row, *column)] = 0;
    }
  if (!any) return;
  // Two sweeps are enough on a plane; across the cut of a global grid, and where steps differ by row, a few more.
  for (bool changed = true; changed;) {
    changed = sweep(nodes, inside, true);
    changed = sweep(nodes, inside, false) || changed;
  }
}

}  // namespace

std::vector<SourceLayer> find_layers(const std::vector<CompositeSource>& sources, const Seams& seams) {
  std::vector<SourceLayer> layers(sources.size());
  for (std::size_t s = 0; s < sources.size(); ++s) {
    auto& layer = layers[s];
    const auto box = sources[s].field.coverage();
    layer.first_s = std::max(box.first_s, sources[s].from_s);
    layer.last_s = std::min(box.last_s, sources[s].to_s);
    layer.here = sources[s].field.always_wet();
    const Nodes nodes{sources[s].field};
    for (std::size_t n = 0; n < layer.here.size(); ++n)
      layer.here[n] = layer.here[n] && sources[s].region.contains(nodes.lats.node(n / nodes.lons.size()),
                                                                  nodes.lons.node(n % nodes.lons.size()));
  }
  for (std::size_t s = 0; s < sources.size(); ++s) {
    for (const auto& other : layers) {
      layers[s].fades_in = layers[s].fades_in || other.first_s < layers[s].first_s;
      layers[s].fades_out = layers[s].fades_out || other.last_s > layers[s].last_s;
    }
    find_seams(sources, seams, layers, s);
  }
  return layers;
}

bool has_node_near(const CompositeSource& source, const SourceLayer& layer, double lat, double lon) {
  const Nodes nodes{source.field};
  if (!nodes.lats.contains(lat)) return false;
  const auto column = nodes.column(lon);
  if (!column) return false;
  const auto row = nodes.lats.place(lat);
  const std::size_t j = row.fraction < 0.5 ? row.cell : row.cell + 1;
  return layer.here[nodes.at(j, column->fraction < 0.5 ? column->cell : nodes.east_of(column->cell))];
}

double metres_inside(const CompositeSource& source, const SourceLayer& layer, double lat, double lon) {
  const Nodes nodes{source.field};
  if (!nodes.lats.contains(lat)) return 0;
  const auto column = nodes.column(lon);
  if (!column) return 0;
  const auto row = nodes.lats.place(lat);
  const auto& d = layer.inside;
  const auto along = [&](std::size_t j) {
    const double west = static_cast<double>(d[nodes.at(j, column->cell)]);
    return west + column->fraction * (static_cast<double>(d[nodes.at(j, nodes.east_of(column->cell))]) - west);
  };
  const double south = along(row.cell);
  return south + row.fraction * (along(row.cell + 1) - south);
}

double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

double opacity_in_time(const SourceLayer& layer, const Seams& seams, double t_s) {
  double opacity = 1;
  if (layer.fades_in) opacity *= smooth_step((t_s - layer.first_s) / seams.join.count());
  if (layer.fades_out) opacity *= smooth_step((layer.last_s - t_s) / seams.join.count());
  return opacity;
}

}  // namespace glidehelm::ocean
