#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/time.hpp"

namespace glidehelm {

/// `2026-11-25T10:20:30Z`, or with milliseconds when asked: every time a person or a program reads is UTC with a Z.
std::string utc_text(Instant t, bool with_milliseconds = false);

/// Reads `YYYY-MM-DD[T| ]HH:MM[:SS[.fff]][Z]` and `YYYY-MM-DD` (midnight); no other zone is understood. A value out of
/// its range (month 13, 30 February, second 60) gives nothing.
std::optional<Instant> utc_from_text(std::string_view text);

/// The instant of a civil UTC date and time; nothing when a field is out of range.
std::optional<Instant> utc_from_civil(int year, int month, int day, int hour, int minute, double second);

}  // namespace glidehelm
