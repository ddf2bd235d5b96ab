#include <fmt/format.h>

#include "core/base/text.hpp"
#include "daemon/session.hpp"
#include "daemon/world/failpoint.hpp"

// The line of one glider, and what its dialog says.
namespace glidehelm::daemon {

namespace {
constexpr Seconds kIdle{2};
}  // namespace

void Session::opened(std::uint64_t, std::string_view peer, bool replaced) {
  reader_ = protocol::DialogReader{entry_.dialog};
  told_ = {};
  name_.clear();
  connected_ = true;
  emitter_->set_transfer_open(false);  // a transfer does not outlive its call
  desk_.log.info(entry_.name,
                 fmt::format("line: {} connected{}", peer, replaced ? ", replacing the older connection" : ""));
}

void Session::received(std::string_view bytes) {
  world::failpoint("first_byte");
  bytes_ += bytes.size();
  for (const auto& event : reader_.append(bytes, desk_.world.clock.utc())) {
    if (!connected_) break;  // a second name closed the connection
    hear(event);
  }
  flush_when_idle();
  desk_.handled(entry_.name, bytes_);
}

/// A prompt has no line end, and a cut dialog no last line: after two silent seconds what is whole is used.
void Session::flush_when_idle() {
  desk_.world.clock.cancel(idle_timer_);
  if (!connected_) return;
  idle_timer_ =
      desk_.world.clock.call_at(desk_.world.clock.tick() + std::chrono::duration_cast<Tick::duration>(kIdle), [this] {
        for (const auto& event : reader_.flush_idle(desk_.world.clock.utc())) hear(event);
        desk_.changed();
      });
}

void Session::closed(std::string_view reason) {
  if (!connected_) return;
  for (const auto& event : reader_.end(desk_.world.clock.utc())) hear(event);
  connected_ = false;
  desk_.world.clock.cancel(idle_timer_);
  tell_unused();
  desk_.log.info(entry_.name, fmt::format("line: closed, {}", reason));
}

/// What the line brought since this was said last and nothing was made of, by the rule that forbids it.
void Session::tell_unused() {
  const auto counts = reader_.counts();
  std::string text;
  const auto add = [&](std::uint64_t now, std::uint64_t before, const char* what) {
    // Damage may be taken back: a torn line whose other half came later was none.
    if (now > before) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", now - before, what);
  };
  add(counts.damaged_lines, told_.damaged_lines, "damaged lines (R7)");
  add(counts.long_lines, told_.long_lines, "lines beyond 4 KiB (R4)");
  add(counts.lost_blocks, told_.lost_blocks, "dockserver blocks without an end (R3)");
  if (!text.empty() && counts.discarded_bytes > told_.discarded_bytes)
    text += fmt::format("; {} bytes were discarded", counts.discarded_bytes - told_.discarded_bytes);
  told_ = counts;
  if (!text.empty()) desk_.log.info(entry_.name, "line: not used were " + text);
}

void Session::hear_name(const std::string& name) {
  if (name_.empty() && equal_without_case(name, entry_.name)) {
    name_ = name;
    return;
  }
  if (!name_.empty() && equal_without_case(name, name_)) return;
  desk_.log.alert(entry_.name,
                  name_.empty()
                      ? fmt::format("the dialog on this line is of glider '{}', configured is {}: connection closed",
                                    name, entry_.name)
                      : fmt::format("two names on one connection, {} and '{}': connection closed", name_, name));
  connected_ = false;
  line_->drop("another glider's name");
}

void Session::hear_block(const protocol::SurfaceBlock& block) {
  if (!block.gps && !block.gps_damaged) return;
  auto surfacing = protocol::accept_fix(block, name_);
  if (!surfacing) {
    feed(mission::FixRefused{surfacing.error()});
    return;
  }
  std::optional<Metres> coast;
  if (chart_ && chart_->chart.has_coast()) coast = chart_->chart.distance_to_coast(surfacing->fix);
  mission::SurfacingHeard heard;
  heard.surfacing = std::move(surfacing).value();
  heard.coast_distance = coast;
  add_forecast_of_dive(heard);
  feed(std::move(heard));
}

/// The forecast in use, along the dive that this fix ends: what the pilot compares with the measured current.
void Session::add_forecast_of_dive(mission::SurfacingHeard& heard) const {
  const auto dive = pilot_.dive_under_way();
  const auto ocean = forecast_.current();
  if (!dive || !ocean) return;
  const auto& surfacing = heard.surfacing;
  const double until_s = epoch_seconds(surfacing.fix_taken);
  heard.forecast = mean_along(*ocean, *dive, surfacing.fix, until_s);
  if (!heard.forecast) return;
  const double lat = dive->from.lat.radians(), lon = dive->from.lon.radians(),
               middle_s = 0.5 * (dive->from_s + until_s);
  const auto middle = GeoPoint::from_kernel(0.5 * (lat + surfacing.fix.lat.radians()),
                                            lon + 0.5 * std::remainder(surfacing.fix.lon.radians() - lon, 2 * kPi));
  if (const auto sample = ocean->forecast.ocean().dive.sample(middle, middle_s))
    heard.extrapolated = sample->extrapolated;
  const auto& names = ocean->forecast.facts().sources;
  const auto shares = ocean->forecast.shares(middle, middle_s);
  for (std::size_t k = 0; k < shares.size(); ++k)
    if (shares[k] > 0) heard.shares.push_back({k < names.size() ? names[k] : "", shares[k]});
}

void Session::hear(const protocol::DialogEvent& event) {
  struct Ear {
    Session& session;
    void operator()(const protocol::ConnectionOpened&) const { session.tell_unused(); }
    void operator()(const protocol::NameHeard& e) const { session.hear_name(e.name); }
    void operator()(const protocol::BlockRead& e) const { session.hear_block(e.block); }
    void operator()(const protocol::WindowHeard& e) const {
      session.feed(mission::WindowHeard{Seconds{static_cast<double>(e.seconds)}});
    }
    void operator()(const protocol::WindowExtended& e) const { session.feed(mission::WindowExtended{e.by}); }
    void operator()(const protocol::MissionResumed&) const {
      session.emitter_->set_transfer_open(false);
      session.feed(mission::DiveBegan{});
    }
    void operator()(const protocol::MissionEnded& e) const {
      session.desk_.log.alert(session.entry_.name, "the dialog says that the glider's mission has ended: " + e.cause);
    }
    void operator()(const protocol::DockserverBlock&) const {}
    void operator()(const protocol::TransferStarted& e) const {
      if (lower(e.file).ends_with(session.emitter_->file_name())) session.emitter_->set_transfer_open(true);
      session.feed(mission::TransferHeard{e.file, false});
    }
    void operator()(const protocol::TransferDone& e) const {
      if (lower(e.file).ends_with(session.emitter_->file_name())) session.emitter_->set_transfer_open(false);
      session.feed(mission::TransferHeard{e.file, true});
    }
    void operator()(const protocol::TransferFailed& e) const {
      if (lower(e.file).ends_with(session.emitter_->file_name())) session.emitter_->set_transfer_open(false);
      session.feed(mission::TransferFailed{e.file});
    }
    void operator()(const protocol::CommandEnded& e) const {
      if (!e.succeeded)
        session.desk_.log.warn(session.entry_.name, "the glider refused the command: " + e.command.substr(0, 80));
    }
    void operator()(const protocol::NothingToSend& e) const {
      session.desk_.log.info(session.entry_.name,
                             fmt::format("'{}' found no file in to-glider: a list that comes now waits for the next "
                                         "surfacing",
                                         e.command.substr(0, 80)));
    }
    void operator()(const protocol::MafilesReread&) const { session.feed(mission::ListReread{}); }
    void operator()(const protocol::AbortSeen& e) const {
      session.desk_.log.alert(session.entry_.name,
                              fmt::format("the dialog says that a mission was aborted: {}", e.cause));
    }
    void operator()(const protocol::PromptSeen&) const {}
    void operator()(const protocol::KeyHeard&) const {}
  };
  std::visit(Ear{*this}, event);
}

}  // namespace glidehelm::daemon
