#include "daemon/world/workers.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace glidehelm::world {

void for_each_index(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) body(k);
  };
  const std::size_t wanted = threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::jthread> others;
  for (std::size_t n = 1; n < std::min(wanted, count); ++n) others.emplace_back(work);
  work();
}

}  // namespace glidehelm::world
