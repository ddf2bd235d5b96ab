#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/ingest/grid_file.hpp"
#include "daemon/ingest/units.hpp"
#include "daemon/ingest/vertical.hpp"

/// The levels of a model's velocity, as its files describe them.
namespace glidehelm::ingest {

/// Which dimension of a velocity is what. The last two are rows and columns.
struct Splitting {
  std::optional<std::size_t> time, level;  ///< positions
  const Variable* time_coordinate{};       ///< in the velocity's file; null: none
  const Variable* level_coordinate{};      ///< depths, or s or sigma; null: none
  bool terrain{};                          ///< the levels follow the terrain
};
/// By the one-dimensional variables over each dimension, else by the dimension's name; dimensions of length one that are
/// neither are read at 0. Refused: fewer than two dimensions, a dimension longer than one that is neither time nor level.
Result<Splitting> split(const Found& velocity);
std::size_t length_of(const Found& found, std::size_t position);

/// The levels, ready to be used.
struct Levels {
  std::size_t count{1};
  bool has_depth{};
  std::vector<double> depths;      ///< z-levels: of the grid that is made, ascending
  std::vector<std::size_t> order;  ///< z-levels: level of the file for each depth; empty: as they come
  std::optional<TerrainLevels> terrain;
  std::vector<double> h;  ///< terrain: depth of the water at the centres, NaN on land
  Found zeta;             ///< terrain: height of the surface; may be missing
  std::string words;
};

/// z-levels with their depths; or terrain-following ones by the file's own description: `standard_name` and `formula_terms`
/// of CF (sigma and the three s-coordinates), and ROMS' variables Vtransform, s_rho, Cs_r, hc, h, zeta. Cs_r that is missing
/// is computed from Vstretching, theta_s and theta_b. `given` counts where the files do not say the law, the stretching or
/// hc; where they say all of them it is not used, with a warning. h may stand in the grid file. Depths count from the moving
/// surface where the file has zeta at the velocity's times, else from zeta = 0, which is said.
///
/// Refused: terrain-following levels whose law, stretching or water depth is not known; other CF vertical coordinates, by
/// name; a Vtransform that contradicts the standard_name.
Result<Levels> levels_of(const ModelFiles& files, const ModelVelocity& velocity, const Splitting& u, const Splitting& v,
                         const Shape& centres, const Units& units, const std::optional<StretchingChoice>& given,
                         std::vector<std::string>& warnings);

/// Height of the surface at a time index of the velocity, per centre; empty when the files have none.
Result<std::vector<double>> surface_at(const Levels& levels, std::size_t time);

}  // namespace glidehelm::ingest
