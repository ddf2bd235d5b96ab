#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/ingest/netcdf_file.hpp"
#include "daemon/ingest/part.hpp"

/// Ensembles inside a file: which dimension counts the members, and one of them read as if it stood alone.
namespace glidehelm::ingest {

/// The dimension of the members; nothing where a file is no ensemble. In this order: one whose coordinate has the
/// standard_name `realization` (CF); one whose coordinate is marked as the ensemble's axis (`axis = "E"`,
/// `_CoordinateAxisType = "Ensemble"`); one with a known name (`ensemble`, `ens`, `member`, `number`, `realization`, …,
/// whatever their case) whose own coordinate is no other axis. A field of numbers with two more dimensions must lie on it,
/// and no latitude or longitude (then its entries are places). `index` and `label` of the result are those of member 0.
/// Refused: several that count equally.
Result<std::optional<EnsembleMember>> recognise_ensemble(const NetcdfFile& file);

/// The file as its member `asked` alone (counted from 0 in the order of the file; none: 0): its ensemble dimension is taken
/// out of every variable. A file without one stays as it is. Refused: a member that it does not have.
Result<NetcdfFile> one_member(Result<NetcdfFile> file, std::optional<std::size_t> asked);

/// Notes in the part which member of `file` its current is, and says so in `facts.layout`. Refused: a member above 0 was
/// asked for and the current lies on no ensemble dimension (a plain forecast is its own member 0).
Result<Done> tell_member(Part& part, const NetcdfFile& file, std::optional<std::size_t> asked);

/// True when both are the same member of equally many, or neither is one.
bool of_one_member(const Part& a, const Part& b);
/// Refuses parts of several members: joined in time, one would be taken for the continuation of another.
Result<Done> same_member(const std::vector<Part>& parts);

}  // namespace glidehelm::ingest
