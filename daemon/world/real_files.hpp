#pragma once

#include "daemon/world/files.hpp"

struct stat;

namespace glidehelm::world {

/// What the system tells of a file, in our words.
FileStat stat_of(const struct ::stat& s);

/// The file system of the machine. Folders hold a descriptor; names below them are opened with openat2(BENEATH,
/// NO_SYMLINKS), or with O_NOFOLLOW where the kernel has no openat2.
class RealFiles final : public Files {
 public:
  [[nodiscard]] FileResult<std::unique_ptr<Folder>> open_folder(const std::string& path) override;
  [[nodiscard]] FileResult<std::unique_ptr<Folder>> make_folder(const std::string& path, unsigned mode) override;
  [[nodiscard]] FileResult<std::string> read(const std::string& path, std::size_t at_most) override;
  [[nodiscard]] FileResult<std::string> read_descriptor(int descriptor, std::size_t at_most) override;
  [[nodiscard]] FileResult<FileStat> stat(const std::string& path) override;
  [[nodiscard]] FileResult<std::unique_ptr<Mapping>> map(const std::string& path) override;
  [[nodiscard]] std::vector<std::string> glob(const std::string& pattern) override;
  [[nodiscard]] std::string scratch() override;
};

}  // namespace glidehelm::world
