#include "daemon/ingest/units.hpp"

#include <udunits2.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>
#include <tuple>
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
  return std::string{trimmed(unit)};
}

/// Year, month and day after "since", as written; nothing when they are not there.
std::optional<std::array<int, 3>> written_date(const std::string& unit) {
  const auto since = lower(unit).find(" since ");
  if (since == std::string::npos) return std::nullopt;
  std::array<int, 3> date{};
  const char* at = unit.data() + since + 7;
  const char* const end = unit.data() + unit.size();
  while (at < end && *at == ' ') ++at;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0 && (at == end || *at++ != '-')) return std::nullopt;
    const auto [next, error] = std::from_chars(at, end, date[i]);
    if (error != std::errc{}) return std::nullopt;
    at = next;
  }
  return date;
}

/// Seconds by which the proleptic Gregorian date lies after the same date of UDUNITS' mixed calendar (Julian before 15
/// October 1582).
double proleptic_shift(const std::array<int, 3>& date) {
  const auto [year, month, day] = date;
  if (std::tuple{year, month, day} >= std::tuple{1582, 10, 15}) return 0;
  const std::chrono::sys_days proleptic{std::chrono::year{year} / std::chrono::month{static_cast<unsigned>(month)} /
                                        std::chrono::day{static_cast<unsigned>(day)}};
  const double mixed = ut_encode_date(year, month, day) - ut_encode_date(1970, 1, 1);
  return static_cast<double>(proleptic.time_since_epoch().count()) * 86400.0 - mixed;
}

}  // namespace

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
  const Unit from = system_->parse(known_spelling(unit)), to = system_->parse(target);
  if (!from)
    return fault("the unit \"" + unit + "\" cannot be read; allowed is any unit of UDUNITS that converts to " + target);
  const Converter converter{ut_get_converter(from.get(), to.get())};
  if (!converter) return fault("the unit \"" + unit + "\" does not convert to " + target);
  const double intercept = cv_convert_double(converter.get(), 0.0);
  return Scaling{cv_convert_double(converter.get(), 1.0) - intercept, intercept};
}

Result<Scaling> Units::time_scaling(const std::string& unit, const std::string& calendar) const {
  const std::string kind = lower(trimmed(calendar));
  const bool proleptic = kind == "proleptic_gregorian";
  if (!proleptic && !kind.empty() && kind != "standard" && kind != "gregorian")
    return fault("the calendar \"" + calendar + "\"; allowed are standard, gregorian and proleptic_gregorian");
  const Unit from = system_->parse(std::string{trimmed(unit)}), to = system_->parse(kEpoch);
  const Converter converter{from ? ut_get_converter(from.get(), to.get()) : nullptr};
  const auto date = written_date(unit);
  if (!converter || !date)
    return fault("the time unit \"" + unit + "\" cannot be read; allowed is like \"hours since 1950-01-01 00:00:00\"");
  const double shift = proleptic ? proleptic_shift(*date) : 0.0;
  const double intercept = cv_convert_double(converter.get(), 0.0);
  // The slope over a million units, so that the large intercept does not round it away.
  const double slope = (cv_convert_double(converter.get(), 1e6) - intercept) * 1e-6;
  return Scaling{slope, intercept + shift};
}

}  // namespace glidehelm::ingest
