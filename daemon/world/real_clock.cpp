#include "daemon/world/real_clock.hpp"

#include <time.h>

#include <algorithm>

namespace glidehelm::world {

RealClock::RealClock(RealLoop& loop) : timer_{loop.context} {}

Instant RealClock::utc() const {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return Instant{std::chrono::seconds{now.tv_sec} + std::chrono::milliseconds{now.tv_nsec / 1'000'000}};
}

Tick RealClock::tick() const {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return Tick{std::chrono::seconds{now.tv_sec} + std::chrono::milliseconds{now.tv_nsec / 1'000'000}};
}

TimerId RealClock::call_at(Tick when, std::function<void()> then) {
  const auto id = queue_.add(when, std::move(then));
  arm();
  return id;
}

void RealClock::cancel(TimerId id) {
  queue_.cancel(id);
  arm();
}

/// The Asio timer runs on CLOCK_MONOTONIC, which stands still in a suspend: it is armed for at most a minute, so that a
/// tick of CLOCK_BOOTTIME is at most a minute late after one.
void RealClock::arm() {
  const auto next = queue_.next();
  if (!next) {
    timer_.cancel();
    return;
  }
  const auto wait = std::clamp<Tick::duration>(*next - tick(), Tick::duration{0}, std::chrono::minutes{1});
  timer_.expires_after(wait);
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) fire();
  });
}

void RealClock::fire() {
  while (auto then = queue_.take_due(tick())) (*then)();
  arm();
}

}  // namespace glidehelm::world
