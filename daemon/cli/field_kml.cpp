#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/cli/field_page.hpp"
#include "daemon/cli/field_text.hpp"
#include "daemon/cli/markup.hpp"

namespace glidehelm::cli {

namespace {

constexpr std::size_t kArrowsAcross = 20, kFramesAtMost = 120;
constexpr std::size_t kClasses = 5;
// Of KML: alpha, blue, green, red.
constexpr std::array<const char*, kClasses> kColours{"ffa83e35", "ffb07d2a", "ff7cb43c", "ff3ac9f0", "ff2b4be8"};

std::string at(double lon, double lat) { return decimal(lon, 5) + "," + decimal(lat, 5) + " "; }

/// An arrow towards which the water flows; `degrees` long on the ground, in degrees of latitude.
std::string arrow(double lat, double lon, double east, double north, double degrees) {
  const double speed = std::hypot(east, north), squeeze = std::cos(lat * kDegree);
  if (!(speed > 0)) return {};
  const double x = east / speed, y = north / speed;
  const auto point = [&](double along, double aside) {
    return at(lon + degrees * (along * x - aside * y) / squeeze, lat + degrees * (along * y + aside * x));
  };
  return "<LineString><coordinates>" + at(lon, lat) + point(1, 0) + point(0.7, 0.15) + point(1, 0) + point(0.7, -0.15) +
         "</coordinates></LineString>";
}

/// Longest arrow of a frame: the distance between arrows.
struct Spread {
  std::size_t step{};
  double degrees{};
  explicit Spread(const Animation& a) {
    const std::size_t most = std::max(a.lats_deg.size(), a.lons_deg.size());
    step = (most + kArrowsAcross - 1) / kArrowsAcross;
    degrees = static_cast<double>(step) * (a.lats_deg.back() - a.lats_deg.front()) /
              static_cast<double>(a.lats_deg.size() - 1);
  }
};

double fastest_of(const Animation& a) {
  double fastest = 0.001;
  for (std::size_t n = 0; n < a.mm_per_s.size(); n += 2)
    if (a.mm_per_s[n] != Animation::kNoCurrent)
      fastest = std::max(fastest, std::hypot(a.mm_per_s[n] * 1e-3, a.mm_per_s[n + 1] * 1e-3));
  return fastest;
}

/// Of more frames than a map can hold, every n-th.
std::size_t frame_step(const Animation& a) { return (a.frames() + kFramesAtMost - 1) / kFramesAtMost; }

/// When a frame is shown: until the next; the last as long as the one before.
std::string time_span(const Animation& a, std::size_t frame) {
  if (a.times_s.empty()) return {};
  const auto& times = a.times_s;
  const double step = times.size() < 2 ? 3600 : times.back() - times[times.size() - 2];
  const std::size_t next = frame + frame_step(a);
  const double end = next < times.size() ? times[next] : times.back() + step;
  return "<TimeSpan><begin>" + time_text(times[frame]) + "</begin><end>" + time_text(end) + "</end></TimeSpan>";
}

std::string frame_of(const Animation& a, std::size_t frame, const Spread& spread, double fastest) {
  std::array<std::string, kClasses> arrows;
  const std::size_t columns = a.lons_deg.size();
  for (std::size_t j = 0; j < a.lats_deg.size(); j += spread.step)
    for (std::size_t i = 0; i < columns; i += spread.step) {
      const auto* value = a.mm_per_s.data() + 2 * ((frame * a.lats_deg.size() + j) * columns + i);
      if (*value == Animation::kNoCurrent) continue;
      const double east = value[0] * 1e-3, north = value[1] * 1e-3, share = std::hypot(east, north) / fastest;
      const auto speed_class = std::min(kClasses - 1, static_cast<std::size_t>(share * kClasses));
      arrows[speed_class] += arrow(a.lats_deg[j], a.lons_deg[i], east, north, spread.degrees * share);
    }
  std::string text = "<Folder>" + time_span(a, frame) + "\n";
  for (std::size_t c = 0; c < kClasses; ++c)
    if (!arrows[c].empty())
      text += "<Placemark><name>" + decimal(fastest * static_cast<double>(c) / kClasses, 2) + " to " +
              decimal(fastest * static_cast<double>(c + 1) / kClasses, 2) + " m/s</name>" + time_span(a, frame) +
              "<styleUrl>#s" + std::to_string(c) + "</styleUrl><MultiGeometry>" + arrows[c] +
              "</MultiGeometry></Placemark>\n";
  return text + "</Folder>\n";
}

}  // namespace

std::string animation_kml(const Animation& a) {
  const Spread spread{a};
  const double fastest = fastest_of(a);
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>\n<name>" +
      escaped(a.title + (a.depth_text.empty() ? "" : ", " + a.depth_text)) + "</name>\n<description>" +
      escaped("Arrows point to where the water flows; the longest is " + decimal(fastest, 2) + " m/s, the distance " +
              "between two arrows. UTC." + (a.decimation.empty() ? "" : " " + a.decimation + ".") +
              (frame_step(a) > 1 ? " One of " + std::to_string(frame_step(a)) + " of these times is shown." : "")) +
      "</description>\n";
  for (std::size_t c = 0; c < kClasses; ++c)
    text += "<Style id=\"s" + std::to_string(c) + "\"><LineStyle><color>" + kColours[c] +
            "</color><width>2</width></LineStyle></Style>\n";
  text += "<Style id=\"shore\"><LineStyle><color>ff505050</color><width>1</width></LineStyle></Style>\n";
  if (!a.shores.empty()) {
    text += "<Placemark><name>shore</name><styleUrl>#shore</styleUrl><MultiGeometry>";
    for (const auto& shore : a.shores) {
      text += "<LineString><coordinates>";
      for (const auto& [lon, lat] : shore) text += at(lon, lat);
      text += "</coordinates></LineString>";
    }
    text += "</MultiGeometry></Placemark>\n";
  }
  for (std::size_t frame = 0; frame < a.frames(); frame += frame_step(a)) text += frame_of(a, frame, spread, fastest);
  return text + "</Document></kml>\n";
}

}  // namespace glidehelm::cli
