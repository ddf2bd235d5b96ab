#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/mission/pilot.hpp"
#include "core/mission/wording.hpp"

// What the pilot learns from surfacings.
namespace glidehelm::mission {

namespace {

constexpr double kPostFix = 60.0;     // s: from the resumed mission to the dive (slocum.md 4.6)
constexpr double kTold = 0.02;        // a change of speed or times by this share is said
constexpr double kToldTurn = 1.0;     // degrees
constexpr double kToldSpread = 0.25;  // a change of a source's spread by this share is said

bool differs(double a, double b) { return std::abs(a - b) > kTold * std::abs(b); }

}  // namespace

void Pilot::set_mission(std::optional<Mission> mission) {
  mission_ = std::move(mission);
  if (mission_ && takes_forecast_water(*mission_)) {
    auto vehicle = in_water(*mission_, water_ ? water_->layers : std::vector<ocean::WaterLayer>{});
    if (water_) tell_water(vehicle);
    mission_ = std::move(vehicle.mission);
  }
  const Mission guesses = mission_.value_or(Mission{});
  learning_.configure(guesses);
  learning_before_.configure(guesses);
  learned_ = learning_.learned();
}

/// In force at once, but for a surfacing that has candidates: they and their verdicts keep the vehicle that the plan began with.
void Pilot::on(const ForecastWater& e) {
  if (forecast_water() == e) return;
  water_waits_.reset();
  if (stage_ == Stage::planning && !ranked_.empty()) {
    water_waits_ = e;
    return;
  }
  if (take_water(e) && stage_ == Stage::planning) plan_again();
}

/// True when the vehicle is another one with it.
bool Pilot::take_water(const ForecastWater& water) {
  water_ = water;
  if (!mission_ || !takes_forecast_water(*mission_)) return false;
  auto vehicle = in_water(*mission_, water.layers);
  tell_water(vehicle);
  const bool other = vehicle.mission != *mission_;
  mission_ = std::move(vehicle.mission);
  for (auto* learning : {&learning_before_, &learning_}) learning->follow_water(*mission_);
  learned_ = learning_.learned();
  return other;
}

void Pilot::tell_water(const InWater& vehicle) {
  if (!vehicle.refused.empty())
    say(Level::alert, "water",
        fmt::format("the body of vehicle.force_balance does not fly in the forecast's water ({}): {}", water_->words,
                    vehicle.refused));
  std::string whose{words(vehicle.from)};
  if (vehicle.from == WaterFrom::climatology && vehicle.refused.empty()) whose += ", for want of the forecast's water";
  if (vehicle.refused.empty() && !water_->words.empty()) whose += " (" + water_->words + ")";
  say(Level::info, "water",
      fmt::format("by its forces the glider makes {:.3f} m/s, {:.1f} deg below the horizon, in {}",
                  vehicle.mission.horizontal_speed.si(), in_degrees(vehicle.mission.glide_angle), whose));
}

std::optional<Dive> Pilot::dive_under_way() const {
  if (!last_) return std::nullopt;
  Dive dive;
  dive.from = last_->fix;
  dive.from_s =
      dived_at_ ? epoch_seconds(*dived_at_) + kPostFix : epoch_seconds(last_->fix_taken) + learned_.surface.count();
  for (const auto& ranked : ranked_) {  // the drift is the same in every plan of this surfacing
    if (ranked.candidate.plan.stints.empty()) continue;
    dive.from = ranked.candidate.plan.stints.front().dive;
    dive.drift_known = true;
  }
  return dive;
}

void Pilot::begin_learning(const SurfacingHeard& e) {
  SurfacingSeen seen;
  if (last_) seen.before = seen_.at;
  seen.dive_said = dived_at_;
  seen.dive = dive_under_way();
  seen.forecast = e.forecast;
  seen.shares = e.shares;
  seen.extrapolated = e.extrapolated;
  seen.at = e.surfacing;
  learning_before_ = learning_;
  seen_ = std::move(seen);
  learn_more(e.surfacing);
}

/// A later block of the same surfacing: values that it leaves out stay, and a final current is not replaced by an
/// initial one.
void Pilot::learn_more(const model::Surfacing& s) {
  auto& known = seen_.at;
  if (s.water && (s.water_is_final || !known.water_is_final)) {
    known.water = s.water;
    known.water_is_final = s.water_is_final;
  }
  if (!s.mission.empty()) known.mission = s.mission;
  if (!s.segment.empty()) known.segment = s.segment;
  if (s.believed_speed) known.believed_speed = s.believed_speed;
  if (s.current_correction) known.current_correction = s.current_correction;
  if (s.magnetic_variation) known.magnetic_variation = s.magnetic_variation;
  const auto same = [&](const model::AimLine& aim) { return aim.at == s.aim->at; };
  if (s.aim && std::none_of(seen_.aims.begin(), seen_.aims.end(), same)) {
    seen_.aims.push_back(*s.aim);
    seen_.aims_from.push_back(s.fix);
  }
  learn();
}

/// From what was known before this surfacing and all that it has said: later blocks replace, they do not add.
void Pilot::learn() {
  learning_ = learning_before_;
  learning_.see(seen_);
  learned_ = learning_.learned();
}

/// Says what changed so much that a pilot would want to know.
void Pilot::tell_learned() {
  const bool first = told_.stint.count() == 0;
  const auto& now = learned_;
  const double turned = std::abs(in_degrees(wrapped(now.rotation.clockwise - told_.rotation.clockwise)));
  if (first || now.rotation.from != told_.rotation.from || turned > kToldTurn) {
    if (!first || now.rotation.from != FrameRotation::From::assumed_zero)
      say(Level::info, "frame",
          fmt::format("the glider's frame is turned {:+.1f} deg (to within {:.1f}), {}",
                      in_degrees(now.rotation.clockwise), in_degrees(now.rotation.spread), word(now.rotation.from)));
    told_.rotation = now.rotation;
  }
  // The first surfacing has no Waypoint: line yet; a frame that is still unknown at the second one stays so.
  const bool unknown = now.rotation.from == FrameRotation::From::assumed_zero;
  if (unknown && !first && believed_ && !unknown_frame_told_)
    say(Level::note, "frame",
        fmt::format(
            "nothing tells how the glider's frame is turned (no m_gps_mag_var, no Waypoint: line beyond 1 km, no "
            "vehicle.local_frame_rotation_deg): its measured current is taken for east and north, to within "
            "{:.0f} deg",
            in_degrees(now.rotation.spread)));
  unknown_frame_told_ = unknown && (unknown_frame_told_ || (!first && believed_));
  if (const auto lines = learning_.contradicted(); lines && !contradiction_told_) {
    contradiction_told_ = true;
    say(Level::note, "frame",
        fmt::format("the Waypoint: lines say that the frame is turned {:+.1f} deg, configured are {:+.1f}: the "
                    "configured value is used",
                    in_degrees(*lines), in_degrees(now.rotation.clockwise)));
  }
  const bool times =
      differs(now.stint.count(), told_.stint.count()) || differs(now.surface.count(), told_.surface.count());
  if (times && !first)
    say(Level::info, "learned",
        fmt::format("stints take {} (to within {:.0f} min), the surface interval {:.0f} min", hours(now.stint),
                    now.stint_spread.count() / 60, now.surface.count() / 60));
  const bool speed = differs(now.speed.si(), told_.speed.si()) ||
                     std::abs(in_degrees(now.heading_bias - told_.heading_bias)) > kToldTurn;
  if (speed && !first)
    say(Level::info, "learned",
        fmt::format("speed through water {:.3f} m/s (to within {:.3f}), heading off by {:+.1f} deg (to within {:.1f})",
                    now.speed.si(), now.speed_spread.si(), in_degrees(now.heading_bias),
                    in_degrees(now.heading_bias_spread)));
  for (const auto& name : now.source_errors.sources()) {
    const double sigma = now.source_errors.spread(name).si();
    if (std::abs(sigma - told_.source_errors.spread(name).si()) <= kToldSpread * sigma) continue;
    say(Level::info, "source",
        fmt::format("{} differs from what the glider measures by {:.2f} m/s in each component (one standard deviation)",
                    name.empty() ? "the forecast" : "source '" + name + "'", sigma));
    told_.source_errors = now.source_errors;
  }
  if (times || first) told_.stint = now.stint, told_.surface = now.surface;
  if (speed || first) told_.speed = now.speed, told_.heading_bias = now.heading_bias;
}

/// What the glider measured, as it believes it; marked where nothing is learned from it.
std::string Pilot::measured_text() const {
  if (!believed_) {
    if (!last_) return "";  // the first one has not dived yet
    const bool steers_by_it = mission_ && mission_->current_correction == 1;
    return std::string{", no measured current in the dialog"} + (steers_by_it ? " (aimed as for still water)" : "");
  }
  std::string text = fmt::format(", measured current {:.2f} m/s towards {:03.0f} deg", believed_->speed().si(),
                                 Course::of(believed_->east.si(), believed_->north.si()).degrees());
  if (!learned_.water)
    text += " (the first of its mission: not learned from)";
  else if (!learned_.water->final_value)
    text += " (initial)";
  return text;
}

void Pilot::greet(const model::Surfacing& s) {
  std::string text = fmt::format("surfacing {}: fix {} taken {}", count_, place(s.fix), clock_text(s.fix_taken));
  text += measured_text();
  if (mission_) text += fmt::format(", {:.1f} km to the goal", distance(s.fix, mission_->goal).si() / 1000);
  text += compared_with_expected(s);
  say(Level::info, "surfacing", text);
  arrive_if_there(s);
}

}  // namespace glidehelm::mission
