#include "core/planning/segment_time.hpp"

#include <cmath>

#include "core/vehicle/constrained_motion.hpp"

namespace glidehelm::planning {

namespace {

constexpr int kMostHalvings = 7;
constexpr double kThreshold = 0.05;  // of the speed

struct Spot {
  double lat, lon;
};
struct Passage {
  double seconds;
  Current at_end;
};

class Splitter {
 public:
  Splitter(const MeanMotion& motion, std::uint64_t& evaluations) : motion_{motion}, evaluations_{evaluations} {}

  [[nodiscard]] Expected<Current, NoPassage> current(Spot at, double t_s) {
    ++evaluations_;
    return motion_.current(at.lat, at.lon, t_s);
  }

  [[nodiscard]] Expected<Passage, NoPassage> pass(Spot from, const Current& begin, Spot to, double t_s, int halvings) {
    const auto way = local_offset(from.lat, from.lon, to.lat, to.lon);
    const auto seconds = [&](const Current& c) {
      return vehicle::crossing_time(way, motion_.speed(), c.east.si(), c.north.si());
    };
    const double guess = seconds(begin).value_or(way.length() / motion_.speed());
    const auto end = current(to, t_s + guess);
    if (!end) return unexpected(end.error());
    const Current mean{0.5 * (begin.east + end->east), 0.5 * (begin.north + end->north)};
    if (halvings < kMostHalvings) {
      const Spot half{0.5 * (from.lat + to.lat), 0.5 * (from.lon + to.lon)};
      const auto middle = current(half, t_s + 0.5 * guess);
      if (!middle) return unexpected(middle.error());
      if (differ(begin, *end, kThreshold) || differ(*middle, mean, 0.5 * kThreshold)) {
        const auto first = pass(from, begin, half, t_s, halvings + 1);
        if (!first) return first;
        auto second = pass(half, first->at_end, to, t_s + first->seconds, halvings + 1);
        if (!second) return second;
        return Passage{first->seconds + second->seconds, second->at_end};
      }
    }
    const auto t = seconds(mean);
    if (!t) return unexpected(NoPassage::too_strong);
    return Passage{*t, *end};
  }

 private:
  [[nodiscard]] bool differ(const Current& a, const Current& b, double share) const {
    return std::hypot(a.east.si() - b.east.si(), a.north.si() - b.north.si()) > share * motion_.speed();
  }

  const MeanMotion& motion_;
  std::uint64_t& evaluations_;
};

}  // namespace

Expected<double, NoPassage> segment_time(const MeanMotion& motion, double lat0, double lon0, double lat1, double lon1,
                                         double t_s, std::uint64_t& evaluations) {
  Splitter splitter{motion, evaluations};
  const auto begin = splitter.current({lat0, lon0}, t_s);
  if (!begin) return unexpected(begin.error());
  const auto passage = splitter.pass({lat0, lon0}, *begin, {lat1, lon1}, t_s, 0);
  if (!passage) return unexpected(passage.error());
  return passage->seconds;
}

}  // namespace glidehelm::planning
