#include "protocol/dialog_facts.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/text.hpp"
#include "protocol/line_splitter.hpp"

namespace glidehelm::protocol {

namespace {

constexpr std::array<std::pair<Say, std::string_view>, 32> kPhrases{{
    {Say::connection_event, "Connection Event:"},
    {Say::iridium, "Iridium console active and ready"},
    {Say::vehicle, "Vehicle Name:"},
    {Say::curr_time, "Curr Time:"},
    {Say::dr, "DR  Location:"},
    {Say::too_far, "GPS TooFar:"},
    {Say::invalid, "GPS Invalid :"},
    {Say::gps, "GPS Location:"},
    {Say::sensor, "sensor:"},
    {Say::at_surface, " at surface."},
    {Say::because, "Because:"},
    {Say::mission, "MissionName:"},
    {Say::water, "Water Velocity Calculations"},
    {Say::waypoint, "Waypoint:"},
    {Say::until_diving, "Time until diving is:"},
    {Say::extending, "Extending surface time by"},
    {Say::typed_resume, "User typed Control-R"},
    {Say::resuming, "RESUMING MISSION"},
    {Say::timed_out, "TIMED OUT WAITING FOR A CHARACTER"},
    {Say::console_off, "disabling Iridium console"},
    {Say::completed, "Mission completed: "},
    {Say::end_of_mission, "End of Mission"},
    {Say::starting, "Starting Mission:"},
    {Say::aborts, "ABORT HISTORY: total since reset:"},
    {Say::devices, "devices:(t/m/s)"},
    {Say::gliderdos, "GliderDos "},
    {Say::gliderlab, "GliderLAB "},
    {Say::scidos, "SciDos>"},
    {Say::heard_a, "I heard a "},
    {Say::noise, ":OOD:"},
    {Say::oddity, "DRIVER_ODDITY:"},
    {Say::login, "No login script found"},
}};

bool is_name_character(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '.'; }

std::string_view first_word(std::string_view text) { return text.substr(0, text.find_first_of(" \t")); }

/// One line with the place of the label that is being read.
struct Place {
  std::string_view line;
  std::size_t begin{}, end{};  ///< of the label
  std::size_t joined_at{};
  [[nodiscard]] std::string_view rest() const { return line.substr(end); }
};

template <class T>
Fact fact(Say say, std::optional<Parsed<T>> parsed, std::size_t& used) {
  Fact out{say, parsed.has_value(), {}, 0};
  if (parsed) {
    used = parsed->used;
    out.value = std::move(parsed->value);
  }
  return out;
}

/// A long head leaves the column of the age open, so a head or a value that was put together from two pieces proves
/// nothing: a name that lost bytes may be the name of another sensor.
bool sensor_spans_join(const Place& place, std::size_t used) {
  constexpr std::size_t kAlignedEnd = 57 + 9;  // the age ends in column 57, " secs ago" follows
  if (place.joined_at == Line::kWhole || place.end + used == kAlignedEnd) return false;
  const auto value_end = place.line.find(' ', place.line.find(")=", place.end));
  return place.joined_at >= place.end && place.joined_at <= value_end;
}

std::optional<Fact> carrier(const Place& place) {
  if (place.rest().starts_with(" Carrier Detect found")) return Fact{Say::connection_event, true, CarrierFound{}, 0};
  if (place.rest().starts_with(" Carrier Detect lost")) return Fact{Say::connection_event, true, CarrierLost{}, 0};
  return std::nullopt;
}

std::optional<Fact> at_surface(const Place& place) {
  constexpr std::string_view kGlider = "Glider ";
  const auto begin = place.line.rfind(kGlider, place.begin);
  if (begin == std::string_view::npos) return std::nullopt;
  const auto from = begin + kGlider.size();
  auto name = from <= place.begin ? vehicle_name(place.line.substr(from, place.begin - from)) : std::nullopt;
  if (!name) return Fact{Say::at_surface, false, {}, 0};
  return Fact{Say::at_surface, true, std::move(*name), 0};
}

std::optional<Fact> water(const Place& place) {
  if (place.rest().starts_with(" COMPLETE")) return Fact{Say::water, true, WaterState::complete, 0};
  if (place.rest().starts_with(" waiting for")) return Fact{Say::water, true, WaterState::waiting, 0};
  return Fact{Say::water, false, {}, 0};
}

/// The key of `I heard a Control-R`, `I heard a character ('CR'), but …`, `I heard a keystroke ('NUL'), …`.
std::optional<Fact> heard_key(const Place& place) {
  constexpr std::string_view kControl = "Control-", kOpen = "('", kClose = "')";
  const auto rest = place.rest();
  if (rest.starts_with(kControl)) return Fact{Say::heard_a, true, std::string{trimmed(first_word(rest))}, 0};
  const auto open = rest.find(kOpen), close = rest.find(kClose);
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return std::nullopt;
  return Fact{Say::heard_a, true, std::string{rest.substr(open + kOpen.size(), close - open - kOpen.size())}, 0};
}

std::optional<Fact> abort_total(const Place& place) {
  const auto total = number_from(trimmed(place.rest()));
  constexpr double kMost = 1e6;
  if (!total || !(*total >= 0 && *total <= kMost)) return Fact{Say::aborts, false, {}, 0};
  return Fact{Say::aborts, true, *total, 0};
}

std::optional<Fact> location(Say say, const Place& place, std::size_t& used) {
  // `DR  Location:` never passes for another label, nor does a label that is the tail of a longer word (R5).
  if (place.begin > 0 && is_letter(place.line[place.begin - 1])) return std::nullopt;
  return fact(say, parse_location(place.rest(), place.end - place.begin), used);
}

std::optional<Fact> sensor(const Place& place, std::size_t& used) {
  const auto rest = place.rest();
  // `report ++` prints `sensor: NAME = VALUE UNIT`: another kind of line, not a damaged one.
  if (rest.empty() || !(is_letter(rest.front()) || rest.front() == '_')) return std::nullopt;
  auto out = fact(Say::sensor, parse_sensor(rest, place.begin), used);
  if (out.whole && sensor_spans_join(place, used)) return Fact{Say::sensor, false, {}, 0};
  return out;
}

std::optional<Fact> prompt(Say say, const Place& place, std::size_t& used) {
  if (say == Say::scidos) return Fact{say, true, Prompt{}, 0};
  auto out = fact(say, parse_prompt(place.rest()), used);
  if (!out.whole) return std::nullopt;  // the words stand in menus, too
  return out;
}

std::optional<Fact> file_name(Say say, const Place& place) {
  const auto rest = place.rest();
  // Behind a word a blank; a name that goes on where the text ends would be the tail of another one.
  const auto begin = rest.find_first_not_of(" \t");
  if (begin == std::string_view::npos || (begin == 0 && is_name_character(place.line[place.end - 1])))
    return Fact{say, false, {}, 0};
  constexpr std::string_view kAround =
      "'\"`,;:()<>.";  // what a sentence puts beside a name; 8.3 names have none of it at their ends
  const auto word = trimmed(first_word(rest.substr(begin)));
  const auto first = word.find_first_not_of(kAround);
  const auto name = first == std::string_view::npos ? std::string_view{}
                                                    : word.substr(first, word.find_last_not_of(kAround) + 1 - first);
  if (name.empty()) return Fact{say, false, {}, 0};
  return Fact{say, true, std::string{name}, 0};
}

std::optional<Fact> read(Say say, const Place& place, std::size_t& used) {
  const auto rest = place.rest();
  switch (say) {
    case Say::connection_event:
      return carrier(place);
    case Say::vehicle: {
      auto name = vehicle_name(rest);
      if (!name) return Fact{say, false, {}, 0};
      return Fact{say, true, std::move(*name), 0};
    }
    case Say::curr_time:
      return fact(say, parse_curr_time(rest), used);
    case Say::dr:
    case Say::too_far:
    case Say::invalid:
    case Say::gps:
      return location(say, place, used);
    case Say::sensor:
      return sensor(place, used);
    case Say::at_surface:
      return at_surface(place);
    case Say::because:
      return fact(say, parse_because(rest), used);
    case Say::mission:
      return fact(say, parse_mission(rest), used);
    case Say::water:
      return water(place);
    case Say::waypoint:
      return fact(say, parse_waypoint(rest), used);
    case Say::until_diving:
      return fact(say, parse_until_diving(rest), used);
    case Say::extending:
      return fact(say, parse_extension(rest), used);
    case Say::completed:
      return Fact{say, true, std::string{trimmed(first_word(rest))}, 0};
    case Say::aborts:
      return abort_total(place);
    case Say::devices:
      return fact(say, parse_devices(rest), used);
    case Say::gliderdos:
    case Say::gliderlab:
    case Say::scidos:
      return prompt(say, place, used);
    case Say::heard_a:
      return heard_key(place);
    case Say::transfer_starts:
    case Say::transfer_done:
    case Say::transfer_failed:
      return file_name(say, place);
    case Say::command_succeeded:
    case Say::command_failed:
      return Fact{say, true, std::string{trimmed(rest)}, 0};
    default:
      return Fact{say, true, {}, 0};
  }
}

/// Where the text ends that a fact of free layout was read from; 0 when a join anywhere in it does no harm, because the
/// layout was checked or because it is made of fixed words.
std::size_t free_text_ends(Say say, const Place& place, std::size_t used) {
  switch (say) {
    case Say::because:
    case Say::mission:
    case Say::waypoint:
    case Say::until_diving:
    case Say::extending:
    case Say::devices:
    case Say::gliderdos:
    case Say::gliderlab:
      return place.end + used;
    case Say::vehicle:
    case Say::at_surface:
    case Say::completed:
    case Say::aborts:
    case Say::heard_a:
    case Say::transfer_starts:
    case Say::transfer_done:
    case Say::transfer_failed:
    case Say::command_succeeded:
    case Say::command_failed:
      return place.line.size();
    default:
      return 0;
  }
}

/// The name of `Glider X at surface.` stands before its label.
std::size_t free_text_begins(Say say, const Place& place) {
  if (say != Say::at_surface) return place.end;
  const auto glider = place.line.rfind("Glider ", place.begin);
  return glider == std::string_view::npos ? 0 : glider;
}

bool may_have_lost_bytes(Say say, const Place& place, std::size_t used) {
  return place.joined_at != Line::kWhole && place.joined_at >= free_text_begins(say, place) &&
         place.joined_at < free_text_ends(say, place, used);
}

}  // namespace

FactFinder::Built FactFinder::build(const DialogWords& words) {
  Built built;
  const auto add = [&](Say say, std::string_view phrase) {
    built.says.push_back(say);
    built.phrases.push_back(phrase);
  };
  for (const auto& [say, phrase] : kPhrases) add(say, phrase);
  for (const auto& phrase : words.reread) add(Say::reread, phrase);
  for (const auto& phrase : words.transfer_starts) add(Say::transfer_starts, phrase);
  for (const auto& phrase : words.transfer_done) add(Say::transfer_done, phrase);
  for (const auto& phrase : words.transfer_failed) add(Say::transfer_failed, phrase);
  for (const auto& phrase : words.command_succeeded) add(Say::command_succeeded, phrase);
  for (const auto& phrase : words.command_failed) add(Say::command_failed, phrase);
  built.nothing_to_send = words.nothing_to_send;
  return built;
}

FactFinder::FactFinder(const DialogWords& words) : FactFinder{build(words)} {}

bool FactFinder::nothing_to_send(std::string_view text) const {
  return std::any_of(nothing_to_send_.begin(), nothing_to_send_.end(), [&](const std::string& phrase) {
    return phrase.size() > 1 && text.find(phrase) != std::string_view::npos;
  });
}

void FactFinder::find(std::string_view text, std::size_t joined_at, std::vector<Fact>& facts) const {
  std::size_t understood = 0;
  phrases_.find(text, [&](const Phrases::Hit& hit) {
    if (hit.begin < understood) return;
    std::size_t used = 0;
    const Place place{text, hit.begin, hit.end, joined_at};
    auto found = read(says_[hit.phrase], place, used);
    if (!found) return;
    if (found->whole && may_have_lost_bytes(found->say, place, used)) *found = Fact{found->say, false, {}, 0};
    understood = hit.end + used;
    found->end = understood;
    facts.push_back(std::move(*found));
  });
}

}  // namespace glidehelm::protocol
