#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/planning/lattice_search.hpp"
#include "core/planning/segment_time.hpp"

namespace glidehelm::planning {

/// The two-point boundary value problem of the quickest way (Thesis 4.7), for a vehicle in the mean motion of the schedule.
///
/// A quickest way is an extremal of H = p·(c + U·n), n the heading: Hamilton's equations (Thesis 4.43) say how p turns, and the heading is
/// that of p. As only its direction matters, place and heading (φ, λ, ψ) are the state (Zermelo, Thesis 4.33). Errata: 4.33 and 4.36–4.38
/// hold for currents without divergence only; the general form is Eichhorn's eq. 2, which in the plane is what is integrated here. ψ is
/// clockwise from north, and heading and momentum agree in sign (4.45–4.46, not 4.44). The metric is part of H, so that ways
/// on the ellipsoid are geodesics in still water: ∂H/∂(φ, λ) are central differences over 400 m, of the currents and of WGS84's radii together.
///
/// Currents that are stronger than the glider, and obstacles, are not for this method (Thesis 4.7.3).
class ExtremalFlow {
 public:
  struct State {
    double lat{}, lon{}, psi{};  ///< radians; heading clockwise from north
  };
  ExtremalFlow(const Problem& problem, const ocean::Ocean& ocean) : motion_{problem, ocean} {}

  /// d(State)/dt at epoch second `t_s`; none where there is no current.
  [[nodiscard]] std::optional<State> rates(const State& s, double t_s) const;
  /// One classical Runge–Kutta step.
  [[nodiscard]] std::optional<State> step(const State& s, double t_s, double dt) const;
  [[nodiscard]] const MeanMotion& motion() const { return motion_; }
  [[nodiscard]] std::uint64_t evaluations() const { return evaluations_; }

 private:
  MeanMotion motion_;
  mutable std::uint64_t evaluations_{};
};

/// An extremal from a place and time to a disc.
struct Extremal {
  std::vector<WayPoint> way;  ///< to the disc, or to where it comes nearest to the centre
  bool arrives{};
  double arrival_s{};  ///< epoch seconds; infinite when it does not arrive
  double nearest_m{};  ///< distance of the way from the disc's centre
  std::uint64_t shots{}, evaluations{};
  bool complete{};  ///< not stopped
};

/// Shooting: an extremal with each of 72 first headings; between two that pass the centre on different sides the heading is halved until the
/// way meets it, and then turned to where the disc is entered first. The earliest counts. `may_go_on`(shots) stops it.
Extremal shoot(const ExtremalFlow& flow, const WayPoint& from, const vehicle::Disc& goal, double until_s,
               const std::function<bool(std::uint64_t)>& may_go_on);

/// Collocation: place and heading at the ends of 48 equal parts of the unknown time, and on each part the cubic whose slope fits in its
/// middle (Hermite and Simpson, fourth order; Thesis 4.7.3: time is scaled by the unknown τ). The way ends on the disc with the heading to
/// its centre (the transversality that the point of Thesis 4.34 does not need). Damped Newton from the straight way. None when it does not
/// converge.
std::optional<Extremal> collocate(const ExtremalFlow& flow, const WayPoint& from, const vehicle::Disc& goal,
                                  double until_s);

}  // namespace glidehelm::planning
