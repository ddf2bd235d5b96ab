#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/planning/held_flight.hpp"

namespace glidehelm::planning {

/// Where held headings have led at an instant, and how that answers to each of them.
struct FlightEnd {
  /// From the goal's centre to the glider, metres, along three axes fixed in the Earth: the chord through WGS84. Its length is
  /// smooth everywhere, and shorter than the geodesic by d³/24R²: 0.3 m on 70 km, which moves no least distance.
  Eigen::Vector3d off = Eigen::Vector3d::Zero();
  double toll{};  ///< metres (HeldFlight)
  Eigen::Matrix3Xd off_by_turn;
  Eigen::RowVectorXd toll_by_turn;
};

/// x_{n−1} = f(x_0, B) of Thesis 4.21, with its derivatives: what optimisation kernels ask for, again and again.
///
/// Seven lanes are flown side by side for each stint: the way, and the way moved a little to both sides in east, in north and
/// in heading. Their differences are the derivatives of the stint's map, and the product of the maps, taken backwards, those
/// of the end: all n of them for the price of seven flights. Differences are central, with steps well below the scale of any
/// eddy (250 m, a third of the buffer at most).
class FlightEndings {
 public:
  /// Toll is paid within `buffer` beyond `margin` (HeldFlight).
  FlightEndings(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres margin,
                Metres buffer);

  /// At epoch second `until_s`. A flight that leaves the water with data ends there. Stints that dive later count nothing.
  [[nodiscard]] FlightEnd end(std::span<const double> headings, double until_s);
  [[nodiscard]] FlightEnd end_with_slopes(std::span<const double> headings, double until_s);
  [[nodiscard]] std::uint64_t evaluations() const { return flight_.evaluations(); }
  [[nodiscard]] const HeldFlight& flight() const { return flight_; }

 private:
  const Problem& problem_;
  HeldFlight flight_;
  Eigen::Vector3d goal_;
  double place_step_, turn_step_;
};

}  // namespace glidehelm::planning
