#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/ingest/fault.hpp"

/// Levels that follow the terrain, and the way from them to fixed depths.
///
/// s and σ run from −1 at the sea floor to 0 at the surface. Depths here are positive down **from the moving surface**,
/// d = ζ − z: that is what a glider's pressure sensor measures, and it makes the top level stand still. Sources: Shchepetkin
/// and McWilliams 2005 (Vtransform 1 and 2), Song and Haidvogel 1994 (stretching 1), Shchepetkin 2005 and 2010 (2 and 4),
/// Geyer (3), Souza (5), as the ROMS documentation and CF appendix D write them.
namespace glidehelm::ingest {

/// Parameters of the stretching as ROMS names them.
struct StretchingChoice {
  int vtransform{}, vstretching{};
  double theta_s{}, theta_b{}, hc_m{};
  friend bool operator==(const StretchingChoice&, const StretchingChoice&) = default;
};
/// "vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,hc=50": every one of the five exactly once. Vtransform 1 or 2,
/// Vstretching 1 to 5, theta_s 0 to 20, theta_b 0 to 4, hc 0 to 10000 m.
Result<StretchingChoice> stretching_choice_from(const std::string& text);

/// s at the middle of N layers, bottom first: (k + ½)/N − 1; stretching 5 has its own quadratic law.
std::vector<double> s_of_layers(std::size_t layers, int vstretching);
/// C(s) in [−1, 0] of a stretching 1…5: C(−1) = −1, C(0) = 0, rising (3 only for exponents near 1; check_levels tells). Precondition: the ranges of StretchingChoice.
double stretching_curve(const StretchingChoice& choice, double s);

/// How the depth of a level follows from the water's depth h and the surface ζ: d = −(A + ζ·B), with S below.
///
///     sigma         z = ζ + σ(h + ζ)                             A = h σ        B = σ
///     s_coordinate  z = ζ(1 + s) + hc s + (h − hc) C             A = Zo         B = s     (CF ocean_s_coordinate)
///     transform_1   Zo = hc s + (h − hc) C, z = Zo + ζ(1 + Zo/h) A = Zo         B = Zo/h  (Vtransform 1, ..._g1)
///     transform_2   S = (hc s + h C)/(hc + h), z = ζ + (ζ + h) S A = h S        B = S     (Vtransform 2, ..._g2)
enum class LevelLaw { sigma, s_coordinate, transform_1, transform_2 };
struct TerrainLevels {
  LevelLaw law{LevelLaw::sigma};
  std::vector<double> s, c;  ///< in the file's order; c is empty for sigma
  double hc_m{};
  [[nodiscard]] std::size_t size() const { return s.size(); }
  /// Depth of level k below the surface, m.
  [[nodiscard]] double depth(std::size_t k, double h_m, double zeta_m) const;
};
/// Levels ordered from bottom to top or back, s within [−1, 0] (to 1e-6), C likewise, no two alike; hc ≥ 0.
Result<Done> check_levels(const TerrainLevels& levels);

/// The fixed depths onto which terrain-following levels are brought: 0, 2 … 10 m, then steps of 5 m to 50, 10 to 100, 20 to
/// 200, 25 to 300, 50 to 600, 100 to 1200, 200 to 2000 and 500 to 12000, as far as they are not deeper than `deepest_m`.
std::vector<double> fixed_depths(double deepest_m);

/// Values of one column at fixed depths, linear between its levels. Above the shallowest level the column holds that
/// level's value, below the deepest one that level's down to the sea floor (`bottom_m`), because a level stands for a layer;
/// deeper: NaN. Levels whose value is NaN are left out. `depths_m` of the levels in any monotone order.
class Column {
 public:
  /// Precondition: as many values as depths; monotone depths.
  void set(std::span<const double> depths_m, double bottom_m);
  /// The value at a fixed depth from values in the order of the levels.
  [[nodiscard]] double at(double depth_m, std::span<const double> values) const;

 private:
  std::span<const double> depths_;
  double bottom_m_{};
  bool descending_{};  ///< the first level is the deepest
};

}  // namespace glidehelm::ingest
