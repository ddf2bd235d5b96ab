#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/safety/judge.hpp"
#include "daemon/journal.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::daemon {

/// What an emission is for; written into its INTENT.
struct EmissionOrder {
  std::string glider;
  std::string surfacing;  ///< key of the surfacing that the file answers
  std::string plan_id;
  Tick deadline;    ///< not visible after this
  bool replaces{};  ///< our own file may lie there and is exchanged
};

struct Emission {
  enum class Outcome { queued, foreign_file, late, aborted, unknown };
  Outcome outcome{};
  std::string detail;  ///< a sentence for the operator
  bool fatal{};        ///< a sync failed: the process ends at once, recovery reads the disk (trust.md K-4)
};

/// What lies in to-glider under our slot's name.
struct FolderView {
  enum class What { nothing, ours, foreign, unreadable };
  What what{};
  std::string detail;  ///< name, owner, time and hash of a foreign file, or why nothing can be read
};

/// What became of an emission that a crash interrupted.
struct RecoveredEmission {
  std::string surfacing;
  Emission emission;
};

/// The crash-safe way of one glider's file into `to-glider` (trust.md 6).
///
/// Staged in `.glidehelm` beside `to-glider` (one file system, one ReadWritePaths= entry), judged there by descriptor, then:
/// INTENT durable → last cheap checks → renameat2(NOREPLACE), or EXCHANGE against our own previous file known by hash →
/// fsync of both folders → COMMITTED durable. At any instant the name in `to-glider` is absent, the whole old file or the whole
/// new one, after a power cut too. A file that we did not write is never touched: the caller stands down.
class Emitter {
 public:
  /// Opens `to_glider`, makes `.glidehelm` beside it, takes its lock. The message says what is wrong: not there, a symbolic link,
  /// another file system, not writable, held by another process; with `need_marker`, not made by glidersim.
  static Expected<std::unique_ptr<Emitter>, std::string> open(world::Files& files, const std::string& to_glider,
                                                              int slot, bool need_marker);

  /// E2: writes the bytes into a staged file, durable. `number` is unique in this process.
  world::FileResult<std::string> stage(std::string_view bytes, std::uint64_t number);
  /// E3: a read-only descriptor of the staged inode, for the verifier.
  world::FileResult<std::unique_ptr<world::OpenFile>> open_staged(const std::string& staged);
  /// Removes a staged file that will not go out.
  void discard(const std::string& staged);

  /// E4–E9. `staged` is the inode that was judged; its bytes must be the file's.
  Emission emit(const safety::VerifiedFile& file, const std::string& staged, const EmissionOrder& order,
                Journal& journal, Instant utc, Tick now);

  /// 6.2: settles what the journal began and did not end, deletes staged files of older epochs. Idempotent. Also learns from the
  /// journal which file is ours.
  std::vector<RecoveredEmission> recover(const std::string& glider, const std::vector<JournalRecord>& past,
                                         Journal& journal, Instant utc, Tick now);

  /// Is there a file of our name, and is it ours? Reads at most 64 KiB.
  FolderView inspect();

  /// A transfer to the glider is open: nothing may be exchanged (trust.md 0-3).
  void set_transfer_open(bool open) { transfer_open_ = open; }
  void set_slot(int slot);
  [[nodiscard]] const std::string& file_name() const { return name_; }

 private:
  Emitter() = default;
  Emission make_visible(const safety::VerifiedFile& file, const std::string& staged, const EmissionOrder& order,
                        bool exchange);
  Emission make_durable(const EmissionOrder& order, const safety::VerifiedFile& file, Journal& journal, Instant utc,
                        Tick now, std::uint64_t intent);
  std::optional<std::string> objection(const EmissionOrder& order, Tick now);
  Emission abort(Journal& journal, std::uint64_t intent, const EmissionOrder& order, Emission why, Instant utc,
                 Tick now);
  Emission settle(const std::string& intent_json, Journal& journal, Instant utc, Tick now, std::string& surfacing);
  std::optional<Sha256> hash_in_target(std::string* problem);

  std::unique_ptr<world::Folder> target_, stage_;
  std::unique_ptr<world::Lock> lock_;
  world::FileStat target_stat_;
  std::string name_;                 ///< goto_lNN.ma
  std::optional<Sha256> ours_;       ///< hash of the file that we last made visible
  std::vector<Sha256> ours_before_;  ///< hashes that earlier processes made visible
  bool transfer_open_{};
};

}  // namespace glidehelm::daemon
