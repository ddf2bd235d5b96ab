#pragma once

#include <optional>

#include "core/base/geo.hpp"
#include "core/ocean/field.hpp"

namespace glidehelm::simulator {

/// The sea floor: that of the true ocean, or a plane with a hump on it.
struct SeabedSpec {
  enum class Kind {
    none,   ///< bottomless
    truth,  ///< where the true ocean says below_bottom; the lowest level of its grid counts as floor
    plane,  ///< depth·(1 at the origin) + slope·distance, plus the hump
  } kind{Kind::none};
  Metres depth{100};  ///< at the origin
  GeoPoint origin;
  double slope{};                            ///< metres of depth gained per metre …
  Bearing deepens{};                         ///< … in this direction
  Metres hump_height{0}, hump_radius{5000};  ///< a Gaussian bank at the origin; the radius is its standard deviation
  friend bool operator==(const SeabedSpec&, const SeabedSpec&) = default;
};

/// Depth of the floor below a position.
class Seabed {
 public:
  /// The field must outlive this object.
  Seabed(SeabedSpec spec, ocean::FieldRef truth) : spec_{spec}, truth_{truth} {}

  [[nodiscard]] bool exists() const { return spec_.kind != SeabedSpec::Kind::none; }
  /// None: no floor down to `look_down`. The truth's is found by halving to 0.1 m. Never negative.
  [[nodiscard]] std::optional<Metres> depth(GeoPoint at, double t_s, Metres look_down) const;

 private:
  SeabedSpec spec_;
  ocean::FieldRef truth_;
};

}  // namespace glidehelm::simulator
