#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/world/published_file.hpp"

/// The published files of one run, as private copies.
namespace glidehelm::ingest {

/// Why one of the files cannot be had: which, what, and whether a later try may succeed.
struct SourceFault {
  std::size_t file{};  ///< index of the argument
  std::string what;
  bool passing{};
};

/// Opens every file, copies each privately and hashes the copies, before any of them is parsed. Copies are kept while they
/// fit into `kept_at_most` bytes together; the others are copied again when they are needed, and are the same bytes or an
/// error. Files are open from the start, so that they can still be copied behind a fence around the file system.
class Sources {
 public:
  /// `file_at_most`: bytes of one file.
  /// What `elsewhere` says is no file of this machine is left alone: it has no copy, and whoever reads it tells its hash.
  static Expected<Sources, SourceFault> open(const std::vector<std::string>& names, std::uint64_t file_at_most,
                                             const std::function<bool(const std::string&)>& elsewhere = {});
  /// Copies and hashes all; `settle`: how long a file must have been left alone (world::PublishedFile).
  Expected<Done, SourceFault> identify(Seconds settle, std::uint64_t kept_at_most);

  /// The content of what lies elsewhere.
  void identify(std::size_t file, const Sha256& content) { identities_[file].hash = content; }

  [[nodiscard]] std::size_t size() const { return files_.size(); }
  [[nodiscard]] bool is_elsewhere(std::size_t file) const { return !files_[file].has_value(); }
  [[nodiscard]] const std::string& name(std::size_t file) const { return names_[file]; }
  /// After `identify`: names and hashes, in order; and each file as it was when it was copied.
  [[nodiscard]] const std::vector<ocean::GridSource>& identities() const { return identities_; }
  [[nodiscard]] world::FileStat stat(std::size_t file) const {
    return files_[file] ? files_[file]->stat() : world::FileStat{};
  }

  /// Hands out the copy of a file, which is not kept any longer. Precondition: it does not lie elsewhere.
  Expected<std::string, SourceFault> take(std::size_t file);

 private:
  std::vector<std::string> names_;
  std::vector<std::optional<world::PublishedFile>> files_;
  std::vector<std::optional<std::string>> kept_;
  std::vector<ocean::GridSource> identities_;
};

}  // namespace glidehelm::ingest
