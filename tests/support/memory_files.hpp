#pragma once

#include <fnmatch.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "daemon/world/files.hpp"
#include "tests/support/fixed_rng.hpp"

namespace glidehelm::test {

/// Thrown out of the operation before which the power is cut: the process is gone, destructors write nothing.
struct PowerCut {};

/// A file system in memory that remembers what was synced. After a power cut it shows any state that a real one may: of
/// the changes to folders that were not synced each is there or not (a rename over two folders as a whole), of bytes that
/// were not synced any sectors of 512 bytes are there, old, zero or garbage. Operations can be made to fail.
///
/// Folders are simple: they are durable once made, and hold files only by path. Descriptors are −1.
class MemoryFiles final : public world::Files {
 public:
  // ---- what the test does; none of it counts as an operation

  void make_folder_at(const std::string& path, std::uint64_t device = 1, std::uint32_t mode = 0750) {
    auto made = std::make_shared<Directory>();
    made->path = path;
    made->stat.device = device;
    made->stat.inode = ++last_inode_;
    made->stat.folder = true;
    made->stat.links = 2;
    made->stat.mode = mode;
    folders_[path] = std::move(made);
  }
  /// The folder gets another name; whoever has it open keeps it.
  void move_folder(const std::string& from, const std::string& to) {
    folders_[to] = folders_.at(from);
    folders_[to]->path = to;
    folders_.erase(from);
  }
  /// Somebody else writes a file as an editor does: a new inode under the name, durable at once.
  void put(const std::string& path, const std::string& bytes, std::uint32_t owner = 1000) {
    commit();
    auto& folder = *folders_.at(parent(path));
    auto file = new_file(bytes, 0640);
    file->durable = bytes;
    file->stat.owner = owner;
    folder.now[leaf(path)] = folder.durable[leaf(path)] = file;
  }
  /// Somebody else takes a file away.
  void take(const std::string& path) {
    commit();
    auto& folder = *folders_.at(parent(path));
    folder.now.erase(leaf(path));
    folder.durable.erase(leaf(path));
  }
  /// Changes bytes in place, on disk as in memory: rot.
  void rot(const std::string& path, const std::function<void(std::string&)>& change) {
    auto& file = *folders_.at(parent(path))->now.at(leaf(path));
    change(file.data);
    file.durable = file.data;
  }
  [[nodiscard]] std::optional<std::string> get(const std::string& path) const { return content(path, false); }
  /// What would surely be there after a power cut now.
  [[nodiscard]] std::optional<std::string> durable(const std::string& path) const { return content(path, true); }
  [[nodiscard]] std::vector<std::string> names(const std::string& folder) const {
    std::vector<std::string> result;
    for (const auto& [name, file] : folders_.at(folder)->now) result.push_back(name);
    return result;
  }

  /// How the `at`-th operation from now (1 = the next) fails.
  struct Fault {
    enum class What { error, short_write, power_cut } what{};
    std::size_t at{};
    int code{};       ///< errno of `error` and of the rest of `short_write`
    bool for_ever{};  ///< every operation from there on that such an error can meet
  };
  void plan(Fault fault) {
    fault_ = fault;
    operations_ = 0;
  }
  void plan_nothing() { fault_.reset(); }
  /// Operations since the last `plan`.
  [[nodiscard]] std::size_t operations() const { return operations_; }
  /// Called before every operation with its name; for observers and for people who interfere.
  std::function<void(const std::string& operation, const std::string& path)> before_each;

  /// The power goes and comes back: what was open is gone, locks are free. `seed` 0: nothing unsynced survived; 1: all did.
  void cut_power(std::uint64_t seed) {
    FixedRng rng{seed};
    const auto survives = [&] { return seed == 1 || (seed != 0 && rng.coin()); };
    for (auto& [path, folder] : folders_) folder->now = folder->durable;
    for (const auto& change : pending_) {
      const bool possible = std::all_of(change.edits.begin(), change.edits.end(), [](const Edit& e) {
        const auto found = e.folder->now.find(e.name);
        return (found == e.folder->now.end() ? nullptr : found->second) == e.before;
      });
      if (possible && survives())
        for (const auto& e : change.edits) set(e.folder->now, e.name, e.after);
    }
    pending_.clear();
    std::set<File*> seen;
    for (auto& [path, folder] : folders_) {
      for (auto& [name, file] : folder->now)
        if (seen.insert(file.get()).second) {
          file->data = file->durable = after_cut(*file, seed, rng);
          file->dropped = false;
        }
      folder->durable = folder->now;
    }
    kill();
  }
  /// The process is killed and the machine lives: everything written is there, locks are free.
  void kill() {
    locked_.clear();
    ++generation_;
    fault_.reset();
  }

  // ---- world::Files

  [[nodiscard]] world::FileResult<std::unique_ptr<world::Folder>> open_folder(const std::string& path) override {
    if (const int code = step("open", path, false)) return failed("open", path, code);
    const auto found = folders_.find(path);
    if (found == folders_.end()) return failed("open", path, ENOENT);
    return std::unique_ptr<world::Folder>{std::make_unique<OpenFolder>(*this, found->second)};
  }
  [[nodiscard]] world::FileResult<std::unique_ptr<world::Folder>> make_folder(const std::string& path,
                                                                              unsigned mode) override {
    if (folders_.count(path) == 0) {
      if (const int code = step("mkdir", path, true)) return failed("mkdir", path, code);
      const auto above = folders_.find(parent(path));
      if (above == folders_.end()) return failed("mkdir", path, ENOENT);
      make_folder_at(path, above->second->stat.device, mode);
    }
    return open_folder(path);
  }
  [[nodiscard]] world::FileResult<std::string> read(const std::string& path, std::size_t at_most) override {
    if (const int code = step("read", path, false)) return failed("read", path, code);
    auto bytes = get(path);
    if (!bytes) return failed("open", path, ENOENT);
    if (bytes->size() > at_most) return failed("read", path, EFBIG);
    return *std::move(bytes);
  }
  [[nodiscard]] world::FileResult<world::FileStat> stat(const std::string& path) override {
    if (const int code = step("stat", path, false)) return failed("stat", path, code);
    if (const auto folder = folders_.find(path); folder != folders_.end()) return folder->second->stat;
    const auto file = find(path, false);
    if (!file) return failed("stat", path, ENOENT);
    return stat_of(*file);
  }
  [[nodiscard]] world::FileResult<std::unique_ptr<world::Mapping>> map(const std::string& path) override {
    auto bytes = read(path, static_cast<std::size_t>(-1));
    if (!bytes) return unexpected(bytes.error());
    return std::unique_ptr<world::Mapping>{std::make_unique<Bytes>(std::move(bytes).value())};
  }
  [[nodiscard]] std::vector<std::string> glob(const std::string& pattern) override {
    std::vector<std::string> found;
    for (const auto& [path, folder] : folders_)
      for (const auto& [name, file] : folder->now)
        if (::fnmatch(pattern.c_str(), (path + "/" + name).c_str(), FNM_PATHNAME | FNM_PERIOD) == 0)
          found.push_back(path + "/" + name);
    std::sort(found.begin(), found.end());
    return found;
  }
  [[nodiscard]] std::string scratch() override { return "/tmp"; }

 private:
  struct File {
    std::string data, durable;
    world::FileStat stat;
    bool dropped{};  ///< a sync failed: the kernel has forgotten that these pages were dirty (fsyncgate)
  };
  using FilePtr = std::shared_ptr<File>;
  using Names = std::map<std::string, FilePtr, std::less<>>;
  struct Directory {
    std::string path;
    world::FileStat stat;
    Names now, durable;
  };
  using DirectoryPtr = std::shared_ptr<Directory>;
  struct Edit {
    DirectoryPtr folder;
    std::string name;
    FilePtr before, after;
  };
  /// One change of names that is not durable yet: it is when all its folders were synced.
  struct Change {
    std::vector<Edit> edits;
    std::set<Directory*> unsynced;
  };

  static Unexpected<world::FileError> failed(std::string operation, std::string path, int code) {
    return {world::FileError{std::move(operation), std::move(path), code}};
  }
  static std::string parent(const std::string& path) { return path.substr(0, path.rfind('/')); }
  static std::string leaf(const std::string& path) { return path.substr(path.rfind('/') + 1); }
  static void set(Names& names, const std::string& name, const FilePtr& file) {
    if (file)
      names[name] = file;
    else
      names.erase(name);
  }
  FilePtr new_file(std::string bytes, std::uint32_t mode) {
    auto file = std::make_shared<File>();
    file->data = std::move(bytes);
    file->stat.inode = ++last_inode_;
    file->stat.regular = true;
    file->stat.links = 1;
    file->stat.mode = mode;
    file->stat.modified_ns = static_cast<std::int64_t>(last_inode_) * 1'000'000'000;
    return file;
  }
  static world::FileStat stat_of(const File& file) {
    auto stat = file.stat;
    stat.size = file.data.size();
    return stat;
  }
  [[nodiscard]] FilePtr find(const std::string& path, bool durably) const {
    const auto folder = folders_.find(parent(path));
    if (folder == folders_.end()) return nullptr;
    const auto& names = durably ? folder->second->durable : folder->second->now;
    const auto file = names.find(leaf(path));
    return file == names.end() ? nullptr : file->second;
  }
  [[nodiscard]] std::optional<std::string> content(const std::string& path, bool durably) const {
    const auto file = find(path, durably);
    if (!file) return std::nullopt;
    return durably ? file->durable : file->data;
  }

  /// Counts an operation; its errno when it is to fail.
  int step(const std::string& operation, const std::string& path, bool writes) {
    if (before_each && !observing_) {
      observing_ = true;
      const auto observer = before_each;  // it may take itself off
      observer(operation, path);
      observing_ = false;
    }
    ++operations_;
    if (!fault_) return 0;
    const bool due = operations_ == fault_->at || (fault_->for_ever && operations_ > fault_->at);
    if (!due) return 0;
    if (fault_->what == Fault::What::power_cut) throw PowerCut{};
    if (fault_->what == Fault::What::short_write) return operation == "write" ? fault_->code : 0;
    const bool only_writes = fault_->code == ENOSPC || fault_->code == EDQUOT || fault_->code == EROFS;
    return only_writes && !writes ? 0 : fault_->code;
  }
  [[nodiscard]] bool cuts_short() const { return fault_ && fault_->what == Fault::What::short_write; }

  void change(std::vector<Edit> edits) {
    Change made;
    for (const auto& e : edits) {
      made.unsynced.insert(e.folder.get());
      set(e.folder->now, e.name, e.after);
    }
    made.edits = std::move(edits);
    pending_.push_back(std::move(made));
  }
  /// What somebody else made durable came after everything before it.
  void commit() {
    for (const auto& change : pending_)
      for (const auto& e : change.edits) set(e.folder->durable, e.name, e.after);
    pending_.clear();
  }
  void synced(Directory& folder) {
    for (auto& change : pending_) change.unsynced.erase(&folder);
    std::set<std::pair<Directory*, std::string>> blocked;  // names that an older change still holds open
    std::vector<Change> rest;
    for (auto& change : pending_) {
      const bool free = std::none_of(change.edits.begin(), change.edits.end(), [&](const Edit& e) {
        return blocked.count({e.folder.get(), e.name}) != 0;
      });
      if (change.unsynced.empty() && free) {
        for (const auto& e : change.edits) set(e.folder->durable, e.name, e.after);
        continue;
      }
      for (const auto& e : change.edits) blocked.insert({e.folder.get(), e.name});
      rest.push_back(std::move(change));
    }
    pending_ = std::move(rest);
  }
  /// What a file holds after a power cut: sector by sector.
  static std::string after_cut(const File& file, std::uint64_t seed, FixedRng& rng) {
    if (seed == 0 || file.data == file.durable) return file.durable;
    if (seed == 1) return file.data;
    constexpr std::size_t kSector = 512;
    const auto shorter = std::min(file.data.size(), file.durable.size());
    const auto longer = std::max(file.data.size(), file.durable.size());
    const auto pick = rng.below(4);
    const std::size_t length = pick == 0   ? file.durable.size()
                               : pick == 1 ? file.data.size()
                                           : shorter + rng.below(longer - shorter + 1);
    std::string result(length, '\0');
    for (std::size_t begin = 0; begin < length; begin += kSector) {
      const auto end = std::min(begin + kSector, length);
      const auto fate = rng.below(4);
      for (auto i = begin; i < end; ++i) {
        const char old_byte = i < file.durable.size() ? file.durable[i] : '\0';
        const char new_byte = i < file.data.size() ? file.data[i] : '\0';
        const bool same = i < file.durable.size() && i < file.data.size() && old_byte == new_byte;
        // Garbage only where nothing was: a disk does not spoil what it has kept.
        result[i] = same || fate == 0                      ? new_byte
                    : fate == 1 || i < file.durable.size() ? old_byte
                    : fate == 2                            ? '\0'
                                                           : static_cast<char>(rng.next());
      }
    }
    return result;
  }

  class Bytes final : public world::Mapping {
   public:
    explicit Bytes(std::string bytes) : bytes_{std::move(bytes)} {}
    [[nodiscard]] std::span<const std::byte> bytes() const override {
      return std::as_bytes(std::span{bytes_.data(), bytes_.size()});
    }

   private:
    std::string bytes_;
  };
  class Opened final : public world::OpenFile {
   public:
    Opened(MemoryFiles& files, FilePtr file, std::string path)
        : files_{files}, file_{std::move(file)}, path_{std::move(path)} {}
    [[nodiscard]] int descriptor() const override { return -1; }
    [[nodiscard]] world::FileResult<std::string> read_all(std::size_t at_most) override {
      if (const int code = files_.step("read", path_, false)) return failed("read", path_, code);
      if (file_->data.size() > at_most) return failed("read", path_, EFBIG);
      return file_->data;
    }

   private:
    MemoryFiles& files_;
    FilePtr file_;
    std::string path_;
  };
  class Appending final : public world::AppendFile {
   public:
    Appending(MemoryFiles& files, FilePtr file, std::string path)
        : files_{files}, file_{std::move(file)}, path_{std::move(path)}, generation_{files.generation_} {}
    [[nodiscard]] world::FileResult<Done> append(std::string_view bytes) override {
      if (generation_ != files_.generation_) return failed("write", path_, EBADF);
      if (const int code = files_.step("write", path_, true)) {
        if (files_.cuts_short()) file_->data.append(bytes.substr(0, bytes.size() / 2));
        return failed("write", path_, code);
      }
      file_->data.append(bytes);
      return Done{};
    }
    [[nodiscard]] world::FileResult<Done> sync() override {
      if (generation_ != files_.generation_) return failed("fdatasync", path_, EBADF);
      if (const int code = files_.step("fdatasync", path_, true)) {
        file_->dropped = true;
        return failed("fdatasync", path_, code);
      }
      if (!file_->dropped) file_->durable = file_->data;
      return Done{};
    }

   private:
    MemoryFiles& files_;
    FilePtr file_;
    std::string path_;
    std::uint64_t generation_;
  };
  class Held final : public world::Lock {
   public:
    Held(MemoryFiles& files, std::uint64_t inode) : files_{files}, inode_{inode}, generation_{files.generation_} {}
    ~Held() override {
      if (generation_ == files_.generation_) files_.locked_.erase(inode_);
    }

   private:
    MemoryFiles& files_;
    std::uint64_t inode_, generation_;
  };

  class OpenFolder final : public world::Folder {
   public:
    OpenFolder(MemoryFiles& files, DirectoryPtr folder)
        : files_{files}, folder_{std::move(folder)}, path_{folder_->path}, generation_{files.generation_} {}
    [[nodiscard]] const std::string& path() const override { return path_; }
    [[nodiscard]] world::FileResult<world::FileStat> stat_self() override {
      if (const int code = step("stat", path_, false)) return failed("stat", path_, code);
      return folder_->stat;
    }
    [[nodiscard]] world::FileResult<world::FileStat> stat(std::string_view name) override {
      if (const int code = step("stat", below(name), false)) return failed("stat", below(name), code);
      const auto file = find(name);
      if (!file) return failed("stat", below(name), ENOENT);
      auto stat = stat_of(*file);
      stat.device = folder_->stat.device;
      return stat;
    }
    [[nodiscard]] world::FileResult<std::vector<std::string>> list() override {
      if (const int code = step("list", path_, false)) return failed("list", path_, code);
      std::vector<std::string> names;
      for (const auto& [name, file] : folder_->now) names.push_back(name);
      return names;
    }
    [[nodiscard]] world::FileResult<std::string> read(std::string_view name, std::size_t at_most) override {
      if (const int code = step("read", below(name), false)) return failed("read", below(name), code);
      const auto file = find(name);
      if (!file) return failed("read", below(name), ENOENT);
      if (file->data.size() > at_most) return failed("read", below(name), EFBIG);
      return file->data;
    }
    [[nodiscard]] world::FileResult<std::unique_ptr<world::OpenFile>> open(std::string_view name) override {
      if (const int code = step("open", below(name), false)) return failed("open", below(name), code);
      const auto file = find(name);
      if (!file) return failed("open", below(name), ENOENT);
      return std::unique_ptr<world::OpenFile>{std::make_unique<Opened>(files_, file, below(name))};
    }
    [[nodiscard]] world::FileResult<world::FileStat> create(std::string_view name, std::string_view bytes,
                                                            unsigned mode) override {
      if (const int code = step("create", below(name), true)) return failed("create", below(name), code);
      if (find(name)) return failed("create", below(name), EEXIST);
      const auto file = files_.new_file("", mode);
      files_.change({{folder_, std::string{name}, nullptr, file}});
      const auto undo = [&](const char* operation, int code) {
        static_cast<void>(unlink(name));
        return failed(operation, below(name), code);
      };
      if (const int code = step("write", below(name), true)) {
        if (files_.cuts_short()) file->data = bytes.substr(0, bytes.size() / 2);
        return undo("write", code);
      }
      file->data = bytes;
      if (const int code = step("fsync", below(name), true)) return undo("fsync", code);
      file->durable = file->data;
      return stat_of(*file);
    }
    [[nodiscard]] world::FileResult<std::unique_ptr<world::AppendFile>> append_to(std::string_view name,
                                                                                  bool create_new) override {
      if (const int code = step("open", below(name), create_new)) return failed("open", below(name), code);
      auto file = find(name);
      if (!file && !create_new) return failed("open", below(name), ENOENT);
      if (file && create_new) return failed("open", below(name), EEXIST);
      if (!file) {
        file = files_.new_file("", 0640);
        files_.change({{folder_, std::string{name}, nullptr, file}});
      }
      return std::unique_ptr<world::AppendFile>{std::make_unique<Appending>(files_, file, below(name))};
    }
    [[nodiscard]] world::FileResult<Done> truncate(std::string_view name, std::uint64_t size) override {
      if (const int code = step("truncate", below(name), true)) return failed("truncate", below(name), code);
      const auto file = find(name);
      if (!file) return failed("open", below(name), ENOENT);
      file->data.resize(static_cast<std::size_t>(size));
      if (const int code = step("fsync", below(name), true)) {
        file->dropped = true;
        return failed("fsync", below(name), code);
      }
      if (!file->dropped) file->durable = file->data;
      return Done{};
    }
    [[nodiscard]] world::FileResult<Done> unlink(std::string_view name) override {
      if (const int code = step("unlink", below(name), true)) return failed("unlink", below(name), code);
      const auto file = find(name);
      if (!file) return failed("unlink", below(name), ENOENT);
      files_.change({{folder_, std::string{name}, file, nullptr}});
      return Done{};
    }
    [[nodiscard]] world::FileResult<Done> rename_new(std::string_view name, world::Folder& to,
                                                     std::string_view new_name) override {
      return rename(name, to, new_name, Kind::fresh);
    }
    [[nodiscard]] world::FileResult<Done> exchange(std::string_view name, world::Folder& with,
                                                   std::string_view other) override {
      return rename(name, with, other, Kind::exchange);
    }
    [[nodiscard]] world::FileResult<Done> rename_over(std::string_view name, world::Folder& to,
                                                      std::string_view new_name) override {
      return rename(name, to, new_name, Kind::over);
    }
    [[nodiscard]] world::FileResult<Done> sync() override {
      if (const int code = step("fsync", path_, true)) return failed("fsync", path_, code);
      files_.synced(*folder_);
      return Done{};
    }
    [[nodiscard]] world::FileResult<Done> check_moves_to(world::Folder& to) override {
      if (const int code = step("access", path_, true)) return failed("rename", path_, code);
      const auto& other = dynamic_cast<OpenFolder&>(to);
      if (other.folder_->stat.device != folder_->stat.device) return failed("rename", path_, EXDEV);
      if ((other.folder_->stat.mode & 0200U) == 0) return failed("write", other.path_, EACCES);
      return Done{};
    }
    [[nodiscard]] world::FileResult<std::unique_ptr<world::Lock>> lock(std::string_view name) override {
      if (const int code = step("lock", below(name), false)) return failed("lock", below(name), code);
      auto file = find(name);
      if (!file) {
        file = files_.new_file("", 0640);
        files_.change({{folder_, std::string{name}, nullptr, file}});
      }
      if (!files_.locked_.insert(file->stat.inode).second) return failed("lock", below(name), EAGAIN);
      return std::unique_ptr<world::Lock>{std::make_unique<Held>(files_, file->stat.inode)};
    }

   private:
    enum class Kind { fresh, exchange, over };
    int step(const std::string& operation, const std::string& path, bool writes) {
      return generation_ != files_.generation_ ? EBADF : files_.step(operation, path, writes);
    }
    [[nodiscard]] std::string below(std::string_view name) const { return path_ + "/" + std::string{name}; }
    [[nodiscard]] FilePtr find(std::string_view name) const {
      const auto found = folder_->now.find(name);
      return found == folder_->now.end() ? nullptr : found->second;
    }
    world::FileResult<Done> rename(std::string_view name, world::Folder& to, std::string_view new_name, Kind kind) {
      if (const int code = step("rename", below(name), true)) return failed("rename", below(name), code);
      auto& other = dynamic_cast<OpenFolder&>(to);
      if (other.folder_->stat.device != folder_->stat.device) return failed("rename", below(name), EXDEV);
      const auto from = find(name), there = other.find(new_name);
      if (!from || (kind == Kind::exchange && !there)) return failed("rename", below(name), ENOENT);
      if (kind == Kind::fresh && there) return failed("rename", below(name), EEXIST);
      files_.change({{folder_, std::string{name}, from, kind == Kind::exchange ? there : nullptr},
                     {other.folder_, std::string{new_name}, there, from}});
      return Done{};
    }
    MemoryFiles& files_;
    DirectoryPtr folder_;
    std::string path_;
    std::uint64_t generation_;
  };

  std::map<std::string, DirectoryPtr> folders_;
  std::vector<Change> pending_;
  std::set<std::uint64_t> locked_;
  std::optional<Fault> fault_;
  std::size_t operations_{};
  std::uint64_t generation_{}, last_inode_{};
  bool observing_{};
};

}  // namespace glidehelm::test
