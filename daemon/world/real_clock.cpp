#include "daemon/world/real_clock.hpp"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>

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

BootId RealClock::boot() const {
  BootId id{};
  std::array<char, 64> text{};
  const int fd = ::open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
  if (fd < 0) return id;
  const auto size = ::read(fd, text.data(), text.size());
  ::close(fd);
  std::size_t digit = 0;
  for (ssize_t i = 0; i < size && digit < 32; ++i) {
    const char c = text[static_cast<std::size_t>(i)];
    const int value = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
    if (value < 0) continue;  // the dashes
    auto& byte = id[digit++ / 2];
    byte = static_cast<std::uint8_t>(byte << 4 | value);
  }
  return digit == 32 ? id : BootId{};
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
