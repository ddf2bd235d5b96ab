#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/geo.hpp"
#include "core/chart/chart.hpp"
#include "daemon/cli/markup.hpp"

/// What pages of the command line draw with: a map and tables in plain HTML, nothing from outside.
namespace glidehelm::cli {

/// Longitude and latitude to the plane of a picture: equirectangular about the middle, north up, wide enough for all points and
/// a tenth on every side; across the antimeridian too.
class MapPicture {
 public:
  /// At least one point; the first one fixes which way round the longitudes are counted.
  explicit MapPicture(std::span<const GeoPoint> points);

  /// "x,y" in pixels.
  [[nodiscard]] std::string at(GeoPoint p) const;
  /// Points of a polyline.
  [[nodiscard]] std::string way(std::span<const GeoPoint> points) const;
  [[nodiscard]] double pixels(Metres length) const;
  [[nodiscard]] double height() const { return height_; }
  static constexpr double kWidth = 760;

  /// `<svg …>` up to what is drawn; the caller closes it.
  [[nodiscard]] std::string opening(std::string_view label) const;
  /// Land as a mosaic: the chart answers for a place, and a few thousand places are a picture. Empty without a coast.
  [[nodiscard]] std::string land(const chart::Chart& chart) const;
  /// Meridians and parallels at round degrees, and a bar of round kilometres.
  [[nodiscard]] std::string scales() const;
  /// A circle of class `name`.
  [[nodiscard]] std::string circle(GeoPoint p, double radius_pixels, std::string_view name) const;

 private:
  struct Pixel {
    double x, y;
  };
  [[nodiscard]] Pixel pixel(GeoPoint p) const;
  [[nodiscard]] double turned(double lon_deg) const;
  [[nodiscard]] double west() const { return middle_ + west_; }  ///< degrees, not folded; so is `east`
  [[nodiscard]] double east() const { return west() + kWidth / scale_ / squeeze_; }
  [[nodiscard]] double south() const { return north_ - height_ / scale_; }

  double middle_{}, squeeze_{1}, west_{}, north_{}, scale_{1}, height_{};
};

/// 1, 2 or 5 times a power of ten: the largest that is no more than `most`.
double round_number(double most);
std::string svg_text(double x, double y, std::string_view anchor, std::string_view text);
std::string svg_line(std::string_view name, double x0, double y0, double x1, double y1);

/// `words`: from this column on the cells are left-aligned. Cells are escaped, heads are not.
std::string html_table(const std::vector<std::string>& heads, const std::vector<std::vector<std::string>>& rows,
                       std::size_t words);
/// The look that all pages share: body, tables, land, grid, start and goal.
extern const char* const kPageStyle;

}  // namespace glidehelm::cli
