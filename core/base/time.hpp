#pragma once

#include <chrono>
#include <cstdint>

namespace glidehelm {

/// A difference of instants.
using Seconds = std::chrono::duration<double>;

/// UTC of the world, to the millisecond: forecasts, fixes, logs.
using Instant = std::chrono::sys_time<std::chrono::milliseconds>;

/// Tag of the monotonic clock (CLOCK_BOOTTIME, or the simulated one). It has no now(): time is handed in.
struct BootClock {
  using duration = std::chrono::milliseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<BootClock>;
  static constexpr bool is_steady = true;
};
/// Monotonic time since boot: deadlines, time-outs, back-off. Never compared with an `Instant`.
using Tick = std::chrono::time_point<BootClock>;

/// Tag of the clock of a glider: a measurement, never our clock.
struct GliderClock {
  using duration = std::chrono::seconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<GliderClock>;
  static constexpr bool is_steady = false;
};
/// What the dialog says (`Curr Time`), as seconds since 1970 on the glider's own clock.
using GliderTime = std::chrono::time_point<GliderClock>;

/// Seconds since 1970-01-01T00:00:00Z as a double: the time axis of fields and integrators.
/// A double resolves 2.4e-7 s here, so sums over a mission keep the millisecond.
constexpr double epoch_seconds(Instant t) { return static_cast<double>(t.time_since_epoch().count()) * 1e-3; }

/// The nearest millisecond. Precondition: |seconds| < 9e12.
constexpr Instant instant_at(double seconds) {
  const double ms = seconds * 1e3;
  return Instant{std::chrono::milliseconds{static_cast<std::int64_t>(ms + (ms < 0 ? -0.5 : 0.5))}};
}

/// `t + dt`, rounded to the millisecond.
constexpr Instant after(Instant t, Seconds dt) { return instant_at(epoch_seconds(t) + dt.count()); }

constexpr Seconds between(Instant from, Instant to) { return Seconds{epoch_seconds(to) - epoch_seconds(from)}; }

}  // namespace glidehelm
