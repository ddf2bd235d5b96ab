#include "daemon/journal.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <iostream>
#include <set>

#include "tests/support/manual_world.hpp"

using namespace glidehelm;
using namespace glidehelm::daemon;
using glidehelm::test::FixedRng;
using glidehelm::test::MemoryFiles;
using glidehelm::test::PowerCut;
using Durable = Journal::Durable;
using Fault = MemoryFiles::Fault;
using What = JournalError::What;

namespace {

constexpr const char* kState = "/state";
constexpr const char* kFirst = "/state/journal-000001.log";
const Instant kUtc{std::chrono::milliseconds{1'800'000'000'123}};
const Tick kTick{std::chrono::milliseconds{987'654}};
constexpr world::BootId kBoot{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 255};
constexpr Journal::Limits kSmall{2048, 4096};

struct JournalDisk {
  JournalDisk() { files.make_folder_at(kState); }
  /// Opens the journal; whoever held it has let go.
  Expected<std::unique_ptr<Journal>, JournalError> open(const Journal::Limits& limits = kSmall) {
    auto opened = files.open_folder(kState);
    if (!opened) return unexpected(JournalError{What::file, opened.error().message(), false});
    folder = std::move(opened).value();
    return Journal::open(*folder, kUtc, kTick, kBoot, limits);
  }
  MemoryFiles files;
  std::unique_ptr<world::Folder> folder;
};

std::string payload(int i) { return fmt::format(R"({{"number":{},"text":"{}"}})", i, std::string(40, 'x')); }

/// What the journal holds of ours: the payloads but for the epoch records.
std::vector<std::string> payloads(const Journal& journal) {
  std::vector<std::string> result;
  for (const auto& record : journal.past())
    if (record.type != RecordType::epoch) result.push_back(record.payload);
  return result;
}

/// A disk with one segment of an epoch record and `n` records, all durable.
std::string segment_of(int n) {
  JournalDisk disk;
  auto journal = disk.open({1U << 20, 4096});
  REQUIRE(journal);
  for (int i = 0; i < n; ++i) REQUIRE((*journal)->append(RecordType::event, payload(i), kUtc, kTick, Durable::yes));
  return *disk.files.durable(kFirst);
}

/// Where each record of a segment begins, and the end.
std::vector<std::size_t> borders(const std::string& segment) {
  std::vector<std::size_t> result;
  for (std::size_t at = 32; at < segment.size();) {
    result.push_back(at);
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length |= std::uint32_t{static_cast<unsigned char>(segment[at + 8 + i])} << 8 * i;
    at += 84 + length + 4;
  }
  result.push_back(segment.size());
  return result;
}

}  // namespace

TEST_CASE("what was appended is read back, with both clocks, boot and type") {
  JournalDisk disk;
  {
    auto journal = disk.open();
    REQUIRE(journal);
    CHECK((*journal)->epoch() == 1);
    CHECK((*journal)->past().empty());
    CHECK((*journal)->append(RecordType::surfacing, payload(1), kUtc, kTick).value() == 2);
    CHECK((*journal)->append(RecordType::intent, payload(2), kUtc, kTick, Durable::yes).value() == 3);
  }
  auto journal = disk.open();
  REQUIRE(journal);
  CHECK((*journal)->epoch() == 2);
  CHECK((*journal)->note().empty());
  const auto& past = (*journal)->past();
  REQUIRE(past.size() == 3);
  CHECK(past[0].type == RecordType::epoch);
  CHECK(past[1] == JournalRecord{2, 1, RecordType::surfacing, kUtc, kTick, kBoot, payload(1)});
  CHECK(past[2] == JournalRecord{3, 1, RecordType::intent, kUtc, kTick, kBoot, payload(2)});
  (*journal)->forget_past();
  CHECK((*journal)->past().empty());
}

TEST_CASE("everything up to now can be read again from the disk, over segments") {
  JournalDisk disk;
  auto journal = disk.open();
  REQUIRE(journal);
  for (int i = 1; i <= 40; ++i) REQUIRE((*journal)->append(RecordType::surfacing, payload(i), kUtc, kTick));
  REQUIRE(disk.files.get("/state/journal-000002.log"));
  const auto all = (*journal)->all();
  REQUIRE(all);
  REQUIRE(all->size() == 41);
  for (std::size_t i = 1; i <= 40; ++i)
    CHECK((*all)[i] ==
          JournalRecord{i + 1, 1, RecordType::surfacing, kUtc, kTick, kBoot, payload(static_cast<int>(i))});
}

TEST_CASE("types have stable numbers and names of their own") {
  const std::vector<std::pair<RecordType, int>> on_disk{
      {RecordType::epoch, 1},      {RecordType::event, 2},     {RecordType::surfacing, 10}, {RecordType::refusal, 11},
      {RecordType::duplicate, 12}, {RecordType::plan, 13},     {RecordType::verdict, 14},   {RecordType::proposal, 15},
      {RecordType::keep, 16},      {RecordType::emission, 17}, {RecordType::mission, 18},   {RecordType::alert, 19},
      {RecordType::command, 20},   {RecordType::intent, 30},   {RecordType::committed, 31}, {RecordType::aborted, 32},
      {RecordType::recovered, 33}};
  std::set<std::string_view> names;
  for (const auto& [type, number] : on_disk) {
    CHECK(static_cast<int>(type) == number);
    names.insert(word(type));
  }
  CHECK(names.size() == on_disk.size());
  CHECK(word(static_cast<RecordType>(999)) == "?");
}

TEST_CASE("a tail torn at any byte is set aside and cut, what was whole before it stays") {
  const auto whole = segment_of(4);
  const auto border = borders(whole);
  for (std::size_t cut = 33; cut <= whole.size(); ++cut) {
    JournalDisk disk;
    disk.files.put(kFirst, whole.substr(0, cut));
    auto journal = disk.open();
    REQUIRE(journal);
    const auto kept =
        static_cast<std::size_t>(std::upper_bound(border.begin(), border.end(), cut) - border.begin()) - 1;
    const bool clean = border[kept] == cut;
    CAPTURE(cut, kept);
    REQUIRE((*journal)->past().size() == kept);
    CHECK((*journal)->note().empty() == clean);
    CHECK(disk.files.get(fmt::format("/state/journal-000001.torn-{}", kept + 1)) ==
          (clean ? std::nullopt : std::optional{whole.substr(border[kept], cut - border[kept])}));
    REQUIRE((*journal)->append(RecordType::event, payload(9), kUtc, kTick, Durable::yes));
    journal->reset();
    auto again = disk.open();
    REQUIRE(again);
    CHECK(payloads(**again).back() == payload(9));
    CHECK((*again)->note().empty());
  }
}

TEST_CASE("a segment whose header never became whole is begun anew") {
  const auto whole = segment_of(1);
  for (std::size_t cut = 0; cut <= 32; ++cut) {
    JournalDisk disk;
    auto header = whole.substr(0, cut);
    if (cut == 32) header[20] = '\x7f';  // the length reached the disk, the bytes did not
    disk.files.put(kFirst, header);
    auto journal = disk.open();
    REQUIRE(journal);
    CHECK((*journal)->past().empty());
    REQUIRE((*journal)->append(RecordType::event, payload(1), kUtc, kTick, Durable::yes));
  }
}

TEST_CASE("one flipped bit in any record but the last is corruption, in the last a torn tail") {
  const auto whole = segment_of(3);
  const auto border = borders(whole);
  const auto last = border[border.size() - 2];
  std::size_t refused = 0;
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      JournalDisk disk;
      auto bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
      disk.files.put(kFirst, bytes);
      auto journal = disk.open();
      CAPTURE(at, bit);
      if (at < last) {
        REQUIRE_FALSE(journal);
        const bool version = at >= 8 && at < 12;  // of the segment: may be a newer one
        CHECK((journal.error().what == What::corrupt || (version && journal.error().what == What::newer)));
        CHECK_FALSE(journal.error().fatal);
        CHECK(disk.files.get(kFirst) == bytes);  // left as it was for a human to look at
        ++refused;
      } else {
        REQUIRE(journal);
        CHECK(payloads(**journal) == std::vector<std::string>{payload(0), payload(1)});
        CHECK_FALSE((*journal)->note().empty());
      }
    }
  CHECK(refused == last * 8);
}

TEST_CASE("what a killed process left unsynced is made durable by the next, and its rot is corruption from then on") {
  JournalDisk disk;
  {
    auto journal = disk.open({1U << 20, 4096});
    REQUIRE(journal);
    for (int i = 0; i < 3; ++i) REQUIRE((*journal)->append(RecordType::event, payload(i), kUtc, kTick));
  }
  disk.files.kill();
  const auto border = borders(*disk.files.get(kFirst));
  REQUIRE(disk.open({1U << 20, 4096}));
  CHECK(disk.files.durable(kFirst) == disk.files.get(kFirst));
  disk.files.kill();
  disk.files.rot(kFirst, [&](std::string& bytes) { bytes[border[2] + 90] ^= 1; });
  const auto journal = disk.open({1U << 20, 4096});
  REQUIRE_FALSE(journal);
  CHECK(journal.error().what == What::corrupt);
}

TEST_CASE("a clean stop can make everything durable") {
  JournalDisk disk;
  auto journal = disk.open();
  REQUIRE(journal);
  REQUIRE((*journal)->append(RecordType::event, payload(1), kUtc, kTick));
  CHECK(disk.files.durable(kFirst)->find(payload(1)) == std::string::npos);
  CHECK((*journal)->sync());
  CHECK(disk.files.durable(kFirst)->find(payload(1)) != std::string::npos);
}

TEST_CASE("a record that was cut out, repeated or put in from another journal breaks the chain") {
  const auto whole = segment_of(3);
  const auto border = borders(whole);
  const auto record = [&](std::size_t i) { return whole.substr(border[i], border[i + 1] - border[i]); };
  JournalDisk other;
  {
    auto journal = other.open({1U << 20, 4096});
    REQUIRE(journal);
    for (int i = 0; i < 3; ++i)
      REQUIRE((*journal)->append(RecordType::event, payload(i + 5), kUtc, kTick, Durable::yes));
  }
  const auto foreign = *other.files.get(kFirst);
  REQUIRE(borders(foreign) == border);
  const auto header = whole.substr(0, 32);
  for (const auto& bytes :
       {header + record(0) + record(2) + record(3), header + record(0) + record(1) + record(1) + record(2),
        header + record(0) + record(2) + record(1) + record(3),
        header + record(0) + foreign.substr(border[1], border[2] - border[1]) + record(2) + record(3)}) {
    JournalDisk disk;
    disk.files.put(kFirst, bytes);
    auto journal = disk.open();
    REQUIRE_FALSE(journal);
    CHECK(journal.error().what == What::corrupt);
    CHECK(journal.error().message.find("human") != std::string::npos);
  }
}

TEST_CASE("segments follow one another, and one that is missing or damaged at its end is corruption") {
  JournalDisk disk;
  std::vector<std::string> expected;
  {
    auto journal = disk.open();
    REQUIRE(journal);
    for (int i = 0; i < 60; ++i) {
      expected.push_back(payload(i));
      REQUIRE((*journal)->append(RecordType::event, payload(i), kUtc, kTick));
    }
  }
  const auto names = disk.files.names(kState);
  REQUIRE(std::count_if(names.begin(), names.end(), [](const auto& n) { return n.ends_with(".log"); }) >= 5);
  {
    auto journal = disk.open();
    REQUIRE(journal);
    CHECK(payloads(**journal) == expected);
  }
  const auto first = *disk.files.get(kFirst);
  disk.files.put(kFirst, first.substr(0, first.size() - 1));
  auto cut = disk.open();
  REQUIRE_FALSE(cut);
  CHECK(cut.error().what == What::corrupt);
  disk.files.put(kFirst, first);
  disk.files.take("/state/journal-000003.log");
  auto gap = disk.open();
  REQUIRE_FALSE(gap);
  CHECK(gap.error().what == What::corrupt);
  CHECK(gap.error().message.find("journal-000003.log") != std::string::npos);
}

TEST_CASE("segments of the real size end at 16 MiB") {
  JournalDisk disk;
  const std::string large(Journal::kMostPayload, 'y');
  {
    auto journal = disk.open({});
    REQUIRE(journal);
    for (int i = 0; i < 260; ++i) REQUIRE((*journal)->append(RecordType::event, large, kUtc, kTick));
  }
  CHECK(disk.files.get(kFirst)->size() >= Journal::kSegment);
  CHECK(disk.files.get(kFirst)->size() < Journal::kSegment + Journal::kMostPayload + 200);
  CHECK(disk.files.get("/state/journal.reserve")->size() == 1U << 20);
  auto journal = disk.open({});
  REQUIRE(journal);
  CHECK((*journal)->past().size() == 261);
  const auto more = (*journal)->append(RecordType::event, std::string(Journal::kMostPayload + 1, 'z'), kUtc, kTick);
  REQUIRE_FALSE(more);
  CHECK(more.error().what == What::too_long);
}

TEST_CASE("a newer journal is refused, not mended") {
  auto bytes = segment_of(2);
  const auto seal = [&](std::size_t from, std::size_t to) {  // CRC-32C of [from, to) behind it
    const auto crc = crc32c(std::string_view{bytes}.substr(from, to - from));
    for (std::size_t i = 0; i < 4; ++i) bytes[to + i] = static_cast<char>(crc >> 8 * i & 0xff);
  };
  SECTION("its segment") {
    bytes[8] = 2;
    seal(0, 28);
  }
  SECTION("a record of it") {
    const auto border = borders(bytes);
    bytes[border[2] + 4] = 2;
    seal(border[2], border[2] + 80);
    seal(border[2], border[3] - 4);
  }
  JournalDisk disk;
  disk.files.put(kFirst, bytes);
  auto journal = disk.open();
  REQUIRE_FALSE(journal);
  CHECK(journal.error().what == What::newer);
  CHECK(disk.files.get(kFirst) == bytes);
}

TEST_CASE("a journal has one writer") {
  JournalDisk disk;
  auto journal = disk.open();
  REQUIRE(journal);
  auto folder = disk.files.open_folder(kState).value();
  auto second = Journal::open(*folder, kUtc, kTick);
  REQUIRE_FALSE(second);
  CHECK(second.error().what == What::held);
  journal->reset();
  CHECK(Journal::open(*folder, kUtc, kTick));
}

TEST_CASE("a failed sync is fatal and is never tried again") {
  JournalDisk disk;
  auto journal = disk.open();
  REQUIRE(journal);
  disk.files.plan({Fault::What::error, 2, EIO, false});  // write, then fdatasync
  const auto failed = (*journal)->append(RecordType::intent, payload(1), kUtc, kTick, Durable::yes);
  REQUIRE_FALSE(failed);
  CHECK(failed.error().fatal);
  const auto after = disk.files.operations();
  for (const auto durable : {Durable::no, Durable::yes}) {
    const auto later = (*journal)->append(RecordType::event, payload(2), kUtc, kTick, durable);
    REQUIRE_FALSE(later);
    CHECK(later.error().fatal);
  }
  CHECK_FALSE((*journal)->sync());
  CHECK(disk.files.operations() == after);
}

TEST_CASE("on a full disk the journal says that it stops, refuses everything, and goes on when there is room") {
  JournalDisk disk;
  auto journal = disk.open();
  REQUIRE(journal);
  REQUIRE((*journal)->append(RecordType::event, payload(1), kUtc, kTick));
  // The first write of the record meets the full disk; giving up the reserve makes room for one more.
  disk.files.plan({Fault::What::short_write, 1, ENOSPC, false});
  const auto refused = (*journal)->append(RecordType::intent, payload(2), kUtc, kTick, Durable::yes);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().what == What::no_space);
  CHECK_FALSE(refused.error().fatal);
  CHECK((*journal)->full());
  CHECK_FALSE(disk.files.get("/state/journal.reserve"));
  CHECK(disk.files.durable(kFirst)->find("stopped: no space") != std::string::npos);
  CHECK(disk.files.durable(kFirst)->find(payload(2)) == std::string::npos);
  // Still full: the reserve cannot be had back, so nothing is recorded.
  disk.files.plan({Fault::What::error, 1, ENOSPC, true});
  const auto still = (*journal)->append(RecordType::event, payload(3), kUtc, kTick);
  REQUIRE_FALSE(still);
  CHECK(still.error().what == What::no_space);
  disk.files.plan_nothing();
  REQUIRE((*journal)->append(RecordType::event, payload(4), kUtc, kTick, Durable::yes));
  CHECK_FALSE((*journal)->full());
  journal->reset();
  auto again = disk.open();
  REQUIRE(again);
  CHECK(payloads(**again) ==
        std::vector<std::string>{payload(1), R"({"code":"no-space","text":"stopped: no space for the journal"})",
                                 payload(4)});
}

TEST_CASE("a segment that cannot be opened is not replaced by the old one") {
  JournalDisk disk;
  auto journal = disk.open();
  REQUIRE(journal);
  std::vector<std::string> expected;
  int refused = 0;
  disk.files.before_each = [&](const std::string& operation, const std::string& path) {
    if (operation == "open" && path == "/state/journal-000002.log" && refused == 0)
      disk.files.plan({Fault::What::error, 1, EMFILE, false});
  };
  for (int i = 0; i < 30; ++i) {
    if ((*journal)->append(RecordType::event, payload(i), kUtc, kTick, Durable::yes))
      expected.push_back(payload(i));
    else
      ++refused;
  }
  CHECK(refused == 1);
  CHECK(disk.files.get(kFirst)->size() < kSmall.segment + 200);  // nothing was put behind its end
  journal->reset();
  auto again = disk.open();
  REQUIRE(again);
  CHECK(payloads(**again) == expected);
}

namespace {

struct Played {
  std::vector<std::string> accepted;  ///< append said yes, in order
  std::size_t durable{};              ///< so many of them must survive a power cut
  bool fatal{};
};

/// A process: opens, appends 24 records of which every third is durable, over a segment border.
Played play(JournalDisk& disk, std::vector<std::string> before) {
  Played played;
  played.accepted = std::move(before);
  played.durable = played.accepted.size();
  const auto keep = [&](bool sure) {
    if (sure) played.durable = played.accepted.size();
  };
  try {
    auto journal = disk.open();
    if (!journal) {
      played.fatal = journal.error().fatal;
      return played;
    }
    for (int i = 0; i < 24; ++i) {
      const bool sure = i % 3 == 2;
      const auto done =
          (*journal)->append(RecordType::event, payload(100 + i), kUtc, kTick, sure ? Durable::yes : Durable::no);
      if (done) {
        played.accepted.push_back(payload(100 + i));
        keep(sure);
      } else if (done.error().fatal) {
        played.fatal = true;
        return played;
      }
    }
  } catch (const PowerCut&) {
  }
  return played;
}

bool is_prefix(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return a.size() <= b.size() && std::equal(a.begin(), a.end(), b.begin());
}

/// Our records without the journal's own words.
std::vector<std::string> ours(const Journal& journal) {
  auto result = payloads(journal);
  result.erase(std::remove_if(result.begin(), result.end(),
                              [](const auto& p) { return p.find("stopped: no space") != std::string::npos; }),
               result.end());
  return result;
}

std::size_t operations_of_play() {
  JournalDisk disk;
  disk.files.plan({Fault::What::error, 1U << 30, EIO, false});
  static_cast<void>(play(disk, {}));
  return disk.files.operations();
}

}  // namespace

TEST_CASE("power cut at any operation: what was acknowledged survives, the rest is a beginning of what was said") {
  std::size_t points = 0, violations = 0;
  const auto operations = operations_of_play();
  for (std::size_t at = 1; at <= operations; ++at)
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      JournalDisk disk;
      disk.files.plan({Fault::What::power_cut, at, 0, false});
      const auto first = play(disk, {});
      disk.files.cut_power(seed);
      // A second process appends more, after which the power is cut again; then everything is read.
      std::vector<std::string> kept;
      {
        auto journal = disk.open();
        if (!journal) {
          ++violations;
          continue;
        }
        kept = ours(**journal);
      }
      // The last record may have been written and not yet acknowledged.
      auto all = first.accepted;
      if (kept.size() > all.size() && all.size() < 24) all.push_back(payload(100 + static_cast<int>(all.size())));
      if (!is_prefix(kept, all) || kept.size() < first.durable) ++violations;
      const auto second = play(disk, kept);
      disk.files.cut_power(seed == 0 ? 0 : seed + 100);
      auto journal = disk.open();
      if (!journal || !is_prefix(ours(**journal), second.accepted) || ours(**journal).size() < second.durable)
        ++violations;
      ++points;
    }
  std::cout << "journal power cuts: points=" << points << " violations=" << violations << std::endl;
  CHECK(points >= 500);
  CHECK(violations == 0);
}

TEST_CASE(
    "an operation that fails, once or for ever, loses nothing that was acknowledged and adds nothing that was not") {
  std::size_t points = 0, violations = 0;
  const auto operations = operations_of_play();
  for (std::size_t at = 1; at <= operations; ++at)
    for (const int code : {EIO, ENOSPC, EDQUOT, EROFS, EMFILE})
      for (const auto what : {Fault::What::error, Fault::What::short_write})
        for (const bool for_ever : {false, true}) {
          JournalDisk disk;
          disk.files.plan({what, at, code, for_ever});
          const auto first = play(disk, {});
          disk.files.plan_nothing();
          // Killed and started again: everything that was accepted is there. After a fatal error the power goes, too.
          if (first.fatal)
            disk.files.cut_power(at);
          else
            disk.files.kill();
          auto journal = disk.open();
          ++points;
          if (!journal) {
            ++violations;
            continue;
          }
          const auto kept = ours(**journal);
          // After a failed sync what was appended may be there or not, and one record more than was acknowledged.
          const bool right = first.fatal ? kept.size() >= first.durable && kept.size() <= first.accepted.size() + 1
                                         : kept == first.accepted;
          if (!right) ++violations;
        }
  std::cout << "journal faults: points=" << points << " violations=" << violations << std::endl;
  CHECK(points >= 1000);
  CHECK(violations == 0);
}
