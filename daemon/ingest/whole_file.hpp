#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "daemon/ingest/fault.hpp"

namespace glidehelm::ingest {

/// The length that the header of a classic NetCDF file (CDF-1, CDF-2, CDF-5) asks for: the end of the last datum of any
/// variable, padding not counted. The header is read with every length checked against the bytes that are there.
/// Complexity: linear in the header.
///
/// Why: libnetcdf reads a truncated classic file without error and gives zeros for what is missing, which a glider would
/// take for "no current" (trust.md, fact 1).
Result<std::uint64_t> classic_length(std::span<const std::byte> file);

/// Success when the bytes are a NetCDF file as long as its own header says: classic by `classic_length`, NetCDF-4 by the
/// end-of-file address of its HDF5 superblock. Else what is wrong with it, with both lengths; of another kind of file, which
/// kind it is (compressed, GRIB, a web page, text, …).
Result<Done> check_whole(std::span<const std::byte> file);

}  // namespace glidehelm::ingest
