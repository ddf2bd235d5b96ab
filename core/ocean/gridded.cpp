#include "core/ocean/gridded.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/ocean/bilinear.hpp"

namespace glidehelm::ocean {

namespace {

Expected<Sample, NoCurrent> answer(double east, double north, bool borrowed) {
  return Sample{{MetresPerSecond{east}, MetresPerSecond{north}}, borrowed};
}

/// True when the gap between the last and the first column is no wider than the columns' own steps.
bool closes_around_globe(const std::vector<double>& lons) {
  double widest = 0;
  for (std::size_t i = 1; i < lons.size(); ++i) widest = std::max(widest, lons[i] - lons[i - 1]);
  return 360.0 - (lons.back() - lons.front()) <= 1.001 * widest;
}

}  // namespace

GriddedField::GriddedField(const GridView& view, const GriddedOptions& options, std::shared_ptr<const void> keep_alive)
    : keep_alive_{std::move(keep_alive)},
      values_{view.values},
      times_{view.axes.times_s, view.axes.has_time, options.outside_time},
      depths_{view.axes.depths_m},
      lats_{view.axes.lats_deg},
      lons_{view.axes.lons_deg},
      around_globe_{closes_around_globe(view.axes.lons_deg)},
      options_{options},
      metric_{std::make_shared<const MetricTable>(lats_.first(), lats_.last())} {
  row_stride_ = 2 * lons_.size();
  level_stride_ = row_stride_ * lats_.size();
  time_stride_ = level_stride_ * depths_.size();
  if (!view.filled.empty()) {
    auto filled = std::make_shared<std::vector<bool>>(view.axes.nodes(), false);
    for (const auto& run : view.filled)
      std::fill_n(filled->begin() + static_cast<std::ptrdiff_t>(run.first), run.length, true);
    filled_ = std::move(filled);
  }
  find_fastest();
}

GriddedField::GriddedField(Grid grid, const GriddedOptions& options)
    : GriddedField{[&] {
        auto owner = std::make_shared<const Grid>(std::move(grid));
        return GriddedField{view_of(*owner), options, owner};
      }()} {}

GriddedField GriddedField::shallowest() const {
  GriddedField top = *this;
  top.depths_.resize(1);
  if (levels() > 1) top.find_fastest();
  return top;
}

void GriddedField::find_fastest() {
  double squared = 0;
  for (std::size_t t = 0; t < times_.times().size(); ++t)
    for (std::size_t k = 0; k < depths_.size(); ++k) {
      const float* from = slice(t, k);
      for (std::size_t n = 0; n < level_stride_; n += 2) {
        const double east = from[n], north = from[n + 1];
        // False for NaN, so a dry node never counts.
        if (east * east + north * north > squared) squared = east * east + north * north;
      }
    }
  // Means of nodes are no faster than the fastest node; 2e-6 covers the rounding of the float kernel.
  const auto how = options_.interpolation;
  fastest_ = std::sqrt(squared) * (1 + 2e-6) * overshoot_bound(how, step_ratio(times_.times()));
  if (levels() > 1) fastest_ *= overshoot_bound(how, step_ratio(depths_));
}

std::vector<bool> GriddedField::always_wet() const {
  const std::size_t plane = lats_.size() * lons_.size();
  std::vector<bool> wet(plane, true);
  for (std::size_t t = 0; t < times_.times().size(); ++t)
    for (std::size_t n = 0; n < plane; ++n)
      if (std::isnan(slice(t, 0)[2 * n])) wet[n] = false;
  return wet;
}

Coverage GriddedField::coverage() const {
  Coverage box;
  box.south = lats_.first();
  box.north = lats_.last();
  box.west = lons_.first();
  box.east = around_globe_ ? lons_.first() + 2 * kPi : lons_.last();
  if (times_.meaningful()) {
    box.first_s = times_.times().front();
    box.last_s = times_.times().back();
    box.holds_outside = times_.policy() != OutsideTime::forbid;
  }
  return box;
}

bool GriddedField::locate(double lat, double lon, Place& place) const {
  if (!lats_.contains(lat)) return false;
  const double west = lons_.first(), edge = around_globe_ ? west + 2 * kPi : lons_.last();
  if (!(lon >= west && lon <= edge)) lon -= 2 * kPi * std::floor((lon - west) / (2 * kPi));
  if (!(lon >= west && lon <= edge)) return false;

  const AxisPlace row = lats_.place(lat);
  AxisPlace column;
  if (lon <= lons_.last()) {
    column = lons_.place(lon);
    place.east = column.cell + 1;
  } else {
    column = {lons_.size() - 1, (lon - lons_.last()) / (edge - lons_.last())};
    place.east = 0;
  }
  place.j = row.cell;
  place.i = column.cell;
  place.v = static_cast<double>(row.cell) + row.fraction;
  place.u = static_cast<double>(column.cell) + column.fraction;
  const bool nearest = options_.interpolation == Interpolation::nearest;
  place.fy = nearest ? (row.fraction < 0.5 ? 0.0F : 1.0F) : static_cast<float>(row.fraction);
  place.fx = nearest ? (column.fraction < 0.5 ? 0.0F : 1.0F) : static_cast<float>(column.fraction);
  return true;
}

bool GriddedField::over_filled(const float* slice, const Place& place) const {
  if (!filled_) return false;
  const auto base = static_cast<std::size_t>(slice - values_) / 2;
  const std::size_t columns = lons_.size();
  const auto marked = [&](std::size_t j, std::size_t i, double weight) {
    return weight > 0 && (*filled_)[base + j * columns + i];
  };
  const double fx = place.fx, fy = place.fy;
  return marked(place.j, place.i, (1 - fx) * (1 - fy)) || marked(place.j, place.east, fx * (1 - fy)) ||
         marked(place.j + 1, place.i, (1 - fx) * fy) || marked(place.j + 1, place.east, fx * fy);
}

GriddedField::Spot GriddedField::wet_mean(const float* slice, const Place& place) const {
  const float* corner = slice + place.j * row_stride_ + 2 * place.i;
  const std::array<const float*, 4> corners{corner, slice + place.j * row_stride_ + 2 * place.east,
                                            slice + (place.j + 1) * row_stride_ + 2 * place.i,
                                            slice + (place.j + 1) * row_stride_ + 2 * place.east};
  if (place.east == place.i + 1) {
    const auto mean = bilinear_at(corner, row_stride_, place.fx, place.fy);
    if (mean[0] == mean[0]) return {mean[0], mean[1], true, over_filled(slice, place), 0};
  }
  const double fx = place.fx, fy = place.fy;
  const std::array<double, 4> weights{(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
  double east = 0, north = 0, wet = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    if (std::isnan(*corners[c]) || weights[c] == 0) continue;
    wet += weights[c];
    east += weights[c] * static_cast<double>(corners[c][0]);
    north += weights[c] * static_cast<double>(corners[c][1]);
  }
  if (wet < 0.5) return {};
  return {static_cast<float>(east / wet), static_cast<float>(north / wet), true, over_filled(slice, place), 0};
}

GriddedField::Spot GriddedField::borrow(const float* slice, const Place& place) const {
  if (options_.mask_is_land) return {};
  const double reach = options_.coastal_fill_cells;
  const auto rows = static_cast<std::int64_t>(lats_.size()), columns = static_cast<std::int64_t>(lons_.size());
  const auto first_row = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(place.v - reach)));
  const auto last_row = std::min(rows - 1, static_cast<std::int64_t>(std::floor(place.v + reach)));
  auto first = static_cast<std::int64_t>(std::ceil(place.u - reach));
  auto last = static_cast<std::int64_t>(std::floor(place.u + reach));
  if (!around_globe_) {
    first = std::max<std::int64_t>(0, first);
    last = std::min(columns - 1, last);
  }
  double best = reach * reach * (1 + 1e-12);
  Spot spot;
  for (std::int64_t j = first_row; j <= last_row; ++j)
    for (std::int64_t column = first; column <= last; ++column) {
      const std::int64_t i = ((column % columns) + columns) % columns;
      const auto node = static_cast<std::size_t>(j) * row_stride_ + 2 * static_cast<std::size_t>(i);
      if (std::isnan(slice[node])) continue;
      const double dy = static_cast<double>(j) - place.v, dx = static_cast<double>(column) - place.u;
      const double distance = dx * dx + dy * dy;
      if (spot.wet ? distance >= best : distance > best) continue;
      best = distance;
      spot = {slice[node], slice[node + 1], true, true, node};
    }
  return spot;
}

GriddedField::Answer GriddedField::between_levels(const Place& place, std::size_t level, double fraction,
                                                  std::size_t time) const {
  Spot upper = wet_mean(slice(time, level), place);
  Spot lower = fraction > 0 ? wet_mean(slice(time, level + 1), place) : upper;
  if (!upper.wet || !lower.wet) {
    // Dry here: is it the coast, or the bottom under water that the shallowest level has?
    if (wet_mean(slice(time, 0), place).wet) return unexpected(NoCurrent::below_bottom);
    const Spot coast = borrow(slice(time, 0), place);
    if (!coast.wet) return unexpected(options_.mask_is_land ? NoCurrent::land : NoCurrent::no_data);
    const auto of_node = [&](std::size_t k) {
      const float* at = slice(time, k) + coast.node;
      return Spot{at[0], at[1], !std::isnan(at[0]), true, coast.node};
    };
    upper = of_node(level);
    lower = fraction > 0 ? of_node(level + 1) : upper;
    if (!upper.wet || !lower.wet) return unexpected(NoCurrent::below_bottom);
  }
  const auto blend = [fraction](float a, float b) {
    return static_cast<double>(a) + fraction * (static_cast<double>(b) - static_cast<double>(a));
  };
  return answer(blend(upper.east, lower.east), blend(upper.north, lower.north), upper.borrowed || lower.borrowed);
}

template <class At>
GriddedField::Answer GriddedField::smooth(const std::vector<double>& axis, std::size_t k, double fraction,
                                          const At& at) const {
  const std::size_t from = k >= 2 ? k - 2 : 0, to = std::min(axis.size() - 1, k + 3);
  std::array<double, 6> x{}, east{}, north{};
  std::size_t count = 0, here = 0;
  bool borrowed = false;
  for (std::size_t n = from; n <= to; ++n) {
    const auto value = at(n);
    if (!value) {
      // A neighbour without a value ends the axis there; the two around the place must have one.
      if (n == k || n == k + 1) return value;
      if (n > k) break;
      count = 0;
      borrowed = false;
      continue;
    }
    if (n == k) here = count;
    x[count] = axis[n];
    east[count] = value->current.east.si();
    north[count] = value->current.north.si();
    borrowed = borrowed || value->extrapolated;
    ++count;
  }
  const std::span<const double> known{x.data(), count};
  return answer(interpolate(options_.interpolation, known, {east.data(), count}, here, fraction),
                interpolate(options_.interpolation, known, {north.data(), count}, here, fraction), borrowed);
}

GriddedField::Answer GriddedField::at_time(const Place& place, double depth, std::size_t time) const {
  if (depths_.size() == 1 || depth <= depths_.front()) return between_levels(place, 0, 0, time);
  if (depth > depths_.back()) {
    const auto top = between_levels(place, 0, 0, time);
    return top ? Answer{unexpected(NoCurrent::below_bottom)} : top;
  }
  const auto above = std::upper_bound(depths_.begin(), depths_.end(), depth);
  const auto level = static_cast<std::size_t>(above - depths_.begin()) - 1;
  if (level + 1 == depths_.size() || depth == depths_[level]) return between_levels(place, level, 0, time);
  double fraction = (depth - depths_[level]) / (depths_[level + 1] - depths_[level]);
  if (options_.interpolation == Interpolation::nearest)
    return between_levels(place, fraction < 0.5 ? level : level + 1, 0, time);
  if (options_.interpolation == Interpolation::linear) return between_levels(place, level, fraction, time);
  return smooth(depths_, level, fraction, [&](std::size_t k) { return between_levels(place, k, 0, time); });
}

GriddedField::Answer GriddedField::in_time(const Place& place, double depth, const TimeBracket& bracket) const {
  if (bracket.next == bracket.first) return at_time(place, depth, bracket.first);
  if (options_.interpolation == Interpolation::nearest)
    return at_time(place, depth, bracket.fraction < 0.5 ? bracket.first : bracket.next);
  if (options_.interpolation != Interpolation::linear)
    return smooth(times_.times(), bracket.first, bracket.fraction,
                  [&](std::size_t k) { return at_time(place, depth, k); });

  if (depths_.size() == 1 && place.east == place.i + 1) {
    const std::size_t corner = place.j * row_stride_ + 2 * place.i;
    const auto mean = bilinear_between(slice(bracket.first, 0) + corner, slice(bracket.next, 0) + corner, row_stride_,
                                       place.fx, place.fy, static_cast<float>(bracket.fraction));
    if (mean[0] == mean[0])
      return answer(mean[0], mean[1],
                    over_filled(slice(bracket.first, 0), place) || over_filled(slice(bracket.next, 0), place));
  }
  const auto before = at_time(place, depth, bracket.first);
  if (!before) return before;
  const auto behind = at_time(place, depth, bracket.next);
  if (!behind) return behind;
  const auto blend = [&](MetresPerSecond a, MetresPerSecond b) {
    return a.si() + bracket.fraction * (b.si() - a.si());
  };
  return answer(blend(before->current.east, behind->current.east), blend(before->current.north, behind->current.north),
                before->extrapolated || behind->extrapolated);
}

GriddedField::Answer GriddedField::at(double lat, double lon, double depth, double t_s) const {
  Place place;
  if (!locate(lat, lon, place)) return unexpected(NoCurrent::outside_area);
  const auto bracket = times_.bracket(t_s);
  if (!bracket) return unexpected(NoCurrent::outside_time);
  return in_time(place, depth, *bracket);
}

Expected<Sample, NoCurrent> GriddedField::sample(GeoPoint p, Depth z, double t_s) const {
  return at(p.lat.radians(), p.lon.radians(), z.below_surface.si(), t_s);
}

}  // namespace glidehelm::ocean
