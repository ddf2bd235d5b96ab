#pragma once

#include <cstdint>
#include <string>

#include "core/base/expected.hpp"
#include "core/base/time.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::world {

/// Why a file that somebody else writes cannot be had.
struct NotToBeHad {
  std::string what;  ///< "is a symbolic link; …", "is still being written: …"
  bool passing{};    ///< true: a later try may succeed though nobody corrects anything
  friend bool operator==(const NotToBeHad&, const NotToBeHad&) = default;
};

/// A file in a folder that others write into: opened once, never through a symbolic link as its last component, never
/// waiting (a FIFO would), and only when it is a regular file. Whoever replaces the name later does not change what is read,
/// and whoever changes the content is noticed.
class PublishedFile {
 public:
  /// Refused, each in words of its own: absent, not permitted, a symbolic link, a folder, a FIFO, a device, a socket, larger
  /// than `at_most` bytes.
  static Expected<PublishedFile, NotToBeHad> open(const std::string& path, std::uint64_t at_most);
  PublishedFile(PublishedFile&& other) noexcept;
  PublishedFile& operator=(PublishedFile&&) = delete;
  ~PublishedFile();

  /// A private copy. A file that was modified less than `settle` ago is waited for until it is that old (by a clock of its
  /// own that runs ahead: at most `settle`); then it is read and looked at again: size and times of the open file, and the
  /// inode under its name, must be what they were at `open`. Else it is still being written, was replaced, or is gone, which
  /// all pass.
  Expected<std::string, NotToBeHad> copy(Seconds settle);

  /// As it was when it was opened, and at the end of every copy that succeeded.
  [[nodiscard]] const FileStat& stat() const { return stat_; }

 private:
  PublishedFile(int fd, std::string path, FileStat stat, std::uint64_t at_most);
  void wait_until_settled(Seconds settle) const;
  [[nodiscard]] Expected<Done, NotToBeHad> unchanged() const;
  int fd_;
  std::string path_;
  FileStat stat_;
  std::uint64_t at_most_;
};

}  // namespace glidehelm::world
