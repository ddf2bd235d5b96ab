#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geo.hpp"
#include "core/base/local_metric.hpp"
#include "core/base/time.hpp"
#include "core/ocean/field.hpp"

namespace glidehelm::simulator {

/// Which of two related oceans: what the model says, or what the water does.
enum class Variant { forecast, truth };

/// A made-up coastal sea. Speeds are peaks. The strengths are tuned for U ≈ 0.3 m/s: against the defaults the straight
/// way from `from` to `to` lies in an opposing jet and a favourable one runs beside it.
struct CoastalSpec {
  std::uint64_t seed{1};
  double west_deg{}, east_deg{}, south_deg{}, north_deg{};  ///< area; east > west, at most 20° each way
  GeoPoint from, to;                                        ///< ends of the straight way that the jets follow
  double start_s{};          ///< epoch seconds: where eddies stand as drawn and the tide has its drawn phase
  double jet{0.12};          ///< against the straight way, on it, m/s
  double counter_jet{0.22};  ///< along the straight way, beside it, m/s
  double jet_width_km{6};    ///< e-folding half width
  double jet_offset_km{14};  ///< from the opposing to the favourable jet; the side is drawn
  double eddy{0.12};         ///< strongest eddy, m/s; each is drawn between half of it and all of it
  int eddies{8};             ///< number drawn per 2.5° × 2.5°; 0 for none
  double eddy_min_km{25}, eddy_max_km{60};  ///< diameter of the ring of fastest flow
  double eddy_drift{0.03};                  ///< westward, m/s
  double tide{0.10};                        ///< M2, major axis along the straight way, m/s
  double tide_ratio{0.35};                  ///< minor to major axis
  double fading_m{0};  ///< e-folding depth of jets and eddies; 0: as strong at every depth. The tide always is
  // How the truth differs from the forecast of the same seed.
  double shift_km{4};       ///< every eddy is elsewhere by this much, in a drawn direction
  double tide_lag_deg{15};  ///< of phase
  double jet_change{0.08};  ///< share by which both jets are weaker or stronger (drawn), and shifted in widths
  double noise{0.03};       ///< small eddies of 6–12 km that the forecast does not have, m/s
  friend bool operator==(const CoastalSpec&, const CoastalSpec&) = default;
};

/// A seeded field of jets, eddies and a tide: smooth, fast to evaluate, the same for every machine.
///
/// In plane coordinates x east, y north about the middle of the area (metres, x scaled with the cosine of the middle
/// latitude), the flow is u = −∂ψ/∂y, v = ∂ψ/∂x with
///
///   ψ = Σ S_i·exp(−|x − c_i(t)|²/(2σ_i²)) + Ψ(d),   Ψ'(d) along the way,   d = distance left of the way,
///
/// so everything but the tide is free of divergence in that plane. An eddy's fastest flow is |S|·e^(−1/2)/σ at the
/// distance σ, which is half of its "diameter". The tide is an ellipse of period 12.4206 h whose phase travels along
/// the way with 120 km to a radian; it does not fill and empty the sea (no elevation is modelled). With `fading_m` the flow
/// without the tide falls as exp(−z/fading_m) with depth.
class CoastalField {
 public:
  CoastalField(const CoastalSpec& spec, Variant variant);

  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double t_s) const;
  [[nodiscard]] ocean::Coverage coverage() const { return coverage_; }
  [[nodiscard]] MetresPerSecond fastest() const { return fastest_; }

  /// Stream function without the tide, m²/s, in plane metres about the middle of the area.
  [[nodiscard]] double stream_function(double x, double y, double t_s) const;
  /// Flow without the tide, m/s, in the same plane.
  [[nodiscard]] Offset flow(double x, double y, double t_s) const;
  [[nodiscard]] std::size_t eddy_count() const { return eddies_.size(); }

 private:
  struct Eddy {
    double x, y, sigma, strength;  ///< m, m, m, m²/s
    double drift_x;                ///< m/s
  };
  struct Jet {
    double centre, width, speed;  ///< m, m, m/s along the way
  };
  void draw_jets(const CoastalSpec& spec, Variant variant);
  void draw_eddies(const CoastalSpec& spec, Variant variant);
  [[nodiscard]] Offset plane(GeoPoint p) const;

  ocean::Coverage coverage_;
  MetresPerSecond fastest_;
  double lat0_{}, lon0_{}, start_s_{};
  LocalMetric metric_;
  double way_x_{}, way_y_{1}, from_x_{}, from_y_{};  ///< unit vector of the way and its start, in the plane
  double width_m_{}, height_m_{}, fading_m_{};
  std::vector<Eddy> eddies_;
  std::vector<Jet> jets_;
  double tide_major_{}, tide_minor_{}, tide_phase_{};
};

}  // namespace glidehelm::simulator
