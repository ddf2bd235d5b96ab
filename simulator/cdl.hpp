#pragma once

#include <string>

#include "core/chart/chart.hpp"
#include "simulator/coastal.hpp"

namespace glidehelm::simulator {

/// The grid that a CDL file samples a field on.
struct CdlGrid {
  double step_deg{0.05};
  int hours{96};  ///< last time; hourly from the field's start
  int every_h{1};
  friend bool operator==(const CdlGrid&, const CdlGrid&) = default;
};

/// The field as CDL, the text form of NetCDF (`ncgen -o FILE.nc FILE.cdl`), after the CF conventions: float variables
/// water_u and water_v over (time, lat, lon) with standard names, units and _FillValue, coordinates with units. Nodes
/// on the chart's land hold the fill value; without a coast no node does. Same arguments, same bytes.
std::string coastal_cdl(const CoastalSpec& spec, Variant variant, const CdlGrid& grid, const chart::Chart& chart);

}  // namespace glidehelm::simulator
