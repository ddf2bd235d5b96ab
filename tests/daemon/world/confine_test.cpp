#include "daemon/world/confine.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <functional>
#include <string>
#include <thread>

#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using namespace glidehelm::world;
using glidehelm::test::TempFolder;

namespace {

/// What a confined process did: its exit code, or minus the signal that it died of.
int in_child(const Confinement& order, const std::function<int(const Confined&)>& work) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const auto confined = confine(order);
    ::_exit(confined ? work(*confined) : 99);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// Which fences this kernel and this build have.
Confined fences() {
  const int told = in_child({}, [](const Confined& c) { return (c.files ? 1 : 0) + (c.calls ? 2 : 0); });
  REQUIRE(told >= 0);
  REQUIRE(told < 4);
  return {(told & 1) != 0, (told & 2) != 0};
}

int errno_of(bool succeeded) { return succeeded ? 0 : errno; }
int open_errno(const std::string& path, int flags) { return errno_of(::open(path.c_str(), flags, 0600) >= 0); }

}  // namespace

TEST_CASE("a confined process reads and writes where it was allowed to, and nowhere else") {
  if (!fences().files) {
    WARN("this kernel has no Landlock: files are not fenced");
    return;
  }
  TempFolder temp;
  for (const char* folder : {"in", "out", "other"}) std::filesystem::create_directory(temp.path / folder);
  temp.write("in/file", "x");
  temp.write("other/file", "x");
  const Confinement order{{temp.path / "in", temp.path / "absent"}, {temp.path / "out"}, false};
  const auto ended = [&](const std::function<int()>& work) {
    return in_child(order, [&](const Confined&) { return work(); });
  };
  const auto path = [&](const char* name) { return (temp.path / name).string(); };
  CHECK(ended([&] { return open_errno(path("in/file"), O_RDONLY); }) == 0);
  CHECK(ended([&] { return open_errno(path("in/file"), O_WRONLY); }) == EACCES);
  CHECK(ended([&] { return open_errno(path("in/new"), O_WRONLY | O_CREAT); }) == EACCES);
  CHECK(ended([&] { return open_errno(path("other/file"), O_RDONLY); }) == EACCES);
  CHECK(ended([&] { return open_errno("/etc/passwd", O_RDONLY); }) == EACCES);
  CHECK(ended([&] { return errno_of(::unlink(path("other/file").c_str()) == 0); }) == EACCES);
  CHECK(ended([&] {
          if (const int problem = open_errno(path("out/new"), O_WRONLY | O_CREAT | O_EXCL)) return problem;
          return errno_of(::rename(path("out/new").c_str(), path("out/renamed").c_str()) == 0);
        }) == 0);
  CHECK(ended([&] { return errno_of(::unlink(path("out/renamed").c_str()) == 0); }) == 0);
  CHECK(ended([&] { return open_errno(path("out/renamed"), O_RDONLY); }) == ENOENT);
}

TEST_CASE("what was open before stays usable") {
  TempFolder temp;
  temp.write("file", "x");
  const int fd = ::open((temp.path / "file").c_str(), O_RDONLY | O_CLOEXEC);
  CHECK(in_child({}, [&](const Confined&) {
          char byte{};
          return ::pread(fd, &byte, 1, 0) == 1 && byte == 'x' ? 0 : 1;
        }) == 0);
  ::close(fd);
}

TEST_CASE("a confined process starts nothing, signals nobody and opens no socket unless it may") {
  if (!fences().calls) {
    WARN("no system call filter in this build or kernel");
    return;
  }
  const auto ended = [](const std::function<int()>& work, bool network = false) {
    return in_child({{"/"}, {}, network}, [&](const Confined&) { return work(); });
  };
  CHECK(ended([] {
          const pid_t child = ::fork();
          if (child == 0) ::_exit(0);
          return errno_of(child >= 0);
        }) == EPERM);
  CHECK(ended([] {
          char program[] = "/bin/true";
          char* const arguments[] = {program, nullptr};
          return errno_of(::execve(program, arguments, nullptr) == 0);
        }) == EPERM);
  CHECK(ended([] { return errno_of(::kill(::getppid(), 0) == 0); }) == EPERM);
  CHECK(ended([] { return errno_of(::socket(AF_INET, SOCK_STREAM, 0) >= 0); }) == EPERM);
  CHECK(ended([] { return errno_of(::socket(AF_INET, SOCK_STREAM, 0) >= 0); }, true) == 0);
  CHECK(ended([] { return errno_of(::mount("none", "/", "none", 0, nullptr) == 0); }) == -SIGSYS);
  CHECK(ended([] { return ::prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0); }) == 1);
}

TEST_CASE("a confined process still computes: memory, threads, and its own death") {
  const auto ended = [](const std::function<int()>& work) {
    return in_child({}, [&](const Confined&) { return work(); });
  };
  CHECK(ended([] {
          void* memory = ::mmap(nullptr, 1 << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
          return memory == MAP_FAILED ? 1 : 0;
        }) == 0);
  CHECK(ended([] {
          int sum = 0;
          std::thread other{[&] { sum = 7; }};
          other.join();
          return sum;
        }) == 7);
  CHECK(ended([]() -> int {
          ::signal(SIGABRT, SIG_DFL);
          ::abort();
        }) == -SIGABRT);
}
