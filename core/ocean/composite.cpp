#include "core/ocean/composite.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace glidehelm::ocean {

namespace {

constexpr double kSteepest = 1.4143;  // of a bilinear surface whose edges are no steeper than 1

}  // namespace

/// A sum under way: what is left for the layers below, and what the layers above gave.
struct CompositeField::Sum {
  double left{1}, east{}, north{};
  bool extrapolated{};
  std::optional<NoCurrent> reason;
};

CompositeField::CompositeField(std::vector<CompositeSource> sources, const Seams& seams)
    : sources_{std::move(sources)}, seams_{seams}, layers_{find_layers(sources_, seams_)} {}

double CompositeField::in_space(std::size_t s, GeoPoint p) const {
  return smooth_step(metres_inside(sources_[s], layers_[s], p.lat.radians(), p.lon.radians()) / seams_.blend.si());
}

/// Beyond the times that count, their end holds; beyond its own times the field answers by its own policy.
Expected<Sample, NoCurrent> CompositeField::answer_of(std::size_t s, GeoPoint p, Depth z, double t_s) const {
  const auto& source = sources_[s];
  if (!source.region.contains(p.lat.radians(), p.lon.radians())) return unexpected(NoCurrent::outside_area);
  return source.field.sample(p, z, std::min(std::max(t_s, source.from_s), source.to_s));
}

/// `give(s, share)` hears each part of the sum; a source may give twice.
template <class Give>
CompositeField::Sum CompositeField::add_up(GeoPoint p, Depth z, double t_s, const Give& give) const {
  Sum sum;
  enum Pass { by_space_and_time, by_space, whoever };
  for (const auto pass : {by_space_and_time, by_space, whoever})
    for (std::size_t s = 0; s < sources_.size() && sum.left > 0; ++s) {
      double opacity = pass == whoever ? 1 : in_space(s, p);
      if (pass == by_space_and_time && opacity > 0) opacity *= opacity_in_time(layers_[s], seams_, t_s);
      if (opacity <= 0) continue;
      const auto value = answer_of(s, p, z, t_s);
      if (!value) {
        if (pass == whoever && (!sum.reason || sum.reason == NoCurrent::outside_area)) sum.reason = value.error();
        continue;
      }
      const double share = sum.left * opacity;
      sum.left = opacity < 1 ? sum.left - share : 0;
      give(s, share);
      sum.east += share * value->current.east.si();
      sum.north += share * value->current.north.si();
      sum.extrapolated = sum.extrapolated || value->extrapolated;
    }
  return sum;
}

Expected<Sample, NoCurrent> CompositeField::sample(GeoPoint p, Depth z, double t_s) const {
  const auto sum = add_up(p, z, t_s, [](std::size_t, double) {});
  if (sum.left > 0) return unexpected(sum.reason.value_or(NoCurrent::no_data));
  return Sample{{MetresPerSecond{sum.east}, MetresPerSecond{sum.north}}, sum.extrapolated};
}

std::vector<double> CompositeField::weights(GeoPoint p, Depth z, double t_s) const {
  std::vector<double> shares(sources_.size(), 0.0);
  add_up(p, z, t_s, [&](std::size_t s, double share) { shares[s] += share; });
  return shares;
}

bool CompositeField::surely_opaque(std::size_t s, double lat, double lon, double reach, double t_s, double dt) const {
  const double from = std::min(t_s, t_s + dt), to = std::max(t_s, t_s + dt);
  return metres_inside(sources_[s], layers_[s], lat, lon) - kSteepest * reach >= seams_.blend.si() &&
         opacity_in_time(layers_[s], seams_, from) == 1 && opacity_in_time(layers_[s], seams_, to) == 1 &&
         from >= sources_[s].from_s && to <= sources_[s].to_s;
}

bool CompositeField::surely_away(std::size_t s, double lat, double lon, double reach) const {
  auto box = sources_[s].field.coverage();
  const double up = reach / 6.3e6, aside = up / std::max(1e-3, std::cos(std::min(std::abs(lat) + up, 1.57)));
  box.south -= up, box.north += up, box.west -= aside, box.east += aside;
  return !box.contains(GeoPoint::from_kernel(lat, lon));
}

/// The source that has all of the weight within `reach` metres and during the step; sources_.size() when that is not
/// certain.
std::size_t CompositeField::owner(double lat, double lon, double reach, double t_s, double dt) const {
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    if (surely_opaque(s, lat, lon, reach, t_s, dt)) return s;
    if (!surely_away(s, lat, lon, reach)) break;
  }
  return sources_.size();
}

void CompositeField::advance(Lanes& lanes, double t_s, double dt) const {
  const auto count = static_cast<std::size_t>(lanes.count);
  const double fast = fastest().si();
  constexpr std::uint8_t kElsewhere = 255;
  std::array<std::size_t, Lanes::kMax> owners{};
  for (std::size_t k = 0; k < count; ++k) {
    const double reach = std::abs(dt) * (std::hypot(lanes.water_east[k], lanes.water_north[k]) + fast);
    owners[k] = lanes.lost[k] != 0 ? sources_.size() + 1 : owner(lanes.lat[k], lanes.lon[k], reach, t_s, dt);
  }
  const Lanes start = lanes;
  for (std::size_t s = 0; s <= sources_.size(); ++s) {
    Lanes mine = start;
    bool any = false;
    for (std::size_t k = 0; k < count; ++k) {
      if (owners[k] != s) mine.lost[k] = kElsewhere;
      any = any || owners[k] == s;
    }
    if (!any) continue;
    s < sources_.size() ? sources_[s].field.advance(mine, t_s, dt) : advance_by_samples(*this, mine, t_s, dt);
    for (std::size_t k = 0; k < count; ++k) {
      if (owners[k] != s) continue;
      if (mine.lost[k] != 0 && s < sources_.size()) {
        owners[k] = sources_.size();  // another source may answer where this one does not
        continue;
      }
      lanes.lat[k] = mine.lat[k];
      lanes.lon[k] = mine.lon[k];
      lanes.lost[k] = mine.lost[k];
    }
  }
}

Coverage CompositeField::coverage() const {
  Coverage all = sources_.front().field.coverage();
  all.holds_outside = false;
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    auto box = sources_[s].field.coverage();
    all.south = std::min(all.south, box.south);
    all.north = std::max(all.north, box.north);
    // In the frame of the first: the turn that makes the common box narrowest.
    const double turn = 2 * kPi * std::round((0.5 * (all.west + all.east) - 0.5 * (box.west + box.east)) / (2 * kPi));
    all.west = std::min(all.west, box.west + turn);
    all.east = std::max(all.east, box.east + turn);
    all.first_s = s == 0 ? layers_[s].first_s : std::min(all.first_s, layers_[s].first_s);
    all.last_s = s == 0 ? layers_[s].last_s : std::max(all.last_s, layers_[s].last_s);
    all.holds_outside = all.holds_outside || box.holds_outside;
  }
  all.east = std::min(all.east, all.west + 2 * kPi);
  return all;
}

MetresPerSecond CompositeField::fastest() const {
  double fastest = 0;
  for (const auto& source : sources_) fastest = std::max(fastest, source.field.fastest().si());
  return MetresPerSecond{fastest * (1 + 1e-12)};  // shares that sum to 1 but for rounding
}

}  // namespace glidehelm::ocean
