#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/hash.hpp"
#include "core/chart/chart.hpp"
#include "core/ocean/analytic.hpp"
#include "core/ocean/composite.hpp"
#include "core/ocean/gridded.hpp"
#include "core/safety/judge.hpp"

/// Values of the core rooms as exact JSON and back: what crosses to the verifier and what stands in the journal.
///
/// A type with a `members(T&, f)` function that names its members once is written and read by it; such functions for types of
/// other rooms stand in those rooms' namespaces, where argument-dependent lookup finds them. Numbers come back bit by bit; NaN and
/// infinities are the strings "nan", "inf", "-inf"; texts that are not printable ASCII are {"hex": "…"}.
/// `read` throws std::runtime_error or json::exception on anything that is not as written; `guarded` turns both into a message.
namespace glidehelm::values {

using nlohmann::json;

inline json write(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}
inline void read(const json& j, double& value) {
  if (j.is_number()) {
    value = j.get<double>();
  } else {
    const auto text = j.get<std::string>();
    if (text == "nan")
      value = std::numeric_limits<double>::quiet_NaN();
    else if (text == "inf" || text == "-inf")
      value = (text == "inf" ? 1 : -1) * std::numeric_limits<double>::infinity();
    else
      throw std::runtime_error("'" + text + "' is not a number");
  }
}

inline json write(const std::string& text) {
  bool printable = true;
  for (const char c : text) printable = printable && ((c >= ' ' && c <= '~') || c == '\n' || c == '\t');
  if (printable) return text;
  constexpr const char* kDigits = "0123456789abcdef";
  std::string hex;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    hex += kDigits[byte / 16];
    hex += kDigits[byte % 16];
  }
  return {{"hex", hex}};
}
inline int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  throw std::runtime_error("not a hexadecimal digit");
}
inline void read(const json& j, std::string& text) {
  if (j.is_string()) {
    text = j.get<std::string>();
    return;
  }
  const auto hex = j.at("hex").get<std::string>();
  if (hex.size() % 2 != 0) throw std::runtime_error("odd number of hexadecimal digits");
  text.clear();
  for (std::size_t i = 0; i < hex.size(); i += 2)
    text += static_cast<char>(hex_digit(hex[i]) * 16 + hex_digit(hex[i + 1]));
}

inline json write(std::uint64_t value) { return value; }
inline void read(const json& j, std::uint64_t& value) {
  if (!j.is_number_unsigned()) throw std::runtime_error("not a whole number");
  value = j.get<std::uint64_t>();
}

inline json write(bool value) { return value; }
inline void read(const json& j, bool& value) { value = j.get<bool>(); }

inline json write(int value) { return value; }
inline void read(const json& j, int& value) {
  if (!j.is_number_integer()) throw std::runtime_error("not a whole number");
  const auto wide = j.get<std::int64_t>();
  if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max())
    throw std::runtime_error("whole number out of range");
  value = static_cast<int>(wide);
}

template <class Tag>
json write(Quantity<Tag> q) {
  return write(q.si());
}
template <class Tag>
void read(const json& j, Quantity<Tag>& q) {
  double si{};
  read(j, si);
  q = Quantity<Tag>{si};
}

inline json write(Seconds s) { return write(s.count()); }
inline void read(const json& j, Seconds& s) {
  double count{};
  read(j, count);
  s = Seconds{count};
}

template <class Clock, class Duration>
json write(std::chrono::time_point<Clock, Duration> t) {
  return t.time_since_epoch().count();
}
template <class Clock, class Duration>
void read(const json& j, std::chrono::time_point<Clock, Duration>& t) {
  if (!j.is_number_integer()) throw std::runtime_error("not a whole number");
  t = std::chrono::time_point<Clock, Duration>{Duration{j.get<typename Duration::rep>()}};
}

inline json write(const Sha256& hash) { return hash.hex(); }
inline void read(const json& j, Sha256& hash) {
  if (!Sha256::from_hex(j.get<std::string>(), hash)) throw std::runtime_error("not a SHA-256");
}

inline json write(const GeoPoint& p) { return {{"lat_rad", p.lat.radians()}, {"lon_rad", p.lon.radians()}}; }
inline void read(const json& j, GeoPoint& p) {
  const double lat = j.at("lat_rad").get<double>(), lon = j.at("lon_rad").get<double>();
  if (!(std::abs(lat) <= kPi / 2) || !(lon >= -kPi && lon < kPi)) throw std::runtime_error("position out of range");
  p = GeoPoint::from_kernel(lat, lon);
}

inline json write(const Current& c) { return {{"east", write(c.east)}, {"north", write(c.north)}}; }
inline void read(const json& j, Current& c) {
  read(j.at("east"), c.east);
  read(j.at("north"), c.north);
}
inline json write(const model::LocalVelocity& v) { return {{"x", write(v.x)}, {"y", write(v.y)}}; }
inline void read(const json& j, model::LocalVelocity& v) {
  read(j.at("x"), v.x);
  read(j.at("y"), v.y);
}

/// An enumeration by its number, no greater than `last`.
template <class E>
void read_enum(const json& j, E& e, E last) {
  int value{};
  read(j, value);
  if (value < 0 || value > static_cast<int>(last)) throw std::runtime_error("unknown choice");
  e = static_cast<E>(value);
}
inline json write(model::WaypointRole role) { return static_cast<int>(role); }
inline void read(const json& j, model::WaypointRole& role) { read_enum(j, role, model::WaypointRole::goal); }
inline json write(model::AtEnd end) { return static_cast<int>(end); }
inline void read(const json& j, model::AtEnd& end) { read_enum(j, end, model::AtEnd::wait); }
inline json write(ocean::OutsideTime policy) { return static_cast<int>(policy); }
inline void read(const json& j, ocean::OutsideTime& policy) { read_enum(j, policy, ocean::OutsideTime::forbid); }
inline json write(ocean::Interpolation how) { return static_cast<int>(how); }
inline void read(const json& j, ocean::Interpolation& how) { read_enum(j, how, ocean::Interpolation::akima); }

// Aggregates name their members once, for both directions.
template <class T>
json write_members(const T& value);
template <class T>
void read_members(const json& j, T& value);
template <class T>
json write(const std::optional<T>& value);
template <class T>
void read(const json& j, std::optional<T>& value);
template <class T>
json write(const std::vector<T>& values);
template <class T>
void read(const json& j, std::vector<T>& values);
inline json write(const std::pair<std::string, double>& p) { return json::array({write(p.first), write(p.second)}); }
inline void read(const json& j, std::pair<std::string, double>& p) {
  read(j.at(0), p.first);
  read(j.at(1), p.second);
}
inline json write(const std::map<std::string, double>& values) {
  json j = json::array();
  for (const auto& [name, value] : values) j.push_back(json::array({write(name), write(value)}));
  return j;
}
inline void read(const json& j, std::map<std::string, double>& values) {
  values.clear();
  for (const auto& entry : j) {
    std::pair<std::string, double> p;
    read(entry, p);
    if (!values.insert(p).second) throw std::runtime_error("a sensor is named twice");
  }
}

template <class F>
void members(model::AimLine& a, F&& f) {
  f("at", a.at), f("range_m", a.range), f("bearing_deg", a.bearing_deg);
}
template <class F>
void members(model::SurfaceReason& r, F&& f) {
  f("text", r.text), f("behavior", r.behavior), f("start_when", r.start_when);
}
template <class F>
void members(model::Surfacing& s, F&& f) {
  f("glider", s.glider), f("heard_ms", s.heard), f("fix", s.fix), f("fix_taken_ms", s.fix_taken);
  f("fix_age_s", s.fix_age), f("curr_time_s", s.curr_time), f("lat_ddmm", s.lat_ddmm), f("lon_ddmm", s.lon_ddmm);
  f("at_surface", s.at_surface), f("mission", s.mission), f("segment", s.segment), f("because", s.because);
  f("until_diving_s", s.until_diving), f("water", s.water), f("water_is_final", s.water_is_final), f("aim", s.aim);
  f("believed_speed_m_per_s", s.believed_speed), f("current_correction", s.current_correction);
  f("magnetic_variation_rad", s.magnetic_variation), f("sensors", s.sensors);
}
template <class F>
void members(model::Glider& g, F&& f) {
  f("name", g.name), f("horizontal_speed_m_per_s", g.horizontal_speed), f("believed_speed_m_per_s", g.believed_speed);
  f("glide_angle_rad", g.glide_angle), f("dive_depth_m", g.dive_depth), f("climb_to_m", g.climb_to);
  f("current_correction", g.current_correction), f("heading_bias_rad", g.heading_bias);
}
template <class F>
void members(model::DiveSchedule& s, F&& f) {
  f("stint_s", s.stint), f("first_stint_s", s.first_stint), f("surface_s", s.surface),
      f("time_to_dive_s", s.time_to_dive);
}
template <class F>
void members(model::Waypoint& w, F&& f) {
  f("at", w.at), f("role", w.role);
}
template <class F>
void members(safety::Rules& r, F&& f) {
  f("coast_margin_m", r.coast_margin), f("max_waypoints", r.max_waypoints), f("slot", r.slot);
  f("max_wpt_distance_m", r.max_wpt_distance), f("arrival_tolerance", r.arrival_tolerance);
  f("surfacing_tolerance", r.surfacing_tolerance), f("refused_speed_m_per_s", r.refused_speed);
  f("tail_stint", r.tail_stint), f("tail_slower", r.tail_slower), f("tail_faster", r.tail_faster);
}
template <class F>
void members(safety::Promise& p, F&& f) {
  f("points", p.points), f("next_surfacing", p.next_surfacing), f("list_arrival_s", p.list_arrival_s),
      f("goal", p.goal);
  f("goal_radius_m", p.goal_radius), f("radius_m", p.radius), f("at_end", p.at_end);
}
template <class F>
void members(ocean::Seams& s, F&& f) {
  f("blend_m", s.blend), f("join_s", s.join);
}
template <class F>
void members(ocean::LocalCorrection& c, F&& f) {
  f("at", c.at), f("at_s", c.at_s), f("added", c.added), f("spread_m_per_s", c.spread), f("length_m", c.length),
      f("time_s", c.time);
}
template <class F>
void members(safety::Dossier& d, F&& f) {
  f("file_name", d.file_name), f("file_bytes", d.file_bytes), f("glider_expected", d.glider_expected), f("at", d.at);
  f("current_surfacing", d.current_surfacing), f("answers_surfacing", d.answers_surfacing), f("glider", d.glider);
  f("believed_current", d.believed_current), f("schedule", d.schedule), f("correction", d.correction),
      f("fix_s", d.fix_s), f("horizon_s", d.horizon_s);
  f("rules", d.rules), f("promise", d.promise), f("judged_s", d.judged_s), f("deadline_s", d.deadline_s);
}
template <class F>
void members(safety::Margin& m, F&& f) {
  f("rule", m.rule), f("holds", m.holds), f("found", m.found), f("limit", m.limit), f("unit", m.unit),
      f("message", m.message);
}
template <class F>
void members(safety::Verdict& v, F&& f) {
  f("of", v.of), f("accepted", v.accepted), f("file_name", v.file_name), f("margins", v.margins);
}
template <class F>
void members(ocean::GriddedOptions& o, F&& f) {
  f("outside_time", o.outside_time), f("interpolation", o.interpolation), f("coastal_fill_cells", o.coastal_fill_cells);
  f("mask_is_land", o.mask_is_land);
}
template <class F>
void members(ocean::AnalyticSpec& s, F&& f) {
  f("kind", s.kind), f("origin", s.origin), f("length_scale_m", s.length_scale),
      f("speed_scale_m_per_s", s.speed_scale);
  f("time_scale_s", s.time_scale), f("t0_ms", s.t0), f("south", s.south), f("params", s.params), f("list", s.gaussians);
}
template <class F>
void members(ocean::Coverage& c, F&& f) {
  f("south_rad", c.south), f("north_rad", c.north), f("west_rad", c.west), f("east_rad", c.east),
      f("first_s", c.first_s);
  f("last_s", c.last_s), f("holds_outside", c.holds_outside);
}
template <class F>
void members(chart::Area& a, F&& f) {
  f("name", a.name), f("vertices", a.vertices);
}

struct Ignore {
  template <class M>
  void operator()(const char*, M&) const {}
};
template <class T>
concept HasMembers = requires(T& value) {
  members(value, Ignore{});
};

template <HasMembers T>
json write(const T& value) {
  return write_members(value);
}
template <HasMembers T>
void read(const json& j, T& value) {
  read_members(j, value);
}

template <class T>
json write_members(const T& value) {
  json j = json::object();
  // `members` serves both directions and so takes its object as changeable; writing changes nothing.
  members(const_cast<T&>(value), [&](const char* name, const auto& member) { j[name] = write(member); });
  return j;
}
template <class T>
void read_members(const json& j, T& value) {
  members(value, [&](const char* name, auto& member) {
    const auto found = j.find(name);
    if (!j.is_object() || found == j.end()) throw std::runtime_error(std::string{name} + " is missing");
    try {
      read(*found, member);
    } catch (const std::exception& e) {
      throw std::runtime_error(std::string{name} + ": " + e.what());
    }
  });
}
template <class T>
json write(const std::optional<T>& value) {
  return value ? write(*value) : json(nullptr);
}
template <class T>
void read(const json& j, std::optional<T>& value) {
  value.reset();
  if (j.is_null()) return;
  T inner{};
  read(j, inner);
  value = inner;
}
template <class T>
json write(const std::vector<T>& values) {
  json j = json::array();
  for (const auto& value : values) j.push_back(write(value));
  return j;
}
template <class T>
void read(const json& j, std::vector<T>& values) {
  if (!j.is_array()) throw std::runtime_error("not a list");
  values.clear();
  for (const auto& entry : j) {
    T value{};
    read(entry, value);
    values.push_back(std::move(value));
  }
}

template <class T>
Expected<T, std::string> guarded(const json& j) {
  try {
    T value{};
    read(j, value);
    return value;
  } catch (const std::exception& e) {
    return unexpected(std::string{e.what()});
  }
}

}  // namespace glidehelm::values
