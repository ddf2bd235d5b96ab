#include "core/chart/region.hpp"

#include <utility>

namespace glidehelm::chart {

Region::Region(Outline outline) : outline_{std::move(outline)}, even_odd_{outline_}, barrier_{outline_} {}

bool Region::contains(double lat, double lon) const {
  return even_odd_.contains(outline_, {folded(lon - outline_.middle), lat});
}

double Region::distance(const Space& p, double at_most) const { return barrier_.distance(outline_, p, at_most); }

bool Region::touches(double lat0, double lon0, double lat1, double lon1, double margin) const {
  const double x0 = folded(lon0 - outline_.middle);
  const Piece piece{{x0, lat0}, {x0 + folded(lon1 - lon0), lat1}, Space::at(lat0, lon0), Space::at(lat1, lon1)};
  return barrier_.touches(outline_, piece, margin);
}

}  // namespace glidehelm::chart
