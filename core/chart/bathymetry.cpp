#include "core/chart/bathymetry.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "core/base/hash.hpp"
#include "core/base/local_metric.hpp"
#include "core/base/text.hpp"

namespace glidehelm::chart {

namespace {

constexpr std::string_view kFirst = "# glidehelm depth v1\n";
constexpr std::string_view kLast = "end crc32c ";
/// A position that rounding puts just outside the outermost nodes is on them: 1e-6 of a step.
constexpr double kRim = 1e-6;

/// The next line of `text`, which loses it.
std::string_view next_line(std::string_view& text) {
  const auto end = text.find('\n');
  const auto line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

std::string hex_of(std::uint32_t crc) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", static_cast<unsigned>(crc));
  return text;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// Reads the words of the `grid` line.
std::optional<std::string> read_grid_line(std::string_view line, DepthGrid& grid) {
  double values[6];
  std::size_t count = 0;
  while (!(line = trimmed(line)).empty()) {
    const auto word = line.substr(0, line.find(' '));
    const auto value = number_from(word);
    if (!value || count == 6) return "line 4: grid has six numbers";
    values[count++] = *value;
    line.remove_prefix(word.size());
  }
  if (count != 6) return "line 4: grid has six numbers";
  for (const double size : {values[4], values[5]})
    if (!(size >= 2 && size <= 1e7 && size == std::floor(size))) return "line 4: columns and rows are 2 to 10000000";
  grid.west_deg = values[0];
  grid.south_deg = values[1];
  grid.lon_step_deg = values[2];
  grid.lat_step_deg = values[3];
  grid.columns = static_cast<std::size_t>(values[4]);
  grid.rows = static_cast<std::size_t>(values[5]);
  return std::nullopt;
}

}  // namespace

std::optional<std::string> DepthGrid::problem() const {
  if (columns < 2 || rows < 2) return "a depth grid has at least 2 by 2 nodes";
  if (columns > Bathymetry::kMostNodes / rows)
    return "the depth grid has more than " + std::to_string(Bathymetry::kMostNodes) + " nodes; cut it to the area";
  if (!(lon_step_deg > 0 && lat_step_deg > 0)) return "steps of a depth grid are positive";
  if (!(west_deg >= -360 && west_deg <= 360 && lon_step_deg * static_cast<double>(columns - 1) <= 360.0001))
    return "a depth grid begins from -360 to 360 degrees east and is at most 360 degrees wide";
  if (!(south_deg >= -90.0001 && south_deg + lat_step_deg * static_cast<double>(rows - 1) <= 90.0001))
    return "a depth grid lies between the poles";
  if (depths_m.size() != columns * rows) return "a depth grid has one depth for every node";
  return std::nullopt;
}

Bathymetry::Bathymetry(DepthGrid grid) : grid_{std::move(grid)} {
  Level level{grid_.columns, grid_.rows, grid_.depths_m};
  for (float& depth : level.least)
    if (!std::isfinite(depth)) depth = -std::numeric_limits<float>::infinity();
  pyramid_.push_back(std::move(level));
  while (pyramid_.back().columns > 1 || pyramid_.back().rows > 1) {
    const Level& below = pyramid_.back();
    Level above{(below.columns + 1) / 2, (below.rows + 1) / 2, {}};
    above.least.assign(above.columns * above.rows, std::numeric_limits<float>::infinity());
    for (std::size_t row = 0; row < below.rows; ++row)
      for (std::size_t column = 0; column < below.columns; ++column) {
        float& least = above.least[row / 2 * above.columns + column / 2];
        least = std::min(least, below.least[row * below.columns + column]);
      }
    pyramid_.push_back(std::move(above));
  }
}

Expected<std::shared_ptr<const Bathymetry>, std::string> Bathymetry::make(DepthGrid grid) {
  if (auto problem = grid.problem()) return unexpected(*std::move(problem));
  return std::shared_ptr<const Bathymetry>{new Bathymetry{std::move(grid)}};
}

Expected<std::shared_ptr<const Bathymetry>, std::string> Bathymetry::parse(std::string_view bytes) {
  const auto refused = [](const std::string& why) { return unexpected("no whole depth file: " + why); };
  if (bytes.substr(0, kFirst.size()) != kFirst)
    return refused("its first line is not '# glidehelm depth v1'; glidehelm-ingest --bathymetry makes one");
  auto rest = bytes.substr(kFirst.size());
  DepthGrid grid;
  const auto source = next_line(rest), decided = next_line(rest), shape = next_line(rest);
  if (source.substr(0, 7) != "source ") return refused("line 2 is not 'source WORDS'");
  if (decided.substr(0, 8) != "decided ") return refused("line 3 is not 'decided WORDS'");
  if (shape.substr(0, 5) != "grid ") return refused("line 4 is not 'grid …'");
  grid.source = source.substr(7);
  grid.decided = decided.substr(8);
  if (const auto problem = read_grid_line(shape.substr(5), grid)) return refused(*problem);
  if (next_line(rest) != "values") return refused("line 5 is not 'values'");
  if (grid.columns > kMostNodes / grid.rows)
    return refused("line 4: more than " + std::to_string(kMostNodes) + " nodes");
  const std::size_t nodes = grid.columns * grid.rows, end = 4 * nodes, tail = kLast.size() + 9;
  if (rest.size() != end + tail)
    return refused("after the head stand " + std::to_string(rest.size()) + " bytes, expected " +
                   std::to_string(end + tail));
  const auto crc = hex_of(crc32c(bytes.substr(0, bytes.size() - tail)));
  if (rest.substr(end) != std::string{kLast} + crc + "\n") return refused("the checksum is not that of the bytes");
  grid.depths_m.resize(nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    std::uint32_t bits = 0;
    for (std::size_t b = 4; b-- > 0;) bits = bits << 8 | static_cast<unsigned char>(rest[4 * n + b]);
    grid.depths_m[n] = std::bit_cast<float>(bits);
  }
  return make(std::move(grid));
}

std::string Bathymetry::text_of(const DepthGrid& grid) {
  std::string text{kFirst};
  text += "source " + grid.source + "\ndecided " + grid.decided + "\ngrid " + number(grid.west_deg) + " " +
          number(grid.south_deg) + " " + number(grid.lon_step_deg) + " " + number(grid.lat_step_deg) + " " +
          std::to_string(grid.columns) + " " + std::to_string(grid.rows) + "\nvalues\n";
  text.reserve(text.size() + 4 * grid.depths_m.size() + 32);
  for (const float depth : grid.depths_m) {
    const auto bits = std::bit_cast<std::uint32_t>(depth);
    for (unsigned shift = 0; shift < 32; shift += 8) text += static_cast<char>(bits >> shift & 0xffU);
  }
  return text + std::string{kLast} + hex_of(crc32c(std::string_view{text})) + "\n";
}

double Bathymetry::x_of(double lon) const {
  // Folded about the middle of the grid, so that a grid across the antimeridian is one piece.
  const double middle = grid_.west_deg + 0.5 * grid_.lon_step_deg * static_cast<double>(grid_.columns - 1);
  return (middle + std::remainder(lon / kDegree - middle, 360.0) - grid_.west_deg) / grid_.lon_step_deg;
}
double Bathymetry::y_of(double lat) const { return (lat / kDegree - grid_.south_deg) / grid_.lat_step_deg; }

bool Bathymetry::holds(const Box& box) const {
  return box.x0 >= -kRim && box.y0 >= -kRim && box.x1 <= static_cast<double>(grid_.columns - 1) + kRim &&
         box.y1 <= static_cast<double>(grid_.rows - 1) + kRim;
}

double Bathymetry::node(std::size_t column, std::size_t row) const {
  return static_cast<double>(pyramid_[0].least[row * grid_.columns + column]);
}

double Bathymetry::at(double x, double y) const {
  x = std::clamp(x, 0.0, static_cast<double>(grid_.columns - 1));
  y = std::clamp(y, 0.0, static_cast<double>(grid_.rows - 1));
  const auto column = std::min(static_cast<std::size_t>(x), grid_.columns - 2);
  const auto row = std::min(static_cast<std::size_t>(y), grid_.rows - 2);
  const double fx = x - static_cast<double>(column), fy = y - static_cast<double>(row);
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double weight = (k % 2 == 0 ? 1 - fx : fx) * (k / 2 == 0 ? 1 - fy : fy);
    if (weight > 0) sum += weight * node(column + k % 2, row + k / 2);  // an unknown node makes it -infinity
  }
  return sum;
}

double Bathymetry::bound(const Box& box) const {
  const auto low = [](double v) { return static_cast<std::size_t>(std::max(0.0, std::floor(v))); };
  const auto high = [](double v, std::size_t most) {
    return std::min(most, static_cast<std::size_t>(std::max(0.0, std::ceil(v))));
  };
  std::size_t c0 = low(box.x0), c1 = high(box.x1, grid_.columns - 1);
  std::size_t r0 = low(box.y0), r1 = high(box.y1, grid_.rows - 1), level = 0;
  while (c1 > c0 + 1 || r1 > r0 + 1) c0 /= 2, c1 /= 2, r0 /= 2, r1 /= 2, ++level;
  const Level& minima = pyramid_[level];
  float least = std::numeric_limits<float>::infinity();
  for (auto row = r0; row <= r1; ++row)
    for (auto column = c0; column <= c1; ++column) least = std::min(least, minima.least[row * minima.columns + column]);
  return static_cast<double>(least);
}

void Bathymetry::least_of_nodes(std::size_t level, std::size_t column, std::size_t row, const std::size_t (&span)[4],
                                double& least) const {
  const Level& minima = pyramid_[level];
  if (column >= minima.columns || row >= minima.rows) return;
  const std::size_t c0 = column << level, c1 = std::min(((column + 1) << level) - 1, grid_.columns - 1);
  const std::size_t r0 = row << level, r1 = std::min(((row + 1) << level) - 1, grid_.rows - 1);
  if (c0 > span[1] || c1 < span[0] || r0 > span[3] || r1 < span[2]) return;
  const double here = static_cast<double>(minima.least[row * minima.columns + column]);
  if (here >= least) return;
  if (c0 >= span[0] && c1 <= span[1] && r0 >= span[2] && r1 <= span[3]) {
    least = here;
    return;
  }
  for (std::size_t k = 0; k < 4; ++k) least_of_nodes(level - 1, 2 * column + k % 2, 2 * row + k / 2, span, least);
}

double Bathymetry::shoalest(const Box& box) const {
  if (!holds(box)) return kUnknown;
  double least = std::min({at(box.x0, box.y0), at(box.x0, box.y1), at(box.x1, box.y0), at(box.x1, box.y1)});
  const double cx0 = std::max(0.0, std::ceil(box.x0)), cx1 = std::floor(box.x1);
  const double cy0 = std::max(0.0, std::ceil(box.y0)), cy1 = std::floor(box.y1);
  for (double x = cx0; x <= cx1; ++x) least = std::min({least, at(x, box.y0), at(x, box.y1)});
  for (double y = cy0; y <= cy1; ++y) least = std::min({least, at(box.x0, y), at(box.x1, y)});
  if (cx0 <= cx1 && cy0 <= cy1) {
    const std::size_t span[4] = {static_cast<std::size_t>(cx0), static_cast<std::size_t>(cx1),
                                 static_cast<std::size_t>(cy0), static_cast<std::size_t>(cy1)};
    least_of_nodes(pyramid_.size() - 1, 0, 0, span, least);
  }
  return least;
}

double Bathymetry::depth(double lat, double lon) const {
  if (!std::isfinite(lat) || !std::isfinite(lon)) return kUnknown;
  const double x = x_of(lon), y = y_of(lat);
  return holds({x, x, y, y}) ? at(x, y) : kUnknown;
}

double Bathymetry::shoalest_in_box(double lat0, double lat1, double lon0, double lon1) const {
  if (!std::isfinite(lat0 + lat1 + lon0 + lon1)) return kUnknown;
  const double x = x_of(0.5 * (lon0 + lon1)), half = 0.5 * (lon1 - lon0) / kDegree / grid_.lon_step_deg;
  return shoalest({x - half, x + half, y_of(lat0), y_of(lat1)});
}

double Bathymetry::shoalest_within(GeoPoint p, Metres radius) const {
  const double lat = p.lat.radians(), lon = p.lon.radians();
  const double up = 1.01 * radius.si() / LocalMetric::at(0).meridian_radius, farthest = std::abs(lat) + up;
  if (!(farthest < 89 * kDegree)) return kUnknown;
  const double across = 1.01 * radius.si() / LocalMetric::at(farthest).parallel_radius;
  return shoalest_in_box(lat - up, lat + up, lon - across, lon + across);
}

double Bathymetry::along(double x0, double y0, double x1, double y1, double enough) const {
  const Box box{std::min(x0, x1), std::max(x0, x1), std::min(y0, y1), std::max(y0, y1)};
  if (!holds(box)) return kUnknown;
  if (const double at_least = bound(box); at_least >= enough) return at_least;
  if (box.x1 - box.x0 <= 0.5 && box.y1 - box.y0 <= 0.5) return shoalest(box);
  const double x = 0.5 * (x0 + x1), y = 0.5 * (y0 + y1);
  const double first = along(x0, y0, x, y, enough);
  // The second half matters only below what the first has.
  return std::min(first, along(x, y, x1, y1, std::min(first, enough)));
}

double Bathymetry::shoalest_along(double lat0, double lon0, double lat1, double lon1) const {
  if (!std::isfinite(lat0 + lat1 + lon0 + lon1)) return kUnknown;
  const double x = x_of(lon0);
  const double dx = std::remainder(lon1 - lon0, 2 * kPi) / kDegree / grid_.lon_step_deg;
  return along(x, y_of(lat0), x + dx, y_of(lat1), std::numeric_limits<double>::infinity());
}

bool Bathymetry::is_deep_along(double lat0, double lon0, double lat1, double lon1, double least) const {
  if (!std::isfinite(lat0 + lat1 + lon0 + lon1)) return false;
  const double x = x_of(lon0);
  const double dx = std::remainder(lon1 - lon0, 2 * kPi) / kDegree / grid_.lon_step_deg;
  return along(x, y_of(lat0), x + dx, y_of(lat1), least) >= least;
}

}  // namespace glidehelm::chart
