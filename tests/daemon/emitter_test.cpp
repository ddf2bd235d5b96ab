#include "daemon/emitter.hpp"

#include <catch2/catch.hpp>
#include <cerrno>
#include <nlohmann/json.hpp>

#include "tests/support/dock.hpp"

using namespace glidehelm;
using namespace glidehelm::daemon;
using glidehelm::test::Dock;
using glidehelm::test::MemoryFiles;
using Outcome = Emission::Outcome;
using What = FolderView::What;
using Fault = MemoryFiles::Fault;

namespace {

std::vector<JournalRecord> journalled(Dock& dock) {
  dock.stop();
  auto folder = dock.files.open_folder(Dock::kState).value();
  return Journal::open(*folder, {}, {}, {}, {1U << 20, 4096}).value()->past();
}

std::vector<RecordType> types(const std::vector<JournalRecord>& records) {
  std::vector<RecordType> result;
  for (const auto& r : records)
    if (r.type != RecordType::epoch) result.push_back(r.type);
  return result;
}

}  // namespace

TEST_CASE("a proven file comes into an empty folder, with INTENT before and COMMITTED after") {
  Dock dock;
  REQUIRE(dock.start().empty());
  CHECK(dock.emitter->inspect().what == What::nothing);
  const auto emission = dock.emit("list 1", "0007.0003");
  CHECK(emission.outcome == Outcome::queued);
  CHECK(emission.detail == "goto_l10.ma is queued in /dock/sim01/to-glider");
  CHECK(dock.visible() == "list 1");
  CHECK(dock.emitter->inspect().what == What::ours);
  CHECK(dock.leftovers().empty());

  const auto records = journalled(dock);
  REQUIRE(types(records) == std::vector{RecordType::intent, RecordType::committed});
  const auto intent = nlohmann::json::parse(records[1].payload);
  CHECK(intent["glider"] == "sim01");
  CHECK(intent["surfacing"] == "0007.0003");
  CHECK(intent["plan"] == "plan-1");
  CHECK(intent["bytes"] == "list 1");
  CHECK(intent["sha256"] == Sha256::of("list 1").hex());
  CHECK(intent["replaces"] == "absent");
  CHECK(intent["margins"].size() == safety::rules().size());
  const auto committed = nlohmann::json::parse(records[2].payload);
  CHECK(committed["intent"] == records[1].sequence);
  CHECK(committed["inode"] != 0);
}

TEST_CASE("our own file that still lies there is exchanged for the next one") {
  Dock dock;
  REQUIRE(dock.start().empty());
  REQUIRE(dock.emit("list 1", "a").outcome == Outcome::queued);
  REQUIRE(dock.emit("list 2", "b").outcome == Outcome::queued);
  CHECK(dock.visible() == "list 2");
  CHECK(dock.leftovers().empty());
  SECTION("after a restart, too") {
    REQUIRE(dock.start().empty());
    CHECK(dock.recovered.empty());
    CHECK(dock.emitter->inspect().what == What::ours);
    CHECK(dock.emit("list 3", "c").outcome == Outcome::queued);
    CHECK(dock.visible() == "list 3");
  }
  SECTION("but not one of ours that a human has brought back") {
    dock.files.put(Dock::kFile, "list 1");
    CHECK(dock.emitter->inspect().what == What::foreign);
    CHECK(dock.emit("list 3", "c").outcome == Outcome::foreign_file);
    CHECK(dock.visible() == "list 1");
  }
}

TEST_CASE("a file that we did not write is left alone, and who wrote it is said") {
  Dock dock;
  REQUIRE(dock.start().empty());
  dock.files.put(Dock::kFile, "by hand", 1042);
  const auto view = dock.emitter->inspect();
  CHECK(view.what == What::foreign);
  CHECK(view.detail.find("goto_l10.ma of uid 1042, written ") == 0);
  CHECK(view.detail.find(Sha256::of("by hand").hex().substr(0, 12)) != std::string::npos);
  const auto emission = dock.emit("list 1", "a");
  CHECK(emission.outcome == Outcome::foreign_file);
  CHECK(emission.detail == view.detail);
  CHECK(dock.visible() == "by hand");
  CHECK(types(journalled(dock)).empty());
}

TEST_CASE("names are compared as DOS does, other slots and other files are nobody's business") {
  Dock dock;
  REQUIRE(dock.start().empty());
  for (const char* name : {"/goto_l11.ma", "/yo10.ma", "/goto_l10.ma.bak", "/xgoto_l10.ma"})
    dock.files.put(std::string{Dock::kTarget} + name, "of somebody");
  CHECK(dock.emitter->inspect().what == What::nothing);
  dock.files.put(std::string{Dock::kTarget} + "/GOTO_L10.MA", "by hand");
  CHECK(dock.emitter->inspect().what == What::foreign);
  CHECK(dock.emit("list 1", "a").outcome == Outcome::foreign_file);
  dock.files.take(std::string{Dock::kTarget} + "/GOTO_L10.MA");
  CHECK(dock.emit("list 1", "a").outcome == Outcome::queued);
  CHECK(dock.files.names(Dock::kTarget).size() == 5);
}

TEST_CASE("the slot may change: the file under the old name stays as it is") {
  Dock dock;
  REQUIRE(dock.start().empty());
  REQUIRE(dock.emit("list 1", "a").outcome == Outcome::queued);
  dock.emitter->set_slot(7);
  CHECK(dock.emitter->file_name() == "goto_l07.ma");
  CHECK(dock.emitter->inspect().what == What::nothing);
  const auto staged = dock.emitter->stage("list 2", 100).value();
  SECTION("a file judged for another slot is refused") {
    CHECK(dock.emitter->emit(Dock::proven("list 2"), staged, dock.order("b"), *dock.journal, dock.clock).outcome ==
          Outcome::aborted);
  }
  SECTION("a file of the new slot goes out") {
    CHECK(dock.emitter->emit(Dock::proven("list 2", "goto_l07.ma"), staged, dock.order("b"), *dock.journal, dock.clock)
              .outcome == Outcome::queued);
    CHECK(dock.visible() == "list 1");
    dock.emitter->set_slot(10);
    CHECK(dock.emitter->inspect().what == What::ours);
  }
}

TEST_CASE("what was staged must be what was judged") {
  Dock dock;
  REQUIRE(dock.start().empty());
  const auto staged = dock.emitter->stage("list 1", 1).value();
  CHECK(dock.emitter->open_staged(staged).value()->read_all(100).value() == "list 1");
  SECTION("other bytes") { dock.files.put(std::string{Dock::kStage} + "/" + staged, "list 2"); }
  SECTION("no file") { dock.emitter->discard(staged); }
  const auto emission = dock.emitter->emit(Dock::proven("list 1"), staged, dock.order("a"), *dock.journal, dock.clock);
  CHECK(emission.outcome == Outcome::aborted);
  CHECK_FALSE(dock.visible());
}

TEST_CASE("what forbids an emission is looked at again once INTENT is durable") {
  Dock dock;
  REQUIRE(dock.start().empty());
  const auto staged = dock.emitter->stage("list 1", 1).value();
  std::function<void()> happens;
  Outcome expected = Outcome::aborted;
  std::string word;
  SECTION("the window closes while the disk is slow") {
    happens = [&] { dock.clock.advance(Seconds{301}); };
    expected = Outcome::late;
    word = "window";
  }
  SECTION("a human says HOLD") {
    happens = [&] { dock.files.put(std::string{Dock::kStage} + "/HOLD", ""); };
    word = "HOLD";
  }
  SECTION("a transfer begins") {
    happens = [&] { dock.emitter->set_transfer_open(true); };
    word = "transfer";
  }
  SECTION("another process has counted its epoch") {
    happens = [&] { dock.files.put(std::string{Dock::kStage} + "/epoch", "2\n"); };
    word = "epoch";
  }
  SECTION("the folder is moved away and another one made") {
    happens = [&] {
      dock.files.move_folder(Dock::kTarget, "/dock/sim01/old");
      dock.files.make_folder_at(Dock::kTarget);
    };
    word = "replaced";
  }
  SECTION("the staging folder is moved away") {
    happens = [&] {
      dock.files.move_folder(Dock::kStage, "/dock/sim01/old");
      dock.files.make_folder_at(Dock::kStage);
    };
    word = "staging";
  }
  SECTION("nobody can tell whether there is a HOLD") {
    happens = [&] { dock.files.plan({Fault::What::error, 2, EIO, false}); };
    word = "HOLD: Input/output error";
  }
  dock.files.before_each = [&](const std::string& operation, const std::string&) {
    if (operation == "fdatasync" && happens) std::exchange(happens, nullptr)();
  };
  const auto emission = dock.emitter->emit(Dock::proven("list 1"), staged, dock.order("a"), *dock.journal, dock.clock);
  dock.files.before_each = nullptr;
  dock.files.plan_nothing();
  CHECK(emission.outcome == expected);
  CHECK(emission.detail.find(word) != std::string::npos);
  CHECK_FALSE(emission.fatal);
  CHECK_FALSE(dock.visible());
  CHECK(types(journalled(dock)) == std::vector{RecordType::intent, RecordType::aborted});
}

TEST_CASE("an emission after its deadline writes nothing at all") {
  Dock dock;
  REQUIRE(dock.start().empty());
  const auto staged = dock.emitter->stage("list 1", 1).value();
  const auto emission =
      dock.emitter->emit(Dock::proven("list 1"), staged, dock.order("a", Seconds{0}), *dock.journal, dock.clock);
  CHECK(emission.outcome == Outcome::late);
  CHECK(types(journalled(dock)).empty());
}

TEST_CASE("a journal that cannot be written keeps the file from being visible") {
  Dock dock;
  REQUIRE(dock.start().empty());
  const auto staged = dock.emitter->stage("list 1", 1).value();
  dock.files.before_each = [&](const std::string& operation, const std::string& path) {
    if (operation == "write" && path.find("journal-0") != std::string::npos)
      dock.files.plan({Fault::What::error, 1, ENOSPC, true});
  };
  const auto emission = dock.emitter->emit(Dock::proven("list 1"), staged, dock.order("a"), *dock.journal, dock.clock);
  CHECK(emission.outcome == Outcome::aborted);
  CHECK(emission.detail.find("full") != std::string::npos);
  CHECK_FALSE(dock.visible());
}

TEST_CASE("every start counts one epoch, and one process flies a glider") {
  Dock dock;
  REQUIRE(dock.start().empty());
  CHECK(dock.emitter->epoch() == 1);
  const auto second = Emitter::open(dock.files, Dock::kTarget, 10, false);
  REQUIRE_FALSE(second);
  CHECK(second.error().find("held by another process") != std::string::npos);
  dock.files.kill();
  REQUIRE(dock.start().empty());
  CHECK(dock.emitter->epoch() == 2);
  dock.stop();
  dock.files.put(std::string{Dock::kStage} + "/epoch", "two\n");
  CHECK(dock.start().find("holds no number") != std::string::npos);
}

TEST_CASE("a folder that cannot be used is refused with the reason, and nothing is made in it") {
  Dock dock;
  std::string path = Dock::kTarget, word;
  bool marker = false;
  SECTION("not there") {
    path = "/dock/sim02/to-glider";
    word = "No such file";
  }
  SECTION("on another file system") {
    dock.files.make_folder_at(Dock::kTarget, 2);
    word = "another file system";
  }
  SECTION("not writable") {
    dock.files.make_folder_at(Dock::kTarget, 1, 0550);
    word = "Permission denied";
  }
  SECTION("everybody may write where we stage") {
    dock.files.make_folder_at(Dock::kStage, 1, 0777);
    word = "everybody may write";
  }
  SECTION("not made by the simulator that gives the time") {
    marker = true;
    word = ".glidersim";
  }
  const auto emitter = Emitter::open(dock.files, path, 10, marker);
  REQUIRE_FALSE(emitter);
  CAPTURE(emitter.error());
  CHECK(emitter.error().find("to_glider " + path + ": ") == 0);
  CHECK(emitter.error().find(word) != std::string::npos);
  CHECK(dock.files.names(Dock::kTarget).empty());
}

TEST_CASE("a folder that the simulator made may be written in simulated time") {
  Dock dock;
  dock.files.put("/dock/sim01/.glidersim", "");
  CHECK(Emitter::open(dock.files, std::string{Dock::kTarget} + "/", 10, true));
}
