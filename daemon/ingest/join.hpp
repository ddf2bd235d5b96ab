#pragma once

#include <vector>

#include "daemon/ingest/part.hpp"

namespace glidehelm::ingest {

/// Joins the files of one or several forecast cycles into one grid.
///
/// All parts lie on the same depths, latitudes and longitudes (to 1e-4 of a cell) and have times, unless there is only
/// one. The newest cycle wins where cycles overlap: an older part's time is kept only if it lies outside the times, first
/// to last, of every newer part, so that no interval is interpolated between two runs of a model. Newer is: the later
/// forecast reference time, if every part names one; else, and among equal ones, the later first time, else the later
/// argument. Parts of one cycle (equal named reference times) are merged time by time; of equal times the newer part's
/// counts, and a difference of more than 0.05 m/s between them is a contradiction that is refused.
Result<ocean::Grid> join(std::vector<Part> parts);

}  // namespace glidehelm::ingest
