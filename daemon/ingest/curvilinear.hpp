#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/ingest/fault.hpp"

/// Meshes whose latitude and longitude are two-dimensional: ROMS, NEMO, POP, MOM and their like.
///
/// Words: a mesh has rows (η, the first index) and columns (ξ, the second). Angles are mathematical here, counter-clockwise
/// from east, because that is how models publish them; radians. Models live on a sphere, so directions along their axes
/// are computed on one.
namespace glidehelm::ingest {

/// Positions in degrees, row-major; NaN where the file gives none. Longitudes of any origin, also across a seam.
struct Mesh {
  std::size_t rows{}, columns{};
  std::vector<double> lat, lon;
  [[nodiscard]] std::size_t index(std::size_t j, std::size_t i) const { return j * columns + i; }
};

/// Folded into [-180, 180).
double fold_degrees(double degrees);
/// Folded into [-π, π).
double fold_radians(double radians);
/// The median, of the lower middle of an even number; NaN of nothing.
double median(std::vector<double> values);

/// Marks as "no position" what cannot be one: latitudes beyond ±90, longitudes beyond ±720, values that are not finite,
/// and points at exactly 0, 0 when there are several (rows that a model never computed). Returns how many.
std::size_t drop_impossible_positions(Mesh& mesh);

/// Direction of the mesh's ξ axis (of its η axis with `along_eta`) at every point, from its neighbours on both sides (one
/// side at the edge); NaN where it has none. Second order in the spacing where both neighbours exist.
std::vector<double> axis_directions(const Mesh& mesh, bool along_eta = false);

/// Median distance of neighbours along the two axes, metres.
struct Spacing {
  double xi_m{}, eta_m{};
};
Spacing median_spacing(const Mesh& mesh);

/// Proves that the η axis is the ξ axis turned by 90° counter-clockwise, to 10° in the median: only then do components
/// along the axes have one meaning. Refused: axes that are left-handed (rows stored the other way round) or oblique.
Result<Done> check_right_handed(const Mesh& mesh);

/// How components along the mesh's axes are turned to east and north: east = a·cos θ − b·sin θ, north = a·sin θ + b·cos θ.
struct Rotation {
  std::vector<double> theta;  ///< radians, counter-clockwise from east, per point
  std::string words;          ///< which angle was used, and how it was checked
};

/// Directions from the positions alone.
Rotation computed_rotation(const Mesh& mesh);

/// The angle of the file, once it is proven against the positions: of the readings degrees or radians × counter-clockwise,
/// clockwise, or of the η axis, one must agree with the directions of the ξ axis to 3° in the median. The reading that the
/// unit names, counter-clockwise, is tried first; another one that is the only one to agree is used with a warning. Refused
/// when none agrees: then the angle belongs to another grid, or the velocities are already east and north.
Result<Rotation> rotation_from(const Mesh& mesh, const std::string& name, const std::string& unit,
                               const std::vector<double>& stored, std::vector<std::string>& warnings);

/// Latitudes of the rows and longitudes of the columns, when the mesh is a rectilinear grid written in two dimensions: to
/// 1e-3 of a cell, ascending or descending, longitudes unwrapped.
struct SeparableAxes {
  std::vector<double> lats, lons;
};
std::optional<SeparableAxes> separable_axes(const Mesh& mesh);

/// A place within a cell: fractions along ξ and η in [0, 1].
struct CellPlace {
  double xi{}, eta{};
};
/// Corners of a cell in the order (j, i), (j, i+1), (j+1, i), (j+1, i+1); x and y in any one linear measure.
struct CellCorners {
  double x[4], y[4];
};
/// Inverse of the bilinear map of a cell by Newton's method from its middle: quadratic convergence in every convex cell.
/// Nothing when the point lies outside by more than `slack` of the cell, or the cell is degenerate; else the place, clamped
/// into the cell.
std::optional<CellPlace> place_in_cell(const CellCorners& corners, double x, double y, double slack);

}  // namespace glidehelm::ingest
