#pragma once

#include <optional>
#include <string>

#include "core/base/units.hpp"

namespace glidehelm::model {

/// A glider as planners and verifier see it. Three speeds are kept apart (product.md 3): the true horizontal speed that
/// we plan with, and the one that the glider believes and steers with.
struct Glider {
  std::string name;
  MetresPerSecond horizontal_speed{0.30};  ///< U: through water, U_path·cos(glide angle); used by every planner
  MetresPerSecond believed_speed{0.30};    ///< Û: m_avg_speed when the dialog prints it, else the configured speed
  Radians glide_angle{degrees(26)};        ///< of the path below the horizon
  Metres dive_depth{200};                  ///< lower turning depth of the yo
  Metres climb_to{20};                     ///< upper turning depth of inner yos
  int current_correction{1};               ///< u_use_current_correction: 0 ignores currents, 1 uses the last measured
  Radians heading_bias{};                  ///< true heading less the one that the glider means to steer, clockwise
  friend bool operator==(const Glider&, const Glider&) = default;
};

}  // namespace glidehelm::model
