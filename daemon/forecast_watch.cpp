#include "daemon/forecast_watch.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/base/utc.hpp"
#include "core/mission/in_water.hpp"
#include "core/ocean/freshness.hpp"

namespace glidehelm::daemon {

namespace {

constexpr Seconds kTryAgain{600};      // after a reason that passes
constexpr double kLookAgain_s = 3600;  // at an address
constexpr double kExpired_s = ocean::kExpiredAfter, kFuture_s = 24 * 3600.0;

/// Whether `a` is a later forecast than `b`: by reference time when both name one, else by its end.
bool later(const OceanSource& a, const OceanSource& b) {
  const auto &x = a.forecast.facts(), &y = b.forecast.facts();
  if (std::isfinite(x.reference_s) && std::isfinite(y.reference_s) && x.reference_s != y.reference_s)
    return x.reference_s > y.reference_s;
  return x.last_s > y.last_s;
}

}  // namespace

ForecastWatch::ForecastWatch(world::World world, std::string grids, Handlers handlers, std::shared_ptr<GridCache> cache,
                             Seconds settle, OceanPool* pool)
    : world_{world},
      grids_{std::move(grids)},
      handlers_{std::move(handlers)},
      cache_{std::move(cache)},
      // A child cannot wait on a clock that stands still: in a simulated world files are complete when they are there.
      settle_{world.clock.simulated() ? Seconds{0} : settle},
      pool_{pool},
      alive_{std::make_shared<bool>(true)} {}

ForecastWatch::~ForecastWatch() { *alive_ = false; }

void ForecastWatch::follow(const mission::Mission& mission) {
  const bool same =
      mission_ && mission_->currents == mission.currents && mission_->coast_file == mission.coast_file &&
      mission_->bathymetry_file == mission.bathymetry_file && mission_->depth_margin == mission.depth_margin &&
      dive_alike(*mission_, mission) &&
      (mission.currents.analytic.empty() || (mission_->goal == mission.goal && mission_->start == mission.start));
  mission_ = mission;
  if (same && (current_ || loading_)) return;
  current_.reset();
  seen_.clear();
  said_.clear();
  try_again_.reset();
  ++generation_;
  look();
}

/// Names and looks of the files: enough to see that something new is there. An address shows nothing from outside: it looks
/// new once an hour.
std::string ForecastWatch::fingerprint() const {
  std::string text = "formula";
  std::vector<std::string> patterns = mission_->currents.files;
  for (const auto& source : mission_->currents.sources)
    patterns.insert(patterns.end(), source.files.begin(), source.files.end());
  for (const auto& pattern : patterns) {
    if (pattern.find("://") != std::string::npos) {
      text += fmt::format("\n{} in hour {:.0f}", pattern, std::floor(epoch_seconds(world_.clock.utc()) / kLookAgain_s));
      continue;
    }
    for (const auto& path : world_.files.glob(pattern)) {
      const auto stat = world_.files.stat(path);
      const auto identity = stat ? FileIdentity::of(*stat) : FileIdentity{};
      text += fmt::format("\n{} {} {} {} {}", path, identity.inode, identity.size, identity.modified_ns,
                          identity.changed_ns);
    }
  }
  // A source that expires is something new, too: the others go on without it.
  if (current_)
    for (const auto& origin : current_->origins)
      if (origin.issued_s && epoch_seconds(world_.clock.utc()) - *origin.issued_s > ocean::kExpiredAfter)
        text += "\n" + origin.name + " has expired";
  return text;
}

void ForecastWatch::look() {
  if (!mission_) return;
  if (loading_) {
    again_ = true;
    return;
  }
  auto seen = fingerprint();
  const bool due = try_again_ && world_.clock.tick() >= *try_again_;
  if (seen != seen_ || due) load(std::move(seen));
}

OceanOrder ForecastWatch::order() const {
  return {*mission_,
          grids_,
          !mission_->coast_file.empty(),
          mission_->start_time.value_or(world_.clock.utc()),
          mission_->start,
          cache_,
          settle_,
          epoch_seconds(world_.clock.utc())};
}

void ForecastWatch::load(std::string seen) {
  loading_ = true;
  again_ = false;
  try_again_.reset();
  if (seen != seen_) said_.clear();
  seen_ = std::move(seen);
  if (!cache_ && mission_->currents.has_files()) {
    auto cache = GridCache::open(world_.files, grids_);
    if (cache)
      cache_ = std::move(*cache);
    else if (handlers_.noted)
      handlers_.noted("forecasts are not kept: " + cache.error());
  }
  const auto asked = order();
  auto then = [this, asked, alive = alive_, generation = generation_](OceanOutcome outcome) {
    if (!*alive) return;
    loading_ = false;
    if (generation == generation_) loaded(asked, std::move(outcome));
    if (again_ || generation != generation_) look();
  };
  if (pool_ != nullptr)
    pool_->load(asked, seen_, world_, std::move(then));
  else
    load_ocean_async(asked, world_, std::move(then));
}

/// A forecast of another time than ours, or nothing when it is one to use.
std::optional<IngestFault> ForecastWatch::untimely(const OceanSource& ocean) const {
  const auto& facts = ocean.forecast.facts();
  if (!facts.issued_s) return std::nullopt;
  const double now = epoch_seconds(world_.clock.utc());
  const auto at = [](double seconds) { return utc_text(instant_at(seconds)); };
  if (now > facts.last_s + kExpired_s)
    return IngestFault{fmt::format("{} has expired: its last field is of {}, {:.1f} h ago; allowed are {:.0f} h",
                                   ocean.label(), at(facts.last_s), (now - facts.last_s) / 3600, kExpired_s / 3600),
                       true};
  if (now < facts.first_s - kFuture_s)
    return IngestFault{fmt::format("{} lies in the future: its first field is of {}, in {:.1f} h; allowed are {:.0f} h",
                                   ocean.label(), at(facts.first_s), (facts.first_s - now) / 3600, kFuture_s / 3600),
                       true};
  return std::nullopt;
}

void ForecastWatch::loaded(const OceanOrder& order, OceanOutcome outcome) {
  if (outcome)
    if (auto fault = untimely(**outcome)) outcome = unexpected(*fault);
  if (outcome)
    take(order, *outcome);
  else
    refuse(order, outcome.error());
  if (handlers_.settled) handlers_.settled();
}

void ForecastWatch::take(const OceanOrder& order, const std::shared_ptr<const OceanSource>& ocean) {
  if (handlers_.noted)
    for (const auto& note : ocean->notes) handlers_.noted(note);
  if (ocean->try_again) try_again_ = world_.clock.tick() + std::chrono::round<Tick::duration>(kTryAgain);
  std::string left_out;
  for (const auto& file : ocean->left_out) left_out += (left_out.empty() ? "" : "; ") + file.why;
  const bool same = current_ && ocean->key && current_->key == ocean->key;
  // What remains of a set must not take us back.
  const bool older = !left_out.empty() && current_ && !same && !later(*ocean, *current_);
  if (!same && !older) {
    current_ = ocean;
    accept_ocean(order, *ocean);
    handlers_.loaded(current_);
  }
  problem_ = left_out;
  if (!left_out.empty()) say_refused(left_out);
}

void ForecastWatch::refuse(const OceanOrder& order, const IngestFault& fault) {
  problem_ = fault.what;
  if (fault.passing) try_again_ = world_.clock.tick() + std::chrono::round<Tick::duration>(kTryAgain);
  if (!current_)
    if (auto last = last_accepted(order, world_); last && !untimely(*last)) {
      current_ = std::move(last);
      handlers_.loaded(current_);
    }
  say_refused(fault.what);
}

void ForecastWatch::say_refused(const std::string& problem) {
  if (problem == said_) return;
  said_ = problem;
  handlers_.refused(problem);
}

double ForecastWatch::age_s() const {
  const auto issued = current_ ? current_->forecast.facts().issued_s : std::nullopt;
  return issued ? epoch_seconds(world_.clock.utc()) - *issued : 0;
}

std::optional<std::string> ForecastWatch::expired() const {
  if (age_s() <= ocean::kExpiredAfter) return std::nullopt;
  return fmt::format("the forecast {} is {:.1f} h old; planned on are at most {:.0f} h", current_->label(),
                     age_s() / 3600, ocean::kExpiredAfter / 3600);
}

std::string ForecastWatch::in_use() const {
  if (!current_) return "none";
  const auto& facts = current_->forecast.facts();
  if (!facts.has_time) return current_->label();
  const double hours = current_->forecast.age(world_.clock.utc()).count() / 3600;
  return hours >= 0 ? fmt::format("{}, {:.1f} h old", current_->label(), hours)
                    : fmt::format("{}, begins in {:.1f} h", current_->label(), -hours);
}

}  // namespace glidehelm::daemon
