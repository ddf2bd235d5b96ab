#pragma once

#include <cstddef>
#include <functional>

namespace glidehelm::world {

/// Calls `body(k)` once for every k from 0 to `count` − 1 on `threads` threads (0: one per processor of this machine) and returns when
/// all calls have. Who gets which k is left to chance, so `body` puts its answer where only k decides. It must be callable from several
/// threads at once and must not throw. With one thread, or one call, everything happens in the caller's.
void for_each_index(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body);

}  // namespace glidehelm::world
