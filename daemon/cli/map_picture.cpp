#include "daemon/cli/map_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glidehelm::cli {

namespace {

std::string degrees_text(double degrees, const char* positive, const char* negative) {
  const double folded = std::remainder(degrees, 360.0);
  return fmt::format("{:g}\u00b0{}", std::round(std::abs(folded) * 1e4) / 1e4, folded < 0 ? negative : positive);
}

}  // namespace

MapPicture::MapPicture(std::span<const GeoPoint> points) {
  middle_ = points.front().lon.degrees();
  double west = 0, east = 0, south = 90, north = -90;
  for (const auto& p : points) {
    west = std::min(west, turned(p.lon.degrees()));
    east = std::max(east, turned(p.lon.degrees()));
    south = std::min(south, p.lat.degrees());
    north = std::max(north, p.lat.degrees());
  }
  squeeze_ = std::cos((south + north) / 360 * kPi);
  const double wide = (east - west) * squeeze_, high = north - south, margin = 0.1 * std::max({wide, high, 0.1});
  west_ = west - margin / squeeze_;
  north_ = north + margin;
  scale_ = kWidth / (wide + 2 * margin);
  height_ = (high + 2 * margin) * scale_;
}

double MapPicture::turned(double lon_deg) const { return std::remainder(lon_deg - middle_, 360.0); }

MapPicture::Pixel MapPicture::pixel(GeoPoint p) const {
  return {(turned(p.lon.degrees()) - west_) * squeeze_ * scale_, (north_ - p.lat.degrees()) * scale_};
}

std::string MapPicture::at(GeoPoint p) const {
  const auto [x, y] = pixel(p);
  return fmt::format("{:.1f},{:.1f}", x, y);
}

std::string MapPicture::way(std::span<const GeoPoint> points) const {
  std::string text;
  for (const auto& p : points) text += (text.empty() ? "" : " ") + at(p);
  return text;
}

double MapPicture::pixels(Metres length) const { return length.si() / 111'195 * scale_; }

std::string MapPicture::opening(std::string_view label) const {
  return fmt::format("<svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">\n", kWidth, height_,
                     escaped(label));
}

std::string MapPicture::land(const chart::Chart& chart) const {
  if (!chart.has_coast()) return "";
  constexpr int kAcross = 160;
  const double step = kWidth / kAcross;
  std::string cells;
  for (int row = 0; row * step < height_; ++row)
    for (int column = 0; column < kAcross; ++column) {
      const double x = (column + 0.5) * step, y = (row + 0.5) * step;
      const auto p = GeoPoint::from_degrees(north_ - y / scale_, std::remainder(west() + x / scale_ / squeeze_, 360.0));
      if (p && chart.is_land(*p))
        cells += fmt::format("M{:.1f},{:.1f}h{:.2f}v{:.2f}h-{:.2f}z", column * step, row * step, step + 0.05,
                             step + 0.05, step + 0.05);
    }
  return "<path class=\"land\" d=\"" + cells + "\"/>\n";
}

std::string MapPicture::scales() const {
  const double step = round_number(std::max(east() - west(), north_ - south()) / 3);
  std::string svg;
  for (double lon = std::ceil(west() / step) * step; lon < east(); lon += step) {
    const double x = kWidth * (lon - west()) / (east() - west());
    svg += svg_line("grid", x, 0, x, height_) + svg_text(x + 3, height_ - 5, "start", degrees_text(lon, "E", "W"));
  }
  for (double lat = std::ceil(south() / step) * step; lat < north_; lat += step) {
    const double y = height_ * (north_ - lat) / (north_ - south());
    svg += svg_line("grid", 0, y, kWidth, y) + svg_text(4, y - 3, "start", degrees_text(lat, "N", "S"));
  }
  const double kilometre = pixels(Metres{1000}), bar = round_number(0.25 * kWidth / kilometre);
  const double right = kWidth - 12, left = right - bar * kilometre;
  return svg + svg_line("bar", left, 16, right, 16) +
         svg_text(0.5 * (left + right), 30, "middle", fmt::format("{:g} km", bar));
}

std::string MapPicture::circle(GeoPoint p, double radius_pixels, std::string_view name) const {
  const auto [x, y] = pixel(p);
  return fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>\n", name, x, y, radius_pixels);
}

double round_number(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

std::string svg_text(double x, double y, std::string_view anchor, std::string_view text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, escaped(text));
}

std::string svg_line(std::string_view name, double x0, double y0, double x1, double y1) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", name, x0, y0, x1,
                     y1);
}

std::string html_table(const std::vector<std::string>& heads, const std::vector<std::vector<std::string>>& rows,
                       std::size_t words) {
  std::string table = "<table><tr>";
  for (const auto& head : heads) table += "<th>" + head + "</th>";
  table += "</tr>\n";
  for (const auto& row : rows) {
    table += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      table += (i < words ? "<td>" : "<td class=\"words\">") + escaped(row[i]) + "</td>";
    table += "</tr>\n";
  }
  return table + "</table>\n";
}

const char* const kPageStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:900px;margin:2em auto;padding:0 1em;color:#1b2a33}"
    "svg{width:100%;background:#e8f1f6;border:1px solid #b9ccd6}svg text{font-size:12px;fill:#3b4f5a}"
    ".land{fill:#c9bfa5}.grid{stroke:#b9ccd6;stroke-width:.8}.bar{stroke:#1b2a33;stroke-width:3}"
    ".start{fill:#1b2a33}.goal{fill:none;stroke:#1b2a33}"
    "table{border-collapse:collapse;margin:1em 0;width:100%}"
    "th,td{padding:.25em .5em;text-align:right;border-bottom:1px solid #d6e0e6}"
    "th:first-child,td:first-child,td.words{text-align:left}";

}  // namespace glidehelm::cli
