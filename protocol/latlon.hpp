#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/expected.hpp"
#include "core/base/geo.hpp"

/// Slocum text ↔ types, from bytes to bytes. No sockets, no planning, no files.
namespace glidehelm::protocol {

/// Why a text is no coordinate, in a pilot's words: what was found and what is allowed.
struct BadCoordinate {
  enum class Why { not_a_number, sentinel, minutes, range } why{};
  std::string text;  ///< as found
  std::string message;
  friend bool operator==(const BadCoordinate&, const BadCoordinate&) = default;
};

enum class Axis { latitude, longitude };

/// Reads degrees and minutes as a Slocum writes them: sign · (100·degrees + minutes), `-11741.800`, `801`, `228.117`, `-0030.5`
/// (slocum.md 2.5). By arithmetic, never by counting digits. Minutes below 60, |latitude| ≤ 90, |longitude| ≤ 180; a magnitude
/// of 9e6 and more is the sentinel of a value never set. Degrees.
Expected<double, BadCoordinate> degrees_from_ddmm(std::string_view text, Axis axis);

/// A position of a goto list or a dialog from its two texts.
Expected<GeoPoint, BadCoordinate> point_from_ddmm(std::string_view lat, std::string_view lon);

/// The same number in units of 1e-4 minute, rounded half away from zero: what a goto list can hold (0.19 m). 59.99996 minutes carry
/// into the next degree here and nowhere else.
std::int64_t ten_thousandths_of_minute(double degrees);

/// `%.4f` of DDMM.mmmm, sign kept at zero degrees: `-0030.5000`, `2917.0020`, `-11741.8000`.
std::string ddmm_text(double degrees);

}  // namespace glidehelm::protocol
