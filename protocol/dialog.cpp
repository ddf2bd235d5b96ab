#include "protocol/dialog.hpp"

#include <algorithm>
#include <utility>

#include "core/base/text.hpp"

namespace glidehelm::protocol {

namespace {

constexpr std::size_t kMostDamaged = 8;

/// All readers of the usual words share one index of them.
std::shared_ptr<const FactFinder> usual_finder() {
  static const auto finder = std::make_shared<const FactFinder>(DialogWords{});
  return finder;
}

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t") == std::string_view::npos; }

template <class T>
T& as(Fact& fact) {
  return std::get<T>(fact.value);
}

bool is_location(Say say) { return say == Say::dr || say == Say::too_far || say == Say::invalid || say == Say::gps; }

/// Numbers that steer: a control character in their line may be what noise made of a digit.
bool is_measured(Say say) {
  return is_location(say) || say == Say::curr_time || say == Say::sensor || say == Say::until_diving;
}

bool is_prompt(Say say) { return say == Say::gliderdos || say == Say::gliderlab || say == Say::scidos; }

}  // namespace

const SensorReading* SurfaceBlock::sensor(std::string_view name) const {
  const auto found =
      std::find_if(sensors.rbegin(), sensors.rend(), [&](const SensorReading& s) { return s.name == name; });
  return found == sensors.rend() ? nullptr : &*found;
}

DialogReader::DialogReader() : finder_{usual_finder()} {}
DialogReader::DialogReader(const DialogWords& words)
    : finder_{words == DialogWords{} ? usual_finder() : std::make_shared<const FactFinder>(words)} {}

std::vector<DialogEvent> DialogReader::append(std::string_view bytes, Instant heard) {
  heard_ = heard;
  splitter_.append(bytes, *this);
  return std::exchange(events_, {});
}

std::vector<DialogEvent> DialogReader::flush_idle(Instant heard) {
  heard_ = heard;
  const std::string text{splitter_.unfinished()};
  facts_.clear();
  finder_->find(text, Line::kWhole, facts_);
  if (!facts_.empty() && is_prompt(facts_.back().say) && is_blank(std::string_view{text}.substr(facts_.back().end))) {
    const std::size_t end = facts_.back().end;
    Line line;
    line.text = std::string_view{text}.substr(0, end);
    line.number = line_;
    take_line(line);
    splitter_.forget(end);
  }
  if (open_ && changed_) give_block(block_);
  return std::exchange(events_, {});
}

std::vector<DialogEvent> DialogReader::end(Instant heard) {
  heard_ = heard;
  splitter_.end(*this);
  finish_block();
  last_text_.clear();
  ends_later_ = false;
  greeting_ = Greeting::none;
  name_.clear();
  water_ = WaterState::unknown;
  console_ = Console::unknown;
  prompt_ = {};
  resumed_ = ended_ = false;
  return std::exchange(events_, {});
}

DialogCounts DialogReader::counts() const {
  auto counts = counts_;
  counts.long_lines = splitter_.long_lines();
  counts.discarded_bytes = splitter_.discarded_bytes();
  return counts;
}

void DialogReader::take_block(DockserverBlock block) {
  ++counts_.dockserver_blocks;
  if (!block.complete) ++counts_.lost_blocks;
  const bool nothing = block.complete && finder_->nothing_to_send(block.text);
  auto command = nothing ? block.command : std::string{};
  events_.emplace_back(std::move(block));
  if (nothing) events_.emplace_back(NothingToSend{std::move(command)});
}

void DialogReader::take_line(const Line& line) {
  line_ = line.number;
  facts_.clear();
  finder_->find(line.text, line.joined_at, facts_);
  if (line.altered)
    for (auto& fact : facts_)
      if (is_measured(fact.say)) fact.whole = false;
  if (line.cut) {
    // Only a prompt is complete without a line end; of anything else that was cut nothing is used.
    const bool said_nothing = facts_.empty();
    std::erase_if(facts_, [](const Fact& f) { return !is_prompt(f.say); });
    // What stands before a transfer may be a stray character; what the connection's end cut was a line.
    const bool stray = line.before_noise && said_nothing;
    if (facts_.empty() && !stray && !is_blank(line.text)) note_damage(line.text);
    static_cast<void>(apply_all());
    last_text_.clear();
    return;
  }
  if (line.after_block && join_with_last(line)) return;
  if (ends_later_) finish_connection_block();
  const bool any_whole = std::any_of(facts_.begin(), facts_.end(), [](const Fact& f) { return f.whole; });
  // The rest of a line that a dockserver block tore stands inside the block of the line.
  const bool rest = line.after_block && facts_.empty() && last_damaged_ && !last_text_.empty();
  const bool ends = !rest && ends_connection_block(line.text);
  const bool damaged = apply_all();
  if (damaged) note_damage(line.text);
  // A line that says nothing may be the first half of a torn location: the next line tells.
  if (ends && facts_.empty())
    ends_later_ = true;
  else if (ends)
    finish_connection_block();
  if (any_whole || is_blank(line.text)) {
    last_text_.clear();
  } else {
    last_text_ = line.text;
    last_damaged_ = damaged;
  }
}

/// A block that the dockserver printed between two lines may have torn one line in two (slocum.md R3). The halves are
/// put together when neither says anything alone and the whole says something completely.
bool DialogReader::join_with_last(const Line& line) {
  const bool alone = std::any_of(facts_.begin(), facts_.end(), [](const Fact& f) { return f.whole; });
  if (alone || last_text_.empty()) return false;
  const std::string joined = last_text_ + std::string{line.text};
  std::vector<Fact> facts;
  finder_->find(joined, last_text_.size(), facts);
  if (facts.empty() || std::any_of(facts.begin(), facts.end(), [](const Fact& f) { return !f.whole; })) return false;
  if (last_damaged_) {
    --counts_.damaged_lines;
    if (open_ && !block_.damaged.empty() && block_.damaged.back() == last_text_) block_.damaged.pop_back();
    block_.gps_damaged = false;
  }
  ends_later_ = false;
  facts_ = std::move(facts);
  static_cast<void>(apply_all());
  last_text_.clear();
  return true;
}

/// True when one of the facts was not whole.
bool DialogReader::apply_all() {
  bool damaged = false;
  for (auto& fact : facts_) {
    damaged = damaged || !fact.whole;
    fact.whole ? apply(fact) : apply_damaged(fact.say);
  }
  return damaged;
}

void DialogReader::note_damage(std::string_view text) {
  ++counts_.damaged_lines;
  if (open_ && block_.damaged.size() < kMostDamaged) block_.damaged.emplace_back(text);
}

/// A connection block ends with the first line that is no part of it; noise and blank lines may stand inside.
bool DialogReader::ends_connection_block(std::string_view text) const {
  if (is_blank(text)) return false;
  return std::none_of(facts_.begin(), facts_.end(), [](const Fact& f) {
    return is_location(f.say) || f.say == Say::sensor || f.say == Say::noise || f.say == Say::oddity ||
           f.say == Say::curr_time || f.say == Say::vehicle || f.say == Say::iridium;
  });
}

void DialogReader::finish_connection_block() {
  ends_later_ = false;
  if (open_ && !block_.at_surface && has_location()) finish_block();
}

void DialogReader::apply(Fact& fact) {
  switch (fact.say) {
    case Say::connection_event:
    case Say::iridium:
      return carrier(fact);
    case Say::vehicle:
      begin_block_after_time();
      block_.vehicle = as<std::string>(fact);
      return hear_name(block_.vehicle);
    case Say::curr_time:
      begin_block_after_time();
      block_.curr_time = as<CurrTime>(fact).time;
      block_.mission_time_s = as<CurrTime>(fact).mission_time_s;
      changed_ = true;
      return;
    case Say::dr:
    case Say::too_far:
    case Say::invalid:
    case Say::gps:
      return locate(fact.say, &as<Location>(fact));
    case Say::sensor:
      return read_sensor(std::move(as<SensorReading>(fact)));
    case Say::at_surface:
      ++counts_.at_surface_blocks;
      begin_block(true);
      resumed_ = ended_ = false;
      console_ = block_.console = Console::mission;
      block_.vehicle = as<std::string>(fact);
      return hear_name(block_.vehicle);
    case Say::because:
      begin_block_after_time();
      block_.at_surface = true;
      block_.because = std::move(as<BecauseLine>(fact));
      console_ = block_.console = Console::mission;
      break;
    case Say::mission:
      begin_block_after_time();
      block_.mission = std::move(as<MissionLine>(fact));
      break;
    case Say::water:
      water_ = as<WaterState>(fact);
      break;
    case Say::waypoint:
      block_.waypoint = std::move(as<WaypointLine>(fact));
      break;
    case Say::devices:
      block_.devices = as<DevicesLine>(fact);
      break;
    case Say::aborts:
      block_.aborts = static_cast<int>(as<double>(fact));
      break;
    case Say::until_diving:
      return window(as<double>(fact));
    case Say::extending:
      events_.emplace_back(WindowExtended{Seconds{as<double>(fact)}});
      return;
    case Say::typed_resume:
    case Say::resuming:
      return resume(MissionResumed::By::key);
    case Say::timed_out:
      return resume(MissionResumed::By::time);
    case Say::console_off:
      return resume(MissionResumed::By::console_off);
    case Say::completed:
      return end_mission(std::move(as<std::string>(fact)));
    case Say::end_of_mission:
      return end_mission({});
    case Say::starting:
      ended_ = false;
      console_ = Console::unknown;
      return;
    case Say::gliderdos:
    case Say::gliderlab:
    case Say::scidos:
      return prompt(fact);
    case Say::heard_a:
      events_.emplace_back(KeyHeard{std::move(as<std::string>(fact))});
      return;
    case Say::reread:
      events_.emplace_back(MafilesReread{});
      return;
    case Say::transfer_starts:
      events_.emplace_back(TransferStarted{std::move(as<std::string>(fact))});
      return;
    case Say::transfer_done:
      events_.emplace_back(TransferDone{std::move(as<std::string>(fact))});
      return;
    case Say::transfer_failed:
      events_.emplace_back(TransferFailed{std::move(as<std::string>(fact))});
      return;
    case Say::command_succeeded:
    case Say::command_failed:
      events_.emplace_back(CommandEnded{std::move(as<std::string>(fact)), fact.say == Say::command_succeeded});
      return;
    case Say::noise:
    case Say::oddity:
    case Say::login:
      return;
  }
  changed_ = open_;
}

void DialogReader::apply_damaged(Say say) {
  if (is_location(say)) return locate(say, nullptr);
  // A block whose time or name is garbled is another block all the same: nothing binds to the older time.
  if (say == Say::curr_time || say == Say::vehicle) begin_block_after_time();
  if (say == Say::at_surface) begin_block(false);
  if (say == Say::curr_time) {
    block_.curr_time.reset();
    block_.mission_time_s.reset();
  }
}

}  // namespace glidehelm::protocol
