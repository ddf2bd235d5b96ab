#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "daemon/emitter.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/memory_files.hpp"
#include "tests/support/verdict.hpp"

namespace glidehelm::test {

/// A glider's folder on a dockserver and a daemon's state folder, in memory; processes start, emit and die on it.
struct Dock {
  static constexpr const char* kTarget = "/dock/sim01/to-glider";
  static constexpr const char* kStage = "/dock/sim01/.glidehelm";
  static constexpr const char* kFile = "/dock/sim01/to-glider/goto_l10.ma";
  static constexpr const char* kState = "/state";

  MemoryFiles files;
  ManualClock clock;
  std::unique_ptr<world::Folder> state;
  std::unique_ptr<daemon::Journal> journal;
  std::unique_ptr<daemon::Emitter> emitter;
  std::vector<daemon::RecoveredEmission> recovered;
  std::vector<daemon::JournalRecord> past;
  std::uint64_t staged{};

  Dock() {
    for (const char* folder : {"/dock", "/dock/sim01", kTarget, kState}) files.make_folder_at(folder);
  }

  /// A process starts: journal, folder, recovery. Empty, or why it could not.
  std::string start() {
    stop();
    auto folder = files.open_folder(kState);
    if (!folder) return folder.error().message();
    state = std::move(folder).value();
    auto opened = daemon::Journal::open(*state, clock.utc(), clock.tick(), {}, {1U << 20, 4096});
    if (!opened) return opened.error().message;
    journal = std::move(opened).value();
    auto made = daemon::Emitter::open(files, kTarget, 10, false);
    if (!made) return made.error();
    emitter = std::move(made).value();
    past = journal->past();
    recovered = emitter->recover("sim01", past, *journal, clock.utc(), clock.tick());
    for (const auto& r : recovered)
      if (r.emission.fatal) return "fatal: " + r.emission.detail;
    return "";
  }
  void stop() {
    emitter.reset();
    journal.reset();
    state.reset();
    recovered.clear();
  }

  static safety::VerifiedFile proven(const std::string& bytes, const std::string& name = "goto_l10.ma") {
    return safety::accept(name, bytes, verdict_on(name, bytes)).value();
  }
  [[nodiscard]] daemon::EmissionOrder order(const std::string& surfacing, Seconds window = Seconds{300}) const {
    return {"sim01", surfacing, "plan-1", clock.tick() + std::chrono::round<Tick::duration>(window), false};
  }
  /// Stages and emits; what staging says when it fails is an aborted emission.
  daemon::Emission emit(const std::string& bytes, const std::string& surfacing) {
    const auto name = emitter->stage(bytes, ++staged);
    if (!name) return {daemon::Emission::Outcome::aborted, name.error().message(), name.error().failed_sync()};
    return emitter->emit(proven(bytes), *name, order(surfacing), *journal, clock);
  }
  [[nodiscard]] std::optional<std::string> visible() const { return files.get(kFile); }
  /// What an earlier process left in the staging folder that is neither lock nor epoch.
  [[nodiscard]] std::vector<std::string> leftovers() const {
    std::vector<std::string> result;
    for (const auto& name : files.names(kStage))
      if (name != "lock" && name != "epoch") result.push_back(name);
    return result;
  }
};

}  // namespace glidehelm::test
