#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/units.hpp"
#include "core/ocean/gridded.hpp"
#include "core/ocean/source_region.hpp"

namespace glidehelm::ocean {

/// One source of a composite field.
struct CompositeSource {
  std::string name;
  GriddedField field;
  SourceRegion region{};
  double from_s{-1e18}, to_s{1e18};  ///< epoch seconds between which it counts, within its own times
};

/// How sources give way to each other.
struct Seams {
  Metres blend{20'000};      ///< a source fades out over this distance before it ends
  Seconds join{6 * 3600.0};  ///< … and over this time
  friend bool operator==(const Seams&, const Seams&) = default;
};

/// Where a source of a composite ends and another goes on, found once per load: with it the source's opacity at any place and
/// time costs one bilinear value (docs/decisions/019-sources-in-order-of-trust.md, formula in composite.hpp).
struct SourceLayer {
  std::vector<bool> here;        ///< by node: always a value, and in the region
  std::vector<float> inside;     ///< by node: metres from the nearest seam, at most 20 km beyond `blend`
  double first_s{}, last_s{};    ///< epoch seconds within which it counts
  bool fades_in{}, fades_out{};  ///< another source begins earlier, ends later
};

/// One layer per source, in their order. O(nodes of all sources · sources).
std::vector<SourceLayer> find_layers(const std::vector<CompositeSource>& sources, const Seams& seams);

/// True when the node nearest to a position (radians) is the source's.
bool has_node_near(const CompositeSource& source, const SourceLayer& layer, double lat, double lon);

/// Metres between a position (radians) and the source's nearest seam; 0 outside its grid. No steeper than √2.
double metres_inside(const CompositeSource& source, const SourceLayer& layer, double lat, double lon);

/// s(x) = x²(3 − 2x) with x clamped to 0 … 1: what a source fades by.
double smooth_step(double x);

/// How much of a source is left at an instant, 0 … 1, wherever it is.
double opacity_in_time(const SourceLayer& layer, const Seams& seams, double t_s);

}  // namespace glidehelm::ocean
