#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/expected.hpp"
#include "core/chart/coast.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm coast (--area W/E/S/N … | --from FILE) [--grow M] [--simplify M] -o FILE`.
struct CoastOptions {
  /// Each "W/E/S/N" in degrees; E may be west of W by the number (across the antimeridian) or exceed 180. Several become one file
  /// (chart::joined_areas).
  std::vector<std::string> areas{};
  std::string output;                  ///< the coast file; replaced when it exists
  std::string from{};                  ///< a coast file to start from instead of cutting one
  std::optional<double> grow_m{};      ///< land grown by this much (chart::grown_land)
  std::optional<double> simplify_m{};  ///< and simplified outwards by at most this much; 100 with `grow_m` alone
};

/// "-19/-12/26.5/30": degrees, west in [-180, 180], east up to 180° east of it (a smaller number means across the
/// antimeridian: 176/-176), within 85° of the equator, each side at least 0.01°. The error says what is allowed.
Expected<chart::CoastArea, std::string> coast_area(const std::string& text);

/// Cuts GSHHG full resolution (levels 1 to 4: land, lakes, islands in lakes, ponds on them; the ice front for Antarctica)
/// with the program `gmt`, closes it along the border of the area and writes a coast file (chart::Coast), complete or not
/// at all. Which side of the shore is land is asked of gmt at many places along the border; the answers must agree.
///
/// With `grow_m` or `simplify_m` the land is then grown and simplified on the safe side: the file holds all land within
/// `grow_m`, and none farther than `grow_m + simplify_m`.
///
/// Messages go to `err` (progress, when there is more than one part to cut), one summary line to `out`. Returns 0 done,
/// 1 when gmt or GSHHG is missing (the message holds the apt line), answers nonsense, or the file cannot be written, 2
/// when area or output make no sense. Nothing is written unless 0 is returned.
int run_coast(const CoastOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
