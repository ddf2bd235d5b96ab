#include "daemon/forecast_watch.hpp"

#include <fmt/format.h>

namespace glidehelm::daemon {

ForecastWatch::ForecastWatch(world::World world, std::string grids, Handlers handlers)
    : world_{world}, grids_{std::move(grids)}, handlers_{std::move(handlers)}, alive_{std::make_shared<bool>(true)} {}

ForecastWatch::~ForecastWatch() { *alive_ = false; }

void ForecastWatch::follow(const mission::Mission& mission) {
  const bool same =
      mission_ && mission_->currents == mission.currents && mission_->coast_file == mission.coast_file &&
      mission_->climb_to == mission.climb_to && mission_->dive_depth == mission.dive_depth &&
      mission_->horizontal_speed == mission.horizontal_speed && mission_->glide_angle == mission.glide_angle &&
      mission_->stint == mission.stint &&
      (mission.currents.analytic.empty() || (mission_->goal == mission.goal && mission_->start == mission.start));
  mission_ = mission;
  if (same && (current_ || loading_)) return;
  current_.reset();
  seen_.clear();
  ++generation_;
  look();
}

/// Names, sizes and times of the files: enough to see that something new is there.
std::string ForecastWatch::fingerprint() const {
  std::string text = "formula";
  for (const auto& pattern : mission_->currents.files)
    for (const auto& path : world_.files.glob(pattern)) {
      const auto stat = world_.files.stat(path);
      text += fmt::format("\n{} {} {}", path, stat ? stat->size : 0, stat ? stat->modified_ns : 0);
    }
  return text;
}

void ForecastWatch::look() {
  if (!mission_) return;
  if (loading_) {
    again_ = true;
    return;
  }
  auto seen = fingerprint();
  if (seen != seen_) load(std::move(seen));
}

void ForecastWatch::load(std::string seen) {
  loading_ = true;
  again_ = false;
  seen_ = std::move(seen);
  const OceanOrder order{*mission_, grids_, !mission_->coast_file.empty(),
                         mission_->start_time.value_or(world_.clock.utc()), mission_->start};
  load_ocean_async(order, world_, [this, alive = alive_, generation = generation_](OceanResult result) {
    if (!*alive) return;
    loading_ = false;
    if (generation == generation_) {
      if (result) {
        current_ = std::move(result).value();
        problem_.clear();
      } else {
        problem_ = result.error();
      }
      if (problem_.empty())
        handlers_.loaded(current_);
      else
        handlers_.refused(problem_);
    }
    if (again_ || generation != generation_) look();
  });
}

}  // namespace glidehelm::daemon
