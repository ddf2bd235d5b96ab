#pragma once

#include <utility>

#include <boost/asio/steady_timer.hpp>

#include "daemon/world/real_loop.hpp"
#include "daemon/world/timer_queue.hpp"

namespace glidehelm::world {

/// CLOCK_REALTIME, CLOCK_BOOTTIME, and one Asio timer for the earliest of all timers.
class RealClock final : public Clock {
 public:
  explicit RealClock(RealLoop& loop);
  [[nodiscard]] Instant utc() const override;
  [[nodiscard]] Tick tick() const override;
  TimerId call_at(Tick when, std::function<void()> then) override;
  void cancel(TimerId id) override;
  [[nodiscard]] bool simulated() const override { return false; }
  [[nodiscard]] BootId boot() const override;  ///< of /proc/sys/kernel/random/boot_id

 private:
  void arm();
  void fire();
  boost::asio::steady_timer timer_;
  TimerQueue queue_;
};

}  // namespace glidehelm::world
