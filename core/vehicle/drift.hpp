#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/current.hpp"
#include "core/base/geo.hpp"
#include "core/chart/chart.hpp"
#include "core/ocean/field.hpp"

/// Vehicles that go where the water goes: drifters and profiling floats (Thesis, Appendix B).
namespace glidehelm::vehicle {

/// A drifter (Thesis B.1.1): a point that the current at one depth carries, dx/dt = u(x, t). What the wind does to a buoy is not in it.
struct Drifter {
  Metres depth;  ///< of its drogue; 0: the shallowest current
};

/// A profiling float (Thesis B.2): it sinks to its parking depth, drifts there, sinks on to the depth at which its profile begins, rises
/// to the surface and drifts there while it reports. Where the water ends above the depth that is due it is carried by the deepest
/// current there is, and its clock runs on as if it were at that depth.
///
/// One vertical speed for all depths: `float_speed` (B.10) says what it is for a hull and a net buoyancy.
struct ProfilingFloat {
  Metres park{1000}, profile{2000};
  MetresPerSecond vertical{0.10};
  Seconds cycle{240 * 3600.0};  ///< from one dive to the next
  Seconds surface{30 * 60.0};   ///< of each cycle, at its end
};
/// What is wrong with a float's numbers: a profile that begins above the parking depth, or a cycle that is too short to go down and up.
/// Empty when nothing is.
std::string why_no_float(const ProfilingFloat& f);

using Passive = std::variant<Drifter, ProfilingFloat>;

/// What a passive vehicle is doing.
enum class DriftPhase : std::uint8_t { drifting, sinking, parked, deepening, rising, surfaced };
std::string_view word(DriftPhase phase);

/// Why a drift ended.
enum class DriftEnd : std::uint8_t {
  time,        ///< it drifted as long as was wanted
  forecast,    ///< the forecast reaches no farther in time
  aground,     ///< the shore, or land by the forecast's mask
  left_chart,  ///< where the coast file ends, or an area's border
  left_area,   ///< where the forecast ends in space
  bottom,      ///< the sea floor rises above a drifter's depth
  no_data      ///< water of which the forecast says nothing
};
/// "time", "forecast", "aground", "left_chart", "left_area", "bottom", "no_data".
std::string_view word(DriftEnd end);

/// A place on the way.
struct DriftPoint {
  double t_s{};  ///< epoch seconds
  GeoPoint at;
  Metres depth;        ///< at which the current was found
  Metres due;          ///< where the vehicle would be in water that is deep enough
  Current current;     ///< there and then
  DriftPhase phase{};  ///< from here on
};

/// Where it goes. No points: it does not get under way, and `end` says why.
struct DriftTrack {
  std::vector<DriftPoint> points;
  DriftEnd end{};
};

/// How long, and what is told of it.
struct DriftSettings {
  double start_s{};              ///< epoch seconds
  Seconds duration{};            ///< ≥ 0
  Seconds every{6 * 3600.0};     ///< > 0: a point each so often, at each change of phase, and at the end
  double forecast_last_s{1e18};  ///< epoch second after which the currents are not believed
};

/// The way of a passive vehicle from a place on the surface (a float begins to sink there; a drifter is at its depth), in a field with
/// depths; one without is the same at all depths.
///
/// Each phase is integrated on its own by `move` (motion.hpp: Runge–Kutta of order 4 with the WGS84 metric at each stage), so no
/// step straddles a change of phase, with steps that differ from two of half their length by at most 0.02 m: in smooth currents
/// a way of 240 h ends within a metre or two of the exact one, far below what any forecast is worth. Shores of the chart are met to
/// the way of 10 s. Preconditions: `why_no_float` has nothing to say.
DriftTrack drift(const Passive& vehicle, ocean::FieldRef full, const chart::Chart& chart, GeoPoint from,
                 const DriftSettings& settings);

}  // namespace glidehelm::vehicle
