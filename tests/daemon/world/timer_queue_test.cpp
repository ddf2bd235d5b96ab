#include "daemon/world/timer_queue.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace glidehelm;
using world::TimerQueue;

namespace {
constexpr Tick at(int ms) { return Tick{std::chrono::milliseconds{ms}}; }
}  // namespace

TEST_CASE("a queue gives what is due, earliest first, equal ticks as they were added") {
  TimerQueue queue;
  std::string order;
  CHECK_FALSE(queue.next());
  CHECK_FALSE(queue.take_due(at(100)));
  queue.add(at(20), [&] { order += 'c'; });
  queue.add(at(10), [&] { order += 'a'; });
  const auto cancelled = queue.add(at(10), [&] { order += 'x'; });
  queue.add(at(10), [&] { order += 'b'; });
  queue.add(at(21), [&] { order += 'd'; });
  CHECK(queue.next() == at(10));
  queue.cancel(cancelled);
  queue.cancel(cancelled);
  while (auto then = queue.take_due(at(20))) (*then)();
  CHECK(order == "abc");
  CHECK(queue.next() == at(21));
}
