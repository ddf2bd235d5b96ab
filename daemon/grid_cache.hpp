#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::daemon {

/// A checked grid, mapped read-only.
struct MappedGrid {
  std::unique_ptr<world::Mapping> mapping;
  ocean::GridView view;              ///< into the mapping
  std::string path;                  ///< its name, when it has one that stays
  std::shared_ptr<const void> hold;  ///< while this lives the name stays
};

/// What a file looks like from outside: when nothing of this changed, its content did not.
struct FileIdentity {
  std::uint64_t device{}, inode{}, size{};
  std::int64_t modified_ns{}, changed_ns{};
  static FileIdentity of(const world::FileStat& s) { return {s.device, s.inode, s.size, s.modified_ns, s.changed_ns}; }
  friend auto operator<=>(const FileIdentity&, const FileIdentity&) = default;
};

/// The flat grids that were made of published files, and what was learned of those files: a folder that one process owns.
///
/// A grid's name is its key: the hash of the contents that went in, of how they were read (`recipe`), and of the format. So
/// the same files read the same way are read once, whatever they are called, before and after a restart. A file is known
/// by its identity, so that neither its content nor a child is needed to see that nothing is new. Refused contents are
/// remembered with their reason; the last accepted grid of each order of files too.
///
/// Nothing here is needed: a cache that is lost or damaged costs time. A grid is used only after all checks of
/// `ocean::open_grid`; one that fails them is removed. The memory is one text file `index` with a checksum, replaced by
/// rename; a damaged one is forgotten. Grids are made in `staging/`, and enter by rename after they were made durable.
/// When the grids are larger than the limit together, those that nobody holds are removed, the oldest first.
///
/// Not for several threads.
class GridCache {
 public:
  struct Limits {
    std::uint64_t bytes{std::uint64_t{8} << 30};  ///< of all grids
    std::size_t memories{4096};  ///< files known by their identity; of refusals a quarter, of orders a 16th
  };
  /// Makes the folder's `staging` when absent, reads the index, and removes what a crash left half made.
  static Expected<std::shared_ptr<GridCache>, std::string> open(world::Files& files, const std::string& folder,
                                                                const Limits& limits);
  static Expected<std::shared_ptr<GridCache>, std::string> open(world::Files& files, const std::string& folder) {
    return open(files, folder, Limits{});
  }

  /// The folder in which a child may make a grid.
  [[nodiscard]] std::string staging() const { return folder_path_ + "/staging"; }

  // ---- what is known of files

  /// The contents of files, in order; nothing when one of them is new, changed or gone.
  [[nodiscard]] std::optional<std::vector<Sha256>> contents(const std::vector<std::string>& paths);
  void learn(const std::string& path, const FileIdentity& identity, const Sha256& content);

  /// Why contents were refused: a reason without the name of the file.
  struct Refusal {
    std::string reason;
    std::uint64_t age{};  ///< larger: later
  };
  void refuse(const std::string& recipe, const std::vector<Sha256>& contents, const std::string& reason);
  [[nodiscard]] const Refusal* refusal(const std::string& recipe, const std::vector<Sha256>& contents) const;
  /// What `glidehelm-ingest --refused-before` reads: the contents that were refused when read so.
  [[nodiscard]] std::string refused_list(const std::string& recipe) const;

  // ---- grids

  [[nodiscard]] static Sha256 key_of(const std::string& recipe, const std::vector<Sha256>& contents);
  /// The grid of a key; nothing when there is none. One that is damaged is removed, and `damage` says what was wrong.
  [[nodiscard]] std::unique_ptr<MappedGrid> take(const Sha256& key, std::string& damage);
  /// Takes in a grid that was made in `staging()` under `name`: checks it, and renames it.
  [[nodiscard]] Expected<std::unique_ptr<MappedGrid>, std::string> put(const std::string& name, const Sha256& key);
  /// Removes what a child left in `staging()` under `name` and its own temporary names for it.
  void discard(const std::string& name);

  /// `order` names which files and how: the last grid that was accepted for it.
  void accept(const std::string& order, const Sha256& key);
  [[nodiscard]] std::optional<Sha256> accepted(const std::string& order) const;

  /// Writes the index when something changed. The cache goes on without it when that fails.
  world::FileResult<Done> save();

 private:
  struct Known {
    FileIdentity identity;
    Sha256 content;
    std::uint64_t age{};
  };
  struct Accepted {
    Sha256 key;
    std::uint64_t age{};
  };
  using RefusalKey = std::pair<Sha256, Sha256>;  // recipe, contents
  GridCache(world::Files& files, std::string folder_path, Limits limits)
      : files_{files}, folder_path_{std::move(folder_path)}, limits_{limits} {}
  void read_index();
  bool read_line(const std::string& line);
  void sweep();
  void make_room();
  [[nodiscard]] std::shared_ptr<const void> hold(const Sha256& key);
  [[nodiscard]] bool held(const Sha256& key) const;

  world::Files& files_;
  std::string folder_path_;
  Limits limits_;
  std::unique_ptr<world::Folder> folder_, staging_;
  std::map<std::string, Known> known_;  ///< by path
  std::map<RefusalKey, Refusal> refusals_;
  std::map<Sha256, Accepted> accepted_;  ///< by the hash of the order
  std::map<Sha256, std::weak_ptr<const void>> holds_;
  std::uint64_t age_{};
  bool changed_{};
};

}  // namespace glidehelm::daemon
