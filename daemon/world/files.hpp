#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/expected.hpp"

namespace glidehelm::world {

/// A file operation that failed: which, on what, and the system's reason.
struct FileError {
  std::string operation;  ///< "open", "rename", "fsync", …
  std::string path;
  int code{};  ///< errno
  [[nodiscard]] std::string message() const;
  /// fsync or fdatasync failed: what the disk holds is unknown, a second try would lie, the process ends (trust.md K-4).
  [[nodiscard]] bool failed_sync() const { return operation == "fsync" || operation == "fdatasync"; }
  friend bool operator==(const FileError&, const FileError&) = default;
};
template <class T>
using FileResult = Expected<T, FileError>;

struct FileStat {
  std::uint64_t device{}, inode{}, size{};
  std::int64_t modified_ns{};
  std::uint32_t owner{}, links{};
  bool regular{}, folder{};
  std::uint32_t mode{};  ///< permission bits, 07777
  /// When content or attributes changed last: the file system's own note, which nobody can set back. 0 in twins.
  std::int64_t changed_ns{};
  friend bool operator==(const FileStat&, const FileStat&) = default;
};

/// An open file that can be handed to a child (Procs); closed by its destructor.
class OpenFile {
 public:
  virtual ~OpenFile() = default;
  [[nodiscard]] virtual int descriptor() const = 0;  ///< −1 in twins that have none
  [[nodiscard]] virtual FileResult<std::string> read_all(std::size_t at_most) = 0;
};

/// An append-only file. A failed sync ends the process that owns it (K-4): never a second try.
class AppendFile {
 public:
  virtual ~AppendFile() = default;
  [[nodiscard]] virtual FileResult<Done> append(
      std::string_view bytes) = 0;                    ///< all or an error; loops over short writes
  [[nodiscard]] virtual FileResult<Done> sync() = 0;  ///< fdatasync
};

/// Bytes of a file mapped read-only; stays valid when the name is replaced by rename.
class Mapping {
 public:
  virtual ~Mapping() = default;
  [[nodiscard]] virtual std::span<const std::byte> bytes() const = 0;
};

/// A held lock; released by its destructor or by the death of the process.
class Lock {
 public:
  virtual ~Lock() = default;
};

/// A folder opened once: names below are single components, symbolic links are never followed.
class Folder {
 public:
  virtual ~Folder() = default;
  [[nodiscard]] virtual const std::string& path() const = 0;
  [[nodiscard]] virtual FileResult<FileStat> stat_self() = 0;                  ///< of the folder that was opened
  [[nodiscard]] virtual FileResult<FileStat> stat(std::string_view name) = 0;  ///< ENOENT in `code` when absent
  [[nodiscard]] virtual FileResult<std::vector<std::string>> list() = 0;       ///< sorted, without . and ..
  [[nodiscard]] virtual FileResult<std::string> read(std::string_view name, std::size_t at_most) = 0;
  [[nodiscard]] virtual FileResult<std::unique_ptr<OpenFile>> open(std::string_view name) = 0;  ///< read-only
  /// O_EXCL | O_NOFOLLOW, whole content, fchmod, fsync, close: the file is complete and durable, or an error and gone.
  [[nodiscard]] virtual FileResult<FileStat> create(std::string_view name, std::string_view bytes, unsigned mode) = 0;
  [[nodiscard]] virtual FileResult<std::unique_ptr<AppendFile>> append_to(std::string_view name, bool create_new) = 0;
  [[nodiscard]] virtual FileResult<Done> truncate(std::string_view name, std::uint64_t size) = 0;  ///< with fsync
  [[nodiscard]] virtual FileResult<Done> unlink(std::string_view name) = 0;
  /// renameat2 with RENAME_NOREPLACE: EEXIST when the target exists.
  [[nodiscard]] virtual FileResult<Done> rename_new(std::string_view name, Folder& to, std::string_view new_name) = 0;
  /// renameat2 with RENAME_EXCHANGE: both names exist before and after.
  [[nodiscard]] virtual FileResult<Done> exchange(std::string_view name, Folder& with, std::string_view other) = 0;
  /// rename that replaces: for files that only we own (caches, grids).
  [[nodiscard]] virtual FileResult<Done> rename_over(std::string_view name, Folder& to, std::string_view new_name) = 0;
  [[nodiscard]] virtual FileResult<Done> sync() = 0;  ///< fsync of the directory
  /// May this process move a name from here into `to` and take it out again? Asked without making a name in either:
  /// EXDEV across mounts, EROFS, EACCES, EINVAL where the file system has no exchange.
  [[nodiscard]] virtual FileResult<Done> check_moves_to(Folder& to) {
    return unexpected(FileError{"rename", path() + " to " + to.path(), ENOSYS});
  }
  /// Exclusive OFD lock on the regular file `name` (created when absent); EAGAIN when somebody holds it.
  [[nodiscard]] virtual FileResult<std::unique_ptr<Lock>> lock(std::string_view name) = 0;
};

class Files {
 public:
  virtual ~Files() = default;
  [[nodiscard]] virtual FileResult<std::unique_ptr<Folder>> open_folder(const std::string& path) = 0;
  /// Creates the last component when absent (mode as given), then opens.
  [[nodiscard]] virtual FileResult<std::unique_ptr<Folder>> make_folder(const std::string& path, unsigned mode) = 0;
  /// For configuration and command-line files: follows links, reads at most `at_most` bytes (EFBIG beyond).
  [[nodiscard]] virtual FileResult<std::string> read(const std::string& path, std::size_t at_most) = 0;
  [[nodiscard]] virtual FileResult<FileStat> stat(const std::string& path) = 0;
  [[nodiscard]] virtual FileResult<std::unique_ptr<Mapping>> map(const std::string& path) = 0;
  /// Reads an inherited descriptor to its end: a child's standard input (0) and the file that it was handed (3). EFBIG
  /// beyond `at_most`. A twin without descriptors says ENOSYS.
  [[nodiscard]] virtual FileResult<std::string> read_descriptor(int descriptor, std::size_t at_most) {
    static_cast<void>(at_most);
    return unexpected(FileError{"read", "descriptor " + std::to_string(descriptor), ENOSYS});
  }
  /// Existing files that match a shell pattern, sorted; a path without wildcard gives itself when it exists.
  [[nodiscard]] virtual std::vector<std::string> glob(const std::string& pattern) = 0;
  /// A path for scratch files of this process, e.g. /tmp or $TMPDIR.
  [[nodiscard]] virtual std::string scratch() = 0;
};

}  // namespace glidehelm::world
