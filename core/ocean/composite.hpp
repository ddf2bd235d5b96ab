#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/units.hpp"
#include "core/ocean/gridded.hpp"
#include "core/ocean/source_layer.hpp"

namespace glidehelm::ocean {

/// Several sources as one field, most trusted first (docs/decisions/019-sources-in-order-of-trust.md).
///
/// Each source has an opacity α = s(d/blend)·s(Δ/join), s(x) = x²(3 − 2x) between 0 and 1: d is how far inside the source the
/// place lies, measured from the nearest node that it has not but another source has; Δ the time to the end (begin) of
/// its times, where another source ends later (begins earlier). So a source fades only where there is somebody to hand
/// over to. The layers are laid over each other from the most trusted down: the first takes α₁, the second α₂ of what is left,
/// and so on. What is left after the last goes through the layers again by d alone, sources held beyond their times, and
/// then to the first that answers at all. The weights sum to 1 and are continuous in space and time:
///
///     |∂w/∂x| ≤ n·1.5·√2/blend,   |∂w/∂t| ≤ n·1.5/join   for n sources.
///
/// Left over: a step where sources touch without overlapping, and what a single field has at a coast. d is known at nodes
/// and bilinear between them, so a source fades over a cell at least. Without a value in any source the reason is that of
/// the most trusted one whose area holds the place. A mean over a borrowed value is marked extrapolated.
class CompositeField {
 public:
  /// Precondition: at least one source. O(nodes of all sources · sources).
  CompositeField(std::vector<CompositeSource> sources, const Seams& seams);

  /// Allocates nothing, as `advance` and unlike `weights`. O(sources) samples.
  [[nodiscard]] Expected<Sample, NoCurrent> sample(GeoPoint p, Depth z, double t_s) const;
  /// A step with the kernel of the one source that all stages of a lane lie in, where that is certain; else by samples.
  void advance(Lanes& lanes, double t_s, double dt) const;
  /// The smallest box around all sources, from the first begin to the last end.
  [[nodiscard]] Coverage coverage() const;
  /// The fastest of the sources: a mean is no faster.
  [[nodiscard]] MetresPerSecond fastest() const;

  /// The share of each source in `sample`, in the order of trust: they sum to 1, or are all 0 where there is no value.
  [[nodiscard]] std::vector<double> weights(GeoPoint p, Depth z, double t_s) const;
  [[nodiscard]] const std::vector<CompositeSource>& sources() const { return sources_; }
  /// What is wrong with the sources taken together, one sentence each: a source without times between `from` and `to`, one
  /// that is transparent everywhere, one that no other overlaps in space, a pair whose times overlap by less than `join`.
  [[nodiscard]] std::vector<std::string> faults() const;

 private:
  struct Sum;

  [[nodiscard]] double in_space(std::size_t source, GeoPoint p) const;
  [[nodiscard]] Expected<Sample, NoCurrent> answer_of(std::size_t source, GeoPoint p, Depth z, double t_s) const;
  template <class Give>
  Sum add_up(GeoPoint p, Depth z, double t_s, const Give& give) const;
  [[nodiscard]] bool surely_opaque(std::size_t source, double lat, double lon, double reach, double t_s,
                                   double dt) const;
  [[nodiscard]] bool surely_away(std::size_t source, double lat, double lon, double reach) const;
  [[nodiscard]] std::size_t owner(double lat, double lon, double reach, double t_s, double dt) const;

  std::vector<CompositeSource> sources_;
  Seams seams_;
  std::vector<SourceLayer> layers_;
};

}  // namespace glidehelm::ocean
