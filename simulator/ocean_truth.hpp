#pragma once

#include <memory>
#include <string>

#include "core/base/expected.hpp"
#include "core/ocean/field.hpp"
#include "daemon/world/files.hpp"
#include "simulator/scenario.hpp"

namespace glidehelm::simulator {

/// Why there is no true ocean: which file or key, and what is wrong with it.
struct TruthError {
  std::string what;
  [[nodiscard]] const std::string& message() const { return what; }
};

/// The ocean that really moves the gliders; owns its fields. A grid is kept in three dimensions: a diving glider meets
/// the current at its depth, a drifting one that of the shallowest level, and time beyond the grid's last hour ends the
/// run. Analytic seas are two-dimensional; made-up ones may fade with depth; both have no end.
///
/// `model()` is what a forecast has of it: the field without `truth.error`, and of a made-up sea the forecast variant.
class OceanTruth {
 public:
  /// `with_coast`: a coastline says what is land; otherwise the grid's own mask does.
  static Expected<OceanTruth, TruthError> make(const TruthPlan& plan, Instant start, bool with_coast,
                                               world::Files& files);
  ~OceanTruth();
  OceanTruth(OceanTruth&&) noexcept;
  OceanTruth& operator=(OceanTruth&&) noexcept;

  /// Views that live as long as this object (moves do not invalidate them).
  [[nodiscard]] ocean::Ocean ocean() const;
  [[nodiscard]] ocean::FieldRef model() const;

 private:
  struct Parts;
  [[nodiscard]] ocean::Ocean exact() const;
  explicit OceanTruth(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace glidehelm::simulator
