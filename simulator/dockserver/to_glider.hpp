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

/// All that was heard on one connection.
struct CallLog {
  std::string glider, medium;  ///< "network_net_0", "modem"
  Instant opened;
  std::string bytes;
  friend bool operator==(const CallLog&, const CallLog&) = default;
};

/// The dockserver's folders of one glider as its script sees them: above all `to-glider`.
class ToGlider {
 public:
  virtual ~ToGlider() = default;
  /// What lies there at `now`, by name. Folders and names that start with a dot are not seen, as `*` does not match them.
  virtual std::vector<OfferedFile> contents(Instant now) = 0;
  /// The transfer of this file ended: archive the bytes that were sent and unlink the name, whatever lies under it now.
  virtual void sent(const OfferedFile& file, Instant when) = 0;
  /// A file came from the glider: it goes to from-glider.
  virtual void received(const OfferedFile& /*file*/, Instant /*when*/) {}
  /// A connection ended: its log goes to logs.
  virtual void logged(const CallLog& /*log*/) {}
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
  void received(const OfferedFile& file, Instant) override { from_glider_.push_back(file); }
  void logged(const CallLog& log) override { logs_.push_back(log); }
  [[nodiscard]] const std::vector<OfferedFile>& archive() const { return archive_; }
  [[nodiscard]] const std::vector<OfferedFile>& from_glider() const { return from_glider_; }
  [[nodiscard]] const std::vector<CallLog>& logs() const { return logs_; }
  [[nodiscard]] bool empty() const { return files_.empty(); }

 private:
  std::map<std::string, std::string> files_;
  std::vector<OfferedFile> archive_, from_glider_;
  std::vector<CallLog> logs_;
};

}  // namespace glidehelm::simulator
