#pragma once

#include <cerrno>
#include <map>
#include <stdexcept>
#include <string>

#include "daemon/world/files.hpp"

namespace glidehelm::test {

/// Files that exist only in the test. The verbs replay and mafile may read, and nothing else: the rest throws.
class ReadableFiles final : public world::Files {
 public:
  std::map<std::string, std::string> files;

  world::FileResult<std::string> read(const std::string& path, std::size_t at_most) override {
    const auto found = files.find(path);
    if (found == files.end()) return unexpected(world::FileError{"open", path, ENOENT});
    if (found->second.size() > at_most) return unexpected(world::FileError{"read", path, EFBIG});
    return found->second;
  }
  world::FileResult<std::unique_ptr<world::Folder>> open_folder(const std::string&) override { throw not_read(); }
  world::FileResult<std::unique_ptr<world::Folder>> make_folder(const std::string&, unsigned) override {
    throw not_read();
  }
  world::FileResult<world::FileStat> stat(const std::string&) override { throw not_read(); }
  world::FileResult<std::unique_ptr<world::Mapping>> map(const std::string&) override { throw not_read(); }
  std::vector<std::string> glob(const std::string&) override { throw not_read(); }
  std::string scratch() override { throw not_read(); }

 private:
  static std::logic_error not_read() { return std::logic_error{"more than read"}; }
};

}  // namespace glidehelm::test
