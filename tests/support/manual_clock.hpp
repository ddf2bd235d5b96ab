#pragma once

#include <vector>

#include "daemon/world/timer_queue.hpp"

namespace glidehelm::test {

/// A clock that stands until the test moves it. Timers fire on the way, each at its own tick.
class ManualClock final : public world::Clock {
 public:
  explicit ManualClock(Instant utc = Instant{std::chrono::milliseconds{1'800'000'000'000}},
                       Tick tick = Tick{std::chrono::milliseconds{1'000}})
      : utc_{utc}, tick_{tick} {}

  [[nodiscard]] Instant utc() const override { return utc_; }
  [[nodiscard]] Tick tick() const override { return tick_; }
  world::TimerId call_at(Tick when, std::function<void()> then) override { return queue_.add(when, std::move(then)); }
  void cancel(world::TimerId id) override { queue_.cancel(id); }
  [[nodiscard]] bool simulated() const override { return simulated_; }
  [[nodiscard]] world::BootId boot() const override { return boot_; }

  /// Both clocks go on by `dt`; a timer that sets another one within `dt` sees it fire too.
  void advance(Seconds dt) {
    const Tick until = tick_ + std::chrono::round<Tick::duration>(dt);
    while (const auto next = queue_.next()) {
      if (*next > until) break;
      if (*next > tick_) go_to(*next);
      if (auto then = queue_.take_due(tick_)) (*then)();
    }
    go_to(until);
  }
  /// Goes to the earliest timer and fires it; false when there is none.
  bool advance_to_next() {
    const auto next = queue_.next();
    if (!next) return false;
    if (*next > tick_) go_to(*next);
    if (auto then = queue_.take_due(tick_)) (*then)();
    return true;
  }
  /// UTC steps, the monotonic clock does not notice.
  void step_utc(Seconds by) { utc_ += std::chrono::round<Instant::duration>(by); }
  [[nodiscard]] std::optional<Tick> next_timer() const { return queue_.next(); }

  void be_simulated() { simulated_ = true; }
  void set_boot(const world::BootId& boot) { boot_ = boot; }

 private:
  void go_to(Tick tick) {
    utc_ += tick - tick_;
    tick_ = tick;
  }
  Instant utc_;
  Tick tick_;
  world::TimerQueue queue_;
  world::BootId boot_{};
  bool simulated_{};
};

}  // namespace glidehelm::test
