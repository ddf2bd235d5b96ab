#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/planning/held_flight.hpp"

/// A flight as a chain of maps, one for each drift and stint, and Newton's method for such chains: what refinement is made of.
namespace glidehelm::planning {

/// A scalar with its first and second differences with respect to place (east, north, metres) and heading (radians).
struct Expansion {
  double value{};
  Eigen::Vector2d by_place = Eigen::Vector2d::Zero();
  double by_turn{};
  Eigen::Matrix2d by_places = Eigen::Matrix2d::Zero();
  Eigen::Vector2d by_place_turn = Eigen::Vector2d::Zero();
  double by_turns{};
};

/// One stint of a way: where its drift begins (radians) and how its end answers to changes of that place and of the heading.
struct ChainLink {
  double lat{}, lon{};
  Expansion east, north;  ///< of the end, metres from where the way ends
  Expansion toll;         ///< metres
};

/// What one turn does, and how it answers to a deviation from the way.
struct Gain {
  double turn{};
  Eigen::Vector2d feedback = Eigen::Vector2d::Zero();
};

/// Steps of the differences.
struct Steps {
  double place{};  ///< metres
  double turn{};   ///< radians
};

inline constexpr double kLongestTurn = 0.5;  ///< radians of one stint in one round

/// Lanes of one link: the way and twelve beside it.
inline constexpr std::size_t kLinkLanes = 13;

/// A link by differences between lanes that are flown side by side, not beyond `until_s`.
struct MeasuredLink {
  ChainLink link;
  double end_lat{}, end_lon{};  ///< of the undisturbed lane
};
/// None where a lane leaves the field.
std::optional<MeasuredLink> measure_link(HeldFlight& flight, int k, double lat, double lon, double heading,
                                         double until_s, Steps steps);

/// How steps that were too bold are held back: by a price on turning, or by one on leaving the way: then turns lead back to it (Tassa et al. 2012),
/// and one stint's change does not carry all that follow away.
struct Damping {
  double turning{}, leaving{};
};

/// The turns of all links, and how many metres the quadratics say that they win when taken whole: the end is nearer, or less toll is paid.
struct ChainStep {
  std::vector<Gain> gains;
  double promises{};
};

/// Backwards along a chain: the distance from `end` to the goal as a quadratic in each link's beginning, and the turns that it asks for
/// (Jacobson and Mayne 1970). `to_end`: metres east and north from the goal's centre to the end of the chain.
ChainStep step_along(const std::vector<ChainLink>& links, Eigen::Vector2d to_end, Damping damping);

}  // namespace glidehelm::planning
