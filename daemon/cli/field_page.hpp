#pragma once

#include <string>

#include "daemon/cli/field_animate.hpp"

namespace glidehelm::cli {

/// The animation as one HTML page that needs nothing else.
std::string animation_page(const Animation& animation);
/// The animation as KML 2.2.
std::string animation_kml(const Animation& animation);

}  // namespace glidehelm::cli
