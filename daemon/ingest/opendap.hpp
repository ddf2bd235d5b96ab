#pragma once

#include <string>

#include "daemon/ingest/part.hpp"

/// Forecasts that lie on an OPeNDAP server (DAP2, libnetcdf's own client).
namespace glidehelm::ingest {

/// True for what is no file of this machine: "http://…" and "https://…".
bool is_address(const std::string& name);

/// Why an address gave nothing, and whether a later try may succeed (nobody answered, or the data were changing).
struct AddressFault {
  std::string what;
  bool passing{};
};

/// Reads an address as `read_part` reads a file. A constraint at its end ("?water_u[0:1:8][0:1:0][100:1:200][50:1:90],…")
/// cuts what is asked for; `options.area` cuts the rest.
///
/// An address cannot be copied privately nor measured against its header. What is proven instead:
///  - no answer ended early (NetcdfFile::open_address);
///  - after the reading the address is opened a second time: dimensions, variables, attributes and axes are as they were,
///    and the last time, read again, has the same values, so that it was not being written meanwhile;
///  - what is proven of the numbers of a file: no time of nothing but zeros, no speed above 5 m/s, and so on.
/// Not proven: that the server has what the producer published. https proves which server it was.
///
/// At most 4e7 nodes (320 MB) are asked for. How long an answer may take is the limit of whoever started the program: this
/// call waits. The hash of the source is that of the axes and values, since there are no bytes of a file.
/// Addresses with a name and password in them are refused: they stand in logs and journals.
Expected<Part, AddressFault> read_address(const std::string& address, const Units& units, ReadOptions options);

}  // namespace glidehelm::ingest
