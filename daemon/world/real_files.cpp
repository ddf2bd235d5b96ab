#include "daemon/world/real_files.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <glob.h>
#include <linux/openat2.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace glidehelm::world {

FileStat stat_of(const struct ::stat& s) {
  FileStat result;
  result.device = s.st_dev;
  result.inode = s.st_ino;
  result.size = static_cast<std::uint64_t>(s.st_size);
  result.modified_ns = static_cast<std::int64_t>(s.st_mtim.tv_sec) * 1'000'000'000 + s.st_mtim.tv_nsec;
  result.changed_ns = static_cast<std::int64_t>(s.st_ctim.tv_sec) * 1'000'000'000 + s.st_ctim.tv_nsec;
  result.owner = s.st_uid;
  result.links = static_cast<std::uint32_t>(s.st_nlink);
  result.regular = S_ISREG(s.st_mode);
  result.folder = S_ISDIR(s.st_mode);
  result.mode = s.st_mode & 07777U;
  return result;
}

namespace {

/// A descriptor that closes itself.
class Fd {
 public:
  explicit Fd(int fd = -1) : fd_{fd} {}
  Fd(Fd&& other) noexcept : fd_{std::exchange(other.fd_, -1)} {}
  Fd& operator=(Fd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Fd() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }
  /// close(2) whose result counts: on NFS the write error comes here.
  [[nodiscard]] bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

Unexpected<FileError> failed(std::string operation, std::string path) {
  return {FileError{std::move(operation), std::move(path), errno}};
}

bool is_component(std::string_view name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}

/// Opens one component below a folder, never through a symbolic link.
int open_below(int folder, const std::string& name, int flags, unsigned mode) {
  open_how how{};
  how.flags = static_cast<std::uint64_t>(flags | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if ((flags & O_CREAT) != 0) how.mode = mode;
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS | RESOLVE_NO_MAGICLINKS;
  const long fd = ::syscall(SYS_openat2, folder, name.c_str(), &how, sizeof how);
  if (fd >= 0 || errno != ENOSYS) return static_cast<int>(fd);
  return ::openat(folder, name.c_str(), flags | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, mode);
}

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

FileResult<std::string> read_fd(int fd, const std::string& path, std::size_t at_most) {
  std::string content;
  char block[65536];
  while (true) {
    const ssize_t n = ::read(fd, block, sizeof block);
    if (n < 0) {
      if (errno == EINTR) continue;
      return failed("read", path);
    }
    if (n == 0) return content;
    if (content.size() + static_cast<std::size_t>(n) > at_most) {
      errno = EFBIG;
      return failed("read", path);
    }
    content.append(block, static_cast<std::size_t>(n));
  }
}

class RealOpenFile final : public OpenFile {
 public:
  RealOpenFile(Fd fd, std::string path) : fd_{std::move(fd)}, path_{std::move(path)} {}
  [[nodiscard]] int descriptor() const override { return fd_.get(); }
  [[nodiscard]] FileResult<std::string> read_all(std::size_t at_most) override {
    if (::lseek(fd_.get(), 0, SEEK_SET) < 0) return failed("seek", path_);
    return read_fd(fd_.get(), path_, at_most);
  }

 private:
  Fd fd_;
  std::string path_;
};

class RealAppendFile final : public AppendFile {
 public:
  RealAppendFile(Fd fd, std::string path) : fd_{std::move(fd)}, path_{std::move(path)} {}
  [[nodiscard]] FileResult<Done> append(std::string_view bytes) override {
    if (!write_all(fd_.get(), bytes)) return failed("write", path_);
    return Done{};
  }
  [[nodiscard]] FileResult<Done> sync() override {
    if (::fdatasync(fd_.get()) != 0) return failed("fdatasync", path_);
    return Done{};
  }

 private:
  Fd fd_;
  std::string path_;
};

class RealMapping final : public Mapping {
 public:
  RealMapping(void* address, std::size_t size) : address_{address}, size_{size} {}
  ~RealMapping() override {
    if (address_ != nullptr) ::munmap(address_, size_);
  }
  [[nodiscard]] std::span<const std::byte> bytes() const override {
    return {static_cast<const std::byte*>(address_), size_};
  }

 private:
  void* address_;
  std::size_t size_;
};

class RealLock final : public Lock {
 public:
  explicit RealLock(Fd fd) : fd_{std::move(fd)} {}

 private:
  Fd fd_;  // closing the descriptor releases an OFD lock
};

class RealFolder final : public Folder {
 public:
  RealFolder(Fd fd, std::string path) : fd_{std::move(fd)}, path_{std::move(path)} {}

  [[nodiscard]] const std::string& path() const override { return path_; }

  [[nodiscard]] FileResult<FileStat> stat_self() override {
    struct ::stat s {};
    if (::fstat(fd_.get(), &s) != 0) return failed("stat", path_);
    return stat_of(s);
  }

  [[nodiscard]] FileResult<FileStat> stat(std::string_view name) override {
    if (!is_component(name)) return bad_name("stat", name);
    struct ::stat s {};
    if (::fstatat(fd_.get(), std::string{name}.c_str(), &s, AT_SYMLINK_NOFOLLOW) != 0)
      return failed("stat", below(name));
    return stat_of(s);
  }

  [[nodiscard]] FileResult<std::vector<std::string>> list() override {
    // A fresh descriptor: reading a directory moves its offset.
    const int fd = ::openat(fd_.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return failed("list", path_);
    DIR* stream = ::fdopendir(fd);
    if (stream == nullptr) {
      ::close(fd);
      return failed("list", path_);
    }
    std::vector<std::string> names;
    errno = 0;
    while (const dirent* entry = ::readdir(stream)) {
      const std::string_view name{entry->d_name};
      if (name != "." && name != "..") names.emplace_back(name);
    }
    const int problem = errno;
    ::closedir(stream);
    if (problem != 0) {
      errno = problem;
      return failed("list", path_);
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  [[nodiscard]] FileResult<std::string> read(std::string_view name, std::size_t at_most) override {
    auto file = open_regular("read", name);
    if (!file) return unexpected(file.error());
    return read_fd(file->get(), below(name), at_most);
  }

  [[nodiscard]] FileResult<std::unique_ptr<OpenFile>> open(std::string_view name) override {
    auto file = open_regular("open", name);
    if (!file) return unexpected(file.error());
    return std::unique_ptr<OpenFile>{std::make_unique<RealOpenFile>(std::move(*file), below(name))};
  }

  [[nodiscard]] FileResult<FileStat> create(std::string_view name, std::string_view bytes, unsigned mode) override {
    if (!is_component(name)) return bad_name("create", name);
    const std::string text{name};
    Fd file{open_below(fd_.get(), text, O_CREAT | O_EXCL | O_WRONLY, mode)};
    if (file.get() < 0) return failed("create", below(name));
    struct ::stat s {};
    const char* failing = !write_all(file.get(), bytes)     ? "write"
                          : ::fchmod(file.get(), mode) != 0 ? "chmod"
                          : ::fsync(file.get()) != 0        ? "fsync"
                          : ::fstat(file.get(), &s) != 0    ? "stat"
                          : !file.close()                   ? "close"
                                                            : nullptr;
    if (failing == nullptr) return stat_of(s);
    const int problem = errno;
    ::unlinkat(fd_.get(), text.c_str(), 0);
    errno = problem;
    return failed(failing, below(name));
  }

  [[nodiscard]] FileResult<std::unique_ptr<AppendFile>> append_to(std::string_view name, bool create_new) override {
    if (!is_component(name)) return bad_name("append", name);
    Fd file{open_below(fd_.get(), std::string{name}, O_WRONLY | O_APPEND | (create_new ? O_CREAT | O_EXCL : 0), 0640)};
    if (file.get() < 0) return failed("open", below(name));
    return std::unique_ptr<AppendFile>{std::make_unique<RealAppendFile>(std::move(file), below(name))};
  }

  [[nodiscard]] FileResult<Done> truncate(std::string_view name, std::uint64_t size) override {
    if (!is_component(name)) return bad_name("truncate", name);
    Fd file{open_below(fd_.get(), std::string{name}, O_WRONLY, 0)};
    if (file.get() < 0) return failed("open", below(name));
    if (::ftruncate(file.get(), static_cast<off_t>(size)) != 0) return failed("truncate", below(name));
    if (::fsync(file.get()) != 0) return failed("fsync", below(name));
    return Done{};
  }

  [[nodiscard]] FileResult<Done> unlink(std::string_view name) override {
    if (!is_component(name)) return bad_name("unlink", name);
    if (::unlinkat(fd_.get(), std::string{name}.c_str(), 0) != 0) return failed("unlink", below(name));
    return Done{};
  }

  [[nodiscard]] FileResult<Done> rename_new(std::string_view name, Folder& to, std::string_view new_name) override {
    return rename_with(name, to, new_name, RENAME_NOREPLACE);
  }
  [[nodiscard]] FileResult<Done> exchange(std::string_view name, Folder& with, std::string_view other) override {
    return rename_with(name, with, other, RENAME_EXCHANGE);
  }
  [[nodiscard]] FileResult<Done> rename_over(std::string_view name, Folder& to, std::string_view new_name) override {
    return rename_with(name, to, new_name, 0);
  }

  [[nodiscard]] FileResult<Done> sync() override {
    if (::fsync(fd_.get()) != 0) return failed("fsync", path_);
    return Done{};
  }

  /// The kernel looks at mounts, then at a read-only file system, then at the names: renaming a name that is not there
  /// says EXDEV or EROFS before it says ENOENT, and changes nothing. Rights are asked of access(2). What flags the file
  /// system has is found out with two names of ours in this folder.
  [[nodiscard]] FileResult<Done> check_moves_to(Folder& to) override {
    auto* other = dynamic_cast<RealFolder*>(&to);
    if (other == nullptr) return bad_name("rename", "");
    constexpr const char* kNobody = ".glidehelm-not-there";
    if (::renameat2(fd_.get(), kNobody, other->fd_.get(), kNobody, RENAME_NOREPLACE) != 0 && errno != ENOENT)
      return failed("rename", path_ + " to " + other->path_);
    for (const RealFolder* folder : {static_cast<const RealFolder*>(this), static_cast<const RealFolder*>(other)})
      if (::faccessat(folder->fd_.get(), ".", W_OK | X_OK, AT_EACCESS) != 0) return failed("write", folder->path_);
    for (const char* name : {".probe-1", ".probe-2"}) {
      ::unlinkat(fd_.get(), name, 0);
      if (auto made = create(name, "", 0640); !made) return unexpected(made.error());
    }
    auto moved = exchange(".probe-1", *this, ".probe-2");
    if (moved) moved = unlink(".probe-2");
    if (moved) moved = rename_new(".probe-1", *this, ".probe-2");
    for (const char* name : {".probe-1", ".probe-2"}) ::unlinkat(fd_.get(), name, 0);
    return moved;
  }

  [[nodiscard]] FileResult<std::unique_ptr<Lock>> lock(std::string_view name) override {
    if (!is_component(name)) return bad_name("lock", name);
    Fd file{open_below(fd_.get(), std::string{name}, O_RDWR | O_CREAT, 0640)};
    if (file.get() < 0) return failed("open", below(name));
    struct ::stat s {};
    if (::fstat(file.get(), &s) != 0) return failed("stat", below(name));
    if (!S_ISREG(s.st_mode)) {
      errno = EINVAL;
      return failed("lock", below(name));
    }
    struct ::flock whole {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    if (::fcntl(file.get(), F_OFD_SETLK, &whole) != 0) {
      if (errno == EACCES) errno = EAGAIN;
      return failed("lock", below(name));
    }
    return std::unique_ptr<Lock>{std::make_unique<RealLock>(std::move(file))};
  }

 private:
  [[nodiscard]] std::string below(std::string_view name) const { return path_ + "/" + std::string{name}; }
  [[nodiscard]] Unexpected<FileError> bad_name(std::string operation, std::string_view name) const {
    errno = EINVAL;
    return failed(std::move(operation), below(name));
  }

  /// Read-only; anything but a regular file is refused (a FIFO or device would block or lie).
  [[nodiscard]] FileResult<Fd> open_regular(std::string operation, std::string_view name) {
    if (!is_component(name)) return bad_name(std::move(operation), name);
    Fd file{open_below(fd_.get(), std::string{name}, O_RDONLY, 0)};
    if (file.get() < 0) return failed(std::move(operation), below(name));
    struct ::stat s {};
    if (::fstat(file.get(), &s) != 0) return failed(std::move(operation), below(name));
    if (!S_ISREG(s.st_mode)) {
      errno = EINVAL;
      return failed(std::move(operation), below(name));
    }
    return file;
  }

  [[nodiscard]] FileResult<Done> rename_with(std::string_view name, Folder& to, std::string_view new_name,
                                             unsigned flags) {
    if (!is_component(name) || !is_component(new_name)) return bad_name("rename", name);
    auto* other = dynamic_cast<RealFolder*>(&to);
    if (other == nullptr) return bad_name("rename", name);
    if (::renameat2(fd_.get(), std::string{name}.c_str(), other->fd_.get(), std::string{new_name}.c_str(), flags) != 0)
      return failed("rename", below(name) + " to " + other->below(new_name));
    return Done{};
  }

  Fd fd_;
  std::string path_;
};

}  // namespace

FileResult<std::unique_ptr<Folder>> RealFiles::open_folder(const std::string& path) {
  // The last component may not be a symbolic link: a folder that somebody can redirect is no folder of ours.
  Fd fd{::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW)};
  if (fd.get() < 0) return failed("open", path);
  return std::unique_ptr<Folder>{std::make_unique<RealFolder>(std::move(fd), path)};
}

FileResult<std::unique_ptr<Folder>> RealFiles::make_folder(const std::string& path, unsigned mode) {
  if (::mkdir(path.c_str(), mode) != 0 && errno != EEXIST) return failed("mkdir", path);
  return open_folder(path);
}

FileResult<std::string> RealFiles::read(const std::string& path, std::size_t at_most) {
  // Opening a FIFO that nobody writes into would wait for ever. What a shell hands over as /dev/fd/N has its writer.
  const bool handed_over = path.rfind("/dev/", 0) == 0;
  Fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | (handed_over ? 0 : O_NONBLOCK))};
  if (fd.get() < 0) return failed("open", path);
  struct ::stat s {};
  if (::fstat(fd.get(), &s) != 0) return failed("stat", path);
  if (!handed_over && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode)) {  // reading a folder says EISDIR
    errno = EINVAL;
    return failed("read", path);
  }
  return read_fd(fd.get(), path, at_most);
}

FileResult<std::string> RealFiles::read_descriptor(int descriptor, std::size_t at_most) {
  const std::string name = "descriptor " + std::to_string(descriptor);
  if (::lseek(descriptor, 0, SEEK_SET) < 0 && errno != ESPIPE) return failed("seek", name);
  return read_fd(descriptor, name, at_most);
}

FileResult<FileStat> RealFiles::stat(const std::string& path) {
  struct ::stat s {};
  if (::stat(path.c_str(), &s) != 0) return failed("stat", path);
  return stat_of(s);
}

FileResult<std::unique_ptr<Mapping>> RealFiles::map(const std::string& path) {
  Fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (fd.get() < 0) return failed("open", path);
  struct ::stat s {};
  if (::fstat(fd.get(), &s) != 0) return failed("stat", path);
  if (!S_ISREG(s.st_mode)) {
    errno = EINVAL;
    return failed("map", path);
  }
  const auto size = static_cast<std::size_t>(s.st_size);
  if (size == 0) return std::unique_ptr<Mapping>{std::make_unique<RealMapping>(nullptr, 0)};
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd.get(), 0);
  if (address == MAP_FAILED) return failed("map", path);
  return std::unique_ptr<Mapping>{std::make_unique<RealMapping>(address, size)};
}

std::vector<std::string> RealFiles::glob(const std::string& pattern) {
  std::vector<std::string> found;
  glob_t result{};
  if (::glob(pattern.c_str(), GLOB_ERR, nullptr, &result) == 0)
    for (std::size_t i = 0; i < result.gl_pathc; ++i) found.emplace_back(result.gl_pathv[i]);
  ::globfree(&result);
  std::sort(found.begin(), found.end());
  return found;
}

std::string RealFiles::scratch() {
  const char* folder = std::getenv("TMPDIR");
  return folder != nullptr && *folder != '\0' ? folder : "/tmp";
}

}  // namespace glidehelm::world
