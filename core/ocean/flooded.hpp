#pragma once

#include "core/ocean/field.hpp"

namespace glidehelm::ocean {

/// A field with its dry places (land, no data, below the bottom) flooded by still water, so that none of them stops anybody. Whoever moves in
/// `field` moves in this one in the same way: what cannot be reached here in time cannot be reached there. The edges of area and time stay.
class FloodedField {
 public:
  /// `field` must outlive this.
  explicit FloodedField(FieldRef field) : field_{field} {}
  [[nodiscard]] Expected<Sample, NoCurrent> sample(GeoPoint p, Depth z, double t_s) const;
  /// The kernel of the field, and samples for the lanes that it leaves at a dry place.
  void advance(Lanes& lanes, double t_s, double dt) const;
  [[nodiscard]] Coverage coverage() const { return field_.coverage(); }
  [[nodiscard]] MetresPerSecond fastest() const { return field_.fastest(); }

 private:
  FieldRef field_;
};

}  // namespace glidehelm::ocean
