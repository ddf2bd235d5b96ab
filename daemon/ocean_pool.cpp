#include "daemon/ocean_pool.hpp"

#include <algorithm>
#include <utility>

#include "core/mission/in_water.hpp"

namespace glidehelm::daemon {

namespace {

/// Everything that a forecast from files is made with.
bool same(const OceanOrder& a, const OceanOrder& b) {
  const auto &m = a.mission, &n = b.mission;
  return a.grids == b.grids && a.cache == b.cache && a.settle == b.settle && a.has_coast == b.has_coast &&
         a.member == b.member && m.currents == n.currents && dive_alike(m, n);
}

}  // namespace

void OceanPool::load(const OceanOrder& order, const std::string& seen, world::World& world, Then then) {
  if (!order.mission.currents.analytic.empty()) return load_ocean_async(order, world, std::move(then));
  std::erase_if(entries_, [](const auto& e) { return e->waiting.empty() && e->ocean.expired(); });
  const auto known = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const auto& e) { return e->seen == seen && same(e->order, order); });
  if (known != entries_.end()) {
    if (!(*known)->waiting.empty()) return (*known)->waiting.push_back(std::move(then));
    // Told from the loop, as an answer that was read would be.
    return world.net.post([ocean = (*known)->ocean.lock(), then = std::move(then)] { then(ocean); });
  }
  const auto entry = std::make_shared<Entry>(Entry{order, seen, {}, {}});
  entry->waiting.push_back(std::move(then));
  entries_.push_back(entry);
  load_ocean_async(order, world, [entry](const OceanOutcome& result) {
    if (result && !(*result)->try_again) entry->ocean = *result;
    for (const auto& tell : std::exchange(entry->waiting, {})) tell(result);
  });
}

}  // namespace glidehelm::daemon
