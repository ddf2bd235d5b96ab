#include "core/chart/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/chart/areas.hpp"
#include "core/chart/bathymetry.hpp"
#include "core/chart/clearance_raster.hpp"
#include "core/chart/coast.hpp"

namespace glidehelm::chart {

namespace {

/// Where along a margin that is judged point by point the next point is looked at, at the latest.
constexpr double kNearestStep = 0.5;

struct Segment {
  double lat, lon, dlat, dlon;
  [[nodiscard]] double lat_at(double t) const { return lat + t * dlat; }
  [[nodiscard]] double lon_at(double t) const { return lon + t * dlon; }
};

std::vector<Region> regions_of(const std::vector<Area>& areas) {
  std::vector<Region> regions;
  regions.reserve(areas.size());
  for (const auto& area : areas) regions.push_back(region_of(area));
  return regions;
}

/// The smallest box around regions, or nothing when there is none or it would reach around the Earth.
std::optional<RasterBox> box_around(const std::vector<Region>& regions) {
  std::optional<RasterBox> box;
  double anchor = 0, east = 0, north = 0;
  for (const auto& region : regions)
    for (const auto& p : region.outline().plane) {
      const double lon = region.outline().middle + p.x;
      if (!box) {
        anchor = east = lon;
        north = p.y;
        box = RasterBox{lon, 0, p.y, 0};
      }
      const double x = anchor + folded(lon - anchor);
      box->west = std::min(box->west, x);
      box->south = std::min(box->south, p.y);
      east = std::max(east, x);
      north = std::max(north, p.y);
    }
  if (!box) return std::nullopt;
  box->width = east - box->west;
  box->height = north - box->south;
  if (!(box->width > 0 && box->height > 0 && box->width < kPi)) return std::nullopt;
  return box;
}

/// The part of `a` that lies in `b`; nothing when there is none.
std::optional<RasterBox> common(const RasterBox& a, const RasterBox& b) {
  const double shift = a.west + folded(b.west + 0.5 * b.width - a.west - 0.5 * a.width) + 0.5 * (a.width - b.width);
  const double west = std::max(a.west, shift), east = std::min(a.west + a.width, shift + b.width);
  const double south = std::max(a.south, b.south), north = std::min(a.south + a.height, b.south + b.height);
  if (!(east > west && north > south)) return std::nullopt;
  return RasterBox{west, east - west, south, north - south};
}

RasterBox box_of(const CoastArea& area) {
  const double k = kPi / (180.0 * kCoastUnitsPerDegree);
  return {static_cast<double>(area.west) * k, static_cast<double>(area.width()) * k,
          static_cast<double>(area.south) * k, static_cast<double>(area.height()) * k};
}

}  // namespace

struct Chart::Parts {
  std::shared_ptr<const Coast> coast;
  std::shared_ptr<const Bathymetry> bathymetry;
  double least_depth{};
  std::vector<Region> keep_in, keep_out;
  bool bounded{};  ///< there are keep-in areas
  ClearanceRaster raster{kHorizon};

  explicit Parts(ChartSources sources)
      : coast{std::move(sources.coast)},
        bathymetry{std::move(sources.bathymetry)},
        least_depth{sources.least_depth.si()},
        keep_in{regions_of(sources.keep_in)},
        keep_out{regions_of(sources.keep_out)},
        bounded{!sources.keep_in.empty()} {
    raster = make_raster();
  }

  [[nodiscard]] ClearanceRaster make_raster() const;
  [[nodiscard]] double clearance(double lat, double lon, double at_most) const;
  [[nodiscard]] double inside_keep_in(double lat, double lon, const Space& p, double at_most) const;
  [[nodiscard]] bool allowed(double lat, double lon) const;
  [[nodiscard]] bool is_deep(const Segment& way) const;
  [[nodiscard]] bool is_clear(const Segment& way, double margin) const;
  [[nodiscard]] bool piece_is_clear(const Segment& way, double from, double to, double margin) const;
  [[nodiscard]] bool kept_in(const Segment& way, double from, double to, double margin) const;
  [[nodiscard]] bool is_clear_step_by_step(const Segment& way, double margin) const;
};

ClearanceRaster Chart::Parts::make_raster() const {
  // Outside the coast file and outside the keep-in areas nothing is allowed; outside the reach of keep-out areas all is.
  std::optional<RasterBox> box;
  if (coast) box = box_of(coast->area());
  double outside = -kHorizon;
  if (bounded) {
    const auto allowed_box = box_around(keep_in);
    if (!box)
      box = allowed_box;
    else if (allowed_box)
      box = common(*box, *allowed_box);
    if (!box) return ClearanceRaster{-kHorizon};
  } else if (!box) {
    box = box_around(keep_out);
    if (!box) return ClearanceRaster{keep_out.empty() ? kHorizon : -kHorizon};
    // The clearance is kHorizon beyond kHorizon from the areas; at 85° a kilometre is 0.1° of longitude.
    const double reach = 1.01 * kHorizon / LocalMetric::at(0).meridian_radius;
    const double farthest = std::min(1.5, std::max(std::abs(box->south), std::abs(box->south + box->height)) + reach);
    const double across = 1.01 * kHorizon / LocalMetric::at(farthest).parallel_radius;
    if (box->width + 2 * across >= 2 * kPi) return ClearanceRaster{-kHorizon};
    *box = {box->west - across, box->width + 2 * across, box->south - reach, box->height + 2 * reach};
    outside = kHorizon;
  }
  return {*box, outside, kHorizon,
          [this](double lat, double lon, double at_most) { return clearance(lat, lon, at_most); }};
}

double Chart::Parts::inside_keep_in(double lat, double lon, const Space& p, double at_most) const {
  double inside = -1, outside = at_most;
  for (const auto& region : keep_in) {
    if (region.contains(lat, lon))
      inside = std::max(inside, region.distance(p, at_most));
    else if (inside < 0)
      outside = region.distance(p, outside);
  }
  return inside >= 0 ? inside : -outside;
}

double Chart::Parts::clearance(double lat, double lon, double at_most) const {
  const auto p = Space::at(lat, lon);
  double least = at_most;
  // A positive distance matters only while nothing is violated, and only below the least one found.
  const auto take = [&](const Region& region, bool violated) {
    if (violated)
      least = std::min(least, -region.distance(p, at_most));
    else if (least > 0)
      least = std::min(least, region.distance(p, least));
  };
  if (coast) {
    const bool charted = coast->covers(lat, lon);
    take(coast->land(), charted && coast->land().contains(lat, lon));
    take(coast->charted(), !charted);
  }
  for (const auto& region : keep_out) take(region, region.contains(lat, lon));
  if (bounded) least = std::min(least, inside_keep_in(lat, lon, p, at_most));
  return least;
}

bool Chart::Parts::allowed(double lat, double lon) const {
  if (coast && (!coast->covers(lat, lon) || coast->land().contains(lat, lon))) return false;
  for (const auto& region : keep_out)
    if (region.contains(lat, lon)) return false;
  return true;
}

bool Chart::Parts::kept_in(const Segment& way, double from, double to, double margin) const {
  const double lat = way.lat_at(from), lon = way.lon_at(from);
  for (const auto& region : keep_in)
    if (region.contains(lat, lon) && !region.touches(lat, lon, way.lat_at(to), way.lon_at(to), margin)) return true;
  if (keep_in.size() == 1) return false;
  const double middle = 0.5 * (from + to);
  const double here = inside_keep_in(way.lat_at(middle), way.lon_at(middle),
                                     Space::at(way.lat_at(middle), way.lon_at(middle)), kHorizon);
  if (here < margin) return false;
  // The way may change from one area into another: somewhere both hold it.
  if (ClearanceRaster::length_at_most(lat, (to - from) * way.dlat, (to - from) * way.dlon) < kNearestStep) return true;
  return kept_in(way, from, middle, margin) && kept_in(way, middle, to, margin);
}

bool Chart::Parts::piece_is_clear(const Segment& way, double from, double to, double margin) const {
  const double lat0 = way.lat_at(from), lon0 = way.lon_at(from), lat1 = way.lat_at(to), lon1 = way.lon_at(to);
  const auto touched = [&](const Region& region) { return region.touches(lat0, lon0, lat1, lon1, margin); };
  if (coast && (touched(coast->land()) || touched(coast->charted()))) return false;
  if (std::any_of(keep_out.begin(), keep_out.end(), touched)) return false;
  return !bounded || kept_in(way, from, to, margin);
}

bool Chart::Parts::is_deep(const Segment& way) const {
  if (bathymetry->is_deep_along(way.lat, way.lon, way.lat_at(1), way.lon_at(1), least_depth)) return true;
  const double begin = bathymetry->depth(way.lat, way.lon), end = bathymetry->depth(way.lat_at(1), way.lon_at(1));
  if (begin >= least_depth || !(end > begin)) return false;
  const auto& grid = bathymetry->grid();
  const double cells = std::max(std::abs(way.dlat) / grid.lat_step_deg, std::abs(way.dlon) / grid.lon_step_deg);
  const int looks = static_cast<int>(std::min(1000.0, std::ceil(4 * cells * 180 / kPi)));
  for (int k = 1; k < looks; ++k)
    if (bathymetry->depth(way.lat_at(double(k) / looks), way.lon_at(double(k) / looks)) < begin) return false;
  return true;
}

bool Chart::Parts::is_clear(const Segment& way, double margin) const {
  // A way that begins and ends on the right side and touches no border on it stays on the right side. (On which side it
  // is of the keep-in areas, each piece looks for itself.)
  if (!allowed(way.lat, way.lon) || !allowed(way.lat_at(1), way.lon_at(1))) return false;
  struct Part {
    double from, to;
  };
  std::array<Part, 64> stack;
  std::size_t waiting = 0;
  stack[waiting++] = {0, 1};
  while (waiting > 0) {
    const auto [from, to] = stack[--waiting];
    const double middle = 0.5 * (from + to), lat = way.lat_at(middle);
    const double dlat = 0.5 * (to - from) * way.dlat, dlon = 0.5 * (to - from) * way.dlon;
    const double half =
        std::max(ClearanceRaster::length_at_most(lat, dlat, dlon), ClearanceRaster::length_at_most(lat, -dlat, dlon));
    if (raster.at_least(lat, way.lon_at(middle)) - margin >= half) continue;
    if (2 * half <= longest_piece(std::abs(lat) + std::abs(dlat)) || waiting + 2 > stack.size()) {
      if (!piece_is_clear(way, from, to, margin)) return false;
      continue;
    }
    stack[waiting++] = {middle, to};
    stack[waiting++] = {from, middle};
  }
  return true;
}

bool Chart::Parts::is_clear_step_by_step(const Segment& way, double margin) const {
  const double length = ClearanceRaster::length_at_most(way.lat, way.dlat, way.dlon);
  for (double at = 0;;) {
    const double t = length > 0 ? std::min(1.0, at / length) : 1.0;
    const double here = clearance(way.lat_at(t), way.lon_at(t), kHorizon);
    if (here < margin) return false;
    if (t >= 1) return true;
    at += std::max(here - margin, kNearestStep);
  }
}

Chart::Chart() = default;
Chart::Chart(ChartSources sources) : parts_{std::make_unique<Parts>(std::move(sources))} {}
Chart::~Chart() = default;
Chart::Chart(Chart&&) noexcept = default;
Chart& Chart::operator=(Chart&&) noexcept = default;

bool Chart::has_coast() const { return parts_ && parts_->coast; }

bool Chart::is_land(GeoPoint p) const {
  if (!has_coast()) return false;
  const double lat = p.lat.radians(), lon = p.lon.radians();
  if (parts_->raster.at_least(lat, lon) > 0) return false;
  return parts_->coast->covers(lat, lon) && parts_->coast->land().contains(lat, lon);
}

bool Chart::is_charted(GeoPoint p) const {
  return !has_coast() || parts_->coast->covers(p.lat.radians(), p.lon.radians());
}

double Chart::clearance(double lat, double lon) const {
  if (!std::isfinite(lat) || !std::isfinite(lon)) return -kHorizon;
  return parts_ ? parts_->clearance(lat, lon, kHorizon) : kHorizon;
}

Metres Chart::distance_to_coast(GeoPoint p) const {
  if (!has_coast()) return Metres{kHorizon};
  const double lat = p.lat.radians(), lon = p.lon.radians();
  const auto& coast = *parts_->coast;
  const double distance = coast.land().distance(Space::at(lat, lon), kHorizon);
  return Metres{coast.covers(lat, lon) && coast.land().contains(lat, lon) ? -distance : distance};
}

const Bathymetry* Chart::bathymetry() const { return parts_ ? parts_->bathymetry.get() : nullptr; }
Metres Chart::least_depth() const { return Metres{bathymetry() ? parts_->least_depth : 0.0}; }

double Chart::clearance_at_least(double lat, double lon) const {
  if (!parts_) return std::isfinite(lat) && std::isfinite(lon) ? kHorizon : -kHorizon;
  return parts_->raster.at_least(lat, lon);
}

bool Chart::segment_is_clear(double lat0, double lon0, double lat1, double lon1, double margin) const {
  return segment_is_clear(lat0, lon0, clearance_at_least(lat0, lon0), lat1, lon1, clearance_at_least(lat1, lon1),
                          margin);
}

bool Chart::segment_is_clear(double lat0, double lon0, double clearance0, double lat1, double lon1, double clearance1,
                             double margin) const {
  const Segment way{lat0, lon0, lat1 - lat0, folded(lon1 - lon0)};
  if (parts_ && parts_->bathymetry && !parts_->is_deep(way)) return false;
  const double room0 = clearance0 - margin, room1 = clearance1 - margin;
  if (room0 >= 0 && room1 >= 0 && room0 + room1 >= ClearanceRaster::length_at_most(lat0, way.dlat, way.dlon))
    return true;
  if (!(margin <= kHorizon) || !std::isfinite(lat0 + lon0 + lat1 + lon1)) return false;
  if (!parts_) return true;
  return margin >= 0 ? parts_->is_clear(way, margin) : parts_->is_clear_step_by_step(way, margin);
}

}  // namespace glidehelm::chart
