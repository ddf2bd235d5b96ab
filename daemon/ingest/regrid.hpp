#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/ingest/axis_values.hpp"
#include "daemon/ingest/curvilinear.hpp"

/// From the points of a model to the nodes of a rectilinear grid of latitude and longitude (docs/decisions/018).
namespace glidehelm::ingest {

/// Where the faces of an Arakawa C grid lie among the centres along their one staggered axis: centre k has the faces
/// k + before and k + before + 1, as far as they exist.
struct Faces {
  bool along_eta{};  ///< v: staggered along the columns; else u
  int before{-1};    ///< −1: face k lies behind centre k (ROMS, NEMO); 0: before it (MITgcm)
  std::size_t rows{}, columns{};
};

/// Means of the faces beside each centre: of the one that has a value where only one has. `open` (empty: not known) is 0 for
/// faces that are closed by land: they do not count, but a centre between closed faces only has 0, because nothing flows
/// through walls. NaN where no face has a value.
std::vector<double> to_centres(const Faces& faces, std::size_t rows, std::size_t columns,
                               std::span<const double> values, std::span<const std::uint8_t> open);

/// Which faces are open, from the wet centres beside them: both, as ROMS and NEMO define their masks.
std::vector<std::uint8_t> open_faces(const Faces& faces, std::size_t rows, std::size_t columns,
                                     std::span<const std::uint8_t> wet);

/// The rectilinear grid that a mesh is brought onto.
struct TargetAxes {
  Ascending lats, lons;  ///< `source` only counts along
  bool native{};         ///< the mesh is this grid, written in two dimensions
  std::string words;
};
/// Native axes when the mesh is separable; else even steps, on multiples of the step, inside the mesh's box (the whole circle
/// when the mesh leaves no gap). Their length in metres at the middle latitude is the smaller of the two median spacings of
/// the mesh; half of it, for half of the error, while the whole mesh then has at most 2e6 nodes over its `levels`. Cut
/// to `area`, on which the step does not depend. Refused: fewer than two rows or columns, nothing in the area.
Result<TargetAxes> target_axes(const Mesh& mesh, std::size_t levels, const std::optional<Area>& area);

/// Where every target node lies in the mesh.
///
/// Found by going over the cells once and asking which nodes lie within (O(cells + nodes)); a node on the border of two
/// cells belongs to the first. Nodes outside the mesh by less than 1e-3 of a cell belong to it. Cells without four
/// positions, and cells wider than 90° of longitude (around a pole), hold none.
class Remap {
 public:
  static Remap of(const Mesh& mesh, const std::vector<double>& lats, const std::vector<double>& lons);

  /// Writes east and north of every node, interleaved, from those of the mesh's points: the bilinear mean over the corners
  /// that have values, renormalised when they hold at least half of the weight (product.md 6), else NaN.
  void apply(std::span<const double> east, std::span<const double> north, float* out) const;

  [[nodiscard]] std::size_t nodes() const { return places_.size(); }
  /// Nodes that lie in the mesh.
  [[nodiscard]] std::size_t inside() const;

 private:
  static constexpr std::uint32_t kOutside = 0xffffffff;
  struct Place {
    std::uint32_t corner{kOutside};  ///< index of the cell's first point
    double xi{}, eta{};
  };
  std::vector<Place> places_;
  std::size_t columns_{};
};

}  // namespace glidehelm::ingest
