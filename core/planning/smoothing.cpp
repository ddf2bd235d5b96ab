#include "core/planning/smoothing.hpp"

#include <cstddef>
#include <utility>

namespace glidehelm::planning {

namespace {

/// Sets the times of `way` from the one at `first` on. False when a leg cannot be flown.
bool set_times(std::vector<WayPoint>& way, std::size_t first, const StraightTime& seconds) {
  for (std::size_t i = first + 1; i < way.size(); ++i) {
    const auto leg = seconds(way[i - 1], way[i], way[i - 1].t_s);
    if (!leg) return false;
    way[i].t_s = way[i - 1].t_s + *leg;
  }
  return true;
}

/// One round of Table 3: `from` grows a straight line until one of the two tests ends it.
std::vector<WayPoint> merged(std::vector<WayPoint> way, const StraightTime& seconds) {
  std::vector<WayPoint> kept{way.front()};
  std::size_t from = 0;
  for (std::size_t next = 2; next < way.size(); ++next) {
    const auto straight = seconds(way[from], way[next], way[from].t_s);
    if (straight && way[from].t_s + *straight <= way[next].t_s) {
      auto rest = way;
      rest[next].t_s = way[from].t_s + *straight;
      if (set_times(rest, next, seconds) && rest.back().t_s <= way.back().t_s) {
        way = std::move(rest);
        continue;
      }
    }
    from = next - 1;
    kept.push_back(way[from]);
  }
  kept.push_back(way.back());
  return kept;
}

}  // namespace

std::vector<WayPoint> smooth(std::vector<WayPoint> way, const StraightTime& seconds) {
  auto timed = way;
  if (way.empty() || !set_times(timed, 0, seconds)) return way;
  for (std::size_t before = timed.size() + 1; timed.size() < before && timed.size() > 2;) {
    before = timed.size();
    timed = merged(std::move(timed), seconds);
  }
  return timed;
}

}  // namespace glidehelm::planning
