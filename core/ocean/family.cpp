#include "core/ocean/family.hpp"

#include <cmath>

namespace glidehelm::ocean {

void CurrentMoments::Component::add(double value, double count) {
  const double before = value - mean;
  mean += before / count;
  squares += before * (value - mean);
}

void CurrentMoments::add(const Current& current) {
  ++count_;
  const auto count = static_cast<double>(count_);
  east_.add(current.east.si(), count);
  north_.add(current.north.si(), count);
}

std::optional<Spread> CurrentMoments::spread() const {
  if (count_ < 2) return std::nullopt;
  const auto freedom = static_cast<double>(count_ - 1);
  return Spread{MetresPerSecond{std::sqrt(east_.squares / freedom)},
                MetresPerSecond{std::sqrt(north_.squares / freedom)}};
}

Expected<FamilySample, NoCurrent> Family::sample(GeoPoint p, Depth z, double t_s) const {
  CurrentMoments moments;
  bool extrapolated = false;
  std::optional<NoCurrent> dry;
  for (const auto& member : members_) {
    const auto sample = member.sample(p, z, t_s);
    if (!sample) {
      dry = dry.value_or(sample.error());
      continue;
    }
    moments.add(sample->current);
    extrapolated = extrapolated || sample->extrapolated;
  }
  if (dry && 2 * moments.count() < size()) return unexpected(*dry);
  return FamilySample{moments.mean(), moments.spread(), moments.count(), extrapolated};
}

}  // namespace glidehelm::ocean
