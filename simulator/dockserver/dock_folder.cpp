#include "simulator/dockserver/dock_folder.hpp"

#include <algorithm>
#include <cerrno>

#include "core/base/utc.hpp"

namespace glidehelm::simulator {
namespace {

constexpr std::size_t kLargestFile = 1U << 20;

/// Makes a folder and those above it.
Expected<std::unique_ptr<world::Folder>, FolderError> make_path(world::Files& files, const std::string& path) {
  auto folder = files.make_folder(path, 0755);
  if (folder) return std::move(*folder);
  const auto slash = path.find_last_of('/');
  if (folder.error().code != ENOENT || slash == std::string::npos || slash == 0)
    return unexpected(FolderError{folder.error().message()});
  auto parent = make_path(files, path.substr(0, slash));
  if (!parent) return parent;
  folder = files.make_folder(path, 0755);
  if (!folder) return unexpected(FolderError{folder.error().message()});
  return std::move(*folder);
}

/// 2026-11-25T10:20:30Z → 20261125T102030
std::string stamp_of(Instant when) {
  std::string stamp = utc_text(when);
  for (const char c : {'-', ':', 'Z'}) stamp.erase(std::remove(stamp.begin(), stamp.end(), c), stamp.end());
  return stamp;
}

}  // namespace

Expected<std::unique_ptr<world::Folder>, FolderError> make_own_folder(world::Files& files, const std::string& path) {
  auto folder = make_path(files, path);
  if (!folder) return folder;
  if ((*folder)->stat(kMarker)) return folder;
  const auto names = (*folder)->list();
  if (!names) return unexpected(FolderError{names.error().message()});
  if (!names->empty())
    return unexpected(FolderError{path + " holds files and has no marker " + kMarker +
                                  ": it was not made by glidersim. Name another folder."});
  const auto marker = (*folder)->create(kMarker, "This folder was made by glidersim.\n", 0644);
  if (!marker) return unexpected(FolderError{marker.error().message()});
  return folder;
}

Expected<std::unique_ptr<DockFolder>, FolderError> DockFolder::make(world::Files& files, const std::string& folder) {
  const auto own = make_own_folder(files, folder);
  if (!own) return unexpected(own.error());
  auto to_glider = make_path(files, folder + "/to-glider");
  if (!to_glider) return unexpected(to_glider.error());
  auto archive = make_path(files, folder + "/archive");
  if (!archive) return unexpected(archive.error());
  auto from_glider = make_path(files, folder + "/from-glider");
  if (!from_glider) return unexpected(from_glider.error());
  auto logs = make_path(files, folder + "/logs");
  if (!logs) return unexpected(logs.error());
  auto dock = std::unique_ptr<DockFolder>{new DockFolder};
  dock->to_glider_ = std::move(*to_glider);
  dock->archive_ = std::move(*archive);
  dock->from_glider_ = std::move(*from_glider);
  dock->logs_ = std::move(*logs);
  return dock;
}

std::vector<OfferedFile> DockFolder::look() {
  std::vector<OfferedFile> found;
  const auto names = to_glider_->list();
  if (!names) {
    trouble_ = names.error().message();
    return found;
  }
  for (const auto& name : *names) {
    if (name.front() == '.') continue;
    const auto stat = to_glider_->stat(name);
    if (!stat || !stat->regular) continue;
    auto bytes = to_glider_->read(name, kLargestFile);
    if (bytes)
      found.push_back({name, std::move(*bytes)});
    else
      trouble_ = bytes.error().message();
  }
  return found;
}

std::vector<OfferedFile> DockFolder::contents(Instant now) {
  if (hidden_until_ && now < *hidden_until_) return remembered_;
  return look();
}

void DockFolder::remember(Instant now) {
  if (!hidden_until_ || now >= *hidden_until_) remembered_ = look();
}

void DockFolder::sent(const OfferedFile& file, Instant when) {
  keep(*archive_, stamp_of(when) + "_" + file.name, file.bytes);
  const auto gone = to_glider_->unlink(file.name);
  if (!gone) trouble_ = gone.error().message();
}

void DockFolder::received(const OfferedFile& file, Instant) { keep(*from_glider_, file.name, file.bytes); }

void DockFolder::logged(const CallLog& log) {
  keep(*logs_, log.glider + "_" + stamp_of(log.opened) + "_" + log.medium + ".log", log.bytes);
}

void DockFolder::keep(world::Folder& folder, const std::string& name, const std::string& bytes) {
  if (folder.stat(name)) static_cast<void>(folder.unlink(name));  // of an earlier run, or fetched again after a redial
  const auto kept = folder.create(name, bytes, 0644);
  if (!kept) trouble_ = kept.error().message();
}

std::string DockFolder::take_trouble() {
  std::string trouble;
  trouble.swap(trouble_);
  return trouble;
}

}  // namespace glidehelm::simulator
