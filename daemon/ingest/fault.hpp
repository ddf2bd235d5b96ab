#pragma once

#include <string>

#include "core/base/expected.hpp"

/// The program that turns published forecasts into one flat grid. The only room that knows NetCDF and UDUNITS.
namespace glidehelm::ingest {

/// Why a file is refused: what, where in the file, what is allowed.
struct Fault {
  std::string what;
  bool library{};  ///< the library could not read: of a remote address, perhaps not now
  friend bool operator==(const Fault&, const Fault&) = default;
};
template <class T>
using Result = Expected<T, Fault>;
inline Unexpected<Fault> fault(std::string what) { return unexpected(Fault{std::move(what)}); }

}  // namespace glidehelm::ingest
