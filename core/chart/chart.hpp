#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/geo.hpp"

/// Where a glider may be: coast, areas and depth of water.
namespace glidehelm::chart {

class Bathymetry;  // bathymetry.hpp
class Coast;       // coast.hpp

/// A closed polygon of an operating or forbidden area: vertices in order, the last joins the first; edges are geodesics
/// (to 0.1 m; at latitudes where the sides reach beyond 80°, to 1 m); may cross the antimeridian; at least three
/// vertices, less than 180° wide. areas.hpp makes one from untrusted corners.
struct Area {
  std::string name;
  std::vector<GeoPoint> vertices;
  friend bool operator==(const Area&, const Area&) = default;
};

/// What a chart is made of. Without a coast the field's own land is all there is. `keep_in`: the glider stays inside one
/// of them; empty means everywhere. `keep_out`: it stays outside all of them.
struct ChartSources {
  std::shared_ptr<const Coast> coast;
  std::vector<Area> keep_in, keep_out;
  std::shared_ptr<const Bathymetry> bathymetry{};  ///< none: depths are not judged
  Metres least_depth{};                            ///< of the water, with bathymetry
};

/// Land and areas with distance queries. Immutable, const calls are safe from several threads. Radians and metres; any
/// finite longitude (kernels let it run on across the antimeridian). A position that is not finite is outside everything:
/// uncharted, with no clearance.
///
/// `clearance` is the least of these signed distances, so it grows by at most a metre per metre:
/// - to the shoreline: positive in water, negative on land. An edge that closes a ring along the border of the coast file
///   is no shore;
/// - to the border of the coast file: positive inside, negative outside: unknown is forbidden;
/// - to the border of each keep-out area: positive outside, negative inside;
/// - to the border of the keep-in areas: inside, the largest distance to the border of one that holds the position (so
///   two areas that overlap by more than twice a margin can be passed through); outside all, minus the distance to the
///   nearest.
/// A negative value is therefore minus the way out of the worst offence. Error below 0.2 m plus 1e-5 of the distance, at
/// every latitude to 85° and across the antimeridian. Exact up to `kHorizon`; farther away ±`kHorizon` is returned.
///
/// Building one takes the time of some 10^5 clearances beside a detailed shore (a second at most on a slow machine), and
/// 4 MB for the raster; the geometry of the coast is shared through `ChartSources::coast`.
class Chart {
 public:
  static constexpr double kHorizon = 60'000.0;

  Chart();  ///< open ocean: no coast, no areas, clearance is kHorizon everywhere
  explicit Chart(ChartSources sources);
  ~Chart();
  Chart(Chart&&) noexcept;
  Chart& operator=(Chart&&) noexcept;

  [[nodiscard]] bool has_coast() const;
  /// True on land by the coastline (even-odd over its rings, so a lake is water). False without a coast and where the
  /// coast file does not reach.
  [[nodiscard]] bool is_land(GeoPoint p) const;
  /// False where the coast file does not reach; its border belongs to it. True everywhere without a coast.
  [[nodiscard]] bool is_charted(GeoPoint p) const;
  /// Clearance as described above. Some µs, far from land as well as beside a detailed shore.
  [[nodiscard]] double clearance(double lat, double lon) const;
  [[nodiscard]] Metres clearance(GeoPoint p) const { return Metres{clearance(p.lat.radians(), p.lon.radians())}; }
  /// Distance to the nearest shoreline alone (areas and file border left out); negative on land; ±kHorizon beyond it.
  /// Outside the coast file: to the nearest shore that the file knows, positive.
  [[nodiscard]] Metres distance_to_coast(GeoPoint p) const;
  /// True when every point of the segment, straight in latitude and longitude, keeps at least `margin` metres of
  /// clearance. Exact up to the distance error above (with several keep-in areas, or a negative margin, up to 1 m); with
  /// margin 0 a segment may touch a border but not cross it. False when `margin` exceeds kHorizon or anything is not
  /// finite. The fast answers come from a raster of lower bounds (tens of ns); only near a limit is geometry asked
  /// (some µs). Meant for segments up to 60 km; longer ones are answered as exactly.
  ///
  /// With bathymetry the water along it must also be `least_depth` deep (Bathymetry::is_deep_along; unknown is not). A
  /// segment that begins in shallower water may only lead out of it: it ends deeper than it began and, looked at every
  /// quarter of a cell, is nowhere shallower than at its beginning. `clearance` knows nothing of depths.
  [[nodiscard]] bool segment_is_clear(double lat0, double lon0, double lat1, double lon1, double margin) const;
  /// The same, when the caller already knows the clearance of both ends or a lower bound of it (a planner keeps it):
  /// accepts at once when the two discs of clearance cover the segment, else asks as above. Never rejects because of
  /// them: an end that is known to be too near needs no call.
  [[nodiscard]] bool segment_is_clear(double lat0, double lon0, double clearance0, double lat1, double lon1,
                                      double clearance1, double margin) const;
  [[nodiscard]] const Bathymetry* bathymetry() const;  ///< null: depths are not judged
  [[nodiscard]] Metres least_depth() const;            ///< 0 without bathymetry
  /// Lower bound of the clearance from the raster alone: one array read. In water it is below the truth by at most the
  /// larger of one raster cell's diagonal (cells are 250 m, or larger so that there are at most 2^20) and a quarter of the
  /// clearance; on the wrong side of a border it may be far below.
  [[nodiscard]] double clearance_at_least(double lat, double lon) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace glidehelm::chart
