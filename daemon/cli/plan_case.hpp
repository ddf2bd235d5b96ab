#pragma once

#include <memory>
#include <ostream>
#include <string>

#include "core/mission/event.hpp"
#include "core/mission/in_water.hpp"
#include "daemon/cli/mission_file.hpp"
#include "daemon/cli/plan.hpp"
#include "daemon/ocean_source.hpp"

namespace glidehelm::cli {

/// Everything that one plan depends on, resolved.
struct Case {
  mission::Mission mission;    ///< its body in the forecast's water
  mission::WaterFrom water{};  ///< whose water that is
  std::string mission_file, mission_text;
  std::shared_ptr<const daemon::ChartSource> chart;
  std::shared_ptr<const daemon::OceanSource> ocean;
  mission::PlanningRequest request;
  daemon::OceanOrder order;  ///< what `ocean` was loaded by
};

/// Reads mission, coast and forecast for `plan` and `rehearse`. Warnings go to `err`. The start is --from, else the mission's; the time is
/// --at, else the mission's, else now, else the first time of the forecast.
Expected<Case, Trouble> prepare_case(const PlanOptions& options, world::World& world, std::ostream& err);

}  // namespace glidehelm::cli
