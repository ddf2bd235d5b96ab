#pragma once

#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "daemon/world/clock.hpp"

namespace glidehelm::world {

/// Timers by tick, equal ticks in the order they were set. What the real, the simulated and the manual clock share.
class TimerQueue {
 public:
  TimerId add(Tick when, std::function<void()> then) {
    const TimerId id = ++last_;
    timers_.emplace(std::pair{when, id}, std::move(then));
    return id;
  }
  void cancel(TimerId id) {
    for (auto timer = timers_.begin(); timer != timers_.end(); ++timer)
      if (timer->first.second == id) {
        timers_.erase(timer);
        return;
      }
  }
  [[nodiscard]] std::optional<Tick> next() const {
    if (timers_.empty()) return std::nullopt;
    return timers_.begin()->first.first;
  }
  /// Takes the earliest timer at or before `now`; a timer may set others.
  [[nodiscard]] std::optional<std::function<void()>> take_due(Tick now) {
    if (timers_.empty() || timers_.begin()->first.first > now) return std::nullopt;
    auto then = std::move(timers_.begin()->second);
    timers_.erase(timers_.begin());
    return then;
  }

 private:
  std::map<std::pair<Tick, TimerId>, std::function<void()>> timers_;
  TimerId last_{};
};

}  // namespace glidehelm::world
