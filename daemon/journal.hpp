#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/hash.hpp"
#include "core/base/time.hpp"
#include "daemon/world/clock.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::daemon {

/// What a record is about. The numbers are on disk: never reuse one.
enum class RecordType : std::uint16_t {
  epoch = 1,       ///< a process took the journal over
  event = 2,       ///< what a pilot was told
  surfacing = 10,  ///< decisions of a pilot, in words …
  refusal = 11,
  duplicate = 12,
  plan = 13,
  verdict = 14,
  proposal = 15,
  keep = 16,
  emission = 17,
  mission = 18,
  alert = 19,
  command = 20,  ///< a human asked for something, with the uid
  intent = 30,   ///< an emission begins: durable before anything is visible
  committed = 31,
  aborted = 32,
  recovered = 33,  ///< an INTENT whose end nobody can know was closed
};
std::string_view word(RecordType type);

/// One record as read back. The payload is JSON text made by whoever appended it.
struct JournalRecord {
  std::uint64_t sequence{};
  std::uint64_t epoch{};
  RecordType type{};
  Instant utc;
  Tick tick;             ///< comparable with another record's only when `boot` is the same
  world::BootId boot{};  ///< zero with a simulated clock
  std::string payload;
  friend bool operator==(const JournalRecord&, const JournalRecord&) = default;
};

/// Why a journal cannot be used. `corrupt`: a record that was durable is bad; nothing may be emitted until a human has
/// looked. `held`: another process writes it. `no_space`: this record is not kept; the next ones are tried again.
struct JournalError {
  enum class What { file, corrupt, newer, too_long, no_space, held } what{};
  std::string message;
  bool fatal{};  ///< a sync failed: what the disk holds is unknown; the process ends at once (trust.md K-4)
  friend bool operator==(const JournalError&, const JournalError&) = default;
};

/// The truth: an append-only, checksummed, chained log in segments of 16 MiB (trust.md 6.3).
///
/// A segment `journal-NNNNNN.log` begins with a header of 32 bytes (magic "GLHJRNL1", version, segment number, CRC-32C).
/// A record, little-endian:
///
///     offset  size  field
///          0     4  magic "GREC"
///          4     2  version (1)
///          6     2  type
///          8     4  bytes of the payload (≤ 64 KiB)
///         12     4  bytes of this segment that were durable when this record was written
///         16     8  sequence number, +1 each, over all segments
///         24     8  epoch: +1 at each opening
///         32     8  UTC, ms since 1970
///         40     8  tick, ms
///         48    16  boot id
///         64    16  first half of the SHA-256 of the previous record (zero for the first)
///         80     4  CRC-32C of bytes 0–79
///         84     …  payload
///          …     4  CRC-32C of everything before
///
/// Opening takes the lock `journal.lock` and reads everything back. A power cut may leave any mixture of what was not yet
/// synced: a bad record in the last segment that no later record knows to have been durable begins a torn tail, which is
/// copied to `journal-NNNNNN.torn-SEQUENCE` and cut. Anything else that is bad is corrupt.
///
/// The file `journal.reserve` keeps 1 MiB free. When the disk is full it is given up for one record that says so (K-3);
/// after that nothing is recorded, and so nothing is done, until there is room for the reserve again.
class Journal {
 public:
  static constexpr std::size_t kSegment = 16U << 20;
  static constexpr std::size_t kMostPayload = 64U << 10;

  /// How large things are; tests make them small.
  struct Limits {
    std::size_t segment{kSegment};  ///< a segment that has reached it is followed by the next
    std::size_t reserve{1U << 20};  ///< bytes kept free for the last word
  };

  /// Opens or begins the journal in `folder`, which must outlive it, and appends an epoch record durably.
  static Expected<std::unique_ptr<Journal>, JournalError> open(world::Folder& folder, Instant utc, Tick tick,
                                                               const world::BootId& boot = {});
  static Expected<std::unique_ptr<Journal>, JournalError> open(world::Folder& folder, Instant utc, Tick tick,
                                                               const world::BootId& boot, const Limits& limits);

  /// Everything that was there at the opening, the new epoch record not included.
  [[nodiscard]] const std::vector<JournalRecord>& past() const { return past_; }
  /// Everything up to now, read again from the disk: for a glider that a reload brings in.
  [[nodiscard]] Expected<std::vector<JournalRecord>, JournalError> all();
  /// Frees what `past` holds once it was replayed.
  void forget_past() { past_ = {}; }
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
  [[nodiscard]] const std::string& note() const { return note_; }  ///< what was mended at the opening; empty: nothing

  enum class Durable { no, yes };
  /// Appends one record and returns its sequence number; with Durable::yes it survives a power cut once this returns.
  /// After a failed write the part that was written is cut off again; after a failed sync the error is fatal.
  Expected<std::uint64_t, JournalError> append(RecordType type, std::string_view payload, Instant utc, Tick tick,
                                               Durable durable = Durable::no);
  /// Makes everything durable that was appended: at a clean stop.
  Expected<Done, JournalError> sync();
  /// The disk was full at the last append.
  [[nodiscard]] bool full() const { return full_; }

 private:
  Journal(world::Folder& folder, const world::BootId& boot, const Limits& limits)
      : folder_{folder}, boot_{boot}, limits_{limits} {}
  Expected<Done, JournalError> read_back();
  Expected<Done, JournalError> read_segment(const std::string& name, bool last);
  Expected<Done, JournalError> cut_torn(const std::string& name, std::size_t good, std::string_view content);
  Expected<Done, JournalError> make_reserve();
  Expected<Done, JournalError> begin_segment(std::uint64_t number);
  Expected<Done, JournalError> continue_segment();
  Expected<Done, JournalError> ready_to_write();
  Expected<Done, JournalError> write(RecordType type, std::string_view payload, Instant utc, Tick tick);
  void say_stopped(Instant utc, Tick tick);
  [[nodiscard]] JournalError failed(const world::FileError& error);

  world::Folder& folder_;
  world::BootId boot_;
  Limits limits_;
  std::unique_ptr<world::Lock> lock_;
  std::unique_ptr<world::AppendFile> file_;
  std::string name_;
  std::uint64_t segment_{}, size_{}, durable_{}, sequence_{}, epoch_{};
  Sha256 last_hash_{};
  std::vector<JournalRecord> past_;
  std::string note_;
  bool broken_{}, full_{};
};

}  // namespace glidehelm::daemon
