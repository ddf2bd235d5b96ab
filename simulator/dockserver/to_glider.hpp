#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/time.hpp"

namespace glidehelm::simulator {

struct OfferedFile {
  std::string name, bytes;
  friend bool operator==(const OfferedFile&, const OfferedFile&) = default;
};

/// The dockserver's `to-glider` folder as its script sees it.
class ToGlider {
 public:
  virtual ~ToGlider() = default;
  /// What lies there at `now`, by name. Folders and names that start with a dot are not seen, as `*` does not match them.
  virtual std::vector<OfferedFile> contents(Instant now) = 0;
  /// The transfer of this file ended: archive the bytes that were sent and unlink the name, whatever lies under it now.
  virtual void sent(const OfferedFile& file, Instant when) = 0;
};

/// A folder of values: for simulations in one process.
class MemoryToGlider final : public ToGlider {
 public:
  void offer(std::string name, std::string bytes) { files_[std::move(name)] = std::move(bytes); }
  std::vector<OfferedFile> contents(Instant) override {
    std::vector<OfferedFile> all;
    for (const auto& [name, bytes] : files_) all.push_back({name, bytes});
    return all;
  }
  void sent(const OfferedFile& file, Instant) override {
    archive_.push_back(file);
    files_.erase(file.name);
  }
  [[nodiscard]] const std::vector<OfferedFile>& archive() const { return archive_; }
  [[nodiscard]] bool empty() const { return files_.empty(); }

 private:
  std::map<std::string, std::string> files_;
  std::vector<OfferedFile> archive_;
};

}  // namespace glidehelm::simulator
