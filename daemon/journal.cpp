#include "daemon/journal.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

namespace glidehelm::daemon {

namespace {

constexpr std::string_view kSegmentMagic = "GLHJRNL1";
constexpr std::string_view kRecordMagic = "GREC";
constexpr std::uint32_t kSegmentVersion = 1;
constexpr std::uint16_t kRecordVersion = 1;
constexpr std::size_t kSegmentHeader = 32;
constexpr std::size_t kRecordHeader = 68;
constexpr std::size_t kTailSearch = 64U << 10;
constexpr std::size_t kReserve = 1U << 20;
constexpr const char* kReserveName = "journal.reserve";

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
  Sha256 hash;
};

/// One record at the front of `bytes`; nothing when it is not whole and right.
std::optional<Parsed> parse_record(std::string_view bytes) {
  if (bytes.size() < kRecordHeader + 4 || bytes.substr(0, 4) != kRecordMagic) return std::nullopt;
  if (crc32c(bytes.substr(0, 64)) != get<std::uint32_t>(bytes, 64)) return std::nullopt;
  const auto length = get<std::uint32_t>(bytes, 8);
  if (length > Journal::kMostPayload || bytes.size() < kRecordHeader + length + 4) return std::nullopt;
  const auto body = bytes.substr(0, kRecordHeader + length);
  if (crc32c(body) != get<std::uint32_t>(bytes, body.size())) return std::nullopt;
  Parsed p;
  p.record.type = static_cast<RecordType>(get<std::uint16_t>(bytes, 6));
  p.record.sequence = get<std::uint64_t>(bytes, 16);
  p.record.epoch = get<std::uint64_t>(bytes, 24);
  p.record.utc = Instant{std::chrono::milliseconds{get<std::int64_t>(bytes, 32)}};
  p.record.tick = Tick{std::chrono::milliseconds{get<std::int64_t>(bytes, 40)}};
  p.record.payload = std::string{bytes.substr(kRecordHeader, length)};
  p.size = body.size() + 4;
  p.hash = Sha256::of(bytes.substr(0, p.size));
  return p;
}

bool follows(std::string_view bytes, const Sha256& previous) {
  return std::memcmp(bytes.data() + 48, previous.bytes.data(), 16) == 0;
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

JournalError Journal::failed(const world::FileError& error, bool fatal) const {
  const bool full = error.code == ENOSPC || error.code == EDQUOT;
  return {full ? JournalError::What::no_space : JournalError::What::file,
          (full ? "the disk of the journal is full: " : "the journal cannot be written: ") + error.message(), fatal};
}

Expected<std::unique_ptr<Journal>, JournalError> Journal::open(world::Folder& folder, Instant utc, Tick tick) {
  std::unique_ptr<Journal> journal{new Journal{folder}};
  if (auto read = journal->read_back(); !read) return unexpected(read.error());
  if (!folder.stat(kReserveName)) {
    if (auto reserve = folder.create(kReserveName, std::string(kReserve, '\0'), 0640); !reserve)
      return unexpected(journal->failed(reserve.error(), false));
    if (auto synced = folder.sync(); !synced) return unexpected(journal->failed(synced.error(), true));
  }
  auto begun = journal->name_.empty() || journal->size_ >= kSegment ? journal->begin_segment(journal->segment_ + 1)
                                                                    : journal->continue_segment();
  if (!begun) return unexpected(begun.error());
  ++journal->epoch_;
  if (auto record = journal->append(RecordType::epoch, "{}", utc, tick, Durable::yes); !record)
    return unexpected(record.error());
  return journal;
}

Expected<Done, JournalError> Journal::read_back() {
  const auto names = folder_.list();
  if (!names) return unexpected(failed(names.error(), false));
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

Expected<Done, JournalError> Journal::read_segment(const std::string& name, bool last) {
  const auto content = folder_.read(name, kSegment + kMostPayload + (1U << 20));
  if (!content) return unexpected(failed(content.error(), false));
  const std::string_view bytes{*content};
  const auto corrupt = [&](std::size_t at, const std::string& what) {
    return unexpected(JournalError{
        JournalError::What::corrupt,
        name + " at byte " + std::to_string(at) + ": " + what + ". Nothing is emitted until a human has looked at it",
        false});
  };
  if (bytes.substr(0, kSegmentHeader) != segment_header(segment_)) {
    if (bytes.size() >= 12 && bytes.substr(0, 8) == kSegmentMagic && get<std::uint32_t>(bytes, 8) > kSegmentVersion)
      return unexpected(
          JournalError{JournalError::What::newer, name + " was written by a newer version of this program", false});
    // A crash between the creation of the newest segment and its header leaves it empty or short.
    if (last && bytes.size() < kSegmentHeader) return cut_torn(name, 0, bytes);
    return corrupt(0, "the segment's header is wrong");
  }
  std::size_t at = kSegmentHeader;
  while (at < bytes.size()) {
    const auto parsed = parse_record(bytes.substr(at));
    if (!parsed) {
      if (!last) return corrupt(at, "a record is damaged");
      const auto end = std::min(bytes.size(), at + kTailSearch + kMostPayload);
      for (std::size_t next = at + 1; next < end; ++next)
        if (bytes[next] == kRecordMagic[0] && parse_record(bytes.substr(next)))
          return corrupt(at, "a record is damaged and good ones follow");
      return cut_torn(name, at, bytes);
    }
    if (parsed->record.sequence != sequence_ + 1) return corrupt(at, "the sequence is broken");
    if (!follows(bytes.substr(at), last_hash_)) return corrupt(at, "the chain is broken");
    if (get<std::uint16_t>(bytes.substr(at), 4) > kRecordVersion)
      return unexpected(
          JournalError{JournalError::What::newer, name + " holds records of a newer version of this program", false});
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
  if (!folder_.stat(aside))
    if (auto copied = folder_.create(aside, content.substr(good), 0640); !copied)
      return unexpected(failed(copied.error(), false));
  note_ = "the journal's last record was torn by a crash: " + std::to_string(content.size() - good) + " bytes of " +
          name + " were set aside";
  if (good < kSegmentHeader) {
    if (auto gone = folder_.unlink(name); !gone) return unexpected(failed(gone.error(), false));
    --segment_;
    name_ = segment_ == 0 ? "" : segment_name(segment_);
    size_ = kSegment;  // the segment before was full, so a new one begins
  } else {
    if (auto cut = folder_.truncate(name, good); !cut) return unexpected(failed(cut.error(), true));
    name_ = name;
    size_ = good;
  }
  if (auto synced = folder_.sync(); !synced) return unexpected(failed(synced.error(), true));
  return Done{};
}

Expected<Done, JournalError> Journal::begin_segment(std::uint64_t number) {
  const auto name = segment_name(number);
  // `create` makes header and file durable before the folder names it durably: a crash leaves no segment or a whole one.
  if (auto made = folder_.create(name, segment_header(number), 0640); !made)
    return unexpected(failed(made.error(), false));
  if (auto synced = folder_.sync(); !synced) return unexpected(failed(synced.error(), true));
  segment_ = number;
  name_ = name;
  size_ = kSegmentHeader;
  return continue_segment();
}

Expected<Done, JournalError> Journal::continue_segment() {
  auto file = folder_.append_to(name_, false);
  if (!file) return unexpected(failed(file.error(), false));
  file_ = std::move(file).value();
  return Done{};
}

Expected<std::uint64_t, JournalError> Journal::append(RecordType type, std::string_view payload, Instant utc, Tick tick,
                                                      Durable durable) {
  if (broken_) return unexpected(JournalError{JournalError::What::file, "the journal failed before", true});
  if (payload.size() > kMostPayload)
    return unexpected(
        JournalError{JournalError::What::too_long,
                     "a record of " + std::to_string(payload.size()) + " bytes; at most 65536 are allowed", false});
  if (size_ >= kSegment) {
    if (auto synced = file_->sync(); !synced) {
      broken_ = true;
      return unexpected(failed(synced.error(), true));
    }
    if (auto begun = begin_segment(segment_ + 1); !begun) return unexpected(begun.error());
  }
  std::string record{kRecordMagic};
  put(record, kRecordVersion);
  put(record, static_cast<std::uint16_t>(type));
  put(record, static_cast<std::uint32_t>(payload.size()));
  put(record, std::uint32_t{0});
  put(record, sequence_ + 1);
  put(record, epoch_);
  put(record, utc.time_since_epoch().count());
  put(record, tick.time_since_epoch().count());
  record.append(reinterpret_cast<const char*>(last_hash_.bytes.data()), 16);
  put(record, crc32c(std::string_view{record}));
  record += payload;
  put(record, crc32c(std::string_view{record}));
  if (auto written = file_->append(record); !written) {
    // A part of the record may be there: it is cut off again, and the reserve gives room for one more word.
    const auto problem = failed(written.error(), false);
    if (!folder_.truncate(name_, size_)) {
      broken_ = true;
      return unexpected(JournalError{problem.what, problem.message, true});
    }
    if (problem.what == JournalError::What::no_space) static_cast<void>(folder_.unlink(kReserveName));
    return unexpected(problem);
  }
  size_ += record.size();
  ++sequence_;
  last_hash_ = Sha256::of(std::string_view{record});
  if (durable == Durable::yes)
    if (auto synced = file_->sync(); !synced) {
      broken_ = true;
      return unexpected(failed(synced.error(), true));
    }
  return sequence_;
}

}  // namespace glidehelm::daemon
