#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/ingest/curvilinear.hpp"
#include "daemon/ingest/netcdf_file.hpp"
#include "daemon/ingest/regrid.hpp"

/// The grid of a model: where its points lie, which are water, how deep. It may stand in the file of the currents or in one
/// of its own (`*_grid.nc`, `coordinates.nc`, `mesh_mask.nc`); dimensions then are known by their lengths, because
/// producers name them differently from file to file.
namespace glidehelm::ingest {

/// A variable and the file it stands in.
struct Found {
  const NetcdfFile* file{};
  const Variable* variable{};
  explicit operator bool() const { return variable != nullptr; }
};

/// The files that belong together, that of the currents first. They must outlive this.
class ModelFiles {
 public:
  explicit ModelFiles(std::vector<const NetcdfFile*> files) : files_{std::move(files)} {}
  [[nodiscard]] const std::vector<const NetcdfFile*>& files() const { return files_; }
  /// The first variable of that name with numbers.
  [[nodiscard]] Found find(std::string_view name) const;
  [[nodiscard]] Found first_of(std::initializer_list<std::string_view> names) const;

 private:
  std::vector<const NetcdfFile*> files_;
};

/// Lengths of the last two dimensions: rows and columns.
struct Shape {
  std::size_t rows{}, columns{};
  friend bool operator==(const Shape&, const Shape&) = default;
};
std::optional<Shape> shape_of(const Found& found);
std::string text(const Shape& shape);

/// All numbers of a variable, unpacked, NaN where they are missing (`Missing`, or beyond 9e36).
Result<std::vector<double>> plain_numbers(const Found& found);
/// The same of a box.
Result<std::vector<double>> plain_numbers(const Found& found, const std::vector<std::size_t>& start,
                                          const std::vector<std::size_t>& count);
/// One number of a scalar, or of an array of one; nothing when there is none or it is missing.
std::optional<double> scalar_of(const Found& found);

/// Latitude and longitude of a set of points: two-dimensional, or one axis each.
struct Positions {
  Found lat, lon;
  [[nodiscard]] Shape shape() const;
  [[nodiscard]] std::string words() const;  ///< "lat_rho, lon_rho"
};
/// The positions as a mesh, impossible ones dropped; degrees whatever the file's unit says that is an angle.
Result<Mesh> mesh_of(const Positions& positions);

/// Positions that the file of a velocity gives for it: those that its `coordinates` name, else the two-dimensional latitude
/// and longitude over its own last two dimensions, else the axis of each of these.
std::optional<Positions> own_positions(const Found& velocity);

/// True when positions of grid points stand in the files in two dimensions.
bool has_plane_positions(const ModelFiles& files);

/// How the two components lie about the centres.
struct Staggering {
  bool staggered{};
  Faces u, v;
  std::string words;
};

/// Everything horizontal that reading needs.
struct ModelGrid {
  Mesh centres;
  Staggering staggering;
  std::string words;  ///< "curvilinear Arakawa C grid of 68 by 37 points (lat_rho, lon_rho)"
  std::string centre_words;
};

/// The centres of the grid on which u and v lie, and how they are staggered.
///
/// ROMS: lat_rho, lon_rho; u has a column less, v a row less. NEMO: gphit, glamt, or computed from the positions of u; all
/// of one shape, u and v each with positions of its own, from whose offset follows on which side of the centres they are.
/// MITgcm, POP, MOM: XC, YC; TLAT, TLONG; geolat, geolon. Collocated: both components on the same positions.
/// `east_north`: the components are east and north, which settles that they are at the centres when only these are known.
/// Refused, with the shapes: positions are missing (is a grid file needed?), fit neither, or leave the staggering open.
Result<ModelGrid> model_grid(const ModelFiles& files, const Found& u, const Found& v, bool east_north);

/// What a file holds, from its header.
enum class Contents {
  currents,  ///< both components
  u_only,    ///< the half of a pair
  v_only,
  grid,  ///< positions, masks or depths, but no velocity
  other  ///< nothing that is recognised: left to the reader, which says what is missing
};
/// The positions of a file that only describes a grid: "lat_rho, lon_rho".
std::optional<std::string> described_grid(const NetcdfFile& file);
/// The u (or v) component of a file that has only one of the two, by standard_name or known name.
Found lone_component(const NetcdfFile& file, bool u);
Contents contents_of(const NetcdfFile& file, const std::string& east, const std::string& north);

/// Names of the components, and whether they are along the grid's axes.
struct ModelVelocity {
  Found u, v;
  std::string why;
  enum class Sense { grid_axes, east_north, open } sense{Sense::open};
};
/// Finds the pair in any of the files: the names asked for; standard_name ending in eastward/northward_sea_water_velocity or
/// sea_water(…)_x/_y_velocity; the names u_eastward/v_northward, u/v, u_sur/v_sur, uo/vo, vozocrtx/vomecrty, water_u/water_v,
/// ubar/vbar. Several by standard_name are settled by being exact, then by the list of names, else refused. Nothing when
/// there is none.
Result<std::optional<ModelVelocity>> model_velocity(const ModelFiles& files, const std::string& east,
                                                    const std::string& north);

}  // namespace glidehelm::ingest
