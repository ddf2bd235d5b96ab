#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/geo.hpp"
#include "core/chart/region.hpp"

namespace glidehelm::chart {

/// Why bytes are no coast file. Line and column count from 1; both are 0 when the file as a whole, or a coast that came
/// from no file, is meant.
struct CoastError {
  std::size_t line{}, column{};
  std::string problem;
  [[nodiscard]] std::string message() const;  ///< "line 7, column 3: …"
  friend bool operator==(const CoastError&, const CoastError&) = default;
};

/// Units of coordinates in a coast: 1e-7 degrees (11 mm of latitude), whole numbers, so that text and back is exact.
inline constexpr double kCoastUnitsPerDegree = 1e7;

/// The box that a coast file covers, in coast units. `east` may exceed 180°: it lies east of `west`.
struct CoastArea {
  std::int64_t west{}, east{}, south{}, north{};

  static constexpr std::int64_t kWest = -1'800'000'000;   ///< -180°, the smallest west; the largest is below 180°
  static constexpr std::int64_t kWidest = 1'800'000'000;  ///< 180°
  static constexpr std::int64_t kFarthest = 850'000'000;  ///< 85° north or south
  [[nodiscard]] std::int64_t width() const { return east - west; }
  [[nodiscard]] std::int64_t height() const { return north - south; }
  /// What is wrong with it, or nothing.
  [[nodiscard]] std::optional<std::string> problem() const;
  friend bool operator==(const CoastArea&, const CoastArea&) = default;
};

/// A corner of a ring in coast units: `x` east of the area's west edge, `y` north of the equator.
struct CoastPoint {
  std::int32_t x{}, y{};
  friend auto operator<=>(const CoastPoint&, const CoastPoint&) = default;
};

/// A closed line; the last point joins the first. `cut[i]` says that the edge from point i to the next runs along the
/// border of the area, where the land goes on outside: it closes the ring and is no shore. At least three points; `cut`
/// as long as `points`.
struct CoastRing {
  std::vector<CoastPoint> points;
  std::vector<bool> cut;
  friend bool operator==(const CoastRing&, const CoastRing&) = default;
};

/// A coastline cut to an area: what `glidehelm coast` writes and charts are made of. Land is where a ray crosses the rings
/// an odd number of times, so lakes are water and islands in lakes are land. Immutable; const calls are safe from several
/// threads.
///
/// A `.coast` file is ASCII text, lines end with a line feed:
///
///     # glidehelm coast v1
///     area WEST EAST SOUTH NORTH
///     source ANY WORDS
///     ring N                          one block per ring, then its N points:
///     LON LAT                         the edge from this point to the next is shore
///     LON LAT cut                     it runs along the border of the area and is no shore
///     end RINGS POINTS crc32c XXXXXXXX
///
/// Coordinates are degrees with seven decimals; longitudes run on across the antimeridian, between WEST and EAST.
/// The last line counts rings and points and holds the CRC-32C of all bytes before it: a half-written file is refused.
class Coast {
 public:
  static constexpr std::size_t kLargestFile = std::size_t{1} << 30;
  static constexpr std::size_t kMostPoints = 20'000'000;

  /// Reads a coast file. Safe on hostile bytes: memory is bounded by their number. Linear in their length.
  static Expected<std::shared_ptr<const Coast>, CoastError> parse(std::string_view bytes);
  /// A coast from rings. Refused are rings of fewer than three points, points outside the area, cut edges that do not
  /// run along its border, and more points (long edges divided, outline.hpp) than kMostPoints.
  static Expected<std::shared_ptr<const Coast>, CoastError> make(CoastArea area, std::string source,
                                                                 std::vector<CoastRing> rings);
  /// The bytes of the coast file. parse(text()) gives an equal coast.
  [[nodiscard]] std::string text() const;

  [[nodiscard]] const CoastArea& area() const { return area_; }
  [[nodiscard]] const std::string& source() const { return source_; }
  [[nodiscard]] const std::vector<CoastRing>& rings() const { return rings_; }
  [[nodiscard]] std::size_t points() const;

  /// True inside the area, its border included.
  [[nodiscard]] bool covers(double lat, double lon) const;
  /// The land, with distances to the shore; nothing outside the area.
  [[nodiscard]] const Region& land() const { return land_; }
  /// The area, with distances to its border.
  [[nodiscard]] const Region& charted() const { return charted_; }

 private:
  Coast(CoastArea area, std::string source, std::vector<CoastRing> rings);

  CoastArea area_;
  std::string source_;
  std::vector<CoastRing> rings_;
  double west_{}, east_{}, south_{}, north_{};  ///< radians; west_ and east_ about middle_
  double middle_{};
  Region land_, charted_;
};

/// A coordinate of a coast file: degrees with seven decimals.
std::string coast_degrees(std::int64_t units);

}  // namespace glidehelm::chart
