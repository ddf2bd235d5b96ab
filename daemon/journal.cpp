#include "daemon/journal.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "daemon/world/program_version.hpp"

namespace glidehelm::daemon {

namespace {

constexpr std::string_view kSegmentMagic = "GLHJRNL1";
constexpr std::string_view kRecordMagic = "GREC";
constexpr std::uint32_t kSegmentVersion = 1;
constexpr std::uint16_t kRecordVersion = 1;
constexpr std::size_t kSegmentHeader = 32;
constexpr std::size_t kRecordHeader = 84;
constexpr std::size_t kMostOvershoot = 1U << 20;  // a segment ends with the record that reached its limit
constexpr const char* kReserveName = "journal.reserve";
constexpr const char* kLockName = "journal.lock";

template <class T>
void put(std::string& to, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    to += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff);
}

template <class T>
T get(std::string_view from, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(from[at + i])) << (8 * i);
  return static_cast<T>(value);
}

/// Whose records these are, should another version not understand one.
std::string epoch_payload() { return nlohmann::json{{"version", world::program_version()}}.dump(); }

std::string segment_name(std::uint64_t number) {
  char name[40];
  std::snprintf(name, sizeof name, "journal-%06llu.log", static_cast<unsigned long long>(number));
  return name;
}

std::string segment_header(std::uint64_t number) {
  std::string header{kSegmentMagic};
  put(header, kSegmentVersion);
  put(header, std::uint32_t{0});
  put(header, number);
  put(header, std::uint32_t{0});
  put(header, crc32c(std::string_view{header}));
  return header;
}

struct Parsed {
  JournalRecord record;
  std::size_t size{};
  std::size_t durable{};  ///< bytes of the segment that were durable when it was written
  std::uint16_t version{};
  Sha256 hash;
};

/// One record at the front of `bytes`; nothing when it is not whole and right.
std::optional<Parsed> parse_record(std::string_view bytes) {
  if (bytes.size() < kRecordHeader + 4 || bytes.substr(0, 4) != kRecordMagic) return std::nullopt;
  if (crc32c(bytes.substr(0, kRecordHeader - 4)) != get<std::uint32_t>(bytes, kRecordHeader - 4)) return std::nullopt;
  const auto length = get<std::uint32_t>(bytes, 8);
  if (length > Journal::kMostPayload || bytes.size() < kRecordHeader + length + 4) return std::nullopt;
  const auto body = bytes.substr(0, kRecordHeader + length);
  if (crc32c(body) != get<std::uint32_t>(bytes, body.size())) return std::nullopt;
  Parsed p;
  p.version = get<std::uint16_t>(bytes, 4);
  p.record.type = static_cast<RecordType>(get<std::uint16_t>(bytes, 6));
  p.durable = get<std::uint32_t>(bytes, 12);
  p.record.sequence = get<std::uint64_t>(bytes, 16);
  p.record.epoch = get<std::uint64_t>(bytes, 24);
  p.record.utc = Instant{std::chrono::milliseconds{get<std::int64_t>(bytes, 32)}};
  p.record.tick = Tick{std::chrono::milliseconds{get<std::int64_t>(bytes, 40)}};
  std::memcpy(p.record.boot.data(), bytes.data() + 48, p.record.boot.size());
  p.record.payload = std::string{bytes.substr(kRecordHeader, length)};
  p.size = body.size() + 4;
  p.hash = Sha256::of(bytes.substr(0, p.size));
  return p;
}

bool follows(std::string_view bytes, const Sha256& previous) {
  return std::memcmp(bytes.data() + 64, previous.bytes.data(), 16) == 0;
}

/// Does a whole record behind `bad` say that the bytes at `bad` were durable before it was written?
bool was_durable(std::string_view bytes, std::size_t bad) {
  for (auto at = bytes.find(kRecordMagic, bad + 1); at != std::string_view::npos; at = bytes.find(kRecordMagic, at + 1))
    if (const auto later = parse_record(bytes.substr(at)); later && later->durable > bad) return true;
  return false;
}

}  // namespace

std::string_view word(RecordType type) {
  switch (type) {
    case RecordType::epoch:
      return "epoch";
    case RecordType::event:
      return "event";
    case RecordType::surfacing:
      return "surfacing";
    case RecordType::refusal:
      return "refusal";
    case RecordType::duplicate:
      return "duplicate";
    case RecordType::plan:
      return "plan";
    case RecordType::verdict:
      return "verdict";
    case RecordType::proposal:
      return "proposal";
    case RecordType::keep:
      return "keep";
    case RecordType::emission:
      return "emission";
    case RecordType::mission:
      return "mission";
    case RecordType::alert:
      return "alert";
    case RecordType::command:
      return "command";
    case RecordType::intent:
      return "intent";
    case RecordType::committed:
      return "committed";
    case RecordType::aborted:
      return "aborted";
    case RecordType::recovered:
      return "recovered";
  }
  return "?";
}

/// What a failed file operation means for the journal. After a failed sync nothing is written any more.
JournalError Journal::failed(const world::FileError& error) {
  const bool full = error.code == ENOSPC || error.code == EDQUOT;
  broken_ = broken_ || error.failed_sync();
  return {full ? JournalError::What::no_space : JournalError::What::file,
          (full ? "the disk of the journal is full: " : "the journal cannot be used: ") + error.message(), broken_};
}

Expected<std::unique_ptr<Journal>, JournalError> Journal::open(world::Folder& folder, Instant utc, Tick tick,
                                                               const world::BootId& boot) {
  return open(folder, utc, tick, boot, Limits{});
}

Expected<std::unique_ptr<Journal>, JournalError> Journal::open(world::Folder& folder, Instant utc, Tick tick,
                                                               const world::BootId& boot, const Limits& limits) {
  std::unique_ptr<Journal> journal{new Journal{folder, boot, limits}};
  auto lock = folder.lock(kLockName);
  if (!lock && lock.error().code == EAGAIN)
    return unexpected(
        JournalError{JournalError::What::held, "another process writes the journal in " + folder.path(), false});
  if (!lock) return unexpected(journal->failed(lock.error()));
  journal->lock_ = std::move(lock).value();
  if (auto read = journal->read_back(); !read) return unexpected(read.error());
  if (auto reserve = journal->make_reserve(); !reserve) return unexpected(reserve.error());
  if (!journal->name_.empty() && journal->size_ < limits.segment) {
    if (auto begun = journal->continue_segment(); !begun) return unexpected(begun.error());
    // What an earlier process left unsynced is made durable first, so that the epoch record can vouch for it.
    if (auto synced = journal->sync(); !synced) return unexpected(synced.error());
  }
  ++journal->epoch_;
  if (auto record = journal->append(RecordType::epoch, epoch_payload(), utc, tick, Durable::yes); !record)
    return unexpected(record.error());
  return journal;
}

Expected<Done, JournalError> Journal::read_back() {
  const auto names = folder_.list();
  if (!names) return unexpected(failed(names.error()));
  std::vector<std::string> segments;
  for (const auto& name : *names)
    if (name.size() == segment_name(1).size() && name.rfind("journal-", 0) == 0 && name.ends_with(".log"))
      segments.push_back(name);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i] != segment_name(i + 1))
      return unexpected(JournalError{JournalError::What::corrupt,
                                     "segment " + segment_name(i + 1) + " of the journal is missing", false});
    segment_ = i + 1;
    if (auto read = read_segment(segments[i], i + 1 == segments.size()); !read) return unexpected(read.error());
  }
  return Done{};
}

Expected<std::vector<JournalRecord>, JournalError> Journal::all() {
  std::vector<JournalRecord> records;
  for (std::uint64_t number = 1; number <= segment_; ++number) {
    const auto name = segment_name(number);
    const auto content = folder_.read(name, kSegment + kMostPayload + kMostOvershoot);
    if (!content) return unexpected(failed(content.error()));
    const std::string_view bytes{*content};
    for (std::size_t at = kSegmentHeader; at < bytes.size();) {
      auto parsed = parse_record(bytes.substr(at));
      if (!parsed || parsed->record.sequence != records.size() + 1)
        return unexpected(JournalError{JournalError::What::corrupt,
                                       name + " at byte " + std::to_string(at) + ": a record of this run is damaged",
                                       false});
      at += parsed->size;
      records.push_back(std::move(parsed->record));
    }
  }
  return records;
}

Expected<Done, JournalError> Journal::read_segment(const std::string& name, bool last) {
  const auto content = folder_.read(name, kSegment + kMostPayload + kMostOvershoot);
  if (!content) return unexpected(failed(content.error()));
  const std::string_view bytes{*content};
  const auto corrupt = [&](std::size_t at, const std::string& what) {
    return unexpected(JournalError{
        JournalError::What::corrupt,
        name + " at byte " + std::to_string(at) + ": " + what + ". Nothing is emitted until a human has looked at it",
        false});
  };
  const auto newer = [&] {
    return unexpected(
        JournalError{JournalError::What::newer, name + " was written by a newer version of this program", false});
  };
  if (bytes.substr(0, kSegmentHeader) != segment_header(segment_)) {
    if (bytes.size() >= 12 && bytes.substr(0, 8) == kSegmentMagic && get<std::uint32_t>(bytes, 8) > kSegmentVersion)
      return newer();
    // A power cut while the newest segment was made leaves less than a header, or a header that never reached the disk.
    if (last && bytes.size() <= kSegmentHeader) return cut_torn(name, 0, bytes);
    return corrupt(0, "the segment's header is wrong");
  }
  std::size_t at = kSegmentHeader;
  while (at < bytes.size()) {
    const auto parsed = parse_record(bytes.substr(at));
    if (!parsed) {
      if (!last) return corrupt(at, "a record is damaged");
      if (was_durable(bytes, at)) return corrupt(at, "a record that was durable is damaged");
      return cut_torn(name, at, bytes);
    }
    if (parsed->version > kRecordVersion) return newer();
    if (parsed->record.sequence != sequence_ + 1) return corrupt(at, "the sequence is broken");
    if (!follows(bytes.substr(at), last_hash_)) return corrupt(at, "the chain is broken");
    sequence_ = parsed->record.sequence;
    epoch_ = std::max(epoch_, parsed->record.epoch);
    last_hash_ = parsed->hash;
    past_.push_back(parsed->record);
    at += parsed->size;
  }
  name_ = name;
  size_ = at;
  return Done{};
}

Expected<Done, JournalError> Journal::cut_torn(const std::string& name, std::size_t good, std::string_view content) {
  const auto aside = name.substr(0, name.size() - 4) + ".torn-" + std::to_string(sequence_ + 1);
  if (auto gone = folder_.unlink(aside); !gone && gone.error().code != ENOENT) return unexpected(failed(gone.error()));
  if (auto copied = folder_.create(aside, content.substr(good), 0640); !copied)
    return unexpected(failed(copied.error()));
  if (auto synced = folder_.sync(); !synced) return unexpected(failed(synced.error()));
  note_ = "the journal's last record was torn by a crash: " + std::to_string(content.size() - good) + " bytes of " +
          name + " were set aside";
  if (good < kSegmentHeader) {
    if (auto gone = folder_.unlink(name); !gone) return unexpected(failed(gone.error()));
    --segment_;
    name_.clear();  // the segment before was full, so a new one begins
  } else {
    if (auto cut = folder_.truncate(name, good); !cut) return unexpected(failed(cut.error()));
    name_ = name;
    size_ = good;
  }
  if (auto synced = folder_.sync(); !synced) return unexpected(failed(synced.error()));
  return Done{};
}

Expected<Done, JournalError> Journal::make_reserve() {
  if (const auto there = folder_.stat(kReserveName); there && there->size == limits_.reserve) return Done{};
  if (auto gone = folder_.unlink(kReserveName); !gone && gone.error().code != ENOENT)
    return unexpected(failed(gone.error()));
  if (auto made = folder_.create(kReserveName, std::string(limits_.reserve, '\0'), 0640); !made)
    return unexpected(failed(made.error()));
  if (auto synced = folder_.sync(); !synced) return unexpected(failed(synced.error()));
  return Done{};
}

Expected<Done, JournalError> Journal::begin_segment(std::uint64_t number) {
  const auto name = segment_name(number);
  // `create` makes header and file durable before the folder names it durably: a crash leaves no segment or a whole one.
  if (auto made = folder_.create(name, segment_header(number), 0640); !made) return unexpected(failed(made.error()));
  if (auto synced = folder_.sync(); !synced) return unexpected(failed(synced.error()));
  segment_ = number;
  name_ = name;
  size_ = durable_ = kSegmentHeader;
  file_.reset();  // should the new one not open, the next append tries again instead of writing into the old one
  return continue_segment();
}

Expected<Done, JournalError> Journal::continue_segment() {
  auto file = folder_.append_to(name_, false);
  if (!file) return unexpected(failed(file.error()));
  file_ = std::move(file).value();
  return Done{};
}

/// A segment with room is open.
Expected<Done, JournalError> Journal::ready_to_write() {
  if (!name_.empty() && size_ < limits_.segment)
    return file_ ? Expected<Done, JournalError>{Done{}} : continue_segment();
  if (file_)
    if (auto synced = sync(); !synced) return synced;
  return begin_segment(segment_ + 1);
}

Expected<Done, JournalError> Journal::sync() {
  if (broken_) return unexpected(JournalError{JournalError::What::file, "the journal failed before", true});
  if (!file_) return Done{};
  if (auto synced = file_->sync(); !synced) return unexpected(failed(synced.error()));
  durable_ = size_;
  return Done{};
}

Expected<Done, JournalError> Journal::write(RecordType type, std::string_view payload, Instant utc, Tick tick) {
  std::string record{kRecordMagic};
  put(record, kRecordVersion);
  put(record, static_cast<std::uint16_t>(type));
  put(record, static_cast<std::uint32_t>(payload.size()));
  put(record, static_cast<std::uint32_t>(durable_));
  put(record, sequence_ + 1);
  put(record, epoch_);
  put(record, utc.time_since_epoch().count());
  put(record, tick.time_since_epoch().count());
  record.append(reinterpret_cast<const char*>(boot_.data()), boot_.size());
  record.append(reinterpret_cast<const char*>(last_hash_.bytes.data()), 16);
  put(record, crc32c(std::string_view{record}));
  record += payload;
  put(record, crc32c(std::string_view{record}));
  if (auto written = file_->append(record); !written) {
    auto problem = failed(written.error());
    // A part of the record may be there. If it cannot be cut off, whatever is appended behind it would be lost.
    if (auto cut = folder_.truncate(name_, size_); !cut) {
      broken_ = true;
      problem.fatal = true;
      problem.message += "; then " + cut.error().message();
    }
    return unexpected(problem);
  }
  size_ += record.size();
  ++sequence_;
  last_hash_ = Sha256::of(std::string_view{record});
  return Done{};
}

/// The reserve's room goes to one last record.
void Journal::say_stopped(Instant utc, Tick tick) {
  full_ = true;
  if (!file_) return;
  static_cast<void>(folder_.unlink(kReserveName));
  static_cast<void>(folder_.sync());
  if (write(RecordType::alert, R"({"code":"no-space","text":"stopped: no space for the journal"})", utc, tick))
    static_cast<void>(sync());
}

Expected<std::uint64_t, JournalError> Journal::append(RecordType type, std::string_view payload, Instant utc, Tick tick,
                                                      Durable durable) {
  if (broken_) return unexpected(JournalError{JournalError::What::file, "the journal failed before", true});
  if (payload.size() > kMostPayload)
    return unexpected(
        JournalError{JournalError::What::too_long,
                     "a record of " + std::to_string(payload.size()) + " bytes; at most 65536 are allowed", false});
  if (full_)
    if (auto reserve = make_reserve(); !reserve) return unexpected(reserve.error());
  full_ = false;
  auto done = ready_to_write();
  if (done) done = write(type, payload, utc, tick);
  if (done && durable == Durable::yes) done = sync();
  if (done) return sequence_;
  if (done.error().what == JournalError::What::no_space && !broken_) say_stopped(utc, tick);
  auto problem = done.error();
  problem.fatal = problem.fatal || broken_;
  return unexpected(problem);
}

}  // namespace glidehelm::daemon
