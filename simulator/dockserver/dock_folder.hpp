#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/expected.hpp"
#include "daemon/world/files.hpp"
#include "simulator/dockserver/to_glider.hpp"

namespace glidehelm::simulator {

/// Why a dockserver folder cannot be used.
struct FolderError {
  std::string what;
  [[nodiscard]] const std::string& message() const { return what; }
};

/// The marker that a folder is glidersim's own: a daemon on a simulated clock writes nowhere else (product.md 4).
inline constexpr const char* kMarker = ".glidersim";

/// A folder with the marker, made with those above it when absent; refused when it holds anything and has none.
Expected<std::unique_ptr<world::Folder>, FolderError> make_own_folder(world::Files& files, const std::string& path);

/// A dockserver folder on disk: the marker file, to-glider, from-glider, archive (`20260301T103000_goto_l10.ma`: what was
/// sent) and logs (`sim01_20260301T103000_network_net_0.log`, one per connection). `make` creates what is absent; a folder that
/// exists without the marker and holds anything belongs to somebody and is refused.
class DockFolder final : public ToGlider {
 public:
  static Expected<std::unique_ptr<DockFolder>, FolderError> make(world::Files& files, const std::string& folder);

  std::vector<OfferedFile> contents(Instant now) override;
  void sent(const OfferedFile& file, Instant when) override;
  void received(const OfferedFile& file, Instant when) override;
  void logged(const CallLog& log) override;

  /// Until `when`, `contents` keeps answering what `remember` last saw: files that computing put there later than it
  /// started are not there yet when its time is charged. `remember` does nothing while news are hidden at `now`.
  void remember(Instant now);
  void hide_news_until(Instant when) { hidden_until_ = when; }
  /// The last thing that went wrong with the files, once; empty when nothing did.
  std::string take_trouble();

 private:
  DockFolder() = default;
  std::vector<OfferedFile> look();
  void keep(world::Folder& folder, const std::string& name, const std::string& bytes);
  std::unique_ptr<world::Folder> to_glider_, from_glider_, archive_, logs_;
  std::vector<OfferedFile> remembered_;
  std::optional<Instant> hidden_until_;
  std::string trouble_;
};

}  // namespace glidehelm::simulator
