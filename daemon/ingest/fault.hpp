#pragma once

#include <limits>
#include <string>

#include "core/base/expected.hpp"

/// The program that turns published forecasts into one flat grid. The only room that knows NetCDF and UDUNITS.
namespace glidehelm::ingest {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  ///< no value

/// Why a file is refused: what, where in the file, what is allowed.
struct Fault {
  std::string what;
  bool by_library{};  ///< the library could not read: of a remote address, perhaps not now
  bool
      alone{};  ///< it says nothing about the file by itself: others beside it (a grid, the other component) would help
  friend bool operator==(const Fault&, const Fault&) = default;
};
template <class T>
using Result = Expected<T, Fault>;
inline Unexpected<Fault> fault(std::string what) { return unexpected(Fault{std::move(what)}); }
/// Numbers in a message, as printf writes them; `format` is ours and takes what it is given.
std::string printed(const char* format, double a, double b = 0);

inline Unexpected<Fault> fault_alone(std::string what) { return unexpected(Fault{std::move(what), false, true}); }

}  // namespace glidehelm::ingest
