#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "core/base/time.hpp"

/// The five adapters: clock, files, net, rng, procs. The only place of the project that asks the system for them; each
/// has a real and a simulated twin (manual twins for tests in tests/support).
namespace glidehelm::world {

using TimerId = std::uint64_t;

/// Names one run of the machine: ticks of two records compare only when it is equal. All zero: not known, simulated.
using BootId = std::array<std::uint8_t, 16>;

/// UTC, monotonic time, and timers. Used from the loop's thread only.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual Instant utc() const = 0;  ///< the world's time: may step
  [[nodiscard]] virtual Tick tick() const = 0;    ///< never steps, counts through suspend (CLOCK_BOOTTIME)
  /// Calls `then` once, from the loop, at or after `when`. Timers of equal tick fire in the order they were set.
  virtual TimerId call_at(Tick when, std::function<void()> then) = 0;
  virtual void cancel(TimerId id) = 0;  ///< no effect on a timer that fired
  /// True when time is handed in by a simulator: every status and log line then says SIMULATED.
  [[nodiscard]] virtual bool simulated() const = 0;
  [[nodiscard]] virtual BootId boot() const { return {}; }
};

}  // namespace glidehelm::world
