#include "core/ocean/composite.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace glidehelm::ocean {

namespace {

double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

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
constexpr double kSteepest = 1.4143;  // of a bilinear surface whose edges are no steeper than 1

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

}  // namespace

SourceRegion::SourceRegion(std::vector<GeoPoint> corners) : corners_{std::move(corners)} {
  for (const auto& corner : corners_) {
    const double lon = corner.lon.radians();
    lons_.push_back(lons_.empty() ? lon : lons_.back() + std::remainder(lon - lons_.back(), 2 * kPi));
  }
  if (lons_.empty()) return;
  const auto [west, east] = std::minmax_element(lons_.begin(), lons_.end());
  middle_ = 0.5 * (*west + *east);
}

bool SourceRegion::contains(double lat, double lon) const {
  if (corners_.empty()) return true;
  lon = middle_ + std::remainder(lon - middle_, 2 * kPi);
  bool in = false;
  for (std::size_t k = 0, before = corners_.size() - 1; k < corners_.size(); before = k++) {
    const double lat0 = corners_[before].lat.radians(), lat1 = corners_[k].lat.radians();
    if ((lat0 > lat) == (lat1 > lat)) continue;
    if (lons_[before] + (lat - lat0) / (lat1 - lat0) * (lons_[k] - lons_[before]) > lon) in = !in;
  }
  return in;
}

/// A sum under way: what is left for the layers below, and what the layers above gave.
struct CompositeField::Sum {
  double left{1}, east{}, north{};
  bool extrapolated{};
  std::vector<double> shares;
  std::optional<NoCurrent> reason;
};

CompositeField::CompositeField(std::vector<CompositeSource> sources, const Seams& seams)
    : sources_{std::move(sources)}, seams_{seams}, layers_(sources_.size()) {
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    auto& layer = layers_[s];
    const auto box = sources_[s].field.coverage();
    layer.first_s = std::max(box.first_s, sources_[s].from_s);
    layer.last_s = std::min(box.last_s, sources_[s].to_s);
    layer.here = sources_[s].field.always_wet();
    const Nodes nodes{sources_[s].field};
    for (std::size_t n = 0; n < layer.here.size(); ++n)
      layer.here[n] = layer.here[n] && sources_[s].region.contains(nodes.lats.node(n / nodes.lons.size()),
                                                                   nodes.lons.node(n % nodes.lons.size()));
  }
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    for (const auto& other : layers_) {
      layers_[s].fades_in = layers_[s].fades_in || other.first_s < layers_[s].first_s;
      layers_[s].fades_out = layers_[s].fades_out || other.last_s > layers_[s].last_s;
    }
    find_seams(s);
  }
}

/// True when the node nearest to a position is the source's.
bool CompositeField::has_node_near(std::size_t s, double lat, double lon) const {
  const Nodes nodes{sources_[s].field};
  if (!nodes.lats.contains(lat)) return false;
  const auto column = nodes.column(lon);
  if (!column) return false;
  const auto row = nodes.lats.place(lat);
  const std::size_t j = row.fraction < 0.5 ? row.cell : row.cell + 1;
  return layers_[s].here[nodes.at(j, column->fraction < 0.5 ? column->cell : nodes.east_of(column->cell))];
}

/// Seams lie at nodes that this source has not and another one has, at their neighbours (no cell with a corner beyond the
/// seam counts: there a value may be borrowed), and at edge nodes that another one has too. The edge of a region is one in
/// any case: who is alone there keeps all of the weight.
void CompositeField::find_seams(std::size_t s) {
  const Nodes nodes = Nodes{sources_[s].field}.with_steps();
  const std::size_t rows = nodes.lats.size(), columns = nodes.lons.size();
  auto& [here, inside, first_s, last_s, fades_in, fades_out] = layers_[s];
  inside.assign(rows * columns, static_cast<float>(seams_.blend.si() + kFarthest));
  bool any = false;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const bool edge = j == 0 || j + 1 == rows || (!nodes.around_globe && (i == 0 || i + 1 == columns));
      const bool mine = here[nodes.at(j, i)];
      if (mine && !edge) continue;
      const double lat = nodes.lats.node(j), lon = nodes.lons.node(i);
      bool seam = !sources_[s].region.contains(lat, lon);
      for (std::size_t o = 0; o < sources_.size() && !seam; ++o) seam = o != s && has_node_near(o, lat, lon);
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

double CompositeField::inside(std::size_t s, double lat, double lon) const {
  const Nodes nodes{sources_[s].field};
  if (!nodes.lats.contains(lat)) return 0;
  const auto column = nodes.column(lon);
  if (!column) return 0;
  const auto row = nodes.lats.place(lat);
  const auto& d = layers_[s].inside;
  const auto along = [&](std::size_t j) {
    const double west = static_cast<double>(d[nodes.at(j, column->cell)]);
    return west + column->fraction * (static_cast<double>(d[nodes.at(j, nodes.east_of(column->cell))]) - west);
  };
  const double south = along(row.cell);
  return south + row.fraction * (along(row.cell + 1) - south);
}

double CompositeField::in_space(std::size_t s, GeoPoint p) const {
  return smooth_step(inside(s, p.lat.radians(), p.lon.radians()) / seams_.blend.si());
}

double CompositeField::in_time(std::size_t s, double t_s) const {
  const auto& layer = layers_[s];
  double opacity = 1;
  if (layer.fades_in) opacity *= smooth_step((t_s - layer.first_s) / seams_.join.count());
  if (layer.fades_out) opacity *= smooth_step((layer.last_s - t_s) / seams_.join.count());
  return opacity;
}

/// Beyond the times that count, their end holds; beyond its own times the field answers by its own policy.
Expected<Sample, NoCurrent> CompositeField::answer_of(std::size_t s, GeoPoint p, Depth z, double t_s) const {
  const auto& source = sources_[s];
  if (!source.region.contains(p.lat.radians(), p.lon.radians())) return unexpected(NoCurrent::outside_area);
  return source.field.sample(p, z, std::min(std::max(t_s, source.from_s), source.to_s));
}

CompositeField::Sum CompositeField::add_up(GeoPoint p, Depth z, double t_s) const {
  Sum sum;
  sum.shares.assign(sources_.size(), 0.0);
  enum Pass { by_space_and_time, by_space, whoever };
  for (const auto pass : {by_space_and_time, by_space, whoever})
    for (std::size_t s = 0; s < sources_.size() && sum.left > 0; ++s) {
      double opacity = pass == whoever ? 1 : in_space(s, p);
      if (pass == by_space_and_time && opacity > 0) opacity *= in_time(s, t_s);
      if (opacity <= 0) continue;
      const auto value = answer_of(s, p, z, t_s);
      if (!value) {
        if (pass == whoever && (!sum.reason || sum.reason == NoCurrent::outside_area)) sum.reason = value.error();
        continue;
      }
      const double share = sum.left * opacity;
      sum.left = opacity < 1 ? sum.left - share : 0;
      sum.shares[s] += share;
      sum.east += share * value->current.east.si();
      sum.north += share * value->current.north.si();
      sum.extrapolated = sum.extrapolated || value->extrapolated;
    }
  return sum;
}

Expected<Sample, NoCurrent> CompositeField::sample(GeoPoint p, Depth z, double t_s) const {
  const auto sum = add_up(p, z, t_s);
  if (sum.left > 0) return unexpected(sum.reason.value_or(NoCurrent::no_data));
  return Sample{{MetresPerSecond{sum.east}, MetresPerSecond{sum.north}}, sum.extrapolated};
}

std::vector<double> CompositeField::weights(GeoPoint p, Depth z, double t_s) const { return add_up(p, z, t_s).shares; }

bool CompositeField::surely_opaque(std::size_t s, double lat, double lon, double reach, double t_s, double dt) const {
  const double from = std::min(t_s, t_s + dt), to = std::max(t_s, t_s + dt);
  return inside(s, lat, lon) - kSteepest * reach >= seams_.blend.si() && in_time(s, from) == 1 && in_time(s, to) == 1 &&
         from >= sources_[s].from_s && to <= sources_[s].to_s;
}

bool CompositeField::surely_away(std::size_t s, double lat, double lon, double reach) const {
  auto box = sources_[s].field.coverage();
  const double up = reach / 6.3e6, aside = up / std::max(1e-3, std::cos(std::min(std::abs(lat) + up, 1.57)));
  box.south -= up, box.north += up, box.west -= aside, box.east += aside;
  return !box.contains(GeoPoint::from_kernel(lat, lon));
}

/// The source that has all of the weight within `reach` metres and during the step; sources_.size() when that is not
/// certain.
std::size_t CompositeField::owner(double lat, double lon, double reach, double t_s, double dt) const {
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    if (surely_opaque(s, lat, lon, reach, t_s, dt)) return s;
    if (!surely_away(s, lat, lon, reach)) break;
  }
  return sources_.size();
}

void CompositeField::advance(Lanes& lanes, double t_s, double dt) const {
  const auto count = static_cast<std::size_t>(lanes.count);
  const double fast = fastest().si();
  constexpr std::uint8_t kElsewhere = 255;
  std::array<std::size_t, Lanes::kMax> owners{};
  for (std::size_t k = 0; k < count; ++k) {
    const double reach = std::abs(dt) * (std::hypot(lanes.water_east[k], lanes.water_north[k]) + fast);
    owners[k] = lanes.lost[k] != 0 ? sources_.size() + 1 : owner(lanes.lat[k], lanes.lon[k], reach, t_s, dt);
  }
  const Lanes start = lanes;
  for (std::size_t s = 0; s <= sources_.size(); ++s) {
    Lanes mine = start;
    bool any = false;
    for (std::size_t k = 0; k < count; ++k) {
      if (owners[k] != s) mine.lost[k] = kElsewhere;
      any = any || owners[k] == s;
    }
    if (!any) continue;
    s < sources_.size() ? sources_[s].field.advance(mine, t_s, dt) : advance_by_samples(*this, mine, t_s, dt);
    for (std::size_t k = 0; k < count; ++k) {
      if (owners[k] != s) continue;
      if (mine.lost[k] != 0 && s < sources_.size()) {
        owners[k] = sources_.size();  // another source may answer where this one does not
        continue;
      }
      lanes.lat[k] = mine.lat[k];
      lanes.lon[k] = mine.lon[k];
      lanes.lost[k] = mine.lost[k];
    }
  }
}

Coverage CompositeField::coverage() const {
  Coverage all = sources_.front().field.coverage();
  all.holds_outside = false;
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    auto box = sources_[s].field.coverage();
    all.south = std::min(all.south, box.south);
    all.north = std::max(all.north, box.north);
    // In the frame of the first: the turn that makes the common box narrowest.
    const double turn = 2 * kPi * std::round((0.5 * (all.west + all.east) - 0.5 * (box.west + box.east)) / (2 * kPi));
    all.west = std::min(all.west, box.west + turn);
    all.east = std::max(all.east, box.east + turn);
    all.first_s = s == 0 ? layers_[s].first_s : std::min(all.first_s, layers_[s].first_s);
    all.last_s = s == 0 ? layers_[s].last_s : std::max(all.last_s, layers_[s].last_s);
    all.holds_outside = all.holds_outside || box.holds_outside;
  }
  all.east = std::min(all.east, all.west + 2 * kPi);
  return all;
}

MetresPerSecond CompositeField::fastest() const {
  double fastest = 0;
  for (const auto& source : sources_) fastest = std::max(fastest, source.field.fastest().si());
  return MetresPerSecond{fastest * (1 + 1e-12)};  // shares that sum to 1 but for rounding
}

std::vector<std::string> CompositeField::faults() const {
  std::vector<std::string> faults;
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const auto& layer = layers_[s];
    const auto name = "source '" + sources_[s].name + "' ";
    if (layer.first_s > layer.last_s) faults.push_back(name + "has no times in the time that it is to be used");
    bool deep = false, here = false;
    for (std::size_t n = 0; n < layer.here.size(); ++n) {
      here = here || layer.here[n];
      deep = deep || (layer.here[n] && layer.inside[n] > 0);
    }
    if (!here)
      faults.push_back(name + "has no node with a current at all its times inside its region");
    else if (!deep)
      faults.push_back(name + "is nowhere wider than the cells at its edges: it is never used");
    bool meets = sources_.size() == 1;
    for (std::size_t o = 0; o < sources_.size(); ++o) {
      if (o == s) continue;
      const auto& other = layers_[o];
      const Nodes nodes{sources_[s].field};
      for (std::size_t n = 0; n < layer.here.size() && !meets; ++n)
        meets = layer.here[n] &&
                has_node_near(o, nodes.lats.node(n / nodes.lons.size()), nodes.lons.node(n % nodes.lons.size()));
      const double overlap = std::min(layer.last_s, other.last_s) - std::max(layer.first_s, other.first_s);
      const bool hands_over = layer.last_s < other.last_s && layer.first_s <= layer.last_s;
      if (hands_over && overlap < seams_.join.count()) {
        char text[96];
        std::snprintf(text, sizeof text, "overlap by %.1f h, join_h is %.1f", overlap / 3600,
                      seams_.join.count() / 3600);
        faults.push_back(name + "and source '" + sources_[o].name + "' " + text);
      }
    }
    if (here && !meets) faults.push_back(name + "overlaps no other source");
  }
  return faults;
}

}  // namespace glidehelm::ocean
