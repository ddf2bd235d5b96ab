#include "core/model/surfacing.hpp"

#include <cmath>

namespace glidehelm::model {

bool same_fix(const Surfacing& a, const Surfacing& b) {
  if (a.lat_ddmm != b.lat_ddmm || a.lon_ddmm != b.lon_ddmm) return false;
  const auto taken = [](const Surfacing& s) {
    return static_cast<double>(s.curr_time.time_since_epoch().count()) - s.fix_age.count();
  };
  return std::abs(taken(a) - taken(b)) < 2.0;
}

}  // namespace glidehelm::model
