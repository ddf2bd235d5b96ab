#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "daemon/ingest/component.hpp"
#include "daemon/ingest/grid_file.hpp"
#include "daemon/ingest/model_levels.hpp"

/// The points of a model, plane by plane: which of them are read, which are water, and their numbers at one time.
namespace glidehelm::ingest {

/// The rectangle of points that is read.
struct Window {
  std::size_t row{}, rows{}, column{}, columns{};
  [[nodiscard]] std::size_t points() const { return rows * columns; }
  /// Index among the whole shape's points of point n of the window.
  [[nodiscard]] std::size_t whole(std::size_t n, std::size_t whole_columns) const {
    return (row + n / columns) * whole_columns + column + n % columns;
  }
};

/// True for a point of the mesh within the area; without one everywhere.
bool in_area(const Mesh& mesh, std::size_t point, const std::optional<Area>& area);
/// The rows and columns with a point in the area, and two more on each side.
Result<Window> window_of(const Mesh& mesh, const std::optional<Area>& area);

/// The window of a plane with `columns` columns, row by row.
template <class T>
std::vector<T> cut_out(const std::vector<T>& whole, std::size_t columns, const Window& w) {
  std::vector<T> part;
  part.reserve(w.points());
  for (std::size_t j = 0; j < w.rows; ++j)
    for (std::size_t i = 0; i < w.columns; ++i) part.push_back(whole[(w.row + j) * columns + w.column + i]);
  return part;
}

/// Water and land of one set of points: one plane, or one per level; empty when the files have no mask.
struct Mask {
  std::vector<std::uint8_t> wet;  ///< whole shape of the file
  std::size_t levels{1};
  Found from;
};
/// The first of `names` that has the shape, once or once per level. Refused: numbers other than 0 and 1.
Result<Mask> mask_of(const ModelFiles& files, std::initializer_list<std::string_view> names, const Shape& shape,
                     std::size_t levels);
/// The part of a level's mask that is read; empty without a mask.
std::vector<std::uint8_t> plane_of(const Mask& mask, std::size_t level, const Shape& shape, const Window& w);

/// One variable: how it is read, and where its dimensions are.
struct Side {
  Found found;
  Component component;
  Splitting split;
  Window at;
};

/// Values of a window, level by level.
using LevelPlanes = std::vector<std::vector<double>>;

/// All levels of one time, in the order of the file; `outside` grows by the values beyond the valid range, which are kept.
Result<LevelPlanes> read_levels(const Side& part, std::size_t time, std::size_t levels, std::size_t& outside);

/// z-levels: their own depths. Terrain-following levels: fixed depths as far down as the water of the window reaches, whatever
/// the surface does, so that all times and files of a model have the same. `wet`: of the window, empty without a mask.
std::vector<double> depths_of(const Levels& levels, const Shape& whole, const Window& w,
                              const std::vector<std::uint8_t>& wet);

/// Two variables from terrain-following levels to fixed depths, column by column; NaN below the sea floor. `surface` as
/// `surface_at` gives it, of the whole shape, which has `columns`.
std::array<LevelPlanes, 2> at_fixed_depths(const Levels& levels, std::size_t columns, const Window& w,
                                           const std::vector<double>& surface, const std::vector<double>& depths,
                                           const std::array<const LevelPlanes*, 2>& in);

}  // namespace glidehelm::ingest
