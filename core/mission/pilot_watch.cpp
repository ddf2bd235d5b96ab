#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/mission/pilot.hpp"
#include "core/mission/wording.hpp"

// When and where the next surfacing is expected, and what is said when it is late or far off.
namespace glidehelm::mission {

namespace {

constexpr double kFarOff = 3.0;          // standard deviations
constexpr double kLeastFarOff = 1000.0;  // m
constexpr double kNoted = 0.1;           // of an interval (product.md 1), as are the next two
constexpr double kPaged = 2.5;
constexpr Seconds kPagedAt{14 * 3600.0};
constexpr Seconds kAfterNote{60};  // a page follows a note, never the other way round
constexpr double kSameDive =
    0.25;  // of a stint: a call that much off its time ended another dive than the one promised

}  // namespace

/// The answer to this surfacing is decided: what it promises is expected.
void Pilot::expect_next() {
  expect_place();
  watch_for_call();
}

/// Where the next surfacing is promised, and how far off it may be: error of the forecast, speed, heading and length of
/// the stint, each over the stint. Nothing is promised when nothing was emitted.
void Pilot::expect_place() {
  expected_.reset();
  const Ranked* best = stage_ == Stage::queued ? best_proven() : nullptr;
  if (best == nullptr) return;
  const double t = learned_.stint.count(), u = learned_.speed.si();
  const double current = learned_.correction ? learned_.correction->spread.si() : learned_.forecast_spread.si();
  Expectation e;
  e.at = best->candidate.promise.next_surfacing;
  const auto& stints = best->candidate.plan.stints;
  e.heading = stints.empty() ? Heading{last_ ? geodesic(last_->fix, e.at).departing.from_north() : Radians{}}
                             : stints.front().heading;
  e.along = std::hypot(t * current, std::hypot(t * learned_.speed_spread.si(), u * learned_.stint_spread.count()));
  e.across = std::hypot(t * current, t * u * learned_.heading_bias_spread.si());
  expected_ = e;
}

/// Sets the timers of a late call, by what is learned of stint and surface interval. From the first fix on, so that a
/// surfacing which is cut off, proposed or left to a human is watched like any other.
void Pilot::watch_for_call() {
  if (!mission_ || !last_) {
    for (const Timer t : {Timer::late_note, Timer::late_alert, Timer::late_page}) cancel_timer(t);
    return;
  }
  const Seconds interval = learned_.surface + learned_.stint;
  expected_s_ = epoch_seconds(last_->fix_taken) + interval.count();
  const Tick expected = later(now_.tick, Seconds{*expected_s_ - epoch_seconds(now_.utc)});
  const Seconds note = kNoted * interval;
  set_timer(Timer::late_note, later(expected, note));
  set_timer(Timer::late_alert, later(expected, interval + note));  // then the second call is missed as the first was
  set_timer(Timer::late_page,
            later(expected, std::max(std::min(kPagedAt, kPaged * interval) - interval, note + kAfterNote)));
}

/// Since when the call is awaited.
std::string Pilot::overdue() const {
  return expected_s_ ? hours(Seconds{epoch_seconds(now_.utc) - *expected_s_}) : std::string{"?"};
}

void Pilot::on(const TimerFired& e) {
  if (e.serial != serials_[static_cast<std::size_t>(e.timer)]) return;
  switch (e.timer) {
    case Timer::budget:
      budget_over_ = true;
      emit_if_due();
      return;
    case Timer::deadline:
      emit_if_due();
      return;
    case Timer::late_note:
      late_said_ = true;
      say(Level::note, "late",
          fmt::format("the call is late: expected {}, {} ago", clock_text(instant_at(*expected_s_)), overdue()));
      return;
    case Timer::late_alert:
      late_said_ = true;
      say(Level::alert, "late",
          fmt::format("the second call is missed: expected {}, {} ago", clock_text(instant_at(*expected_s_)),
                      overdue()));
      return;
    case Timer::late_page:
      late_said_ = true;
      say(Level::page, "late",
          fmt::format("no call for {} after it was expected ({})", overdue(), clock_text(instant_at(*expected_s_))));
      return;
  }
}

/// How far a fix is from where it was expected. One that is far off raises an alert when the glider flew our list; as long as
/// only its `Waypoint:` line can tell that, the alert waits for it.
std::string Pilot::compared_with_expected(const model::Surfacing& s) {
  if (!expected_ || !expected_s_) return "";
  const double off_time = std::abs(epoch_seconds(s.fix_taken) - *expected_s_);
  if (off_time > std::max(kSameDive * learned_.stint.count(), kFarOff * learned_.stint_spread.count())) return "";
  const auto off = geodesic(expected_->at, s.fix);
  const Radians turn = off.departing + Radians{-expected_->heading.from_north().si()} - Bearing{};
  const double along = off.length.si() * std::cos(turn.si()), across = off.length.si() * std::sin(turn.si());
  const double sigmas = std::hypot(along / expected_->along, across / expected_->across);
  if (sigmas > kFarOff && off.length.si() > kLeastFarOff) {
    far_off_ = fmt::format("the glider came up {:.1f} km from where it was expected, {:.1f} standard deviations away",
                           off.length.si() / 1000, sigmas);
    if (file_.state() == Delivery::flying || file_.state() == Delivery::reread) tell_far_off();
  } else if (std::exchange(far_off_said_, false)) {
    say(Level::clear, "far-off",
        fmt::format("the glider came up {:.1f} km from where it was expected: all clear", off.length.si() / 1000));
  }
  return fmt::format(", {:.1f} km from where it was expected (to within {:.1f} km along its way and {:.1f} km across)",
                     off.length.si() / 1000, expected_->along / 1000, expected_->across / 1000);
}

void Pilot::tell_far_off() {
  if (!far_off_) return;
  far_off_said_ = true;
  say(Level::alert, "far-off", *std::exchange(far_off_, std::nullopt));
}

}  // namespace glidehelm::mission
