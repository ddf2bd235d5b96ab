#include "daemon/ingest/read_files.hpp"

#include <deque>
#include <optional>
#include <utility>

#include "daemon/ingest/ensemble.hpp"
#include "daemon/ingest/grid_file.hpp"
#include "daemon/ingest/model_levels.hpp"
#include "daemon/ingest/opendap.hpp"
#include "daemon/ingest/recognise.hpp"
#include "daemon/ingest/whole_file.hpp"

namespace glidehelm::ingest {

namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span{text.data(), text.size()});
}

/// A file in memory, open.
struct Open {
  std::string bytes;
  std::optional<NetcdfFile> file;
};
Result<Open> open_whole(std::string bytes) {
  Open open{std::move(bytes), std::nullopt};
  if (auto whole = check_whole(bytes_of(open.bytes)); !whole) return unexpected(whole.error());
  return open;
}

/// What the headers say about one file of several.
struct Look {
  Contents contents{Contents::other};
  bool model_half{};          ///< one component of a model's grid, to be paired before it is read
  std::vector<double> times;  ///< of a half, as stored
  std::string time_unit;
};

/// The only component in a file that has one.
Found component_in(const NetcdfFile& file, const ReadOptions& options, bool u) {
  if (const auto& name = u ? options.east : options.north; !name.empty()) return {&file, file.find(name)};
  return lone_component(file, u);
}

Look look_at(const NetcdfFile& file, const ReadOptions& options) {
  Look look;
  look.contents = contents_of(file, options.east, options.north);
  if (look.contents != Contents::u_only && look.contents != Contents::v_only) return look;
  const Found component = component_in(file, options, look.contents == Contents::u_only);
  if (!component || recognise_axes(file, *component.variable)) return look;  // rectilinear: the plain reader's
  look.model_half = true;
  const auto parts = split(component);
  if (!parts || parts->time_coordinate == nullptr) return look;
  if (auto times = plain_numbers({&file, parts->time_coordinate})) look.times = std::move(*times);
  look.time_unit = parts->time_coordinate->unit().value_or("");
  return look;
}

Unexpected<Fault> named(const std::string& name, const Fault& what) {
  return unexpected(Fault{name + ": " + what.what, what.by_library, what.alone});
}

/// The set as it is read: grid files stay open to the end.
class Reader {
 public:
  Reader(const std::vector<std::string>& names, std::size_t grid_files, const FileAccess& access, const Units& units,
         const ReadOptions& options)
      : names_{names}, grid_files_{grid_files}, access_{access}, units_{units}, options_{options} {}

  Result<std::vector<Part>> read() {
    looks_.resize(names_.size());
    aside_.resize(names_.size());
    if (names_.size() > 1)
      for (std::size_t i = 0; i < names_.size(); ++i)
        if (auto done = look(i); !done) return unexpected(done.error());
    if (kept_.size() == names_.size())
      return fault_alone(names_.front() + ": it describes a grid, and no file has currents");
    std::vector<Part> parts;
    std::vector<bool> used(names_.size(), false);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (used[i] || looks_[i].contents == Contents::grid) continue;
      auto part = looks_[i].model_half ? read_pair(i, used) : read_one(i);
      if (!part) return unexpected(part.error());
      parts.push_back(std::move(*part));
    }
    auto whole = pair_halves(std::move(parts));
    if (!whole) return fault_alone(whole.error().what);
    if (auto same = same_member(*whole); !same) return fault_alone(same.error().what);
    return whole;
  }

 private:
  Result<Open> load(std::size_t i) {
    auto bytes = bytes_at(i);
    if (!bytes) return named(names_[i], bytes.error());
    auto open = open_whole(std::move(*bytes));
    if (!open) return named(names_[i], open.error());
    return open;
  }

  /// Opens where the bytes have come to rest: the library reads them in place.
  Result<Done> open_in_place(Open& open, std::size_t i) {
    auto file = one_member(NetcdfFile::open(bytes_of(open.bytes)), options_.member);
    if (!file) return named(names_[i], file.error());
    open.file.emplace(std::move(*file));
    return Done{};
  }

  Result<Done> look(std::size_t i) {
    if (is_address(names_[i])) return Done{};
    access_.tell(i);
    auto loaded = load(i);
    if (!loaded) return unexpected(loaded.error());
    kept_.push_back(std::move(*loaded));
    Open& open = kept_.back();
    if (auto done = open_in_place(open, i); !done) return done;
    looks_[i] = look_at(*open.file, options_);
    if (i + grid_files_ >= names_.size() && looks_[i].contents != Contents::grid)
      return fault(names_[i] + ": it is given as a grid file, but it does not describe a grid: needed are positions " +
                   "(lat_rho, lon_rho; gphit, glamt; …) and a mask, an angle or a depth, and no velocity");
    if (looks_[i].contents == Contents::grid)
      grids_.push_back({&*open.file, {names_[i], Sha256::of(bytes_of(open.bytes))}});
    else
      put_aside(i);
    return Done{};
  }

  /// Keeps the bytes of the last file that was opened for its reading, while there is room.
  void put_aside(std::size_t i) {
    kept_.back().file.reset();  // closed before its bytes move
    std::string bytes = std::move(kept_.back().bytes);
    kept_.pop_back();
    if (aside_bytes_ + bytes.size() > kAsideAtMost) return;
    aside_bytes_ += bytes.size();
    aside_[i] = std::move(bytes);
  }

  Result<std::string> bytes_at(std::size_t i) {
    if (auto bytes = std::exchange(aside_[i], std::nullopt)) {
      aside_bytes_ -= bytes->size();
      return std::move(*bytes);
    }
    return access_.load(i);
  }

  Result<Part> read_one(std::size_t i) {
    access_.tell(i);
    if (is_address(names_[i])) {
      auto part = access_.read_address(i);
      if (!part) return named(names_[i], part.error());
      return part;
    }
    const auto bytes = bytes_at(i);
    if (!bytes) return named(names_[i], bytes.error());
    auto part = read_part(names_[i], bytes_of(*bytes), units_, options_, grids_);
    if (!part) return named(names_[i], part.error());
    return part;
  }

  Result<Part> read_pair(std::size_t i, std::vector<bool>& used) {
    const Look& mine = looks_[i];
    const bool is_u = mine.contents == Contents::u_only;
    std::size_t other = i + 1;
    while (other < names_.size() &&
           (used[other] || !looks_[other].model_half || looks_[other].contents == mine.contents ||
            looks_[other].times != mine.times || looks_[other].time_unit != mine.time_unit))
      ++other;
    if (other == names_.size())
      return fault_alone(names_[i] +
                         ": it has one component of the velocity only, and no file with the other one at the same " +
                         "times was given");
    used[other] = true;
    std::vector<Open> halves;
    for (const std::size_t half : {is_u ? i : other, is_u ? other : i}) {
      access_.tell(half);
      auto loaded = load(half);
      if (!loaded) return unexpected(loaded.error());
      halves.push_back(std::move(*loaded));
    }
    std::vector<GridFile> files;
    for (std::size_t h = 0; h < 2; ++h) {
      const std::size_t half = (h == 0) == is_u ? i : other;
      if (auto done = open_in_place(halves[h], half); !done) return unexpected(done.error());
      files.push_back({&*halves[h].file, {names_[half], Sha256::of(bytes_of(halves[h].bytes))}});
    }
    files.insert(files.end(), grids_.begin(), grids_.end());
    auto part = read_model_pair(files[0].source.name, files, units_, options_);
    if (!part) return fault_alone(names_[i] + " and " + names_[other] + ": " + part.error().what);
    return part;
  }

  const std::vector<std::string>& names_;
  std::size_t grid_files_;
  const FileAccess& access_;
  const Units& units_;
  const ReadOptions& options_;
  std::vector<Look> looks_;
  static constexpr std::size_t kAsideAtMost = std::size_t{256} << 20;
  std::vector<std::optional<std::string>> aside_;
  std::size_t aside_bytes_{};
  std::deque<Open> kept_;  // grid files; a deque, whose elements stay where they are
  std::vector<GridFile> grids_;
};

}  // namespace

Result<std::vector<Part>> read_files(const std::vector<std::string>& names, std::size_t grid_files,
                                     const FileAccess& access, const Units& units, const ReadOptions& options) {
  return Reader{names, grid_files, access, units, options}.read();
}

}  // namespace glidehelm::ingest
