#include "daemon/world/published_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "daemon/world/real_files.hpp"

namespace glidehelm::world {

namespace {

constexpr bool kPassing = true;

Unexpected<NotToBeHad> refuse(std::string what, bool passing = false) {
  return unexpected(NotToBeHad{std::move(what), passing});
}

std::string gigabytes(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB", static_cast<double>(bytes) * 1e-9);
  return text;
}

Unexpected<NotToBeHad> refuse_open(int problem) {
  switch (problem) {
    case ELOOP:
      return refuse("is a symbolic link, which may be turned while it is read; allowed is the name of the file itself");
    case ENOENT:
    case ENOTDIR:
      return refuse("is not there (any more)", kPassing);
    case EACCES:
    case EPERM:
      return refuse("may not be read by this user (permission denied)", kPassing);
    case ENXIO:
      return refuse("is a socket; allowed is a regular file");
    default:
      return refuse(std::string{"cannot be opened: "} + std::strerror(problem), kPassing);
  }
}

/// Why a thing of this kind is no forecast; nothing for a regular file.
const char* no_file(unsigned mode) {
  if (S_ISREG(mode)) return nullptr;
  if (S_ISDIR(mode)) return "is a folder; allowed are files, for example by a pattern like FOLDER/*.nc";
  if (S_ISFIFO(mode)) return "is a FIFO; allowed is a regular file";
  if (S_ISCHR(mode) || S_ISBLK(mode)) return "is a device; allowed is a regular file";
  return "is no regular file";
}

double utc_now() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

}  // namespace

PublishedFile::PublishedFile(int fd, std::string path, FileStat stat, std::uint64_t at_most)
    : fd_{fd}, path_{std::move(path)}, stat_{stat}, at_most_{at_most} {}
PublishedFile::PublishedFile(PublishedFile&& other) noexcept
    : fd_{std::exchange(other.fd_, -1)}, path_{std::move(other.path_)}, stat_{other.stat_}, at_most_{other.at_most_} {}
PublishedFile::~PublishedFile() {
  if (fd_ >= 0) ::close(fd_);
}

Expected<PublishedFile, NotToBeHad> PublishedFile::open(const std::string& path, std::uint64_t at_most) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) return refuse_open(errno);
  struct ::stat s {};
  const int told = ::fstat(fd, &s);
  PublishedFile file{fd, path, told == 0 ? stat_of(s) : FileStat{}, at_most};
  if (told != 0) return refuse_open(errno);
  if (const char* kind = no_file(s.st_mode)) return refuse(kind);
  if (file.stat_.size > at_most)
    return refuse("has " + gigabytes(file.stat_.size) + ", allowed is " + gigabytes(at_most) +
                  "; cut it to the area, times and depths of the mission");
  return file;
}

void PublishedFile::wait_until_settled(Seconds settle) const {
  const double age = utc_now() - static_cast<double>(stat_.modified_ns) * 1e-9;
  const double wait = std::clamp(settle.count() - age, 0.0, settle.count());
  timespec left{static_cast<time_t>(wait),
                static_cast<long>((wait - static_cast<double>(static_cast<time_t>(wait))) * 1e9)};
  while (::nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
}

Expected<Done, NotToBeHad> PublishedFile::unchanged() const {
  struct ::stat open_now {
  }, named_now{};
  if (::fstat(fd_, &open_now) != 0) return refuse_open(errno);
  const auto now = stat_of(open_now);
  if (now.size != stat_.size)
    return refuse("is still being written: it went from " + std::to_string(stat_.size) + " to " +
                      std::to_string(now.size) + " bytes while it was read",
                  kPassing);
  if (now.modified_ns != stat_.modified_ns)
    return refuse("is still being written: it changed while it was read", kPassing);
  if (::lstat(path_.c_str(), &named_now) != 0) return refuse("was taken away while it was read", kPassing);
  if (named_now.st_ino != open_now.st_ino || named_now.st_dev != open_now.st_dev)
    return refuse("was replaced while it was read", kPassing);
  return Done{};
}

Expected<std::string, NotToBeHad> PublishedFile::copy(Seconds settle) {
  wait_until_settled(settle);
  if (auto same = unchanged(); !same) return unexpected(same.error());
  std::string bytes(static_cast<std::size_t>(stat_.size), '\0');
  std::size_t at = 0;
  while (at < bytes.size()) {
    const ssize_t n = ::pread(fd_, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return refuse(std::string{"cannot be read: "} + std::strerror(errno), kPassing);
    if (n == 0) break;
    at += static_cast<std::size_t>(n);
  }
  if (auto same = unchanged(); !same) return unexpected(same.error());
  if (at != bytes.size()) return refuse("is still being written: it became shorter while it was read", kPassing);
  return bytes;
}

}  // namespace glidehelm::world
