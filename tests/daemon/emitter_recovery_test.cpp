#include <catch2/catch.hpp>
#include <cerrno>
#include <iostream>
#include <map>

#include "tests/support/dock.hpp"

using namespace glidehelm;
using namespace glidehelm::daemon;
using glidehelm::test::Dock;
using glidehelm::test::MemoryFiles;
using glidehelm::test::PowerCut;
using Outcome = Emission::Outcome;
using What = FolderView::What;
using Fault = MemoryFiles::Fault;

// Every operation of a process that starts and emits is made to fail, to be the last one before the process is killed, or
// the last one before the power is cut; after each the process starts again. The observer knows nothing of the
// emitter: it sees the folder, the bytes of the journal and what was acknowledged (trust.md 6.1, T-7, T-8).

namespace {

const std::string kOld = "the list before", kNew = "the new list", kHuman = "a human's list", kNext = "the next list";

enum class Before { nothing, ours };
enum class Who { nobody, human, dockserver };

struct Case {
  Before before{};
  Who who{};               ///< and who interferes
  std::size_t when{};      ///< before which operation
  Fault fault;             ///< at = 0: none
  std::uint64_t power{1};  ///< seed of the power cut after it; 1: killed only
  Fault in_recovery{};     ///< at = 0: none
  std::uint64_t power_again{1};
};

struct Observer {
  Dock dock;
  Case c;
  bool interfered{}, acknowledged{}, taken{};
  std::string what_went_wrong;
  std::optional<Emission> emission;

  explicit Observer(Case chosen) : c{std::move(chosen)} {
    if (c.before == Before::ours) {
      if (!dock.start().empty() || dock.emit(kOld, "before").outcome != Outcome::queued) wrong("no beginning");
      dock.stop();
    }
  }

  void wrong(const std::string& what) {
    if (what_went_wrong.empty()) what_went_wrong = what;
  }

  /// At every instant: one name at most, always a whole file, the new one only behind a durable INTENT.
  void look() {
    const auto names = dock.files.names(Dock::kTarget);
    if (!names.empty() && names != std::vector<std::string>{"goto_l10.ma"}) wrong("another name in to-glider");
    const auto visible = dock.visible();
    if (!visible) return;
    if (*visible != kOld && *visible != kNew && *visible != kHuman && *visible != kNext)
      wrong("a torn or strange file");
    if (*visible == kNew) {
      const auto journal = dock.files.durable("/state/journal-000001.log").value_or("");
      if (journal.find(Sha256::of(kNew).hex()) == std::string::npos) wrong("visible before INTENT is durable");
    }
  }

  /// Starts a process that emits `kNew`, with the case's fault and interference.
  void run() {
    std::size_t count = 0;
    dock.files.before_each = [&](const std::string&, const std::string&) {
      if (++count == c.when) interfere();
      look();
    };
    dock.files.plan(c.fault.at > 0 ? c.fault : Fault{Fault::What::error, 1U << 30, 0, false});
    try {
      if (dock.start().empty()) emission = dock.emit(kNew, "0007.0003");
      // Life goes on, and makes durable what the journal says of it.
      if (emission && !emission->fatal)
        static_cast<void>(
            dock.journal->append(RecordType::event, "{}", dock.clock.utc(), dock.clock.tick(), Journal::Durable::yes));
    } catch (const PowerCut&) {
    }
    operations = dock.files.operations();
    acknowledged = emission && emission->outcome == Outcome::queued;
    dock.files.before_each = nullptr;
    look();
  }
  void interfere() {
    interfered = true;
    if (c.who == Who::human) dock.files.put(Dock::kFile, kHuman);
    if (c.who == Who::dockserver && dock.visible()) {
      taken = taken || *dock.visible() == kNew;
      dock.files.take(Dock::kFile);
    }
  }

  void lose(std::uint64_t power) {
    dock.stop();
    if (power == 1)
      dock.files.kill();
    else
      dock.files.cut_power(power);
  }

  /// The process starts again, perhaps to die again, until it lives.
  void recover() {
    lose(c.power);
    look();
    if (c.in_recovery.at > 0) {
      dock.files.before_each = [&](const std::string&, const std::string&) { look(); };
      dock.files.plan(c.in_recovery);
      try {
        static_cast<void>(dock.start());
      } catch (const PowerCut&) {
      }
      recovery_operations = dock.files.operations();
      dock.files.before_each = nullptr;
      lose(c.power_again);
      look();
    }
    if (const auto problem = dock.start(); !problem.empty()) wrong("cannot start again: " + problem);
  }

  /// What must be so once a process lives again.
  void judge() {
    if (!dock.emitter) return;
    look();
    const auto visible = dock.visible();
    const bool human = c.who == Who::human && interfered;
    const bool gone = c.who == Who::dockserver && interfered;
    if (human && visible != kHuman) wrong("a human's file is gone");
    if (acknowledged && !human && !gone && visible != kNew) wrong("an acknowledged file is gone");
    if (!visible && !gone && c.before == Before::ours) wrong("our old file is gone");
    if (!dock.leftovers().empty()) wrong("files are left in the staging folder");
    const auto view = dock.emitter->inspect();
    const auto expected = !visible ? What::nothing : *visible == kHuman ? What::foreign : What::ours;
    if (view.what != expected) wrong("what lies there is not known for what it is");
    for (const auto& r : dock.recovered) {
      const auto outcome = r.emission.outcome;
      if (outcome == Outcome::queued && visible != kNew) wrong("queued, says recovery, and it is not");
      if (outcome == Outcome::aborted && (visible == kNew || taken)) wrong("aborted, says recovery, and it was not");
      if (outcome == Outcome::unknown && !gone) wrong("unknown, says recovery, and nobody took it");
      if (r.surfacing != "0007.0003") wrong("another surfacing was settled");
    }
    const bool settled_as_queued = visible == kNew;
    again(settled_as_queued);
  }

  /// Idempotent: another start settles nothing more and changes nothing; and then the next file goes out.
  void again(bool new_is_there) {
    const auto before = dock.visible();
    dock.files.kill();
    if (!dock.start().empty() || !dock.recovered.empty() || dock.visible() != before)
      wrong("a second recovery does something");
    std::map<std::uint64_t, int> ends;
    std::size_t emitted = 0;
    for (const auto& record : dock.past) {
      if (record.type == RecordType::committed && record.payload.find("0007.0003") != std::string::npos) ++emitted;
    }
    if (emitted > 1) wrong("two COMMITTED for one surfacing");
    if (new_is_there && emitted != 1) wrong("visible and not COMMITTED");
    const auto next = dock.emit(kNext, "0007.0004");
    const auto wanted = before == kHuman ? Outcome::foreign_file : Outcome::queued;
    if (next.outcome != wanted) wrong("the next file does not go out: " + next.detail);
    if (before == kHuman && dock.visible() != kHuman) wrong("a human's file was overwritten later");
  }
  std::size_t operations{}, recovery_operations{};
};

struct Tally {
  std::size_t points{}, violations{};
  std::map<std::string, std::size_t> reasons;
  void add(Case c) {
    Observer observer{c};
    observer.run();
    observer.recover();
    observer.judge();
    ++points;
    if (observer.what_went_wrong.empty()) return;
    ++violations;
    if (++reasons[observer.what_went_wrong] == 1)
      std::cout << "first of its kind: before=" << static_cast<int>(c.before) << " who=" << static_cast<int>(c.who)
                << " when=" << c.when << " fault=" << static_cast<int>(c.fault.what) << "@" << c.fault.at << " code "
                << c.fault.code << (c.fault.for_ever ? " for ever" : "") << " power=" << c.power << " in_recovery@"
                << c.in_recovery.at << " power_again=" << c.power_again << ": " << observer.what_went_wrong << "\n";
  }
  void print(const std::string& what) const {
    std::cout << what << ": points=" << points << " violations=" << violations << std::endl;
  }
};

/// How many operations a process takes that starts and emits, and after how many it begins to stage.
std::size_t operations_of(Before before) {
  Observer observer{Case{before, Who::nobody, 0, {}, 1, {}, 1}};
  observer.run();
  REQUIRE(observer.acknowledged);
  return observer.operations;
}
std::size_t operations_of_start(Before before) {
  Observer observer{Case{before, Who::nobody, 0, {}, 1, {}, 1}};
  observer.dock.files.plan({Fault::What::error, 1U << 30, 0, false});
  REQUIRE(observer.dock.start().empty());
  return observer.dock.files.operations();
}

}  // namespace

TEST_CASE("killed or without power at any operation: never torn, never early, never lost, never twice") {
  Tally tally;
  for (const auto before : {Before::nothing, Before::ours}) {
    const auto last = operations_of(before) + 1;  // one behind the end: after the acknowledgement
    for (std::size_t at = 1; at <= last; ++at)
      for (std::uint64_t power = 0; power < 16; ++power)
        tally.add({before, Who::nobody, 0, {Fault::What::power_cut, at, 0, false}, power, {}, 1});
  }
  tally.print("emission, crash points");
  CHECK(tally.points >= 1500);
  CHECK(tally.violations == 0);
}

TEST_CASE("any operation that fails, once or for ever: the same promises") {
  Tally tally;
  for (const auto before : {Before::nothing, Before::ours}) {
    const auto last = operations_of(before);
    for (std::size_t at = 1; at <= last; ++at)
      for (const int code : {EIO, ENOSPC, EROFS, EDQUOT, EMFILE})
        for (const auto what : {Fault::What::error, Fault::What::short_write})
          for (const bool for_ever : {false, true})
            for (const std::uint64_t power : {1U, 2U})
              tally.add({before, Who::nobody, 0, {what, at, code, for_ever}, power, {}, 1});
  }
  tally.print("emission, failing operations");
  CHECK(tally.points >= 1500);
  CHECK(tally.violations == 0);
}

TEST_CASE("a human's file that appears at any instant stays, whatever fails beside it") {
  Tally tally;
  for (const auto before : {Before::nothing, Before::ours}) {
    const auto first = operations_of_start(before), last = operations_of(before);
    for (auto when = first + 1; when <= last; ++when) {
      for (std::uint64_t power = 0; power < 16; ++power) tally.add({before, Who::human, when, {}, power, {}, 1});
      for (auto at = when; at <= last + 4; ++at) {
        for (const std::uint64_t power : {0U, 1U, 2U, 3U})
          tally.add({before, Who::human, when, {Fault::What::power_cut, at, 0, false}, power, {}, 1});
        // Soon after the exchange, many ways in which the power may go: between the two exchanges is where it hurts.
        const std::uint64_t powers = before == Before::ours && at <= when + 6 ? 16 : 3;
        for (std::uint64_t power = 1; power <= powers; ++power)
          tally.add({before, Who::human, when, {Fault::What::error, at, EIO, false}, power, {}, 1});
        tally.add({before, Who::human, when, {Fault::What::error, at, EIO, true}, 3, {}, 1});
      }
    }
  }
  tally.print("emission, a human interferes");
  CHECK(tally.points >= 1500);
  CHECK(tally.violations == 0);
}

TEST_CASE("a dockserver that takes the file at any instant is never given it twice") {
  Tally tally;
  for (const auto before : {Before::nothing, Before::ours}) {
    const auto first = operations_of_start(before), last = operations_of(before);
    for (auto when = first + 1; when <= last; ++when) {
      tally.add({before, Who::dockserver, when, {}, 1, {}, 1});
      for (auto at = when; at <= last + 4; ++at)
        for (const std::uint64_t power : {0U, 1U, 2U, 3U})
          tally.add({before, Who::dockserver, when, {Fault::What::power_cut, at, 0, false}, power, {}, 1});
    }
  }
  tally.print("emission, the dockserver takes it");
  CHECK(tally.points >= 1500);
  CHECK(tally.violations == 0);
}

TEST_CASE("recovery that is itself killed at any operation ends where it would have ended") {
  Tally tally;
  for (const auto before : {Before::nothing, Before::ours}) {
    const auto first = operations_of_start(before), last = operations_of(before);
    for (auto at = first + 1; at <= last; ++at)
      for (const std::uint64_t power : {1U, 3U}) {
        Observer trial{{before,
                        Who::nobody,
                        0,
                        {Fault::What::power_cut, at, 0, false},
                        power,
                        {Fault::What::error, 1U << 30, 0, false},
                        1}};
        trial.run();
        trial.recover();
        for (std::size_t then = 1; then <= trial.recovery_operations; ++then) {
          tally.add({before,
                     Who::nobody,
                     0,
                     {Fault::What::power_cut, at, 0, false},
                     power,
                     {Fault::What::error, then, EIO, false},
                     1});
          for (const std::uint64_t power_again : {0U, 4U})
            tally.add({before,
                       Who::nobody,
                       0,
                       {Fault::What::power_cut, at, 0, false},
                       power,
                       {Fault::What::power_cut, then, 0, false},
                       power_again});
        }
      }
  }
  tally.print("recovery, crash points");
  CHECK(tally.points >= 1500);
  CHECK(tally.violations == 0);
}

TEST_CASE("a human's file that an exchange had swapped out when the power failed goes back") {
  // By hand, what a crash between the two exchanges leaves: ours visible, the human's file staged.
  Dock dock;
  REQUIRE(dock.start().empty());
  REQUIRE(dock.emit(kOld, "before").outcome == Outcome::queued);
  dock.files.before_each = [&](const std::string& operation, const std::string& path) {
    if (operation != "rename" || path.find(".glidehelm/.goto") == std::string::npos) return;
    dock.files.put(Dock::kFile, kHuman);
    // The exchange is the next operation, the look at what came out the one after it.
    dock.files.before_each = nullptr;
    dock.files.plan({Fault::What::power_cut, 2, 0, false});
  };
  REQUIRE_THROWS_AS(dock.emit(kNew, "0007.0003"), PowerCut);
  CHECK(dock.visible() == kNew);
  dock.stop();
  dock.files.kill();
  REQUIRE(dock.start().empty());
  REQUIRE(dock.recovered.size() == 1);
  CHECK(dock.recovered[0].emission.outcome == Outcome::foreign_file);
  CHECK(dock.visible() == kHuman);
  CHECK(dock.emitter->inspect().what == What::foreign);
  CHECK(dock.leftovers().empty());
}

TEST_CASE("what the crash left decides what recovery says") {
  Dock dock;
  REQUIRE(dock.start().empty());
  std::string stop_before, word;
  Outcome expected{};
  bool takes = false;
  SECTION("before the rename: aborted") {
    stop_before = "rename";
    expected = Outcome::aborted;
    word = "before the file was visible";
  }
  SECTION("after it: queued") {
    stop_before = "fsync";
    expected = Outcome::queued;
    word = "is queued";
  }
  SECTION("after it, and taken: only the dialog will tell") {
    stop_before = "fsync";
    takes = true;
    expected = Outcome::unknown;
    word = "Waypoint:";
  }
  bool intent = false;
  dock.files.before_each = [&](const std::string& operation, const std::string&) {
    if (operation == "fdatasync") intent = true;
    if (intent && operation == stop_before) dock.files.plan({Fault::What::power_cut, 1, 0, false});
  };
  REQUIRE_THROWS_AS(dock.emit(kNew, "0007.0003"), PowerCut);
  dock.files.before_each = nullptr;
  dock.stop();
  dock.files.kill();
  if (takes) dock.files.take(Dock::kFile);
  REQUIRE(dock.start().empty());
  REQUIRE(dock.recovered.size() == 1);
  CHECK(dock.recovered[0].surfacing == "0007.0003");
  CHECK(dock.recovered[0].emission.outcome == expected);
  CHECK(dock.recovered[0].emission.detail.find(word) != std::string::npos);
}

TEST_CASE("a staged file that somebody removed does not make our own file foreign") {
  Dock dock;
  REQUIRE(dock.start().empty());
  REQUIRE(dock.emit(kOld, "before").outcome == Outcome::queued);
  dock.files.before_each = [&](const std::string& operation, const std::string& path) {
    if (operation == "rename" && path.find(".glidehelm/.goto") != std::string::npos)
      dock.files.plan({Fault::What::power_cut, 1, 0, false});
  };
  REQUIRE_THROWS_AS(dock.emit(kNew, "0007.0003"), PowerCut);
  dock.files.before_each = nullptr;
  dock.stop();
  dock.files.kill();
  REQUIRE(dock.leftovers().size() == 1);
  dock.files.take(std::string{Dock::kStage} + "/" + dock.leftovers()[0]);
  REQUIRE(dock.start().empty());
  REQUIRE(dock.recovered.size() == 1);
  CHECK(dock.recovered[0].emission.outcome == Outcome::aborted);
  CHECK(dock.emitter->inspect().what == What::ours);
}

TEST_CASE("records of other gliders and records that are no JSON settle nothing") {
  Dock dock;
  REQUIRE(dock.start().empty());
  const auto hash = Sha256::of(kNew).hex();
  for (const auto& payload :
       {std::string{"[1, 2]"}, std::string{"no json"}, std::string{R"({"glider": 7})"},
        R"({"glider": "other", "surfacing": "a", "name": "goto_l10.ma", "staged": "x.tmp", "sha256": ")" + hash + "\"}",
        std::string{R"({"glider": "sim01", "sha256": "short"})"}})
    REQUIRE(dock.journal->append(RecordType::intent, payload, dock.clock.utc(), dock.clock.tick()));
  REQUIRE(dock.start().empty());
  CHECK(dock.recovered.empty());
}
