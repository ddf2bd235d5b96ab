#include "daemon/ingest/units.hpp"

#include <udunits2.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/text.hpp"

namespace glidehelm::ingest {

namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;
using Converter = std::unique_ptr<cv_converter, FreeConverter>;

const char* kEpoch = "seconds since 1970-01-01 00:00:00";

/// What people write and UDUNITS does not know, or knows as something else.
std::string known_spelling(const std::string& unit) {
  const std::string plain = lower(trimmed(unit));
  if (plain == "deg") return "degree";
  for (const char* knots : {"kn", "kts", "knots", "knot", "kt"})
    if (plain == knots) return "knot";
  for (const char* speed : {"mps", "ms-1", "ms^-1"})
    if (plain == speed) return "m/s";
  return std::string{trimmed(unit)};
}

using Date = std::array<int, 3>;  ///< year, month, day

enum class Calendar { mixed, proleptic, julian, no_leap };

bool leap_year(int year, Calendar calendar) {
  if (calendar == Calendar::no_leap) return false;
  const bool julian = calendar == Calendar::julian || (calendar == Calendar::mixed && year <= 1582);
  return year % 4 == 0 && (julian || year % 100 != 0 || year % 400 == 0);
}
constexpr std::array<int, 12> kDaysOfMonth{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
bool exists(const Date& date, Calendar calendar) {
  const auto [year, month, day] = date;
  if (month < 1 || month > 12 || day < 1 || std::abs(year) > 9999) return false;
  return day <= kDaysOfMonth[static_cast<std::size_t>(month) - 1] + (month == 2 && leap_year(year, calendar) ? 1 : 0);
}

/// Days since 1970-01-01 of the same calendar.
std::int64_t proleptic_days(const Date& date) {
  return std::chrono::sys_days{std::chrono::year{date[0]} / std::chrono::month{static_cast<unsigned>(date[1])} /
                               std::chrono::day{static_cast<unsigned>(date[2])}}
      .time_since_epoch()
      .count();
}
std::int64_t no_leap_days(const Date& date) {
  std::int64_t days = std::int64_t{365} * (date[0] - 1970) + date[2] - 1;
  for (std::size_t m = 0; m + 1 < static_cast<std::size_t>(date[1]); ++m) days += kDaysOfMonth[m];
  return days;
}
/// Days from 1970-01-01 (Gregorian) to a date of the Julian calendar.
std::int64_t julian_days(const Date& date) {
  // Counted in years that begin in March, so that the leap day is the last of them.
  const std::int64_t year = date[0] - (date[1] <= 2 ? 1 : 0);
  const auto floored = [](std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); };
  const std::int64_t month = (date[1] + 9) % 12;
  const std::int64_t from_march_of_year_0 = 365 * year + floored(year, 4) + (153 * month + 2) / 5 + date[2] - 1;
  // 1 March of year 0 in the Julian calendar is Julian day 1721118 (that noon); 1970-01-01 (Gregorian) is 2440588.
  return from_march_of_year_0 + 1721118 - 2440588;
}

/// Seconds by which the date of a calendar lies from where UDUNITS, whose calendar is mixed (Julian before 15 October
/// 1582), puts it.
double calendar_shift(const Date& date, Calendar calendar) {
  const auto [year, month, day] = date;
  const double mixed = ut_encode_date(year, month, day) - ut_encode_date(1970, 1, 1);
  switch (calendar) {
    case Calendar::mixed:
      return 0;
    case Calendar::proleptic:
      return static_cast<double>(proleptic_days(date)) * 86400.0 - mixed;
    case Calendar::julian:
      return static_cast<double>(julian_days(date)) * 86400.0 - mixed;
    case Calendar::no_leap:
      return static_cast<double>(no_leap_days(date)) * 86400.0 - mixed;
  }
  return 0;
}

/// "hours", and where the text after "since" begins; nothing without such a word.
struct Since {
  std::string unit;
  std::size_t epoch{};
};
std::optional<Since> since_of(const std::string& text) {
  const std::string plain = lower(text);
  for (const std::string word : {" since ", " after ", " from ", " ref ", "@"}) {
    const auto at = plain.find(word);
    if (at != std::string::npos && at > 0) return Since{std::string{trimmed(text.substr(0, at))}, at + word.size()};
  }
  return std::nullopt;
}

/// Spellings of the unit word that UDUNITS does not know.
std::string known_time_word(const std::string& word) {
  const std::string plain = lower(word);
  if (plain == "hrs") return "hours";
  if (plain == "mins") return "minutes";
  if (plain == "julian days" || plain == "julian_days" || plain == "dys") return "days";
  return word;
}

/// Year, month and day at the beginning of an epoch: 1950-1-1, 1950/01/01 or 19500101; `behind` is what follows.
std::optional<Date> written_date(std::string_view text, std::string_view& behind) {
  Date date{};
  const char* const end = text.data() + text.size();
  const char* at = text.data();
  std::array<std::ptrdiff_t, 3> digits{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0 && (at == end || (*at != '-' && *at != '/') || ++at == end)) return std::nullopt;
    if (i > 0 && *at == '-') return std::nullopt;
    const auto [next, error] = std::from_chars(at, end, date[i]);
    if (error != std::errc{}) return std::nullopt;
    digits[i] = next - at;
    at = next;
    if (i == 0 && digits[0] == 8 && (at == end || (*at != '-' && *at != '/'))) {
      date = {date[0] / 10000, date[0] / 100 % 100, date[0] % 100};
      break;
    }
  }
  if (digits[1] > 2 || digits[2] > 2) return std::nullopt;  // day or month first
  behind = {at, static_cast<std::size_t>(end - at)};
  return date;
}

std::string two(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

/// The calendar of a name, or why it is not read.
Result<Calendar> calendar_of(const std::string& name) {
  const std::string kind = lower(trimmed(name));
  if (kind.empty() || kind == "standard" || kind == "gregorian") return Calendar::mixed;
  if (kind == "proleptic_gregorian") return Calendar::proleptic;
  if (kind == "julian") return Calendar::julian;
  if (kind == "noleap" || kind == "365_day") return Calendar::no_leap;
  const std::string allowed = "; allowed are standard, gregorian, proleptic_gregorian, julian, noleap and 365_day";
  if (kind == "360_day" || kind == "all_leap" || kind == "366_day")
    return fault("the calendar \"" + name + "\" has days that never were" + allowed);
  if (kind == "utc" || kind == "tai") return fault("the calendar \"" + name + "\" counts leap seconds" + allowed);
  return fault("the calendar \"" + name + "\"" + allowed);
}

/// Time units that are whole conversions by themselves.
std::optional<TimeScaling> special_unit(const std::string& unit) {
  std::string plain;
  for (const char c : lower(trimmed(unit))) plain += c == '_' ? ' ' : c;
  if (plain.find(" as %y%m%d") != std::string::npos) return TimeScaling{TimeScaling::Kind::coded, 1, 0};
  constexpr double kDay = 86400;
  for (const char* modified : {"modified julian day", "modified julian days", "modified julian date", "mjd"})
    if (plain == modified) return TimeScaling{TimeScaling::Kind::linear, kDay, -40587 * kDay};
  for (const char* true_day : {"julian day", "julian days", "julian date", "true julian day"})
    if (plain == true_day) return TimeScaling{TimeScaling::Kind::linear, kDay, -2440587.5 * kDay};
  return std::nullopt;
}

}  // namespace

double TimeScaling::operator()(double value) const {
  if (kind == Kind::linear) return slope * value + intercept;
  if (kind == Kind::coded) {
    if (!(value >= 1e6 && value < 1e8)) return kNaN;
    const int whole = static_cast<int>(std::floor(value));
    const Date date{whole / 10000, whole / 100 % 100, whole % 100};
    if (!exists(date, Calendar::proleptic)) return kNaN;
    // A double holds 20240131.25 to 4e-9 of a day, 0.3 ms.
    return (static_cast<double>(proleptic_days(date)) + (value - whole)) * 86400.0;
  }
  const double seconds = slope * value + intercept;
  if (!(std::abs(seconds) < 1e12)) return kNaN;
  const double day_number = std::floor(seconds / 86400.0);
  const auto days = static_cast<std::int64_t>(day_number);
  std::int64_t year = days / 365, day = days % 365;
  if (day < 0) day += 365, --year;
  std::size_t month = 0;
  while (day >= kDaysOfMonth[month]) day -= kDaysOfMonth[month++];
  const Date date{static_cast<int>(1970 + year), static_cast<int>(month) + 1, static_cast<int>(day) + 1};
  return static_cast<double>(proleptic_days(date)) * 86400.0 + (seconds - day_number * 86400.0);
}

bool names_epoch(const std::string& unit) { return special_unit(unit).has_value() || since_of(unit).has_value(); }

bool counts_in_months(const std::string& unit) {
  const auto since = since_of(unit);
  const std::string word = since ? lower(since->unit) : "";
  for (const char* long_unit : {"month", "months", "year", "years", "yr", "common_year", "common_years"})
    if (word == long_unit) return true;
  return false;
}

struct Units::System {
  ut_system* system{};
  ~System() {
    if (system != nullptr) ut_free_system(system);
  }
  [[nodiscard]] Unit parse(const std::string& text) const { return Unit{ut_parse(system, text.c_str(), UT_UTF8)}; }
};

Units::Units(std::unique_ptr<System> system) : system_{std::move(system)} {}
Units::~Units() = default;
Units::Units(Units&&) noexcept = default;
Units& Units::operator=(Units&&) noexcept = default;

Result<Units> Units::load() {
  ut_set_error_message_handler(ut_ignore);  // its messages go to stderr without saying of which file
  auto system = std::make_unique<System>();
  system->system = ut_read_xml(nullptr);
  if (system->system == nullptr)
    return fault("the unit database of UDUNITS cannot be read (Debian package libudunits2-data)");
  return Units{std::move(system)};
}

Result<Scaling> Units::scaling(const std::string& unit, const std::string& target) const {
  const Unit to = system_->parse(target);
  Unit from = system_->parse(known_spelling(unit));
  if (!from) from = system_->parse(lower(trimmed(unit)));
  if (!from)
    return fault("the unit \"" + unit + "\" cannot be read; allowed is any unit of UDUNITS that converts to " + target);
  const Converter converter{ut_get_converter(from.get(), to.get())};
  if (!converter) return fault("the unit \"" + unit + "\" does not convert to " + target);
  const double intercept = cv_convert_double(converter.get(), 0.0);
  return Scaling{cv_convert_double(converter.get(), 1.0) - intercept, intercept};
}

Result<TimeScaling> Units::time_scaling(const std::string& unit, const std::string& calendar) const {
  const auto kind = calendar_of(calendar);
  if (!kind) return unexpected(kind.error());
  if (const auto special = special_unit(unit)) return *special;
  const auto unreadable = [&](const std::string& why) {
    return fault("the time unit \"" + unit + "\" " + why + "; allowed is like \"hours since 1950-01-01 00:00:00\"");
  };
  const auto since = since_of(unit);
  if (!since) return unreadable("cannot be read");
  const std::string epoch{trimmed(unit.substr(since->epoch))};
  std::string_view behind;
  const auto date = written_date(epoch, behind);
  if (!date) return unreadable("cannot be read");
  if ((*date)[0] == 0 && *kind != Calendar::proleptic)
    return unreadable("counts from the year 0, which its calendar does not have");
  if (!exists(*date, *kind)) return unreadable("counts from a date that does not exist");
  // The date is written anew, so that what was checked above is what UDUNITS reads.
  std::string clock{behind};
  if (!clock.empty() && clock.front() == '_') clock.front() = ' ';
  const std::string known = known_time_word(since->unit) + " since " + std::to_string((*date)[0]) + "-" +
                            two((*date)[1]) + "-" + two((*date)[2]) + clock;
  const Unit from = system_->parse(known), to = system_->parse(kEpoch);
  const Converter converter{from ? ut_get_converter(from.get(), to.get()) : nullptr};
  if (!converter) return unreadable("cannot be read");
  const double intercept = cv_convert_double(converter.get(), 0.0);
  // The slope over a million units, so that the large intercept does not round it away.
  const double slope = (cv_convert_double(converter.get(), 1e6) - intercept) * 1e-6;
  return TimeScaling{*kind == Calendar::no_leap ? TimeScaling::Kind::no_leap : TimeScaling::Kind::linear, slope,
                     intercept + calendar_shift(*date, *kind)};
}

}  // namespace glidehelm::ingest
