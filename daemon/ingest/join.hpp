#pragma once

#include <vector>

#include "daemon/ingest/part.hpp"

namespace glidehelm::ingest {

/// Joins the files of one or several forecast cycles into one grid.
///
/// All parts lie on the same depths, latitudes and longitudes (to 1e-4 of a cell) and have times, unless there is only
/// one. Newer is: the later forecast reference time, if every part names one; else, and among equal ones, the later first time, else
/// the later argument. Parts of one cycle (equal named reference times) are merged time by time; of equal times the newer part's
/// counts, and a difference of more than 0.05 m/s between them is a contradiction that is refused.
///
/// Between its first and last time the newest cycle counts, at its own times. It takes over without a jump: over the first 6 h (or
/// the overlap, where that is shorter) its weight rises as s(x) = x²(3 − 2x) from the older cycle's value, and where the older one goes on
/// after it, it falls in the same way before its end; so the joint adds at most 1.5·|difference|/6 h to the rate of change (decision 019).
/// Cycles are laid over each other from the oldest up. Numbers that are equal in both stay as they are, bit by bit; a node that one of
/// the two has not is the newest one's. The water is the mean of the parts' columns, each for its times.
Result<ocean::Grid> join(std::vector<Part> parts);

}  // namespace glidehelm::ingest
