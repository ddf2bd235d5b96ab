#include "daemon/ingest/curvilinear.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/base/local_metric.hpp"
#include "core/base/text.hpp"

namespace glidehelm::ingest {

namespace {

constexpr double kAgreement = 3 * kDegree, kOblique = 10 * kDegree;

std::string degrees_text(double radians) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.1f°", radians / kDegree);
  return buffer;
}

bool placed(const Mesh& mesh, std::size_t at) { return !std::isnan(mesh.lat[at]) && !std::isnan(mesh.lon[at]); }

/// Median of angles that may lie on both sides of ±π: taken around the first of them.
double median_angle(const std::vector<double>& angles) {
  std::vector<double> around;
  double first = kNaN;
  for (const double angle : angles) {
    if (std::isnan(angle)) continue;
    if (std::isnan(first)) first = angle;
    around.push_back(fold_radians(angle - first));
  }
  return around.empty() ? kNaN : fold_radians(first + median(std::move(around)));
}

std::string range_text(const std::vector<double>& theta) {
  const double middle = median_angle(theta);
  double low = 0, high = 0;
  for (const double angle : theta)
    if (!std::isnan(angle)) {
      const double off = fold_radians(angle - middle);
      low = std::min(low, off);
      high = std::max(high, off);
    }
  if (high - low < 0.05 * kDegree) return degrees_text(middle);
  return degrees_text(middle + low) + " to " + degrees_text(middle + high);
}

/// Median of |a − b| over the points that have both.
double disagreement(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> off;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (!std::isnan(a[k]) && !std::isnan(b[k])) off.push_back(std::abs(fold_radians(a[k] - b[k])));
  return median(std::move(off));
}

}  // namespace

double fold_degrees(double degrees) { return degrees - 360 * std::floor((degrees + 180) / 360); }
double fold_radians(double radians) { return radians - 2 * kPi * std::floor((radians + kPi) / (2 * kPi)); }

double median(std::vector<double> values) {
  if (values.empty()) return kNaN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::size_t drop_impossible_positions(Mesh& mesh) {
  std::size_t zeros = 0, dropped = 0;
  for (std::size_t k = 0; k < mesh.lat.size(); ++k) zeros += mesh.lat[k] == 0 && mesh.lon[k] == 0 ? 1U : 0U;
  for (std::size_t k = 0; k < mesh.lat.size(); ++k) {
    const double lat = mesh.lat[k], lon = mesh.lon[k];
    // Written so that NaN is impossible too.
    const bool possible = std::abs(lat) <= 90 && std::abs(lon) <= 720 && !(zeros > 1 && lat == 0 && lon == 0);
    if (possible) continue;
    mesh.lat[k] = mesh.lon[k] = kNaN;
    ++dropped;
  }
  return dropped;
}

std::vector<double> axis_directions(const Mesh& mesh, bool along_eta) {
  std::vector<double> directions(mesh.lat.size(), kNaN);
  const std::size_t length = along_eta ? mesh.rows : mesh.columns, step = along_eta ? mesh.columns : 1;
  for (std::size_t j = 0; j < mesh.rows; ++j)
    for (std::size_t i = 0; i < mesh.columns; ++i) {
      const std::size_t here = mesh.index(j, i), along = along_eta ? j : i;
      if (!placed(mesh, here)) continue;
      const std::size_t before = along > 0 && placed(mesh, here - step) ? here - step : here;
      const std::size_t behind = along + 1 < length && placed(mesh, here + step) ? here + step : here;
      if (before == behind) continue;
      const double middle = 0.5 * (mesh.lat[before] + mesh.lat[behind]) * kDegree;
      const double east = fold_degrees(mesh.lon[behind] - mesh.lon[before]) * std::cos(middle);
      const double north = mesh.lat[behind] - mesh.lat[before];
      if (east != 0 || north != 0) directions[here] = std::atan2(north, east);
    }
  return directions;
}

Spacing median_spacing(const Mesh& mesh) {
  std::vector<double> xi, eta;
  const auto distance = [&](std::size_t a, std::size_t b, std::vector<double>& list) {
    if (!placed(mesh, a) || !placed(mesh, b)) return;
    const double length =
        local_offset(mesh.lat[a] * kDegree, mesh.lon[a] * kDegree, mesh.lat[b] * kDegree, mesh.lon[b] * kDegree)
            .length();
    if (length > 0) list.push_back(length);
  };
  for (std::size_t j = 0; j < mesh.rows; ++j)
    for (std::size_t i = 0; i < mesh.columns; ++i) {
      if (i + 1 < mesh.columns) distance(mesh.index(j, i), mesh.index(j, i + 1), xi);
      if (j + 1 < mesh.rows) distance(mesh.index(j, i), mesh.index(j + 1, i), eta);
    }
  return {median(std::move(xi)), median(std::move(eta))};
}

Result<Done> check_right_handed(const Mesh& mesh) {
  const auto xi = axis_directions(mesh), eta = axis_directions(mesh, true);
  std::vector<double> turn(xi.size());
  for (std::size_t k = 0; k < xi.size(); ++k) turn[k] = fold_radians(eta[k] - xi[k]);
  const double middle = median_angle(turn);
  if (std::isnan(middle)) return fault("the grid has no two neighbouring positions");
  if (std::abs(middle - kPi / 2) <= kOblique) return Done{};
  if (std::abs(middle + kPi / 2) <= kOblique)
    return fault(
        "the rows of the grid run the other way round than its second axis (left-handed), so that the sign of the "
        "velocity along it is not known");
  return fault("the axes of the grid meet at " + degrees_text(middle) +
               ", so that components along them have no one meaning; allowed is 90°");
}

Rotation computed_rotation(const Mesh& mesh) {
  Rotation rotation{axis_directions(mesh), {}};
  rotation.words = "turned by the direction of the grid's rows, computed from the positions (" +
                   range_text(rotation.theta) + " from east)";
  return rotation;
}

Result<Rotation> rotation_from(const Mesh& mesh, const std::string& name, const std::string& unit,
                               const std::vector<double>& stored, std::vector<std::string>& warnings) {
  const auto directions = axis_directions(mesh);
  const bool degrees = lower(unit).rfind("deg", 0) == 0;
  struct Reading {
    double scale, sign, offset;
    const char *words, *doubt;
  };
  const double named = degrees ? kDegree : 1.0, other = degrees ? 1.0 : kDegree;
  const char* other_unit = degrees ? "radians" : "degrees";
  const std::array<Reading, 6> readings{
      {{named, 1, 0, "counter-clockwise from east to the rows", ""},
       {other, 1, 0, "counter-clockwise from east to the rows", other_unit},
       {named, -1, 0, "clockwise from east to the rows", ""},
       {other, -1, 0, "clockwise from east to the rows", other_unit},
       {named, 1, -kPi / 2, "counter-clockwise from east to the columns", ""},
       {other, 1, -kPi / 2, "counter-clockwise from east to the columns", other_unit}}};
  double first_off = 0;
  for (std::size_t r = 0; r < readings.size(); ++r) {
    const auto& reading = readings[r];
    std::vector<double> theta(stored.size());
    for (std::size_t k = 0; k < stored.size(); ++k)
      theta[k] = fold_radians(reading.sign * stored[k] * reading.scale + reading.offset);
    const double off = disagreement(theta, directions);
    if (std::isnan(off)) return fault(name + " has no value where the grid has positions");
    if (r == 0) first_off = off;
    if (off > kAgreement) continue;
    std::string words = "turned by " + name + " (" + range_text(theta) +
                        " from east; it agrees with the positions to " + degrees_text(off) + ")";
    if (r > 0)
      warnings.push_back(name + " agrees with the positions only when it is read " +
                         (*reading.doubt != '\0' ? std::string{"in "} + reading.doubt + ", " : std::string{}) +
                         reading.words + "; read so");
    return Rotation{std::move(theta), std::move(words)};
  }
  return fault(name + " does not fit the positions: it is " + degrees_text(first_off) +
               " off the direction of the grid's rows in the median, allowed is 3°; say --rotation grid to turn by the "
               "positions, or --rotation none if the velocities are east and north");
}

std::optional<SeparableAxes> separable_axes(const Mesh& mesh) {
  if (mesh.rows < 2 || mesh.columns < 2) return std::nullopt;
  for (std::size_t k = 0; k < mesh.lat.size(); ++k)
    if (!placed(mesh, k)) return std::nullopt;
  SeparableAxes axes{std::vector<double>(mesh.rows), std::vector<double>(mesh.columns)};
  for (std::size_t j = 0; j < mesh.rows; ++j) axes.lats[j] = mesh.lat[mesh.index(j, 0)];
  axes.lons[0] = mesh.lon[0];
  for (std::size_t i = 1; i < mesh.columns; ++i)
    axes.lons[i] = axes.lons[i - 1] + fold_degrees(mesh.lon[i] - mesh.lon[i - 1]);
  double least_lat = 1e9, least_lon = 1e9;
  for (const auto& [axis, least] : {std::pair{&axes.lats, &least_lat}, std::pair{&axes.lons, &least_lon}}) {
    const double sign = axis->back() > axis->front() ? 1 : -1;
    for (std::size_t k = 1; k < axis->size(); ++k) {
      const double step = sign * ((*axis)[k] - (*axis)[k - 1]);
      if (!(step > 0)) return std::nullopt;
      *least = std::min(*least, step);
    }
  }
  if (std::abs(axes.lons.back() - axes.lons.front()) >= 360) return std::nullopt;
  for (std::size_t j = 0; j < mesh.rows; ++j)
    for (std::size_t i = 0; i < mesh.columns; ++i) {
      const std::size_t at = mesh.index(j, i);
      if (std::abs(mesh.lat[at] - axes.lats[j]) > 1e-3 * least_lat) return std::nullopt;
      if (std::abs(fold_degrees(mesh.lon[at] - axes.lons[i])) > 1e-3 * least_lon) return std::nullopt;
    }
  return axes;
}

std::optional<CellPlace> place_in_cell(const CellCorners& corners, double x, double y, double slack) {
  const auto* X = corners.x;
  const auto* Y = corners.y;
  const double x_xi = X[1] - X[0], x_eta = X[2] - X[0], x_both = X[0] - X[1] - X[2] + X[3];
  const double y_xi = Y[1] - Y[0], y_eta = Y[2] - Y[0], y_both = Y[0] - Y[1] - Y[2] + Y[3];
  double xi = 0.5, eta = 0.5;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const double miss_x = X[0] + x_xi * xi + x_eta * eta + x_both * xi * eta - x;
    const double miss_y = Y[0] + y_xi * xi + y_eta * eta + y_both * xi * eta - y;
    const double a = x_xi + x_both * eta, b = x_eta + x_both * xi, c = y_xi + y_both * eta, d = y_eta + y_both * xi;
    const double determinant = a * d - b * c;
    if (determinant == 0 || !std::isfinite(determinant)) return std::nullopt;
    const double step_xi = (d * miss_x - b * miss_y) / determinant, step_eta = (a * miss_y - c * miss_x) / determinant;
    xi -= step_xi;
    eta -= step_eta;
    if (std::abs(xi) > 1e3 || std::abs(eta) > 1e3) return std::nullopt;
    if (std::abs(step_xi) < 1e-12 && std::abs(step_eta) < 1e-12) break;
  }
  // Negated, so that what never converged to a number is outside.
  if (!(xi >= -slack && xi <= 1 + slack && eta >= -slack && eta <= 1 + slack)) return std::nullopt;
  return CellPlace{std::clamp(xi, 0.0, 1.0), std::clamp(eta, 0.0, 1.0)};
}

}  // namespace glidehelm::ingest
