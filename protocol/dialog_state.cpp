#include <algorithm>
#include <utility>

#include "protocol/dialog.hpp"

// What a reader remembers between lines: the connection, the block that is open, the dive, the prompt.
namespace glidehelm::protocol {

namespace {

constexpr std::size_t kMostSensors = 512;

/// The place of a location line in its block.
std::optional<Location>& slot_of(SurfaceBlock& block, Say say) {
  switch (say) {
    case Say::dr:
      return block.dead_reckoned;
    case Say::too_far:
      return block.too_far;
    case Say::invalid:
      return block.invalid;
    default:
      return block.gps;
  }
}

}  // namespace

void DialogReader::carrier(const Fact& fact) {
  if (std::holds_alternative<CarrierLost>(fact.value)) {
    finish_block();
    if (greeting_ != Greeting::carrier) greeting_ = Greeting::none;
    return;
  }
  const auto now = fact.say == Say::iridium ? Greeting::console : Greeting::carrier;
  // The carrier and the console behind it are one connection; so are carriers on which nothing was said.
  if (greeting_ != Greeting::carrier) open_connection();
  greeting_ = now;
}

void DialogReader::open_connection() {
  finish_block();
  ++counts_.connections;
  name_.clear();
  water_ = WaterState::unknown;
  console_ = Console::unknown;
  prompt_ = {};
  resumed_ = ended_ = false;
  events_.emplace_back(ConnectionOpened{});
  begin_block(false);
}

void DialogReader::hear_name(const std::string& name) {
  greeting_ = Greeting::none;
  if (name_ == name) return;
  name_ = name;
  events_.emplace_back(NameHeard{name});
}

void DialogReader::begin_block(bool at_surface) {
  finish_block();
  open_ = true;
  changed_ = false;
  block_ = {};
  block_.at_surface = at_surface;
  block_.console = console_;
}

/// A line that stands above the locations of its block: when the block has those already, it is the next block's.
void DialogReader::begin_block_after_time() {
  if (!open_ || has_location() || block_.gps_damaged || !block_.sensors.empty()) begin_block(false);
}

bool DialogReader::has_location() const {
  return block_.dead_reckoned || block_.too_far || block_.invalid || block_.gps;
}

void DialogReader::finish_block() {
  if (open_ && changed_) give_block(std::move(block_));
  open_ = false;
}

void DialogReader::give_block(SurfaceBlock block) {
  changed_ = false;
  if (!block.gps && !block.gps_damaged) return;
  if (block.vehicle.empty()) block.vehicle = name_;
  block.water = water_;
  events_.emplace_back(BlockRead{std::move(block)});
}

void DialogReader::locate(Say say, Location* location) {
  auto& slot = slot_of(block_, say);
  const bool gps = say == Say::gps;
  if (!open_ || slot || !block_.sensors.empty() || (gps && block_.gps_damaged)) begin_block(false);
  changed_ = true;
  if (gps) {
    block_.line = line_;
    block_.heard = heard_;
    block_.gps_damaged = location == nullptr;
    if (location != nullptr) ++counts_.gps_lines;
  }
  if (location != nullptr) slot = std::move(*location);
}

void DialogReader::read_sensor(SensorReading reading) {
  ++counts_.sensor_lines;
  if (!open_) begin_block(false);
  changed_ = true;
  if (block_.sensors.size() < kMostSensors) block_.sensors.push_back(std::move(reading));
}

void DialogReader::window(double seconds) {
  if (open_) {
    block_.until_diving_s = seconds + between(block_.heard, heard_).count();
    changed_ = true;
    finish_block();
  }
  events_.emplace_back(WindowHeard{static_cast<int>(seconds)});
}

void DialogReader::resume(MissionResumed::By by) {
  finish_block();
  water_ = WaterState::unknown;
  if (!std::exchange(resumed_, true)) events_.emplace_back(MissionResumed{by});
}

void DialogReader::end_mission(std::string cause) {
  finish_block();
  console_ = Console::unknown;
  if (std::exchange(ended_, true)) return;
  events_.emplace_back(MissionEnded{cause});
  if (cause.starts_with("MS_ABORT")) events_.emplace_back(AbortSeen{std::move(cause)});
}

void DialogReader::prompt(const Fact& fact) {
  if (fact.say == Say::scidos) return;
  console_ = fact.say == Say::gliderdos ? Console::gliderdos : Console::gliderlab;
  block_.console = console_;
  changed_ = open_;
  const auto& seen = std::get<Prompt>(fact.value);
  const PromptSeen now{console_, seen.state, seen.code};
  if (now == prompt_) return;
  prompt_ = now;
  events_.emplace_back(now);
  if (now.console == Console::gliderdos && now.state == 'A')
    events_.emplace_back(AbortSeen{"GliderDos A " + std::to_string(now.code)});
}

}  // namespace glidehelm::protocol
