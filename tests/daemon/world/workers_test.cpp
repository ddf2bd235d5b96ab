#include "daemon/world/workers.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <thread>
#include <vector>

using namespace glidehelm;

TEST_CASE("workers call every index once whatever their number") {
  for (const unsigned threads : {0U, 1U, 2U, 7U}) {
    std::vector<int> calls(1000, 0);  // one place per index: no two calls share one
    world::for_each_index(calls.size(), threads, [&](std::size_t k) { ++calls[k]; });
    CHECK(calls == std::vector<int>(1000, 1));
  }
}

TEST_CASE("one worker works in the thread of its caller and in order") {
  std::vector<std::size_t> order;
  bool elsewhere = false;
  const auto here = std::this_thread::get_id();
  world::for_each_index(5, 1, [&](std::size_t k) {
    order.push_back(k);
    elsewhere = elsewhere || std::this_thread::get_id() != here;
  });
  CHECK(order == std::vector<std::size_t>{0, 1, 2, 3, 4});
  CHECK_FALSE(elsewhere);
}

TEST_CASE("two workers are at work at the same time") {
  // Each call waits for the other one to have begun: with one thread this would never end.
  std::atomic<int> begun{0};
  world::for_each_index(2, 2, [&](std::size_t) {
    ++begun;
    while (begun < 2) std::this_thread::yield();
  });
  CHECK(begun == 2);
}

TEST_CASE("what workers do in turns never overlaps") {
  world::Turns turns;
  int inside = 0, most = 0, done = 0;  // not atomic: only a turn touches them
  world::for_each_index(500, 4, [&](std::size_t) {
    turns.take([&] {
      most = std::max(most, ++inside);
      std::this_thread::yield();
      --inside;
      ++done;
    });
  });
  CHECK(most == 1);
  CHECK(done == 500);
}

TEST_CASE("no index is no call") {
  world::for_each_index(0, 4, [](std::size_t) { FAIL(); });
}
