#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/ocean/field.hpp"

/// The analytic currents of product.md 5: the test functions of Thesis 5.1.2 and Eichhorn 6.1, with the errata of
/// seeds/README.md applied.
namespace glidehelm::ocean {

/// One analytic field as a mission says it.
struct AnalyticSpec {
  std::string kind;  ///< see AnalyticField
  GeoPoint origin;
  Metres length_scale{1.0};                            ///< L
  MetresPerSecond speed_scale{1.0};                    ///< V
  std::optional<Seconds> time_scale;                   ///< T; default L/V
  std::optional<Instant> t0;                           ///< default: the start that `make` is given
  bool south{};                                        ///< both components change sign (Thesis 5.4–5.5)
  std::vector<std::pair<std::string, double>> params;  ///< by name; one that is missing has the kind's default
  std::vector<std::vector<double>> gaussians;          ///< rows [w, x, y, sxx, sxy, syy, vx, vy] of kind gaussians
  friend bool operator==(const AnalyticSpec&, const AnalyticSpec&) = default;
};

/// Why a specification makes no field.
struct AnalyticError {
  std::string what;
  [[nodiscard]] const std::string& message() const { return what; }
  friend bool operator==(const AnalyticError&, const AnalyticError&) = default;
};

/// Dimensionless current (u, v) at (x, y, t). Each kind states its bound: the largest speed for |x|, |y| up to the given
/// half-widths and at all times.
namespace analytic {

struct Uv {
  double u{}, v{};
};

/// The same everywhere (Thesis 5.7–5.8). Params u (0), v (0).
struct Constant {
  double u{}, v{};
  [[nodiscard]] Uv at(double x, double y, double t) const;
  [[nodiscard]] double bound(double x, double y) const;
};
/// Outflow from the origin (Thesis 5.9–5.12): (u, v) = (x, y); the sink has the opposite sign.
struct Source {
  double sign{1};
  [[nodiscard]] Uv at(double x, double y, double t) const;
  [[nodiscard]] double bound(double x, double y) const;
};
/// Rotation as of a rigid body, counter-clockwise for ω > 0: (u, v) = (−ωy, ωx). Param omega (1).
struct SolidBody {
  double omega{1};
  [[nodiscard]] Uv at(double x, double y, double t) const;
  [[nodiscard]] double bound(double x, double y) const;
};
/// Eastward current that grows northwards: (u, v) = (rate·y, 0). Param rate (1).
struct Shear {
  double rate{1};
  [[nodiscard]] Uv at(double x, double y, double t) const;
  [[nodiscard]] double bound(double x, double y) const;
};
/// Two eddies that stretch and shrink (Thesis 5.15–5.20, Shadden et al. 2005). Params A (0.1), epsilon (0.25),
/// omega (2π). Bound: u² + v² = (πA)²·(s²c'² + c²s'²g²) with sines and cosines s, c, s', c' and g = ∂f/∂x, at most
/// (πA)²·max(1, g²), |g| ≤ 1 + 2|ε|(|x| + 1).
struct DoubleEddy {
  double a{0.1}, epsilon{0.25}, omega{2 * kPi};
  [[nodiscard]] double stream(double x, double y, double t) const;
  [[nodiscard]] Uv at(double x, double y, double t) const;
  [[nodiscard]] double bound(double x, double y) const;
};
/// Stuart vortices drifting east (Thesis 5.21–5.23; the sign of 5.22 corrected, else the field has divergence). Bound:
/// sinh/(cosh − 1/4) ≤ 4/√15 (at cosh = 4), sin/(4·3/4) ≤ 1/3.
struct Stuart {
  [[nodiscard]] double stream(double x, double y, double t) const;
  [[nodiscard]] Uv at(double x, double y, double t) const;
  [[nodiscard]] double bound(double x, double y) const;
};
/// A chequerboard of eddies (Thesis 5.24–5.27); dynamic (param dynamic ≠ 0) moves it south with speed 1. Bound √2.
struct Tiled {
  bool dynamic{};
  [[nodiscard]] double stream(double x, double y, double t) const;
  [[nodiscard]] Uv at(double x, double y, double t) const;
  [[nodiscard]] double bound(double x, double y) const;
};
/// The meandering eastward jet (Thesis 5.28–5.35 = Eichhorn eq. 7–9; 5.34 corrected). Params B0 (1.2), epsilon (0.3),
/// omega (0.4), theta (π/2), k (0.84), c (0.12). Bound: with q·sech²q ≤ 0.4480, sech²Q·|1 − Q·A_xx/D| ≤ m = 1 +
/// 0.4480·k²·(|B0| + |ε|), and u² + v² ≤ (1 + A_x²·m²)/D² ≤ m² because D² = 1 + A_x².
struct Jet {
  double b0{1.2}, epsilon{0.3}, omega{0.4}, theta{kPi / 2}, k{0.84}, c{0.12};
  [[nodiscard]] double stream(double x, double y, double t) const;
  [[nodiscard]] Uv at(double x, double y, double t) const;
  [[nodiscard]] double bound(double x, double y) const;
};
/// A sum of drifting Gaussian hills and hollows of sea surface (Thesis 5.6): Ψ = Σ w·N(μ + t·(vx, vy), Σ) with the
/// normalised density N. Bound: Σ |w|/(2π√det Σ)·e^(−1/2)/√λ_min, the steepest slope of each.
struct Gaussians {
  struct Hill {
    double w, x, y, sxx, sxy, syy, vx, vy;
  };
  std::vector<Hill> hills;
  [[nodiscard]] double stream(double x, double y, double t) const;
  [[nodiscard]] Uv at(double x, double y, double t) const;
  [[nodiscard]] double bound(double x, double y) const;
};

using Kind = std::variant<Constant, Source, SolidBody, Shear, DoubleEddy, Stuart, Tiled, Jet, Gaussians>;

}  // namespace analytic

/// An analytic current over a box: with x = N(φ0)·cos φ0·Δλ/L east and y = M(φ0)·Δφ/L north of the origin (WGS84 radii
/// at the origin, Δλ folded into ±π), the current is V·(u, v)(x, y, (t − t0)/T). Two-dimensional: the depth is ignored.
///
/// Kinds: constant, source, sink, solid-body, shear, double-eddy, stuart, tiled, jet, gaussians. Where a stream function
/// Ψ exists, (u, v) = (−∂Ψ/∂y, ∂Ψ/∂x) (Thesis 5.1–5.2), free of divergence in (x, y).
class AnalyticField {
 public:
  /// `start` is used where the specification names no t0. Unknown kinds and parameters, numbers that are not finite,
  /// scales that are not positive and covariances that are not positive definite are refused.
  static Expected<AnalyticField, AnalyticError> make(const AnalyticSpec& spec, Instant start, const Coverage& coverage);
  static Expected<AnalyticField, AnalyticError> make(const AnalyticSpec& spec, Instant start) {
    return make(spec, start, Coverage{});
  }

  [[nodiscard]] Expected<Sample, NoCurrent> sample(GeoPoint p, Depth z, double t_s) const;
  [[nodiscard]] Coverage coverage() const { return coverage_; }
  /// A proven bound over the coverage, see the kinds. Finite also for the whole globe, but then source, solid-body and
  /// shear are very fast at its far side: give a box.
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{fastest_}; }
  /// The same field over another box.
  [[nodiscard]] AnalyticField within(const Coverage& coverage) const;

  [[nodiscard]] const AnalyticSpec& spec() const { return spec_; }
  [[nodiscard]] double t0_s() const { return t0_s_; }
  /// Position in the field's own plane; for tests and drawings.
  [[nodiscard]] analytic::Uv plane(GeoPoint p) const;
  [[nodiscard]] const analytic::Kind& kind() const { return kind_; }

 private:
  AnalyticField() = default;
  AnalyticSpec spec_;
  analytic::Kind kind_;
  double lat0_{}, lon0_{}, per_lat_{}, per_lon_{};  ///< dimensionless lengths per radian
  double speed_{}, per_second_{}, t0_s_{};
  Coverage coverage_;
  double fastest_{};
};

/// Several fields over each other: the currents add; a place has a value only where all have one (the first reason
/// counts); the bound is the sum of the bounds. Non-owning, like FieldRef.
class FieldSum {
 public:
  explicit FieldSum(std::vector<FieldRef> parts) : parts_{std::move(parts)} {}
  [[nodiscard]] Expected<Sample, NoCurrent> sample(GeoPoint p, Depth z, double t_s) const;
  /// The overlap of the parts' boxes (longitudes in the frame of the first). An empty overlap has east < west.
  [[nodiscard]] Coverage coverage() const;
  [[nodiscard]] MetresPerSecond fastest() const;

 private:
  std::vector<FieldRef> parts_;
};

}  // namespace glidehelm::ocean
