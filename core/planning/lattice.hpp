#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ocean/field.hpp"
#include "core/planning/lattice_choice.hpp"

namespace glidehelm::planning {

/// From a node to a neighbour.
struct LatticeStep {
  int rows{}, columns{};
  friend bool operator==(const LatticeStep&, const LatticeStep&) = default;
};

/// The nodes that A* goes over, and which of them are neighbours (Garau, "The path planner"; Thesis 4.3).
///
/// Nodes lie in rows of equal latitude, the start is one of them. `regular`: equal steps of latitude and of longitude,
/// square at the latitude midway. `irregular`: rows and columns half as far apart beside start and goal and twice as far
/// away from both, growing by an eighth of the distance. `triangular`: equilateral triangles; every second row is
/// shifted by half a step.
///
/// Neighbours, on square lattices 8, 16 or 24: the ring around a node (8), two rings (24), two rings without what two steps in one
/// direction reach (16: Garau). Triangles have 6, 12 and 18 of the same kind. A radius above 1 adds the neighbours' neighbours, that
/// often, as far as they lie in a new direction (Thesis 4.3).
///
/// Garau also takes the meshes of finite-element models as they are. Here every forecast comes to the planner on
/// latitude and longitude, so there is no such mesh to take; a lattice of triangles stands for it.
///
/// The box holds what lies within `reach` of the middle of the way and inside `coverage`. Beyond `kMostNodes` the spacing is enlarged.
class Lattice {
 public:
  static constexpr std::int64_t kMostNodes = 8'000'000;

  /// `start` and `goal` in radians as {latitude, longitude}, the goal's longitude next to the start's; lengths in metres.
  Lattice(std::array<double, 2> start, std::array<double, 2> goal, double reach, double spacing,
          const LatticeChoice& choice, const ocean::Coverage& coverage);

  [[nodiscard]] int rows() const { return static_cast<int>(lats_.size()); }
  [[nodiscard]] int columns() const { return static_cast<int>(lons_.size()); }
  [[nodiscard]] bool contains(int row, int column) const {
    return row >= 0 && row < rows() && column >= 0 && column < columns();
  }
  [[nodiscard]] std::int32_t index(int row, int column) const { return row * columns() + column; }
  [[nodiscard]] double lat(int row) const { return lats_[static_cast<std::size_t>(row)]; }
  [[nodiscard]] double lon(int row, int column) const {
    return lons_[static_cast<std::size_t>(column)] + (is_shifted(row) ? half_ : 0.0);
  }
  [[nodiscard]] int start_row() const { return start_row_; }
  [[nodiscard]] int start_column() const { return start_column_; }
  [[nodiscard]] std::size_t nodes() const { return lats_.size() * lons_.size(); }
  /// To the neighbours of the nodes in a row, those of smaller rings first.
  [[nodiscard]] std::span<const LatticeStep> steps(int row) const { return steps_[is_shifted(row) ? 1 : 0]; }
  [[nodiscard]] double spacing() const { return spacing_; }
  /// No step is longer than this, at the latitude midway (metres).
  [[nodiscard]] double longest_step() const { return longest_step_; }

 private:
  [[nodiscard]] bool is_shifted(int row) const { return half_ > 0 && ((row - start_row_) & 1) != 0; }
  void choose_steps(const LatticeChoice& choice);

  std::vector<double> lats_, lons_;
  int start_row_{}, start_column_{};
  double half_{};  ///< shift of every second row in radians; triangular only
  double spacing_, longest_step_{};
  std::array<std::vector<LatticeStep>, 2> steps_;
};

}  // namespace glidehelm::planning
