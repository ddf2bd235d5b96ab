#pragma once

#include <cstddef>
#include <functional>
#include <mutex>

namespace glidehelm::world {

/// Calls `body(k)` once for every k from 0 to `count` − 1 on `threads` threads (0: one per processor of this machine) and returns when
/// all calls have. Who gets which k is left to chance, so `body` puts its answer where only k decides. It must be callable from several
/// threads at once and must not throw. With one thread, or one call, everything happens in the caller's.
void for_each_index(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body);

/// For what the bodies of such calls may only do one at a time: asking the outer world.
class Turns {
 public:
  /// Waits for the turn and calls `body`, which must not take another one.
  template <class Body>
  void take(const Body& body) {
    const std::scoped_lock turn{mutex_};
    body();
  }

 private:
  std::mutex mutex_;
};

}  // namespace glidehelm::world
