#include "simulator/forecast_feed.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/utc.hpp"
#include "simulator/dockserver/dock_folder.hpp"

namespace glidehelm::simulator {
namespace {

constexpr const char* kPrefix = "cycle_";
constexpr const char* kUnfinished = ".unfinished";

std::string name_of(double reference_s) {
  std::string stamp = utc_text(instant_at(reference_s));
  for (const char c : {'-', ':', 'Z'}) stamp.erase(std::remove(stamp.begin(), stamp.end(), c), stamp.end());
  return kPrefix + stamp + ".nc";
}

}  // namespace

Expected<std::unique_ptr<ForecastFeed>, std::string> ForecastFeed::make(world::Files& files, ForecastPlan plan,
                                                                        ocean::FieldRef model) {
  auto folder = make_own_folder(files, plan.folder);
  if (!folder) return unexpected(folder.error().message());
  return std::unique_ptr<ForecastFeed>{new ForecastFeed{std::move(plan), model, std::move(*folder)}};
}

Expected<int, std::string> ForecastFeed::publish(Instant now) {
  const double every_s = 3600 * plan_.every_h;
  const double newest = std::floor((epoch_seconds(now) - 3600 * plan_.delay_h) / every_s) * every_s;
  int count = 0;
  for (double reference = last_s_ ? *last_s_ + every_s : newest; reference <= newest; reference += every_s) {
    const auto done = publish_cycle(reference);
    if (!done) return unexpected(done.error());
    last_s_ = reference;
    ++count;
  }
  if (count > 0) forget_old();
  return count;
}

Expected<Done, std::string> ForecastFeed::publish_cycle(double reference_s) {
  OceanError error;
  error.noise_m_per_s = plan_.cycle_noise_m_per_s;
  error.seed = plan_.seed * 1000003 + static_cast<std::uint64_t>(std::llround(reference_s / 3600));
  const PerturbedField cycle{model_, error, reference_s};
  auto grid = plan_.grid;
  for (double h = 0; h <= plan_.hours + 1e-6; h += plan_.time_step_h) grid.times_s.push_back(reference_s + 3600 * h);
  const auto name = name_of(reference_s);
  if (folder_->stat(kUnfinished)) static_cast<void>(folder_->unlink(kUnfinished));
  const auto made = folder_->create(kUnfinished, forecast_file(cycle, grid, reference_s), 0644);
  if (!made) return unexpected(made.error().message());
  const auto there = folder_->rename_over(kUnfinished, *folder_, name);
  if (!there) return unexpected(there.error().message());
  return Done{};
}

void ForecastFeed::forget_old() {
  const auto names = folder_->list();
  if (!names) return;
  std::vector<std::string> cycles;
  for (const auto& name : *names)
    if (name.rfind(kPrefix, 0) == 0) cycles.push_back(name);
  const auto keep = static_cast<std::size_t>(plan_.keep);
  for (std::size_t i = 0; i + keep < cycles.size(); ++i) static_cast<void>(folder_->unlink(cycles[i]));
}

}  // namespace glidehelm::simulator
