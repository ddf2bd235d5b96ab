#pragma once

#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/box.hpp"

namespace glidehelm::ingest {

/// Takes out the values that the producer's own quality control has failed.
///
/// Counted are the variables that `velocity` names in `ancillary_variables`, lie on its dimensions, and have
/// `flag_values` with `flag_meanings` of which one is "fail", "bad" or "bad_data" (QARTOD and its like). Where one of them is
/// a summary ("primary" or "aggregate" in its name) only that one counts: it is the producer's verdict over the single tests.
/// A warning says how many values fell out and by which flags; the other meanings ("suspect", "not_evaluated") are kept.
Result<Done> drop_failed(const NetcdfFile& file, const Variable& velocity, const Axes& axes, const Box& box,
                         ocean::Grid& grid, std::vector<std::string>& warnings);

}  // namespace glidehelm::ingest
