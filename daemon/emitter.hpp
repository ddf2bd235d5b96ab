#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/safety/judge.hpp"
#include "daemon/journal.hpp"
#include "daemon/world/clock.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::daemon {

/// What an emission is for; written into its INTENT.
struct EmissionOrder {
  std::string glider;
  std::string surfacing;  ///< key of the surfacing that the file answers
  std::string plan_id;
  Tick deadline;    ///< not visible after this
  bool replaces{};  ///< a second file for the same surfacing; journalled
};

struct Emission {
  /// `foreign_file`: somebody else's file lies there, untouched. `unknown`: our file may be or have been visible, and
  /// nobody can say how it ended; the next start looks again.
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
/// Staged in `.glidehelm` beside `to-glider` (one file system, one ReadWritePaths= entry), judged there by descriptor,
/// then: INTENT durable → last cheap checks → renameat2(NOREPLACE), or EXCHANGE against our own previous file known by
/// hash → fsync of both folders → COMMITTED durable. At any instant the name in `to-glider` is absent, the whole old file
/// or the whole new one, after a power cut too; no other name is ever made there. A file that we did not write is put
/// back as it was if an exchange met it: the caller stands down.
///
/// One process per glider: it holds the OFD lock on `.glidehelm/lock` and has written its own number into
/// `.glidehelm/epoch`, which is compared before every rename. A file `HOLD` in `.glidehelm` forbids every emission.
class Emitter {
 public:
  /// Opens `to_glider`, makes `.glidehelm` beside it, takes its lock, counts its epoch. The message says what is wrong: not
  /// there, a symbolic link, another file system or mount, not writable, held by another process; with `need_marker`,
  /// not made by glidersim. Nothing is ever made in `to_glider` itself. `files` must outlive the emitter.
  static Expected<std::unique_ptr<Emitter>, std::string> open(world::Files& files, const std::string& to_glider,
                                                              int slot, bool need_marker);

  /// E2: writes the bytes into a staged file, durable with its name. `number` is unique in this process.
  world::FileResult<std::string> stage(std::string_view bytes, std::uint64_t number);
  /// E3: a read-only descriptor of the staged inode, for the verifier.
  world::FileResult<std::unique_ptr<world::OpenFile>> open_staged(const std::string& staged);
  /// Removes a staged file that will not go out. One whose INTENT has no end yet stays: recovery needs it.
  void discard(const std::string& staged);

  /// E4–E9. `staged` is the inode that was judged; its bytes must be the file's. The clock is read again after INTENT is
  /// durable: a slow disk must not make a late file visible.
  Emission emit(const safety::VerifiedFile& file, const std::string& staged, const EmissionOrder& order,
                Journal& journal, const world::Clock& clock);

  /// 6.2: settles what the journal began and did not end, deletes staged files of older epochs, and learns from the
  /// journal which file is ours. `past` is everything up to now. Idempotent: may be killed and run again at any point.
  std::vector<RecoveredEmission> recover(const std::string& glider, const std::vector<JournalRecord>& past,
                                         Journal& journal, Instant utc, Tick now);

  /// Is there a file of our name, and is it ours? Ours is what we made visible last, by hash. Reads at most 64 KiB.
  FolderView inspect();

  /// What `inspect` would look at, without reading it: names that the glider would take for ours with device, inode, size
  /// and time of change. Two equal texts: nothing happened in between. Cheap enough for every second.
  std::string glance();

  /// A transfer of our file to the glider is open: nothing is made visible (trust.md 0-3: the dockserver removes by name
  /// what it has sent). A new connection or a dive ends it.
  void set_transfer_open(bool open) { transfer_open_ = open; }
  void set_slot(int slot);
  [[nodiscard]] const std::string& file_name() const { return name_; }
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }

 private:
  /// What one name of one folder holds.
  struct Found {
    /// `strange`: not a plain file of at most 64 KiB, so none of ours. `problem`: the system could not tell.
    enum class What { absent, file, strange, problem } what{What::absent};
    Sha256 hash;
    std::string problem;
    [[nodiscard]] bool is(const Sha256& wanted) const { return what == What::file && hash == wanted; }
  };
  /// An INTENT that nothing ended.
  struct Open {
    std::uint64_t sequence{};
    std::string surfacing, name, staged;
    Sha256 wanted;
    std::optional<Sha256> replaced;
  };
  struct Settled {
    Emission emission;
    bool closed{true};     ///< false: nothing could be read; the INTENT stays open for the next start
    std::string remove{};  ///< a staged file of ours that is not needed once the INTENT is closed
  };

  explicit Emitter(world::Files& files) : files_{files} {}
  std::optional<std::string> open_stage(const std::string& beside);
  std::optional<std::string> count_epoch();
  static Found look(world::Folder& folder, const std::string& name);
  std::optional<std::string> objection(const EmissionOrder& order);
  Emission make_visible(const safety::VerifiedFile& file, const std::string& staged, bool exchange);
  Emission put_back(const std::string& staged, const std::string& name, const Sha256& ours);
  std::string keep_aside(const std::string& staged);
  static std::string aside_of(const std::string& staged);
  Emission make_durable(const EmissionOrder& order, const safety::VerifiedFile& file, const std::string& staged,
                        Journal& journal, const world::Clock& clock, std::uint64_t intent);
  Emission abort(Journal& journal, std::uint64_t intent, const EmissionOrder& order, const std::string& staged,
                 Emission why, const world::Clock& clock);
  std::vector<Open> read_past(const std::string& glider, const std::vector<JournalRecord>& past);
  Settled settle(Open intent);
  Settled settle_visible(const Open& intent);
  Settled settle_gone(const Open& intent, const Found& target, bool staged_is_foreign);
  std::optional<world::FileError> sync_both();

  world::Files& files_;
  std::string target_path_, stage_path_;
  std::unique_ptr<world::Folder> target_, stage_;
  std::unique_ptr<world::Lock> lock_;
  world::FileStat target_stat_, stage_stat_;
  std::string name_;                    ///< goto_lNN.ma
  std::map<std::string, Sha256> ours_;  ///< by name: the file that we last made visible
  std::set<std::string> pinned_;        ///< staged files whose INTENT has no end
  std::uint64_t epoch_{};
  bool transfer_open_{};
};

}  // namespace glidehelm::daemon
