#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/geo.hpp"

/// Where a glider may be: coast and areas.
namespace glidehelm::chart {

class Coast;  // coast.hpp

/// A closed polygon of an operating or forbidden area: vertices in order, the last joins the first; edges are geodesics
/// to within the local metric; may cross the antimeridian; at least three vertices.
struct Area {
  std::string name;
  std::vector<GeoPoint> vertices;
  friend bool operator==(const Area&, const Area&) = default;
};

/// What a chart is made of. Empty `keep_in` means everywhere. Without a coast the field's own land is all there is.
struct ChartSources {
  std::shared_ptr<const Coast> coast;
  std::vector<Area> keep_in, keep_out;
};

/// Land and areas with distance queries. Immutable, const calls are safe from several threads. Radians and metres.
///
/// `clearance` is the distance to the nearest thing a glider must not touch: shoreline, border of the coast file,
/// border of every keep-in area, border of every keep-out area. It is negative inside land, outside the coast file,
/// outside the keep-in areas or inside a keep-out area (then its size is the distance to the way out of the nearest
/// offence). Error below 0.2 % of the distance, and below 1 m where the distance is under 500 m. Distances are exact up
/// to `kHorizon`; farther away `kHorizon` is returned.
class Chart {
 public:
  static constexpr double kHorizon = 60'000.0;

  Chart();  ///< open ocean: no coast, no areas, clearance is kHorizon everywhere
  explicit Chart(ChartSources sources);
  ~Chart();
  Chart(Chart&&) noexcept;
  Chart& operator=(Chart&&) noexcept;

  [[nodiscard]] bool has_coast() const;
  /// True on land by the coastline (even-odd over its rings). False without a coast.
  [[nodiscard]] bool is_land(GeoPoint p) const;
  /// False where the coast file does not reach.
  [[nodiscard]] bool is_charted(GeoPoint p) const;
  /// Clearance as described above. About 1 µs far from land, tens of µs beside a detailed shore.
  [[nodiscard]] double clearance(double lat, double lon) const;
  [[nodiscard]] Metres clearance(GeoPoint p) const { return Metres{clearance(p.lat.radians(), p.lon.radians())}; }
  /// Distance to the nearest shoreline alone (areas and file border left out); negative on land; kHorizon beyond it.
  [[nodiscard]] Metres distance_to_coast(GeoPoint p) const;
  /// True when every point of the straight segment keeps at least `margin` metres of clearance. Exact up to the
  /// distance error above. The fast answers come from a raster of lower bounds; only near a limit is geometry asked.
  /// Segments up to 60 km.
  [[nodiscard]] bool segment_is_clear(double lat0, double lon0, double lat1, double lon1, double margin) const;
  /// The same, when the caller already knows the clearance of both ends (a planner keeps it): accepts at once when
  /// the two discs of clearance cover the segment.
  [[nodiscard]] bool segment_is_clear(double lat0, double lon0, double clearance0, double lat1, double lon1,
                                      double clearance1, double margin) const;
  /// Lower bound of the clearance from the raster alone: one array read, at most one raster cell below the truth.
  [[nodiscard]] double clearance_at_least(double lat, double lon) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace glidehelm::chart
