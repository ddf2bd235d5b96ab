#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/waypoint_list.hpp"

namespace glidehelm::mission {

/// How far a file of ours has come (product.md 1; slocum.md W8). Only `flying` is proof of what the glider flies.
enum class Delivery {
  none,      ///< nothing was emitted yet
  queued,    ///< it lies in to-glider
  sending,   ///< the dialog says that a transfer of it began
  gone,      ///< the transfer ended, or the file is gone from to-glider: probably picked up
  unknown,   ///< its transfer failed and it is gone from to-glider: half of it may be on the glider
  reread,    ///< after that the dialog said that the glider reads its lists again
  flying,    ///< after that a `Waypoint:` line named one of its waypoints
  overruled  ///< a human's file lies where it lay
};
std::string_view word(Delivery state);

/// A file of ours that lies in to-glider, for a planner to look at again.
struct QueuedFile {
  std::string surfacing;  ///< key of the surfacing that it was made for
  std::string name, bytes;
  model::WaypointList list;
  friend bool operator==(const QueuedFile&, const QueuedFile&) = default;
};

/// Follows the file that was emitted last. A value: `Pilot` feeds it what folder and dialog say. Each function tells
/// whether the state changed.
class FileOnItsWay {
 public:
  /// A file became visible in to-glider. What was known of the one before is over; its list is remembered.
  void queued(QueuedFile file);
  bool transfer_began();
  bool transfer_ended();
  /// The transfer failed: the file is queued again, or unknown when it has left the folder before or leaves it now.
  bool transfer_failed();
  /// The folder was looked at: ours is there, no file, or somebody else's.
  bool seen_in_folder();
  bool seen_no_file();
  bool seen_foreign();
  bool list_reread();
  /// Proof, when the waypoint is one of the list to within the 1.5e-4 minute of two roundings (0.3 m) and the file has left
  /// the folder. A waypoint that one of the three lists before has too proves nothing unless the re-read was heard. A
  /// re-read after a failed transfer proves nothing, its waypoint does.
  bool waypoint_heard(GeoPoint at);
  /// The call is over: a transfer that did not end has failed.
  bool call_ended();

  [[nodiscard]] Delivery state() const { return state_; }
  /// The file is in to-glider as far as known.
  [[nodiscard]] bool in_folder() const { return state_ == Delivery::queued || state_ == Delivery::sending; }
  [[nodiscard]] const std::optional<QueuedFile>& file() const { return file_; }
  /// The glider steers to this waypoint of an older list of ours, and not to one of the newest.
  [[nodiscard]] bool of_older_list(GeoPoint at) const;
  /// Number, from 1, of the waypoint in the newest list.
  [[nodiscard]] std::optional<std::size_t> number_of(GeoPoint at) const;
  friend bool operator==(const FileOnItsWay&, const FileOnItsWay&) = default;

 private:
  bool become(Delivery state);
  [[nodiscard]] bool in_older(GeoPoint at) const;

  Delivery state_{Delivery::none};
  bool failed_{};  ///< the last transfer of it did
  std::optional<QueuedFile> file_;
  std::deque<model::WaypointList> older_;  ///< the newest last
};

}  // namespace glidehelm::mission
