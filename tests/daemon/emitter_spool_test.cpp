#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "daemon/emitter.hpp"
#include "daemon/world/real_files.hpp"
#include "tests/simulator/temp_folder.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/verdict.hpp"

// The emitter on the machine's own file system: what somebody with rights on the dockserver's folders may do (trust.md I-12,
// I-13, I-15, I-16), and a process that is really killed.

using namespace glidehelm;
using namespace glidehelm::daemon;
using Outcome = Emission::Outcome;
using What = FolderView::What;
namespace fs = std::filesystem;

namespace {

struct Spool {
  test::TempFolder temp;
  fs::path glider{temp.path / "sim01"}, target{glider / "to-glider"}, stage{glider / ".glidehelm"};
  world::RealFiles files;
  test::ManualClock clock;
  std::unique_ptr<world::Folder> state;
  std::unique_ptr<Journal> journal;
  std::unique_ptr<Emitter> emitter;
  std::vector<RecoveredEmission> recovered;
  std::uint64_t number{};

  Spool() {
    fs::create_directories(target);
    fs::create_directory(temp.path / "state");
  }
  std::string start() {
    emitter.reset();
    journal.reset();
    state = files.open_folder(temp.path / "state").value();
    auto opened = Journal::open(*state, clock.utc(), clock.tick(), {}, {1U << 20, 4096});
    if (!opened) return opened.error().message;
    journal = std::move(opened).value();
    auto made = Emitter::open(files, target, 10, false);
    if (!made) return made.error();
    emitter = std::move(made).value();
    recovered = emitter->recover("sim01", journal->past(), *journal, clock.utc(), clock.tick());
    return "";
  }
  Emission emit(const std::string& bytes) {
    const auto staged = emitter->stage(bytes, ++number);
    if (!staged) return {Outcome::aborted, staged.error().message(), false};
    return emitter->emit(safety::accept("goto_l10.ma", bytes, test::verdict_on("goto_l10.ma", bytes)).value(), *staged,
                         {"sim01", "0007.0003", "plan", clock.tick() + std::chrono::minutes{5}, false}, *journal,
                         clock);
  }
  [[nodiscard]] std::string visible() const { return temp.read("sim01/to-glider/goto_l10.ma"); }
  void put(const std::string& bytes) const { temp.write("sim01/to-glider/goto_l10.ma", bytes); }
};

}  // namespace

TEST_CASE("on a real file system a file goes out, is exchanged, and keeps the inode that was judged") {
  Spool spool;
  REQUIRE(spool.start().empty());
  CHECK(fs::status(spool.stage).permissions() == fs::perms{0750});
  CHECK(fs::is_empty(spool.target));
  REQUIRE(spool.emit("list 1").outcome == Outcome::queued);
  CHECK(spool.visible() == "list 1");
  const auto staged = spool.emitter->stage("list 2", 99).value();
  struct ::stat before {
  }, after{};
  REQUIRE(::stat((spool.stage / staged).c_str(), &before) == 0);
  const auto file = safety::accept("goto_l10.ma", "list 2", test::verdict_on("goto_l10.ma", "list 2")).value();
  REQUIRE(spool.emitter
              ->emit(file, staged, {"sim01", "b", "plan", spool.clock.tick() + std::chrono::minutes{5}, false},
                     *spool.journal, spool.clock)
              .outcome == Outcome::queued);
  REQUIRE(::stat((spool.target / "goto_l10.ma").c_str(), &after) == 0);
  CHECK(before.st_ino == after.st_ino);
  CHECK((after.st_mode & 07777U) == 0640);
  CHECK(spool.visible() == "list 2");
  std::size_t left = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator{spool.stage}) ++left;
  CHECK(left == 2);  // lock and epoch
  CHECK(spool.temp.read("sim01/.glidehelm/epoch") == "1\n");
}

TEST_CASE("folders that are symbolic links, or no folders, are refused") {
  Spool spool;
  std::string word = "symbolic link";
  SECTION("to-glider is a link") {
    fs::rename(spool.target, spool.glider / "real");
    fs::create_directory_symlink("real", spool.target);
  }
  SECTION("to-glider is a file") {
    fs::remove(spool.target);
    spool.temp.write("sim01/to-glider", "");
  }
  SECTION("the staging folder is a link to somewhere else") {
    fs::create_directory(spool.temp.path / "elsewhere");
    fs::create_directory_symlink(spool.temp.path / "elsewhere", spool.stage);
    word = "staging folder";
  }
  SECTION("the staging folder is a file") {
    spool.temp.write("sim01/.glidehelm", "");
    word = "staging folder";
  }
  SECTION("everybody may write into the staging folder") {
    fs::create_directory(spool.stage);
    fs::permissions(spool.stage, fs::perms{0777});
    word = "everybody may write";
  }
  SECTION("the lock is a link") {
    fs::create_directory(spool.stage);
    fs::create_symlink(spool.temp.path / "victim", spool.stage / "lock");
    word = "Too many levels of symbolic links";
  }
  SECTION("the lock is a pipe that would block") {
    fs::create_directory(spool.stage);
    REQUIRE(::mkfifo((spool.stage / "lock").c_str(), 0600) == 0);
    word = "Invalid argument";
  }
  SECTION("the epoch is a link") {
    fs::create_directory(spool.stage);
    spool.temp.write("victim", "7\n");
    fs::create_symlink(spool.temp.path / "victim", spool.stage / "epoch");
    word = "epoch cannot be read";
  }
  const auto refused = spool.start();
  CAPTURE(refused);
  CHECK(refused.find("to_glider " + spool.target.string() + ": ") == 0);
  CHECK(refused.find(word) != std::string::npos);
  CHECK_FALSE(fs::exists(spool.temp.path / "elsewhere/epoch"));
  CHECK((!fs::exists(spool.temp.path / "victim") || spool.temp.read("victim") == "7\n"));
}

TEST_CASE("whatever lies under our name and is not our plain file is foreign and stays as it is") {
  Spool spool;
  REQUIRE(spool.start().empty());
  const auto path = spool.target / "goto_l10.ma";
  SECTION("a symbolic link") {
    spool.temp.write("secret", "keep");
    fs::create_symlink(spool.temp.path / "secret", path);
  }
  SECTION("a symbolic link to nowhere") { fs::create_symlink("nowhere", path); }
  SECTION("a pipe") { REQUIRE(::mkfifo(path.c_str(), 0600) == 0); }
  SECTION("a folder") { fs::create_directory(path); }
  SECTION("a file of 10 MB") {
    spool.put("");
    fs::resize_file(path, 10'000'000);
  }
  SECTION("our own file with a second name") {
    REQUIRE(spool.emit("list 1").outcome == Outcome::queued);
    fs::create_hard_link(path, spool.glider / "second");
  }
  SECTION("our own file, edited in place") {
    REQUIRE(spool.emit("list 1").outcome == Outcome::queued);
    std::ofstream{path, std::ios::app} << "# by hand";
  }
  const auto before = fs::symlink_status(path).type();
  const auto view = spool.emitter->inspect();
  CHECK(view.what == What::foreign);
  CHECK(view.detail.find("uid " + std::to_string(::getuid())) != std::string::npos);
  const auto emission = spool.emit("list 2");
  CHECK(emission.outcome == Outcome::foreign_file);
  CHECK(fs::symlink_status(path).type() == before);
  if (before == fs::file_type::regular) CHECK(spool.visible().find("list 2") == std::string::npos);
  if (before == fs::file_type::symlink && fs::exists(path)) CHECK(spool.temp.read("secret") == "keep");
  CHECK(fs::is_empty(spool.stage) == false);
}

TEST_CASE("folders that are swapped between check and use stop the emission") {
  Spool spool;
  REQUIRE(spool.start().empty());
  std::string word;
  SECTION("to-glider is moved away and another one made") {
    fs::rename(spool.target, spool.glider / "old");
    fs::create_directory(spool.target);
    word = "replaced";
  }
  SECTION("to-glider becomes a link to the folder that it was") {
    fs::rename(spool.target, spool.glider / "old");
    fs::create_directory_symlink("old", spool.target);
    word = "replaced";
  }
  SECTION("to-glider is removed") {
    fs::remove(spool.target);
    word = "replaced";
  }
  SECTION("the staging folder is opened to everybody") {
    fs::permissions(spool.stage, fs::perms{0777});
    word = "staging folder";
  }
  SECTION("the lock is removed and another process takes a new one") {
    fs::remove(spool.stage / "lock");
    REQUIRE(Emitter::open(spool.files, spool.target, 10, false));
    word = "epoch";
  }
  const auto emission = spool.emit("list 1");
  CAPTURE(emission.detail);
  CHECK(emission.outcome == Outcome::aborted);
  CHECK(emission.detail.find(word) != std::string::npos);
  for (const auto& folder : {spool.target, spool.glider / "old"}) CHECK_FALSE(fs::exists(folder / "goto_l10.ma"));
}

TEST_CASE("a second process is told who flies, and cannot start before the first has ended") {
  Spool spool;
  REQUIRE(spool.start().empty());
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    world::RealFiles files;
    const auto second = Emitter::open(files, spool.target, 10, false);
    ::_exit(!second && second.error().find("held by another process") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  CHECK(spool.temp.read("sim01/.glidehelm/epoch") == "1\n");  // the second did not count
  CHECK(spool.start().empty());
  CHECK(spool.emitter->epoch() == 2);
}

TEST_CASE("a folder in which this process may not write is refused at the start") {
  Spool spool;
  for (auto path = spool.temp.path; path != "/"; path = path.parent_path())
    if (path.string().rfind(fs::temp_directory_path().string() + "/", 0) == 0) fs::permissions(path, fs::perms{0755});
  fs::permissions(spool.glider, fs::perms{0777});
  fs::permissions(spool.target, fs::perms{0555});
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) ::_exit(99);
    if (::geteuid() == 0) ::_exit(99);  // rights mean nothing to root: the test would prove nothing
    world::RealFiles files;
    const auto refused = Emitter::open(files, spool.target, 10, false);
    ::_exit(!refused && refused.error().find("Permission denied") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  fs::permissions(spool.target, fs::perms{0755});
  CHECK(fs::is_empty(spool.target));
}

TEST_CASE("a process killed at any named step leaves one file or none, and the next one knows which") {
  const bool exchanged = GENERATE(false, true);
  for (const char* step : {"before_intent", "after_intent", "before_rename", "after_rename", "after_folder_sync",
                           "before_committed", "after_committed"}) {
    CAPTURE(exchanged, step);
    Spool spool;
    if (exchanged) {
      REQUIRE(spool.start().empty());
      REQUIRE(spool.emit("list 1").outcome == Outcome::queued);
      spool.emitter.reset();
      spool.journal.reset();
    }
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      ::setenv("GLIDEHELM_FAILPOINT", step, 1);
      if (!spool.start().empty()) ::_exit(1);
      static_cast<void>(spool.emit("list 2"));
      ::_exit(2);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    REQUIRE(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGKILL);
    REQUIRE(spool.start().empty());
    const std::string name{step};
    const bool visible = name == "after_rename" || name == "after_folder_sync" || name == "before_committed" ||
                         name == "after_committed";
    CHECK(spool.visible() == (visible ? "list 2" : exchanged ? "list 1" : ""));
    const bool open = name != "before_intent" && name != "after_committed";
    REQUIRE(spool.recovered.size() == (open ? 1U : 0U));
    if (open) CHECK(spool.recovered[0].emission.outcome == (visible ? Outcome::queued : Outcome::aborted));
    CHECK(spool.emitter->inspect().what == (visible || exchanged ? What::ours : What::nothing));
    std::size_t left = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator{spool.stage}) ++left;
    CHECK(left == 2);
  }
}
