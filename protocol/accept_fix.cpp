#include "protocol/accept_fix.hpp"

#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "core/base/text.hpp"
#include "protocol/latlon.hpp"

namespace glidehelm::protocol {

namespace {

/// From this age on a value was never updated (slocum.md 1.2); also keeps sums of times finite.
constexpr double kNeverUpdated = 1e8;
/// The glider's clock may be set back between the fix and the print: by seconds, not more.
constexpr double kYoungest = -5.0;
constexpr double kMaxWaterSpeed = 2.8;

std::string text_of(double value, int decimals) {
  char text[48];
  const int n = std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return {text, static_cast<std::size_t>(n)};
}

class Judgement {
 public:
  Judgement(const SurfaceBlock& block, const Limits& limits) : block_{block}, limits_{limits} {}

  /// The reason against the fix, or nothing with `out` filled.
  std::optional<model::Refusal> objection(model::Surfacing& out) {
    if (auto no = of_name()) return no;
    if (auto no = of_console()) return no;
    const auto& gps = block_.gps;
    if (!gps) {
      if (block_.gps_damaged)
        return refused("R7", "the GPS Location line is damaged: bytes were lost, added or changed");
      return refused("S3", "there is no GPS Location line in this block");
    }
    if (auto no = of_time(*gps)) return no;
    return of_position(*gps, out);
  }

 private:
  [[nodiscard]] model::Refusal refused(std::string rule, std::string reason) const {
    model::Refusal r;
    r.rule = std::move(rule);
    r.reason = std::move(reason);
    r.glider = block_.vehicle;
    r.heard = block_.heard;
    if (const auto& gps = block_.gps) {
      r.lat_ddmm = gps->lat_text;
      r.lon_ddmm = gps->lon_text;
    }
    return r;
  }

  [[nodiscard]] std::optional<model::Refusal> of_name() const {
    if (block_.vehicle.empty()) return refused("S2", "the block does not name the vehicle");
    if (!limits_.glider.empty() && !equal_without_case(block_.vehicle, limits_.glider))
      return refused("S2", "this is glider " + block_.vehicle + ", expected is " + lower(limits_.glider));
    return std::nullopt;
  }

  [[nodiscard]] std::optional<model::Refusal> of_console() const {
    if (block_.console != Console::gliderdos && block_.console != Console::gliderlab) return std::nullopt;
    const std::string prompt = block_.console == Console::gliderdos ? "GliderDos" : "GliderLAB";
    return refused("S8", "printed at the " + prompt + " prompt: a position report, no mission is running");
  }

  [[nodiscard]] std::optional<model::Refusal> of_time(const Location& gps) const {
    const auto sentinel = [](std::string_view text) {
      const auto value = number_from(text);
      return value && std::abs(*value) >= kSentinel;
    };
    if (sentinel(gps.lat_text) || sentinel(gps.lon_text))
      return refused("S3", "the glider has had no GPS fix yet (" + gps.lat_text + ")");
    if (!block_.curr_time) return refused("S3", "the block has no readable Curr Time, so the fix has no time");
    if (gps.age_s >= kNeverUpdated)
      return refused("S3", "the fix has no age: it was never updated since the glider started");
    if (gps.age_s > limits_.max_age.count())
      return refused("S3", "the fix is " + text_of(gps.age_s, 0) + " s old, allowed are " +
                               text_of(limits_.max_age.count(), 0) + " s");
    if (gps.age_s < kYoungest) return refused("S3", "the fix is " + text_of(-gps.age_s, 0) + " s in the future");
    return std::nullopt;
  }

  /// `letter` is the axis's positive one; the opposite one negates an unsigned number.
  static Expected<double, std::string> degrees(const std::string& text, char letter, char positive, char negative,
                                               Axis axis) {
    const bool opposite = letter == negative;
    if (letter != positive && !opposite)
      return unexpected(std::string{"the letter behind "} + text + " is " + letter + ", expected is " + positive);
    if (opposite && text.starts_with('-'))
      return unexpected(text + " " + letter + " has a sign and the letter of the other hemisphere");
    const auto deg = degrees_from_ddmm(text, axis);
    if (!deg) return unexpected(deg.error().message());
    return opposite ? -*deg : *deg;
  }

  [[nodiscard]] std::optional<model::Refusal> of_position(const Location& gps, model::Surfacing& out) const {
    const auto lat = degrees(gps.lat_text, gps.lat_letter, 'N', 'S', Axis::latitude);
    if (!lat) return refused("S3", lat.error());
    const auto lon = degrees(gps.lon_text, gps.lon_letter, 'E', 'W', Axis::longitude);
    if (!lon) return refused("S3", lon.error());
    if (*lat == 0.0 && *lon == 0.0) return refused("S3", "the fix is 0 N 0 E: a value that was never set");
    const auto fix = GeoPoint::from_degrees(*lat, *lon);
    if (!fix) return refused("S3", fix.error().message());
    out.glider = block_.vehicle;
    out.heard = block_.heard;
    out.fix = *fix;
    out.fix_age = Seconds{gps.age_s};
    out.fix_taken = after(block_.heard, -out.fix_age);
    out.curr_time = *block_.curr_time;
    out.lat_ddmm = gps.lat_text;
    out.lon_ddmm = gps.lon_text;
    return std::nullopt;
  }

  const SurfaceBlock& block_;
  const Limits& limits_;
};

void take_mission(const SurfaceBlock& block, model::Surfacing& out) {
  if (block.mission) {
    out.mission = lower(block.mission->file);
    out.segment = block.mission->segment;
  }
  if (block.because)
    out.because = model::SurfaceReason{block.because->text, block.because->behavior, block.because->start_when};
  out.at_surface = block.at_surface && block.because && block.mission;
  if (block.until_diving_s) out.until_diving = Seconds{*block.until_diving_s};
}

/// Readings beyond this age are of another dive, or were never taken.
std::optional<double> recent(const SurfaceBlock& block, std::string_view name, double max_age_s) {
  const auto* reading = block.sensor(name);
  if (reading == nullptr || reading->age_s > max_age_s) return std::nullopt;
  return reading->value;
}

void take_water(const SurfaceBlock& block, const Limits& limits, model::Surfacing& out) {
  const bool complete = block.water == WaterState::complete;
  const auto take = [&](std::string_view x_name, std::string_view y_name, bool final_value) {
    const auto x = recent(block, x_name, limits.max_water_age.count());
    const auto y = recent(block, y_name, limits.max_water_age.count());
    if (!x || !y || !(std::hypot(*x, *y) <= kMaxWaterSpeed)) return;
    out.water = model::LocalVelocity{MetresPerSecond{*x}, MetresPerSecond{*y}};
    out.water_is_final = final_value;
  };
  take("m_water_vx", "m_water_vy", complete);
  // A list of surface sensors without them may have what they are made of. Until it is complete the final one is that of
  // the dive before.
  if (block.sensor("m_water_vx") != nullptr || block.sensor("m_water_vy") != nullptr) return;
  if (complete) take("m_final_water_vx", "m_final_water_vy", true);
  if (!out.water) take("m_initial_water_vx", "m_initial_water_vy", false);
}

void take_aim(const SurfaceBlock& block, model::Surfacing& out) {
  if (!block.waypoint) return;
  const auto lat = latitude_from_ddmm(block.waypoint->lat_text);
  const auto lon = longitude_from_ddmm(block.waypoint->lon_text);
  if (!lat || !lon) return;
  out.aim = model::AimLine{GeoPoint{*lat, *lon}, Metres{block.waypoint->range_m}, block.waypoint->bearing_deg};
}

bool is_meaningful(const SensorReading& reading) {
  const bool position = reading.unit == "lat" || reading.unit == "lon";
  if (position && std::abs(reading.value) >= kSentinel) return false;
  if (reading.age_s < kNeverUpdated) return true;
  const std::string_view name = reading.name;
  return name.starts_with("u_") || (name.starts_with("c_") && !position);
}

void take_sensors(const SurfaceBlock& block, model::Surfacing& out) {
  constexpr double kSlowest = 0.01, kFastest = 3.0;
  for (const auto& reading : block.sensors)
    if (is_meaningful(reading)) out.sensors[reading.name] = reading.value;
  if (const auto speed = recent(block, "m_avg_speed", kNeverUpdated); speed && *speed >= kSlowest && *speed <= kFastest)
    out.believed_speed = MetresPerSecond{*speed};
  if (const auto variation = recent(block, "m_gps_mag_var", kNeverUpdated); variation && std::abs(*variation) < kPi)
    out.magnetic_variation = Radians{*variation};
  const auto* correction = block.sensor("u_use_current_correction");
  if (correction != nullptr && (correction->value == 0 || correction->value == 1 || correction->value == 2))
    out.current_correction = static_cast<int>(correction->value);
}

}  // namespace

model::Surfacing facts_beside_fix(const SurfaceBlock& block, const Limits& limits) {
  model::Surfacing out;
  take_mission(block, out);
  take_water(block, limits, out);
  take_aim(block, out);
  take_sensors(block, out);
  return out;
}

Expected<model::Surfacing, model::Refusal> accept_fix(const SurfaceBlock& block, const Limits& limits) {
  model::Surfacing out = facts_beside_fix(block, limits);
  if (auto no = Judgement{block, limits}.objection(out)) return unexpected(std::move(*no));
  return out;
}

Expected<model::Surfacing, model::Refusal> accept_fix(const SurfaceBlock& block, const std::string& glider) {
  Limits limits;
  limits.glider = glider;
  return accept_fix(block, limits);
}

}  // namespace glidehelm::protocol
