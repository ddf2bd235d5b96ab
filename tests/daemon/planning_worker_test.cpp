#include "daemon/planning_worker.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <future>
#include <vector>

using namespace glidehelm::daemon;

namespace {

constexpr std::chrono::seconds kPatience{30};

/// A job that runs until the test lets it go, and tells whether it was stopped.
struct Held {
  std::promise<void> begun, go;
  std::promise<bool> expired;
  PlanningWorker::Job job() {
    return [this](const std::atomic<bool>& stopped) {
      begun.set_value();
      go.get_future().wait();
      expired.set_value(stopped.load());
    };
  }
};

bool ready(const std::future<void>& future) { return future.wait_for(kPatience) == std::future_status::ready; }

}  // namespace

TEST_CASE("jobs run one after the other in the order in which they came") {
  std::vector<int> order;
  std::promise<void> done;
  {
    PlanningWorker worker;
    for (int i = 0; i < 20; ++i) worker.submit([&order, i](const std::atomic<bool>&) { order.push_back(i); });
    worker.submit([&done](const std::atomic<bool>&) { done.set_value(); });
    REQUIRE(ready(done.get_future()));
  }
  REQUIRE(order.size() == 20);
  for (int i = 0; i < 20; ++i) CHECK(order[static_cast<std::size_t>(i)] == i);
}

TEST_CASE("stopping raises the flag of the job that runs and of no other") {
  PlanningWorker worker;
  Held first, second;
  auto first_expired = first.expired.get_future(), second_expired = second.expired.get_future();
  const auto ticket = worker.submit(first.job());
  worker.submit(second.job());
  first.begun.get_future().wait();
  worker.stop(ticket);
  first.go.set_value();
  CHECK(first_expired.get());
  second.begun.get_future().wait();
  worker.stop(ticket);  // of a job that has ended
  worker.stop(4711);    // of none
  second.go.set_value();
  CHECK_FALSE(second_expired.get());
}

TEST_CASE("a job that waits and is stopped never starts") {
  PlanningWorker worker;
  Held running;
  worker.submit(running.job());
  running.begun.get_future().wait();
  bool ran = false;
  const auto ticket = worker.submit([&ran](const std::atomic<bool>&) { ran = true; });
  worker.stop(ticket);
  std::promise<void> last;
  worker.submit([&last](const std::atomic<bool>&) { last.set_value(); });
  running.go.set_value();
  REQUIRE(ready(last.get_future()));
  CHECK_FALSE(ran);
}

TEST_CASE("what a job holds is released when it ended, before the next begins") {
  PlanningWorker worker;
  auto held = std::make_shared<int>(1);
  const std::weak_ptr<int> watched{held};
  worker.submit([held = std::move(held)](const std::atomic<bool>&) {});
  std::promise<bool> released;
  auto answer = released.get_future();
  worker.submit([&](const std::atomic<bool>&) { released.set_value(watched.expired()); });
  CHECK(answer.get());
}

TEST_CASE("the end of the worker stops the job that runs and drops those that wait") {
  Held running;
  auto expired = running.expired.get_future();
  bool ran = false;
  {
    PlanningWorker worker;
    worker.submit([&](const std::atomic<bool>& stopped) {
      running.begun.set_value();
      while (!stopped) std::this_thread::sleep_for(std::chrono::milliseconds{1});
      running.expired.set_value(true);
    });
    worker.submit([&ran](const std::atomic<bool>&) { ran = true; });
    running.begun.get_future().wait();
  }
  CHECK(expired.get());
  CHECK_FALSE(ran);
}
