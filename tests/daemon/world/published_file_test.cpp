#include "daemon/world/published_file.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using namespace glidehelm::world;
using glidehelm::test::TempFolder;
using namespace std::chrono_literals;

namespace {

constexpr std::uint64_t kAtMost = 1'000'000;

NotToBeHad refusal(const std::filesystem::path& path) {
  const auto file = PublishedFile::open(path, kAtMost);
  REQUIRE_FALSE(file);
  return file.error();
}

void append(const std::filesystem::path& path, const std::string& text) {
  std::ofstream{path, std::ios::app | std::ios::binary} << text;
}

/// Sets the time at which a file was modified to `ago` before now.
void modified(const std::filesystem::path& path, std::chrono::milliseconds ago) {
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - ago);
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

TEST_CASE("a published file that nobody touches is copied whole, and says what it looked like") {
  TempFolder temp;
  const std::string bytes(300'000, 'x');
  temp.write("a.nc", bytes);
  auto file = PublishedFile::open(temp.path / "a.nc", kAtMost);
  REQUIRE(file);
  CHECK(file->copy(Seconds{0}).value() == bytes);
  CHECK(file->copy(Seconds{0}).value() == bytes);
  CHECK(file->stat().size == bytes.size());
  CHECK(file->stat().inode != 0);
  CHECK(file->stat().modified_ns != 0);
  temp.write("empty.nc", "");
  auto empty = PublishedFile::open(temp.path / "empty.nc", kAtMost);
  REQUIRE(empty);
  CHECK(empty->copy(Seconds{0}).value().empty());
}

TEST_CASE("what is no regular file is refused in words of its own, and opening never waits") {
  TempFolder temp;
  temp.write("a.nc", "bytes");
  std::filesystem::create_symlink(temp.path / "a.nc", temp.path / "link.nc");
  std::filesystem::create_symlink(temp.path / "nowhere", temp.path / "dangling.nc");
  REQUIRE(mkfifo((temp.path / "fifo.nc").c_str(), 0644) == 0);
  CHECK(refusal(temp.path / "link.nc").what ==
        "is a symbolic link, which may be turned while it is read; allowed is the name of the file itself");
  CHECK(refusal(temp.path / "dangling.nc").what == refusal(temp.path / "link.nc").what);
  CHECK(refusal(temp.path / "fifo.nc").what == "is a FIFO; allowed is a regular file");
  CHECK(refusal(temp.path).what == "is a folder; allowed are files, for example by a pattern like FOLDER/*.nc");
  CHECK(refusal("/dev/null").what == "is a device; allowed is a regular file");
  CHECK_FALSE(refusal("/dev/null").passing);

  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (temp.path / "s.nc").c_str(), sizeof address.sun_path - 1);
  REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  CHECK(refusal(temp.path / "s.nc").what == "is a socket; allowed is a regular file");
  ::close(socket);
}

TEST_CASE("a file that is not there may come, one that is too large is not even read") {
  TempFolder temp;
  CHECK(refusal(temp.path / "none.nc") == NotToBeHad{"is not there (any more)", true});
  temp.write("huge.nc", "");
  std::filesystem::resize_file(temp.path / "huge.nc", 40'000'000'000);  // a hole: it takes no room
  CHECK(refusal(temp.path / "huge.nc") ==
        NotToBeHad{"has 40.0 GB, allowed is 0.0 GB; cut it to the area, times and depths of the mission", false});
  temp.write("edge.nc", std::string(kAtMost, 'x'));
  CHECK(PublishedFile::open(temp.path / "edge.nc", kAtMost));
  append(temp.path / "edge.nc", "x");
  CHECK_FALSE(PublishedFile::open(temp.path / "edge.nc", kAtMost));
}

TEST_CASE("a young file is waited for until it has been left alone long enough, an old one is not") {
  TempFolder temp;
  temp.write("a.nc", "bytes");
  const auto copied_in = [&](double settle) {
    auto file = PublishedFile::open(temp.path / "a.nc", kAtMost);
    REQUIRE(file);
    return seconds_of([&] { REQUIRE(file->copy(Seconds{settle})); });
  };
  modified(temp.path / "a.nc", 60'000ms);
  CHECK(copied_in(1) < 0.5);
  modified(temp.path / "a.nc", 200ms);
  const double waited = copied_in(0.6);
  CHECK(waited >= 0.3);  // 0.6 s less the 0.2 s of its age, less the time that passed before it was opened
  modified(temp.path / "a.nc", -3'600'000ms);  // a file server whose clock is an hour ahead
  const double ahead = copied_in(0.4);
  CHECK(ahead >= 0.39);
  CHECK(ahead < 60);
}

TEST_CASE("a file that grows, changes, is replaced or goes while it is waited for is not taken, and may be later") {
  TempFolder temp;
  const auto while_waiting = [&](const std::function<void()>& meddle) {
    temp.write("a.nc", "bytes");
    auto file = PublishedFile::open(temp.path / "a.nc", kAtMost);
    REQUIRE(file);
    std::thread other{[&] {
      std::this_thread::sleep_for(50ms);
      meddle();
    }};
    const auto copy = file->copy(Seconds{0.4});
    other.join();
    REQUIRE_FALSE(copy);
    CHECK(copy.error().passing);
    return copy.error().what;
  };
  CHECK(while_waiting([&] { append(temp.path / "a.nc", "more"); }) ==
        "is still being written: it went from 5 to 9 bytes while it was read");
  CHECK(while_waiting([&] {
          const int fd = ::open((temp.path / "a.nc").c_str(), O_WRONLY | O_CLOEXEC);
          REQUIRE(::pwrite(fd, "BYTES", 5, 0) == 5);
          ::close(fd);
        }) == "is still being written: it changed while it was read");
  CHECK(while_waiting([&] {
          temp.write("b.nc", "other");
          std::filesystem::rename(temp.path / "b.nc", temp.path / "a.nc");
        }) == "was replaced while it was read");
  CHECK(while_waiting([&] { std::filesystem::remove(temp.path / "a.nc"); }) == "was taken away while it was read");
}

TEST_CASE("a file that this user may not read says so") {
  if (geteuid() == 0) {
    // Root may read everything: as nobody, in another process.
    TempFolder temp;
    temp.write("a.nc", "bytes");
    REQUIRE(::chmod((temp.path / "a.nc").c_str(), 0600) == 0);
    REQUIRE(::chmod(temp.path.c_str(), 0755) == 0);
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
      if (::setgid(65'534) != 0 || ::setuid(65'534) != 0) ::_exit(1);
      const auto file = PublishedFile::open(temp.path / "a.nc", kAtMost);
      const std::string said = file ? "opened" : file.error().what + (file.error().passing ? " passing" : "");
      static_cast<void>(!::write(ends[1], said.data(), said.size()));
      ::_exit(0);
    }
    ::close(ends[1]);
    char text[200]{};
    const auto n = ::read(ends[0], text, sizeof text - 1);
    ::close(ends[0]);
    REQUIRE(::waitpid(child, nullptr, 0) == child);
    CHECK(n > 0);
    CHECK(std::string{text} == "may not be read by this user (permission denied) passing");
  } else {
    TempFolder temp;
    temp.write("a.nc", "bytes");
    REQUIRE(::chmod((temp.path / "a.nc").c_str(), 0) == 0);
    CHECK(refusal(temp.path / "a.nc") == NotToBeHad{"may not be read by this user (permission denied)", true});
  }
}
