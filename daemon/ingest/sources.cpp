#include "daemon/ingest/sources.hpp"

#include <utility>

namespace glidehelm::ingest {

namespace {

Unexpected<SourceFault> refuse(std::size_t file, const world::NotToBeHad& why) {
  return unexpected(SourceFault{file, why.what, why.passing});
}

}  // namespace

Expected<Sources, SourceFault> Sources::open(const std::vector<std::string>& names, std::uint64_t file_at_most,
                                             const std::function<bool(const std::string&)>& elsewhere) {
  Sources sources;
  sources.names_ = names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (elsewhere && elsewhere(names[i])) {
      sources.files_.emplace_back(std::nullopt);
      continue;
    }
    auto file = world::PublishedFile::open(names[i], file_at_most);
    if (!file) return refuse(i, file.error());
    sources.files_.emplace_back(std::move(*file));
  }
  sources.kept_.resize(names.size());
  return sources;
}

Expected<Done, SourceFault> Sources::identify(Seconds settle, std::uint64_t kept_at_most) {
  std::uint64_t kept = 0;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    if (is_elsewhere(i)) {
      identities_.push_back({names_[i], Sha256{}});
      continue;
    }
    auto bytes = files_[i]->copy(settle);
    if (!bytes) return refuse(i, bytes.error());
    identities_.push_back({names_[i], Sha256::of(std::string_view{*bytes})});
    if (bytes->size() > kept_at_most - kept) continue;
    kept += bytes->size();
    kept_[i] = std::move(*bytes);
  }
  return Done{};
}

Expected<std::string, SourceFault> Sources::take(std::size_t file) {
  if (auto kept = std::exchange(kept_[file], std::nullopt)) return std::move(*kept);
  auto bytes = files_[file]->copy(Seconds{0});
  if (!bytes) return refuse(file, bytes.error());
  if (Sha256::of(std::string_view{*bytes}) != identities_[file].hash)
    return unexpected(SourceFault{file, "is still being written: it changed while it was read", true});
  return std::move(*bytes);
}

}  // namespace glidehelm::ingest
