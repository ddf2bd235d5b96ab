#include "daemon/grid_cache.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace glidehelm::daemon {

namespace {

constexpr const char* kIndex = "index";
constexpr std::string_view kFirstLine = "glidehelm grids 1\n";
constexpr std::size_t kIndexAtMost = std::size_t{16} << 20;
constexpr std::string_view kGrid = ".grid";

std::string name_of(const Sha256& key) { return key.hex() + std::string{kGrid}; }

std::optional<Sha256> key_in(const std::string& name) {
  Sha256 key;
  if (name.size() != 64 + kGrid.size() || name.compare(64, kGrid.size(), kGrid) != 0) return std::nullopt;
  if (!Sha256::from_hex(std::string_view{name}.substr(0, 64), key)) return std::nullopt;
  return key;
}

Sha256 provenance(const std::vector<Sha256>& contents) {
  std::vector<ocean::GridSource> sources;
  for (const auto& content : contents) sources.push_back({{}, content});
  return ocean::provenance_of(sources);
}

/// Takes words from the front of a line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_{line} {}
  std::string_view next() {
    const auto space = rest_.find(' ');
    const auto word = rest_.substr(0, space);
    rest_ = space == std::string_view::npos ? std::string_view{} : rest_.substr(space + 1);
    return word;
  }
  template <class T>
  T number() {
    const auto word = next();
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    failed_ = failed_ || error != std::errc{} || end != word.data() + word.size();
    return value;
  }
  Sha256 hash() {
    Sha256 value;
    failed_ = !Sha256::from_hex(next(), value) || failed_;
    return value;
  }
  [[nodiscard]] std::string rest() const { return std::string{rest_}; }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  std::string_view rest_;
  bool failed_{};
};

/// Forgets the oldest entries beyond `most`.
template <class Map>
void bound(Map& map, std::size_t most) {
  while (map.size() > most)
    map.erase(std::min_element(map.begin(), map.end(),
                               [](const auto& a, const auto& b) { return a.second.age < b.second.age; }));
}

bool is_one_line(const std::string& text) { return text.find('\n') == std::string::npos; }

std::string checksum_line(std::string_view text) { return "sum " + std::to_string(crc32c(text)) + "\n"; }

}  // namespace

Expected<std::shared_ptr<GridCache>, std::string> GridCache::open(world::Files& files, const std::string& folder,
                                                                  const Limits& limits) {
  std::shared_ptr<GridCache> cache{new GridCache{files, folder, limits}};
  auto opened = files.make_folder(folder, 0750);
  if (!opened) return unexpected(opened.error().message());
  cache->folder_ = std::move(*opened);
  auto staging = files.make_folder(cache->staging(), 0750);
  if (!staging) return unexpected(staging.error().message());
  cache->staging_ = std::move(*staging);
  cache->read_index();
  cache->sweep();
  return cache;
}

/// Nobody else makes anything here, so what is neither a grid nor the index is half made.
void GridCache::sweep() {
  if (const auto left = staging_->list())
    for (const auto& name : *left) (void)staging_->unlink(name);
  if (const auto names = folder_->list())
    for (const auto& name : *names)
      if (name != kIndex && name != "staging" && !key_in(name)) (void)folder_->unlink(name);
}

// ---- the index

void GridCache::read_index() {
  const auto text = folder_->read(kIndex, kIndexAtMost);
  if (!text) return;
  const auto sum = text->rfind("sum ");
  if (sum == std::string::npos || text->substr(sum) != checksum_line(std::string_view{*text}.substr(0, sum)) ||
      text->compare(0, kFirstLine.size(), kFirstLine) != 0)
    return;
  for (std::size_t at = kFirstLine.size(); at < sum;) {
    const auto end = text->find('\n', at);
    if (!read_line(text->substr(at, end - at))) return;
    at = end + 1;
  }
}

bool GridCache::read_line(const std::string& line) {
  Words words{line};
  const auto kind = words.next();
  if (kind == "file") {
    Known known;
    known.content = words.hash();
    known.identity = {words.number<std::uint64_t>(), words.number<std::uint64_t>(), words.number<std::uint64_t>(),
                      words.number<std::int64_t>(), words.number<std::int64_t>()};
    known.age = ++age_;
    if (!words.failed()) known_[words.rest()] = known;
  } else if (kind == "refused") {
    const auto recipe = words.hash(), contents = words.hash();
    if (!words.failed()) refusals_[{recipe, contents}] = {words.rest(), ++age_};
  } else if (kind == "accepted") {
    const auto order = words.hash(), key = words.hash();
    if (!words.failed()) accepted_[order] = {key, ++age_};
  }
  return !words.failed();
}

world::FileResult<Done> GridCache::save() {
  if (!changed_) return Done{};
  // Oldest first, so that a reader that counts lines finds the same order again.
  std::vector<std::pair<std::uint64_t, std::string>> lines;
  for (const auto& [path, known] : known_) {
    std::string line = "file " + known.content.hex();
    for (const auto number : {known.identity.device, known.identity.inode, known.identity.size})
      line += " " + std::to_string(number);
    for (const auto number : {known.identity.modified_ns, known.identity.changed_ns})
      line += " " + std::to_string(number);
    lines.emplace_back(known.age, line + " " + path);
  }
  for (const auto& [key, refusal] : refusals_)
    lines.emplace_back(refusal.age, "refused " + key.first.hex() + " " + key.second.hex() + " " + refusal.reason);
  for (const auto& [order, accepted] : accepted_)
    lines.emplace_back(accepted.age, "accepted " + order.hex() + " " + accepted.key.hex());
  std::sort(lines.begin(), lines.end());
  std::string text{kFirstLine};
  for (const auto& [age, line] : lines) text += line + "\n";
  text += checksum_line(text);
  const std::string staged = ".index";
  (void)staging_->unlink(staged);
  if (auto made = staging_->create(staged, text, 0640); !made) return unexpected(made.error());
  if (auto renamed = staging_->rename_over(staged, *folder_, kIndex); !renamed) return renamed;
  changed_ = false;
  return folder_->sync();
}

// ---- what is known of files

std::optional<std::vector<Sha256>> GridCache::contents(const std::vector<std::string>& paths) {
  std::vector<Sha256> found;
  for (const auto& path : paths) {
    const auto known = known_.find(path);
    if (known == known_.end()) return std::nullopt;
    const auto stat = files_.stat(path);
    if (!stat || FileIdentity::of(*stat) != known->second.identity) return std::nullopt;
    found.push_back(known->second.content);
  }
  return found;
}

void GridCache::learn(const std::string& path, const FileIdentity& identity, const Sha256& content) {
  if (!is_one_line(path)) return;
  known_[path] = {identity, content, ++age_};
  bound(known_, limits_.memories);
  changed_ = true;
}

void GridCache::refuse(const std::string& recipe, const std::vector<Sha256>& contents, const std::string& reason) {
  auto text = reason;
  std::replace(text.begin(), text.end(), '\n', ' ');
  refusals_[{Sha256::of(recipe), provenance(contents)}] = {text, ++age_};
  bound(refusals_, limits_.memories / 4);
  changed_ = true;
}

const GridCache::Refusal* GridCache::refusal(const std::string& recipe, const std::vector<Sha256>& contents) const {
  const auto found = refusals_.find({Sha256::of(recipe), provenance(contents)});
  return found == refusals_.end() ? nullptr : &found->second;
}

std::string GridCache::refused_list(const std::string& recipe) const {
  const auto wanted = Sha256::of(recipe);
  std::string list;
  for (const auto& [key, refusal] : refusals_)
    if (key.first == wanted) list += key.second.hex() + "\n";
  return list;
}

// ---- grids

Sha256 GridCache::key_of(const std::string& recipe, const std::vector<Sha256>& contents) {
  return Sha256::of("grid " + std::to_string(ocean::kGridVersion) + "\n" + recipe + "\n" + provenance(contents).hex());
}

std::shared_ptr<const void> GridCache::hold(const Sha256& key) {
  auto& weak = holds_[key];
  auto strong = weak.lock();
  if (!strong) weak = strong = std::make_shared<const int>();
  return strong;
}

bool GridCache::held(const Sha256& key) const {
  const auto hold = holds_.find(key);
  return hold != holds_.end() && !hold->second.expired();
}

std::unique_ptr<MappedGrid> GridCache::take(const Sha256& key, std::string& damage) {
  const auto name = name_of(key);
  if (!folder_->stat(name)) return nullptr;
  auto mapping = files_.map(folder_path_ + "/" + name);
  if (!mapping) return nullptr;
  auto view = ocean::open_grid((*mapping)->bytes());
  if (!view) {
    damage = view.error().message();
    (void)folder_->unlink(name);
    return nullptr;
  }
  return std::make_unique<MappedGrid>(
      MappedGrid{std::move(*mapping), std::move(*view), folder_path_ + "/" + name, hold(key)});
}

Expected<std::unique_ptr<MappedGrid>, std::string> GridCache::put(const std::string& name, const Sha256& key) {
  auto mapping = files_.map(staging() + "/" + name);
  if (!mapping) return unexpected(mapping.error().message());
  auto view = ocean::open_grid((*mapping)->bytes());
  if (!view) return unexpected(view.error().message());
  const auto final_name = name_of(key);
  if (auto renamed = staging_->rename_over(name, *folder_, final_name); !renamed)
    return unexpected(renamed.error().message());
  // The child made the bytes durable. If the power goes now the name may be lost, and the grid is made again.
  (void)folder_->sync();
  auto grid = std::make_unique<MappedGrid>(
      MappedGrid{std::move(*mapping), std::move(*view), folder_path_ + "/" + final_name, hold(key)});
  make_room();
  return grid;
}

void GridCache::discard(const std::string& name) {
  const auto names = staging_->list();
  if (!names) return;
  for (const auto& found : *names)
    if (found == name || found.compare(0, name.size() + 2, "." + name + ".") == 0) (void)staging_->unlink(found);
}

void GridCache::make_room() {
  struct Entry {
    std::int64_t modified_ns;
    std::string name;
    std::uint64_t size;
  };
  const auto names = folder_->list();
  if (!names) return;
  std::vector<Entry> unused;
  std::uint64_t total = 0;
  for (const auto& name : *names) {
    const auto key = key_in(name);
    const auto stat = key ? folder_->stat(name) : world::FileResult<world::FileStat>{world::FileStat{}};
    if (!key || !stat) continue;
    total += stat->size;
    if (!held(*key)) unused.push_back({stat->modified_ns, name, stat->size});
  }
  std::sort(unused.begin(), unused.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.modified_ns, a.name) < std::tie(b.modified_ns, b.name);
  });
  for (const auto& entry : unused) {
    if (total <= limits_.bytes) break;
    if (folder_->unlink(entry.name)) total -= entry.size;
  }
  std::erase_if(holds_, [](const auto& hold) { return hold.second.expired(); });
}

void GridCache::accept(const std::string& order, const Sha256& key) {
  auto& entry = accepted_[Sha256::of(order)];
  if (entry.key == key) return;
  entry = {key, ++age_};
  bound(accepted_, std::max<std::size_t>(1, limits_.memories / 16));
  changed_ = true;
}

std::optional<Sha256> GridCache::accepted(const std::string& order) const {
  const auto found = accepted_.find(Sha256::of(order));
  if (found == accepted_.end()) return std::nullopt;
  return found->second.key;
}

}  // namespace glidehelm::daemon
