#include "core/ocean/flooded.hpp"

#include <array>
#include <cstddef>

namespace glidehelm::ocean {

namespace {

bool is_dry(NoCurrent reason) {
  return reason == NoCurrent::land || reason == NoCurrent::no_data || reason == NoCurrent::below_bottom;
}

}  // namespace

Expected<Sample, NoCurrent> FloodedField::sample(GeoPoint p, Depth z, double t_s) const {
  auto answer = field_.sample(p, z, t_s);
  if (!answer && is_dry(answer.error())) return Sample{};
  return answer;
}

void FloodedField::advance(Lanes& lanes, double t_s, double dt) const {
  const Lanes before = lanes;
  field_.advance(lanes, t_s, dt);
  Lanes dry = before;
  std::array<bool, Lanes::kMax> again{};
  bool any = false;
  const auto n = static_cast<std::size_t>(lanes.count);
  for (std::size_t k = 0; k < n; ++k) {
    again[k] = before.lost[k] == 0 && lanes.lost[k] != 0 && is_dry(static_cast<NoCurrent>(lanes.lost[k]));
    dry.lost[k] = again[k] ? 0 : 1;
    any = any || again[k];
  }
  if (!any) return;
  advance_by_samples(*this, dry, t_s, dt);
  for (std::size_t k = 0; k < n; ++k) {
    if (!again[k]) continue;
    lanes.lat[k] = dry.lat[k];
    lanes.lon[k] = dry.lon[k];
    lanes.lost[k] = dry.lost[k];
  }
}

}  // namespace glidehelm::ocean
