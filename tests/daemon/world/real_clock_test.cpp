#include "daemon/world/real_clock.hpp"

#include <time.h>

#include <algorithm>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>

#include "daemon/world/real.hpp"
#include "tests/support/manual_clock.hpp"

using namespace glidehelm;
using namespace glidehelm::world;
using namespace std::chrono_literals;

TEST_CASE("UTC and the monotonic clock are the machine's") {
  RealWorld real;
  const auto& clock = real.world().clock;
  const auto before = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto utc = clock.utc();
  const auto after = std::chrono::ceil<std::chrono::milliseconds>(std::chrono::system_clock::now());
  CHECK(utc >= before);
  CHECK(utc <= after);
  timespec boot{};
  clock_gettime(CLOCK_BOOTTIME, &boot);
  const auto tick = clock.tick();
  // Read after `boot`, in whole milliseconds: not earlier than its millisecond.
  CHECK(tick.time_since_epoch() >=
        std::chrono::seconds{boot.tv_sec} + std::chrono::milliseconds{boot.tv_nsec / 1'000'000});
  CHECK(tick.time_since_epoch() < std::chrono::seconds{boot.tv_sec + 60});
  CHECK_FALSE(clock.simulated());
}

TEST_CASE("the boot id is the kernel's") {
  std::ifstream file{"/proc/sys/kernel/random/boot_id"};
  std::string text, hex;
  file >> text;
  RealWorld real;
  for (const auto byte : real.world().clock.boot()) {
    constexpr const char* kDigits = "0123456789abcdef";
    hex += kDigits[byte >> 4];
    hex += kDigits[byte & 15];
  }
  text.erase(std::remove(text.begin(), text.end(), '-'), text.end());
  CHECK(hex == text);
}

TEST_CASE("timers fire in the order of their ticks, equal ones as they were set, never early, never when cancelled") {
  RealWorld real;
  auto world = real.world();
  const auto now = world.clock.tick();
  std::string order;
  bool early = false;
  const auto at = [&](std::chrono::milliseconds wait, char name) {
    return world.clock.call_at(now + wait, [&, wait, name] {
      early = early || world.clock.tick() < now + wait;
      order += name;
    });
  };
  at(30ms, 'd');
  at(10ms, 'b');
  at(10ms, 'c');
  const auto cancelled = at(20ms, 'x');
  at(-5ms, 'a');  // already due
  world.clock.call_at(now + 40ms, [&] {
    order += 'e';
    world.clock.call_at(now + 45ms, [&] {
      order += 'f';
      world.net.stop();
    });
  });
  world.clock.cancel(cancelled);
  world.clock.cancel(9999);
  world.net.run();
  CHECK(order == "abcdef");
  CHECK_FALSE(early);
}

TEST_CASE("a clock in the test's hand fires each timer at its own tick and steps UTC alone") {
  test::ManualClock clock;
  const auto utc = clock.utc();
  const auto tick = clock.tick();
  std::vector<std::int64_t> fired;
  const auto note = [&] { fired.push_back((clock.tick() - tick).count()); };
  clock.call_at(tick + 2s, note);
  clock.call_at(tick + 1s, [&] {
    note();
    clock.call_at(tick + 1500ms, note);
  });
  const auto cancelled = clock.call_at(tick + 1s, note);
  clock.cancel(cancelled);
  clock.call_at(tick + 10s, note);
  clock.advance(Seconds{3});
  CHECK(fired == std::vector<std::int64_t>{1000, 1500, 2000});
  CHECK(clock.utc() == utc + 3s);
  CHECK(clock.next_timer() == tick + 10s);
  clock.step_utc(Seconds{-3600});
  CHECK(clock.utc() == utc + 3s - 1h);
  CHECK(clock.tick() == tick + 3s);
  CHECK(clock.advance_to_next());
  CHECK(clock.tick() == tick + 10s);
  CHECK_FALSE(clock.advance_to_next());
}
