#pragma once

#include <cstddef>

#include "core/ocean/grid_format.hpp"

namespace glidehelm::ingest {

/// Currents that balance the slope of the sea surface (Thesis A.1–A.2, with derivatives per metre as the errata ask;
/// Garau, "Realistic ocean environments"):
///
///     u = −(g/f) ∂h/∂y,   v = (g/f) ∂h/∂x,   f = 2Ω sin φ
///
/// with the WGS84 radii of curvature, normal gravity of WGS84 (Somigliana) and Ω = 7.292115e-5 rad/s, at the node's own
/// latitude.
///
/// `grid` comes with the height (m) in both floats of a node, NaN where there is none, and leaves with east and north
/// (m/s). Derivatives are centred differences (weighted where the axis is uneven, so that a parabola comes out exactly),
/// one-sided at coasts and edges, and across the seam of a grid around the globe. Missing: nodes without height, without a
/// neighbour in one of the directions, and those nearer to the equator than `equator_band_deg`, where f vanishes and the
/// balance with it. Returns how many nodes with a height that band left out, at one time.
///
/// Left out besides: wind drift (Ekman), tides, curvature of the flow (in a ring of 50 km radius at 1 m/s about a fifth).
/// Centred differences over two cells lose (kΔ)²/6 of a wave of wave number k: 6 % of the speeds of a 1/4° product.
/// Complexity: linear in the nodes.
std::size_t geostrophic_currents(ocean::Grid& grid, double equator_band_deg);

/// Normal gravity of WGS84 at a latitude, m/s².
double normal_gravity(double lat_rad);
/// Coriolis parameter at a latitude, rad/s; negative in the south.
double coriolis(double lat_rad);

}  // namespace glidehelm::ingest
