#include <algorithm>
#include <cstdio>

#include "core/ocean/composite.hpp"

namespace glidehelm::ocean {

std::vector<std::string> CompositeField::faults() const {
  std::vector<std::string> faults;
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const auto& layer = layers_[s];
    const auto name = "source '" + sources_[s].name + "' ";
    if (layer.first_s > layer.last_s) faults.push_back(name + "has no times in the time that it is to be used");
    bool deep = false, here = false;
    for (std::size_t n = 0; n < layer.here.size(); ++n) {
      here = here || layer.here[n];
      deep = deep || (layer.here[n] && layer.inside[n] > 0);
    }
    if (!here)
      faults.push_back(name + "has no node with a current at all its times inside its region");
    else if (!deep)
      faults.push_back(name + "is nowhere wider than the cells at its edges: it is never used");
    const auto &lats = sources_[s].field.latitudes(), &lons = sources_[s].field.longitudes();
    bool meets = sources_.size() == 1;
    for (std::size_t o = 0; o < sources_.size(); ++o) {
      if (o == s) continue;
      const auto& other = layers_[o];
      for (std::size_t n = 0; n < layer.here.size() && !meets; ++n)
        meets =
            layer.here[n] && has_node_near(sources_[o], other, lats.node(n / lons.size()), lons.node(n % lons.size()));
      const double overlap = std::min(layer.last_s, other.last_s) - std::max(layer.first_s, other.first_s);
      const bool hands_over = layer.last_s < other.last_s && layer.first_s <= layer.last_s;
      if (hands_over && overlap < seams_.join.count()) {
        char text[96];
        std::snprintf(text, sizeof text, "overlap by %.1f h, join_h is %.1f", overlap / 3600,
                      seams_.join.count() / 3600);
        faults.push_back(name + "and source '" + sources_[o].name + "' " + text);
      }
    }
    if (here && !meets) faults.push_back(name + "overlaps no other source");
  }
  return faults;
}

}  // namespace glidehelm::ocean
