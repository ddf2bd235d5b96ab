#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/units.hpp"

namespace glidehelm::planning {

/// Equilateral triangles over a box of latitude and longitude, one node on a given position: rows of equal latitude steps, every
/// second one shifted by half a column.
///
/// Each triangle is a `base` of two neighbours in a row and an `apex` above or below their middle, so that the gradient of a function
/// that is linear between the nodes is two differences. Sides have the same length at the latitude of the seed and, east and west, are
/// as much shorter or longer elsewhere as the parallels are. Radians and metres; longitudes run on across the antimeridian.
class TriangleLattice {
 public:
  /// `seed` is a node. The box reaches `south` and `north`, `west` and `east` metres from it, rounded up to whole sides.
  TriangleLattice(double seed_lat, double seed_lon, double side, double south, double north, double west, double east);

  [[nodiscard]] std::size_t nodes() const { return static_cast<std::size_t>(rows_ * columns_); }
  [[nodiscard]] std::size_t triangles() const { return static_cast<std::size_t>((rows_ - 1) * (columns_ - 1) * 2); }
  [[nodiscard]] double side() const { return side_; }
  [[nodiscard]] std::size_t seed() const { return node(seed_row_, seed_column_); }

  struct Place {
    double lat{}, lon{};
  };
  [[nodiscard]] Place at(std::size_t node) const {
    const int row = static_cast<int>(node) / columns_, column = static_cast<int>(node) % columns_;
    return {south_ + row * per_row_, west_ + (column + shift(row)) * per_column_};
  }
  /// On the rim nothing is known of one side.
  [[nodiscard]] bool on_rim(std::size_t node) const {
    const int row = static_cast<int>(node) / columns_, column = static_cast<int>(node) % columns_;
    return row == 0 || row == rows_ - 1 || column == 0 || column == columns_ - 1;
  }

  /// Nodes of a triangle, and how its base and height measure at the latitude of its middle.
  struct Triangle {
    std::size_t left{}, right{}, apex{};
    double base{}, height{};  ///< metres; the height is negative when the apex lies south of the base
    /// Largest and smallest ratio of a parallel inside to the one in the middle.
    double narrowest{}, widest{};
  };
  [[nodiscard]] Triangle triangle(std::size_t index) const;
  [[nodiscard]] Place middle(const Triangle& t) const {
    const auto left = at(t.left), apex = at(t.apex);
    return {left.lat + (apex.lat - left.lat) / 3, left.lon + 0.5 * per_column_};
  }

  /// The triangles of which a node is a corner, `count` of them.
  struct Around {
    std::array<std::uint32_t, 6> triangle{};
    int count{};
  };
  [[nodiscard]] Around around(std::size_t node) const;

  /// The triangle of a position and the weights of its corners there; false outside the box.
  struct Within {
    std::size_t index{};
    double left{}, right{}, apex{};
  };
  [[nodiscard]] bool locate(double lat, double lon, Within& found) const;

 private:
  static double shift(int row) { return row % 2 == 0 ? 0.0 : 0.5; }
  [[nodiscard]] std::size_t node(int row, int column) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }
  [[nodiscard]] std::size_t index(int row, int column, bool down) const {
    return static_cast<std::size_t>((row * (columns_ - 1) + column) * 2 + (down ? 1 : 0));
  }

  double side_;
  int rows_{}, columns_{}, seed_row_{}, seed_column_{};
  double south_{}, west_{}, per_row_{}, per_column_{};
  struct Strip {
    double base{}, height{}, narrowest{}, widest{};
  };
  std::vector<Strip> strips_;  ///< between two rows
};

}  // namespace glidehelm::planning
