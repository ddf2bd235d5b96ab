#include "core/base/utc.hpp"

#include <charconv>
#include <cstdio>

namespace glidehelm {

namespace {

/// Exactly `digits` decimal digits from the front of `text`.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return std::nullopt;
  int value = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    if (text[i] < '0' || text[i] > '9') return std::nullopt;
    value = value * 10 + (text[i] - '0');
  }
  text.remove_prefix(digits);
  return value;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

std::string utc_text(Instant t, bool with_milliseconds) {
  using namespace std::chrono;
  const auto day = floor<days>(t);
  const year_month_day date{day};
  const hh_mm_ss time{t - day};
  char text[48];
  int n = std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02d", static_cast<int>(date.year()),
                        static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                        static_cast<int>(time.hours().count()), static_cast<int>(time.minutes().count()),
                        static_cast<int>(time.seconds().count()));
  std::string result(text, static_cast<std::size_t>(n));
  if (with_milliseconds) {
    n = std::snprintf(text, sizeof text, ".%03d", static_cast<int>(time.subseconds().count()));
    result.append(text, static_cast<std::size_t>(n));
  }
  return result + 'Z';
}

std::optional<Instant> utc_from_civil(int year, int month, int day, int hour, int minute, double second) {
  using namespace std::chrono;
  if (year < 1 || year > 9999 || month < 1 || month > 12 || day < 1) return std::nullopt;
  const year_month_day date{std::chrono::year{year}, std::chrono::month{static_cast<unsigned>(month)},
                            std::chrono::day{static_cast<unsigned>(day)}};
  if (!date.ok()) return std::nullopt;
  if (hour < 0 || hour > 23 || minute < 0 || minute > 59 || !(second >= 0.0 && second < 60.0)) return std::nullopt;
  const auto midnight = time_point_cast<milliseconds>(sys_days{date});
  return Instant{midnight + hours{hour} + minutes{minute} +
                 milliseconds{static_cast<std::int64_t>(second * 1e3 + 0.5)}};
}

std::optional<Instant> utc_from_text(std::string_view text) {
  const auto year = take_digits(text, 4);
  if (!year || !take(text, '-')) return std::nullopt;
  const auto month = take_digits(text, 2);
  if (!month || !take(text, '-')) return std::nullopt;
  const auto day = take_digits(text, 2);
  if (!day) return std::nullopt;
  if (text.empty()) return utc_from_civil(*year, *month, *day, 0, 0, 0.0);
  if (!take(text, 'T') && !take(text, ' ')) return std::nullopt;
  const auto hour = take_digits(text, 2);
  if (!hour || !take(text, ':')) return std::nullopt;
  const auto minute = take_digits(text, 2);
  if (!minute) return std::nullopt;
  double second = 0.0;
  if (take(text, ':')) {
    const auto whole = take_digits(text, 2);
    if (!whole) return std::nullopt;
    second = *whole;
    if (take(text, '.')) {
      double unit = 0.1;
      bool any = false;
      while (!text.empty() && text.front() >= '0' && text.front() <= '9') {
        second += unit * (text.front() - '0');
        unit *= 0.1;
        any = true;
        text.remove_prefix(1);
      }
      if (!any) return std::nullopt;
    }
  }
  take(text, 'Z');
  if (!text.empty()) return std::nullopt;
  return utc_from_civil(*year, *month, *day, *hour, *minute, second);
}

}  // namespace glidehelm
