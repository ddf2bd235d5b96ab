#pragma once

#include <string>

#include "simulator/simulation.hpp"

namespace glidehelm::simulator {

/// One line per surfacing: time, glider, fix, measured current, what became of the file, distance to the goal.
std::string surfacing_line(const SurfacingRecord& record, const GliderPlan& plan);
/// One line at the end of a run.
std::string result_line(const GliderResult& result, const GliderPlan& plan);
/// The runs as one JSON document, schema glidehelm/glidersim/v1.
std::string results_json(const Simulation& simulation, std::uint64_t seed);

}  // namespace glidehelm::simulator
