#include "protocol/dialog.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "protocol/latlon.hpp"

namespace glidehelm::protocol {

namespace {

constexpr std::size_t kMostSensors = 256;
constexpr double kNeverUpdated = 1e8;  // the age of a value never updated is 1e+308

/// Reads a text from left to right; every step says whether it matched.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_{text} {}
  bool text(std::string_view wanted) {
    if (rest_.substr(0, wanted.size()) != wanted) return false;
    rest_.remove_prefix(wanted.size());
    return true;
  }
  void blanks() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) rest_.remove_prefix(1);
  }
  /// A number of the dialog (R6): [-]digits[.digits][e[±]digits], as text.
  bool number(std::string_view& out) {
    std::size_t n = 0;
    const auto digits = [&] {
      const std::size_t from = n;
      while (n < rest_.size() && rest_[n] >= '0' && rest_[n] <= '9') ++n;
      return n > from;
    };
    if (n < rest_.size() && (rest_[n] == '-' || rest_[n] == '+')) ++n;
    if (!digits()) return false;
    if (n < rest_.size() && rest_[n] == '.') {
      ++n;
      if (!digits()) return false;
    }
    if (n < rest_.size() && (rest_[n] == 'e' || rest_[n] == 'E')) {
      const std::size_t mantissa = n++;
      if (n < rest_.size() && (rest_[n] == '-' || rest_[n] == '+')) ++n;
      if (!digits()) n = mantissa;
    }
    out = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return true;
  }
  bool number(double& out) {
    std::string_view digits;
    if (!number(digits)) return false;
    const auto value = number_from(digits);
    if (!value) return false;
    out = *value;
    return true;
  }
  bool integer(int& out) {
    std::string_view digits;
    if (!number(digits)) return false;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out);
    return error == std::errc{} && end == digits.data() + digits.size();
  }
  bool letter(char& out) {
    if (rest_.empty()) return false;
    out = rest_.front();
    rest_.remove_prefix(1);
    return true;
  }
  /// Everything up to `end`, which is passed over.
  bool until(std::string_view end, std::string_view& out) {
    const auto at = rest_.find(end);
    if (at == std::string_view::npos) return false;
    out = rest_.substr(0, at);
    rest_.remove_prefix(at + end.size());
    return true;
  }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

/// The text behind `label`, wherever it stands (R5: searched, not anchored).
std::optional<Cursor> behind(std::string_view line, std::string_view label) {
  const auto at = line.find(label);
  if (at == std::string_view::npos) return std::nullopt;
  return Cursor{line.substr(at + label.size())};
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Age in seconds before ` secs ago`; 1e+308 is read as "never".
bool age(Cursor& c, double& out) {
  c.blanks();
  std::string_view digits;
  if (!c.number(digits) || !c.text(" secs ago")) return false;
  out = number_from(digits).value_or(1e308);
  return true;
}

/// `Thu Nov  9 10:06:56 2023`, UTC, month names by table.
std::optional<GliderTime> glider_time(Cursor& c) {
  constexpr std::array<std::string_view, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const auto text = c.rest();
  if (text.size() < 24) return std::nullopt;
  int month = 0;
  for (std::size_t i = 0; i < kMonths.size(); ++i)
    if (text.substr(4, 3) == kMonths[i]) month = static_cast<int>(i) + 1;
  Cursor rest{text.substr(7)};
  int day{}, hour{}, minute{}, second{}, year{};
  rest.blanks();
  const bool matched = month > 0 && rest.integer(day) && rest.text(" ") && rest.integer(hour) && rest.text(":") &&
                       rest.integer(minute) && rest.text(":") && rest.integer(second) && rest.text(" ") &&
                       rest.integer(year);
  if (!matched) return std::nullopt;
  const auto instant = utc_from_civil(year, month, day, hour, minute, second);
  if (!instant) return std::nullopt;
  c = rest;
  return GliderTime{std::chrono::floor<std::chrono::seconds>(instant->time_since_epoch())};
}

/// A label that names another location line must not be read as this one: no letter may stand before it.
std::optional<Cursor> location_behind(std::string_view line, std::string_view label) {
  for (std::size_t from = 0;;) {
    const auto at = line.find(label, from);
    if (at == std::string_view::npos) return std::nullopt;
    if (at == 0 || !is_letter(line[at - 1])) return Cursor{line.substr(at + label.size())};
    from = at + 1;
  }
}

std::optional<LocationLine> location(Cursor c) {
  LocationLine l;
  std::string_view lat, lon;
  c.blanks();
  if (!c.number(lat) || !c.text(" ") || !c.letter(l.lat_letter)) return std::nullopt;
  c.blanks();
  if (!c.number(lon) || !c.text(" ") || !c.letter(l.lon_letter) || !c.text(" measured")) return std::nullopt;
  if (!age(c, l.age_s)) return std::nullopt;
  l.lat = lat;
  l.lon = lon;
  return l;
}

}  // namespace

// ---- the stream -----------------------------------------------------------------------------------------------------

std::vector<DialogEvent> DialogReader::append(std::string_view bytes, Instant heard) {
  splitter_.append(bytes, {[&](std::string_view line) { take_line(line, heard); },
                           [&](std::string_view block) {
                             ++counts_.dockserver_blocks;
                             out_.emplace_back(DockserverBlock{std::string{block}});
                           }});
  counts_.discarded_bytes = splitter_.discarded();
  return std::exchange(out_, {});
}

std::vector<DialogEvent> DialogReader::flush_idle(Instant) {
  if (open_ && !given_ && block_.gps) give_block();
  return std::exchange(out_, {});
}

std::vector<DialogEvent> DialogReader::end(Instant heard) {
  splitter_.end({[&](std::string_view line) { take_line(line, heard); },
                 [&](std::string_view block) {
                   ++counts_.dockserver_blocks;
                   out_.emplace_back(DockserverBlock{std::string{block}});
                 }});
  counts_.discarded_bytes = splitter_.discarded();
  auto events = flush_idle(heard);
  open_ = console_ = shell_ = false;
  first_ = true;
  return events;
}

void DialogReader::begin(SurfaceBlock::Kind kind, Instant heard) {
  if (open_ && !given_ && block_.gps) give_block();
  block_ = {};
  block_.kind = kind;
  block_.first_line = line_;
  block_.heard = heard;
  open_ = true;
  given_ = false;
}

void DialogReader::give_block() {
  given_ = true;
  out_.emplace_back(BlockRead{block_});
}

void DialogReader::take_line(std::string_view line, Instant heard) {
  ++line_;
  if (line.find("Carrier Detect found") != std::string_view::npos) {
    if (open_ && !given_ && block_.gps) give_block();
    open_ = false;
    console_ = false;
    first_ = true;
  }
  if (line.find("Iridium console active and ready") != std::string_view::npos) {
    ++counts_.connections;
    out_.emplace_back(ConnectionOpened{});
    console_ = true;
    shell_ = false;
    begin(SurfaceBlock::Kind::connection, heard);
    return;
  }
  if (line.find("GliderDos") != std::string_view::npos || line.find("GliderLAB") != std::string_view::npos)
    shell_ = true;
  if (take_fact(line, heard)) return;
  // The first line that is no fact ends the facts of a connection block.
  if (open_ && !given_ && block_.kind != SurfaceBlock::Kind::at_surface && block_.gps) give_block();
  take_event(line);
}

bool DialogReader::take_fact(std::string_view line, Instant heard) {
  if (auto name = behind(line, "Vehicle Name:")) {
    name->blanks();
    const std::string text{trimmed(name->rest())};
    const bool named_block = open_ && block_.vehicle.empty() && !block_.curr_time;
    if (!named_block) begin(first_ && !shell_ ? SurfaceBlock::Kind::connection : SurfaceBlock::Kind::other, heard);
    first_ = false;
    block_.vehicle = text;
    out_.emplace_back(NameHeard{text});
    return true;
  }
  if (const auto at = line.find(" at surface."); at != std::string_view::npos && line.find("Glider ") < at) {
    ++counts_.at_surface_blocks;
    shell_ = first_ = false;
    begin(SurfaceBlock::Kind::at_surface, heard);
    return true;
  }
  if (auto time = behind(line, "Curr Time: ")) {
    const auto read = glider_time(*time);
    if (!read) {
      ++counts_.damaged_lines;
      return true;
    }
    if (open_ && block_.curr_time && block_.gps)
      begin(SurfaceBlock::Kind::other, heard);  // printed again without a header
    if (!open_) begin(SurfaceBlock::Kind::other, heard);
    block_.curr_time = read;
    int mission_time{};
    time->blanks();
    if (time->text("MT:")) {
      time->blanks();
      if (time->integer(mission_time)) block_.mission_time_s = mission_time;
    }
    return true;
  }
  if (take_location(line, heard) || take_sensor(line)) return true;
  if (!open_) return false;
  if (auto because = behind(line, "Because:")) {
    std::string_view text, behavior;
    double start_when{};
    if (because->until(" [behavior ", text) && because->until(" start_when = ", behavior) &&
        because->number(start_when) && because->text("]"))
      block_.because = model::SurfaceReason{std::string{text}, std::string{behavior}, start_when};
    else
      ++counts_.damaged_lines;
    return true;
  }
  if (auto mission = behind(line, "MissionName:")) {
    std::string_view name, number, segment;
    if (mission->until(" MissionNum:", name) && mission->until(" (", number) && mission->until(")", segment)) {
      block_.mission = lower(trimmed(name));
      block_.mission_number = number;
      block_.segment = segment;
    } else {
      ++counts_.damaged_lines;
    }
    return true;
  }
  if (auto waypoint = behind(line, "Waypoint: (")) {
    WaypointLine w;
    std::string_view lat, lon;
    if (waypoint->number(lat) && waypoint->text(",") && waypoint->number(lon) && waypoint->text(") Range: ") &&
        waypoint->number(w.range_m) && waypoint->text("m, Bearing: ") && waypoint->number(w.bearing_deg) &&
        waypoint->text("deg")) {
      w.lat = lat;
      w.lon = lon;
      block_.waypoint = w;
    } else {
      ++counts_.damaged_lines;
    }
    return true;
  }
  if (line.find("Water Velocity Calculations COMPLETE") != std::string_view::npos) {
    block_.water_complete = true;
    return true;
  }
  if (auto window = behind(line, "Time until diving is:")) {
    int seconds{};
    window->blanks();
    if (!window->integer(seconds) || !window->text(" secs") || seconds < 0) {
      ++counts_.damaged_lines;
      return true;
    }
    if (!given_ && block_.gps) {
      block_.until_diving_s = seconds;
      give_block();
    } else {
      out_.emplace_back(WindowHeard{seconds});
    }
    return true;
  }
  // Lines of an at-surface block that carry nothing for us, and blank lines, do not end it.
  return block_.kind == SurfaceBlock::Kind::at_surface && trimmed(line).empty();
}

bool DialogReader::take_location(std::string_view line, Instant heard) {
  struct Label {
    std::string_view text;
    std::optional<LocationLine> SurfaceBlock::*field;
  };
  constexpr std::array<Label, 4> kLabels{
      Label{"GPS Location:", &SurfaceBlock::gps}, Label{"DR  Location:", &SurfaceBlock::dead_reckoned},
      Label{"GPS TooFar:", &SurfaceBlock::too_far}, Label{"GPS Invalid :", &SurfaceBlock::invalid}};
  for (const auto& label : kLabels) {
    const auto found = location_behind(line, label.text);
    if (!found) continue;
    auto read = location(*found);
    if (!read) {
      ++counts_.damaged_lines;
      return true;
    }
    if (!open_) begin(SurfaceBlock::Kind::other, heard);
    read->line = line_;
    block_.*label.field = *read;
    if (label.field == &SurfaceBlock::gps) {
      block_.heard = heard;
      const auto lat = number_from(read->lat);
      const bool sentinel = read->age_s > kNeverUpdated || !lat || std::abs(*lat) >= 9e6;
      ++(sentinel ? counts_.gps_sentinels : counts_.gps_lines);
    }
    return true;
  }
  return false;
}

bool DialogReader::take_sensor(std::string_view line) {
  auto c = behind(line, "sensor:");
  if (!c) return false;
  SensorLine sensor;
  std::string_view name, unit, digits;
  if (!c->until("(", name) || !c->until(")=", unit) || name.size() > 64 || !c->number(digits) ||
      !age(*c, sensor.age_s)) {
    ++counts_.damaged_lines;
    return true;
  }
  ++counts_.sensor_lines;
  const auto value = number_from(digits);
  if (!value || !open_) return true;
  sensor.value = *value;
  sensor.unit = unit;
  if (block_.sensors.size() < kMostSensors) block_.sensors[std::string{name}] = sensor;
  return true;
}

bool DialogReader::take_event(std::string_view line) {
  const auto has = [&](std::string_view text) { return line.find(text) != std::string_view::npos; };
  if (has("RESUMING MISSION") || has("TIMED OUT WAITING FOR A CHARACTER")) {
    out_.emplace_back(MissionResumed{});
  } else if (has("terminating the mission") || has("Mission completed:")) {
    out_.emplace_back(MissionEnded{});
  } else if (has("Extending surface time by 5 minutes")) {
    out_.emplace_back(WindowExtended{});
  } else if (has("MAFILES will be re-read") || has("MAFILES reread.")) {
    out_.emplace_back(MafilesReread{});
  } else if (auto started = behind(line, "Starting zModem transfer of ")) {
    std::string_view file;
    if (started->until(" ", file)) out_.emplace_back(TransferStarted{std::string{file}});
  } else if (auto done = behind(line, "zModem transfer DONE for file ")) {
    out_.emplace_back(TransferDone{std::string{trimmed(done->rest())}});
  } else {
    return false;
  }
  return true;
}

// ---- one fix ---------------------------------------------------------------------------------------------------------

namespace {

/// A location line's signed text: letters are always N and E in practice, the sign tells the hemisphere. S and W are taken with an
/// unsigned number only (S3).
std::optional<std::string> signed_text(const std::string& digits, char letter, char positive, char negative) {
  if (letter == positive) return digits;
  if (letter == negative && digits.front() != '-') return "-" + digits;
  return std::nullopt;
}

std::optional<double> fresh(const SurfaceBlock& block, const char* name) {
  const auto found = block.sensors.find(name);
  if (found == block.sensors.end() || !(found->second.age_s <= kNeverUpdated)) return std::nullopt;
  return found->second.value;
}

/// Configured constants are meaningful whatever their age says (slocum.md 1.2).
std::optional<double> any_age(const SurfaceBlock& block, const char* name) {
  const auto found = block.sensors.find(name);
  if (found == block.sensors.end()) return std::nullopt;
  return found->second.value;
}

std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

void add_beside(model::Surfacing& s, const SurfaceBlock& block) {
  s.at_surface = block.kind == SurfaceBlock::Kind::at_surface && !block.mission.empty();
  s.mission = block.mission;
  s.segment = block.segment;
  s.because = block.because;
  if (block.until_diving_s) s.until_diving = Seconds{static_cast<double>(*block.until_diving_s)};
  s.water_is_final = block.water_complete;
  const auto vx = fresh(block, "m_water_vx"), vy = fresh(block, "m_water_vy");
  if (vx && vy) s.water = model::LocalVelocity{MetresPerSecond{*vx}, MetresPerSecond{*vy}};
  if (block.waypoint)
    if (const auto at = point_from_ddmm(block.waypoint->lat, block.waypoint->lon))
      s.aim = model::AimLine{*at, Metres{block.waypoint->range_m}, block.waypoint->bearing_deg};
  if (const auto speed = fresh(block, "m_avg_speed"); speed && *speed > 0.05 && *speed < 2.0)
    s.believed_speed = MetresPerSecond{*speed};
  if (const auto correction = any_age(block, "u_use_current_correction");
      correction && *correction >= 0 && *correction <= 2)
    s.current_correction = *correction >= 1 ? 1 : 0;
  if (const auto variation = any_age(block, "m_gps_mag_var"); variation && std::abs(*variation) < 1.0)
    s.magnetic_variation = Radians{*variation};
  for (const auto& [name, sensor] : block.sensors)
    if (std::abs(sensor.value) < 9e6) s.sensors[name] = sensor.value;
}

}  // namespace

Expected<model::Surfacing, model::Refusal> accept_fix(const SurfaceBlock& block, const std::string& glider,
                                                      const FixLimits& limits) {
  const auto refuse = [&](std::string rule, std::string reason) {
    model::Refusal refusal{std::move(rule), std::move(reason), lower(glider), block.heard, {}, {}};
    if (block.gps) {
      refusal.lat_ddmm = block.gps->lat;
      refusal.lon_ddmm = block.gps->lon;
    }
    return unexpected(refusal);
  };
  if (glider.empty()) return refuse("S2", "no Vehicle Name was heard on this connection");
  if (!block.gps) return refuse("S3", "the block has no complete GPS Location line");
  const auto& gps = *block.gps;
  if (block.kind == SurfaceBlock::Kind::other)
    return refuse("S8", "a position report outside of a running mission (`where`, GliderDos) is no surfacing");
  const auto lat_text = signed_text(gps.lat, gps.lat_letter, 'N', 'S');
  const auto lon_text = signed_text(gps.lon, gps.lon_letter, 'E', 'W');
  if (!lat_text || !lon_text) return refuse("S3", "the letters of the GPS line are not N and E");
  const auto at = point_from_ddmm(*lat_text, *lon_text);
  if (!at) return refuse("S3", at.error().message);
  if (at->lat.degrees() == 0 && at->lon.degrees() == 0)
    return refuse("S3", "0/0 is the receiver's empty value, not a position");
  if (gps.age_s > kNeverUpdated) return refuse("S3", "the receiver never had a fix (age 1e+308)");
  if (gps.age_s < 0 || gps.age_s > limits.oldest_s)
    return refuse(
        "S3", "the fix is " + number_text(gps.age_s) + " s old; allowed are " + number_text(limits.oldest_s) + " s");
  if (!block.curr_time) return refuse("S3", "no Curr Time in the same block: the fix has no time");
  model::Surfacing s;
  s.glider = lower(glider);
  s.heard = block.heard;
  s.fix = *at;
  s.fix_age = Seconds{gps.age_s};
  s.fix_taken = after(block.heard, -s.fix_age);
  s.curr_time = *block.curr_time;
  s.lat_ddmm = gps.lat;
  s.lon_ddmm = gps.lon;
  add_beside(s, block);
  return s;
}

}  // namespace glidehelm::protocol
