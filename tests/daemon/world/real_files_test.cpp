#include "daemon/world/real_files.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "tests/contract/files_contract.hpp"
#include "tests/simulator/temp_folder.hpp"
#include "tests/support/memory_files.hpp"

using namespace glidehelm;
using namespace glidehelm::world;
using glidehelm::test::TempFolder;

namespace {

/// The errno of a result; 0 when it is none.
template <class T>
int code(const FileResult<T>& result) {
  return result ? 0 : result.error().code;
}

/// Runs `what` in a child of this process that is `nobody` and returns its exit code. When nobody can be had the child
/// says 99, so that a test of rights never passes as root.
int as_nobody(const std::function<int()>& what) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) ::_exit(99);
    if (::geteuid() == 0) ::_exit(99);
    ::_exit(what());
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  return WEXITSTATUS(status);
}

}  // namespace

TEST_CASE("the machine's files and the ones in memory keep one contract") {
  SECTION("the machine's") {
    TempFolder temp;
    ::umask(022);
    RealFiles files;
    test::check_files_contract(files, temp.path);
  }
  SECTION("in memory") {
    test::MemoryFiles files;
    files.make_folder_at("/root");
    test::check_files_contract(files, "/root");
  }
}

TEST_CASE("names below a folder are single components") {
  TempFolder temp;
  temp.write("file", "x");
  RealFiles files;
  const auto folder = files.open_folder(temp.path).value();
  for (const std::string& name : {std::string{}, std::string{"."}, std::string{".."}, std::string{"../file"},
                                  std::string{"a/b"}, std::string{"file\0x", 6}, std::string{"/etc/passwd"}}) {
    CAPTURE(name);
    CHECK(code(folder->read(name, 10)) == EINVAL);
    CHECK(code(folder->stat(name)) == EINVAL);
    CHECK(code(folder->open(name)) == EINVAL);
    CHECK(code(folder->create(name, "", 0640)) == EINVAL);
    CHECK(code(folder->append_to(name, true)) == EINVAL);
    CHECK(code(folder->truncate(name, 0)) == EINVAL);
    CHECK(code(folder->unlink(name)) == EINVAL);
    CHECK(code(folder->lock(name)) == EINVAL);
    CHECK(code(folder->rename_new(name, *folder, "new")) == EINVAL);
    CHECK(code(folder->rename_new("file", *folder, name)) == EINVAL);
    CHECK(code(folder->exchange("file", *folder, name)) == EINVAL);
    CHECK(code(folder->rename_over("file", *folder, name)) == EINVAL);
  }
  CHECK(temp.read("file") == "x");
}

TEST_CASE("a symbolic link is never followed") {
  TempFolder temp;
  temp.write("secret", "keep out");
  std::filesystem::create_directory(temp.path / "folder");
  std::filesystem::create_symlink(temp.path / "secret", temp.path / "folder/link");
  std::filesystem::create_symlink(temp.path / "folder", temp.path / "way");
  RealFiles files;
  CHECK(code(files.open_folder(temp.path / "way")) == ENOTDIR);
  CHECK(code(files.make_folder(temp.path / "way", 0750)) == ENOTDIR);
  const auto folder = files.open_folder(temp.path / "folder").value();
  CHECK(code(folder->read("link", 100)) == ELOOP);
  CHECK(code(folder->open("link")) == ELOOP);
  CHECK(code(folder->append_to("link", false)) == ELOOP);
  CHECK(code(folder->truncate("link", 0)) == ELOOP);
  CHECK(code(folder->lock("link")) == ELOOP);
  CHECK(code(folder->create("link", "x", 0640)) == EEXIST);
  const auto stat = folder->stat("link").value();
  CHECK_FALSE(stat.regular);
  CHECK_FALSE(stat.folder);
  CHECK(temp.read("secret") == "keep out");
  // Configuration files may be links: that is how people manage them.
  CHECK(files.read(temp.path / "folder/link", 100).value() == "keep out");
}

TEST_CASE("what is no regular file is refused at once, not waited for") {
  TempFolder temp;
  REQUIRE(::mkfifo((temp.path / "fifo").c_str(), 0600) == 0);
  std::filesystem::create_directory(temp.path / "folder");
  RealFiles files;
  const auto folder = files.open_folder(temp.path).value();
  for (const char* name : {"fifo", "folder"}) {
    CHECK(code(folder->read(name, 100)) == EINVAL);
    CHECK(code(folder->open(name)) == EINVAL);
  }
  CHECK(code(folder->lock("fifo")) == EINVAL);
  CHECK(code(files.map(temp.path / "folder")) == EINVAL);
  CHECK(code(files.map(temp.path / "fifo")) == EINVAL);
  CHECK(code(files.read(temp.path / "fifo", 100)) == EINVAL);
  CHECK(code(files.read(temp.path / "folder", 100)) == EISDIR);
  temp.write("one", "x");
  std::filesystem::create_hard_link(temp.path / "one", temp.path / "two");
  CHECK(folder->stat("one").value().links == 2);
}

TEST_CASE("names cannot be moved between file systems, and asking changes nothing") {
  TempFolder temp;
  RealFiles files;
  const auto here = files.open_folder(temp.path).value();
  const std::string elsewhere_root = "/dev/shm";
  const auto there_stat = files.stat(elsewhere_root);
  if (!there_stat || there_stat->device == here->stat_self().value().device) {
    WARN("one file system only: not tried");
    return;
  }
  std::string pattern = elsewhere_root + "/glidehelm-XXXXXX";
  REQUIRE(::mkdtemp(pattern.data()) != nullptr);
  const auto there = files.open_folder(pattern).value();
  CHECK(code(here->check_moves_to(*there)) == EXDEV);
  CHECK(here->create("file", "x", 0640));
  CHECK(code(here->rename_new("file", *there, "file")) == EXDEV);
  CHECK(there->list().value().empty());
  CHECK(here->list().value() == std::vector<std::string>{"file"});
  std::filesystem::remove_all(pattern);
}

TEST_CASE("rights are those of the process, and a folder that may not be written says so") {
  TempFolder temp;
  std::filesystem::permissions(temp.path, std::filesystem::perms{0755});
  for (const char* name : {"closed", "open"}) std::filesystem::create_directory(temp.path / name);
  temp.write("closed/mine", "x");
  const auto rights = [](int mode) { return static_cast<std::filesystem::perms>(mode); };
  std::filesystem::permissions(temp.path / "closed/mine", rights(::geteuid() == 0 ? 0600 : 0000));
  std::filesystem::permissions(temp.path / "closed", rights(0555));
  std::filesystem::permissions(temp.path / "open", rights(0777));
  const int outcome = as_nobody([&] {
    RealFiles files;
    const auto closed = files.open_folder(temp.path / "closed"), open = files.open_folder(temp.path / "open");
    if (!closed || !open) return 1;
    if (code((*closed)->create("new", "x", 0640)) != EACCES) return 2;
    if (code((*closed)->read("mine", 10)) != EACCES) return 3;
    if (code((*open)->check_moves_to(**closed)) != EACCES) return 4;
    if (code((*closed)->check_moves_to(**open)) != EACCES) return 5;
    if (!(*open)->create("new", "x", 0640)) return 6;
    if (!(*open)->check_moves_to(**open)) return 7;
    if (code((*closed)->lock("lock")) != EACCES) return 8;
    if (code(files.make_folder(temp.path / "closed/deeper", 0750)) != EACCES) return 9;
    return 0;
  });
  CHECK(outcome == 0);
  std::filesystem::permissions(temp.path / "closed", rights(0755));
}

TEST_CASE("a full device is an error of the write") {
  RealFiles files;
  const auto devices = files.open_folder("/dev").value();
  const auto full = devices->append_to("full", false);
  REQUIRE(full);
  CHECK(code((*full)->append("x")) == ENOSPC);
  CHECK((*full)->append("x").error().message() == "write /dev/full: No space left on device");
}

TEST_CASE("a lock is held against other processes and ends with its holder") {
  TempFolder temp;
  RealFiles files;
  const auto folder = files.open_folder(temp.path).value();
  std::array<int, 2> pipe{};
  REQUIRE(::pipe(pipe.data()) == 0);
  const pid_t holder = ::fork();
  if (holder == 0) {
    const auto held = folder->lock("lock");
    static_cast<void>(!::write(pipe[1], held ? "y" : "n", 1));
    ::pause();
    ::_exit(0);
  }
  char answer = 0;
  REQUIRE(::read(pipe[0], &answer, 1) == 1);
  CHECK(answer == 'y');
  CHECK(code(folder->lock("lock")) == EAGAIN);
  ::kill(holder, SIGKILL);
  ::waitpid(holder, nullptr, 0);
  CHECK(folder->lock("lock"));
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST_CASE("an inherited descriptor is read to its end, a file from its beginning") {
  TempFolder temp;
  RealFiles files;
  std::array<int, 2> pipe{};
  REQUIRE(::pipe(pipe.data()) == 0);
  REQUIRE(::write(pipe[1], "from a pipe", 11) == 11);
  ::close(pipe[1]);
  CHECK(files.read_descriptor(pipe[0], 100).value() == "from a pipe");
  ::close(pipe[0]);
  temp.write("file", "from a file");
  const auto opened = files.open_folder(temp.path).value()->open("file").value();
  for (int i = 0; i < 2; ++i) CHECK(files.read_descriptor(opened->descriptor(), 100).value() == "from a file");
  CHECK(code(files.read_descriptor(opened->descriptor(), 5)) == EFBIG);
  CHECK(code(files.read_descriptor(999, 5)) == EBADF);
}

TEST_CASE("an empty file can be mapped, and a failed sync is known by its name") {
  TempFolder temp;
  temp.write("empty", "");
  RealFiles files;
  CHECK(files.map(temp.path / "empty").value()->bytes().empty());
  CHECK(FileError{"fsync", "x", EIO}.failed_sync());
  CHECK(FileError{"fdatasync", "x", EIO}.failed_sync());
  CHECK_FALSE(FileError{"write", "x", EIO}.failed_sync());
}
