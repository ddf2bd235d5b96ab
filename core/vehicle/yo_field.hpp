#pragma once

#include <cstdint>

#include "core/model/dive_schedule.hpp"
#include "core/model/glider.hpp"
#include "core/ocean/field.hpp"

namespace glidehelm::vehicle {

/// What moves a diving glider in a plan: the current's mean over the dive, or the current at the depth of its yo-yo.
enum class MotionModel : std::uint8_t { point, yo_yo };

/// The three-dimensional yo-yo model (Thesis 2.5–2.14) for planners that think in two dimensions: the current at the depth at which the
/// glider is at that instant.
///
/// Stints are constant in time, so the depth follows from the clock alone: yo_depth of the time since the dive of the stint under
/// way. Every planner, and the front of the lower bound, then flies the yo-yo without knowing of it. While the glider drifts (and before
/// its first dive) the depth is 0; below the bottom the current is the deepest above it (`current_above_bottom`).
///
/// A sample is one of the full field. The current changes within minutes as the glider sinks through sheared water, so an
/// integrator with a fixed step must be told (vehicle::lane_step finds it out). Non-owning: the field must outlive it.
class YoField {
 public:
  /// `fix_s`: epoch second at which the schedule begins.
  YoField(ocean::FieldRef full, const model::Glider& glider, const model::DiveSchedule& schedule, double fix_s)
      : full_{full}, glider_{glider}, schedule_{schedule}, fix_s_{fix_s} {}

  /// The depth asked for is ignored: it is the clock's.
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth, double t_s) const;
  [[nodiscard]] ocean::Coverage coverage() const { return full_.coverage(); }
  [[nodiscard]] MetresPerSecond fastest() const { return full_.fastest(); }
  /// Metres below the surface at an instant.
  [[nodiscard]] double depth(double t_s) const;

 private:
  ocean::FieldRef full_;
  model::Glider glider_;
  model::DiveSchedule schedule_;
  double fix_s_;
};

}  // namespace glidehelm::vehicle
