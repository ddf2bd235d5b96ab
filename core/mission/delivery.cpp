#include "core/mission/delivery.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::mission {

namespace {

constexpr std::size_t kOlder = 3;
constexpr double kPrinted = 1.5e-4 / 60.0;  // degrees: half a unit of our text, half a unit of the glider's, and a bit

bool same_place(GeoPoint a, GeoPoint b) {
  return std::abs(a.lat.degrees() - b.lat.degrees()) <= kPrinted &&
         std::abs(std::remainder(a.lon.degrees() - b.lon.degrees(), 360.0)) <= kPrinted;
}

std::optional<std::size_t> index_of(const model::WaypointList& list, GeoPoint at) {
  for (std::size_t i = 0; i < list.points.size(); ++i)
    if (same_place(list.points[i].at, at)) return i;
  return std::nullopt;
}

}  // namespace

std::string_view word(Delivery state) {
  switch (state) {
    case Delivery::none:
      return "none";
    case Delivery::queued:
      return "queued";
    case Delivery::sending:
      return "sending";
    case Delivery::gone:
      return "gone";
    case Delivery::unknown:
      return "unknown";
    case Delivery::reread:
      return "re-read";
    case Delivery::flying:
      return "flying";
    case Delivery::overruled:
      return "overruled";
  }
  return "?";
}

bool FileOnItsWay::become(Delivery state) {
  if (state_ == state) return false;
  state_ = state;
  return true;
}

void FileOnItsWay::queued(QueuedFile file) {
  if (file_) older_.push_back(std::move(file_->list));
  if (older_.size() > kOlder) older_.pop_front();
  file_ = std::move(file);
  state_ = Delivery::queued;
  failed_ = false;
}

bool FileOnItsWay::transfer_began() {
  if (state_ != Delivery::queued) return false;
  failed_ = false;
  return become(Delivery::sending);
}

bool FileOnItsWay::transfer_ended() {
  if (!in_folder() && state_ != Delivery::unknown) return false;
  failed_ = false;
  return become(Delivery::gone);
}

bool FileOnItsWay::transfer_failed() {
  // One that flies was whole; what failed now is another transfer, of a file that is not ours.
  const bool left = state_ == Delivery::gone || state_ == Delivery::reread;
  if (!in_folder() && !left) return false;
  failed_ = true;
  return become(left ? Delivery::unknown : Delivery::queued);
}

bool FileOnItsWay::seen_in_folder() {
  // During a transfer it lies there until the end. What lies there afterwards is sent again at the next call.
  if (state_ == Delivery::none || in_folder()) return false;
  return become(Delivery::queued);
}

bool FileOnItsWay::seen_no_file() { return in_folder() && become(failed_ ? Delivery::unknown : Delivery::gone); }

bool FileOnItsWay::seen_foreign() { return in_folder() && become(Delivery::overruled); }

bool FileOnItsWay::list_reread() { return state_ == Delivery::gone && become(Delivery::reread); }

bool FileOnItsWay::waypoint_heard(GeoPoint at) {
  const bool left = state_ == Delivery::gone || state_ == Delivery::unknown || state_ == Delivery::reread;
  if (!left || !number_of(at)) return false;
  if (state_ != Delivery::reread && in_older(at)) return false;
  return become(Delivery::flying);
}

bool FileOnItsWay::call_ended() { return state_ == Delivery::sending && become(Delivery::queued); }

bool FileOnItsWay::in_older(GeoPoint at) const {
  return std::any_of(older_.begin(), older_.end(),
                     [&](const model::WaypointList& list) { return index_of(list, at).has_value(); });
}

bool FileOnItsWay::of_older_list(GeoPoint at) const { return !number_of(at) && in_older(at); }

std::optional<std::size_t> FileOnItsWay::number_of(GeoPoint at) const {
  if (!file_) return std::nullopt;
  const auto i = index_of(file_->list, at);
  return i ? std::optional{*i + 1} : std::nullopt;
}

}  // namespace glidehelm::mission
